/* Explains a pixel's brightness in one sentence, by the rays of its first sample. */
#include <string.h>

#include "base/text.h"
#include "whit/whit_probe.h"
#include "whit/whit_scene.h"

enum { LIGHTS_NAMED = 4 };
static const double PART_MIN = 0.005; /* smaller shares of the light are not mentioned */

struct sentence {
    char *text;
    size_t bytes;
};

#define put(to, ...) text_add((to)->text, (to)->bytes, __VA_ARGS__)

static double sum_of(const float v[3])
{
    return (double)v[0] + (double)v[1] + (double)v[2];
}

/* ---- Where the light comes from ---- */

enum { PART_OWN, PART_REFLECTED, PART_THROUGH, PARTS };

/* Which PART_* a ray belongs to: the camera ray itself, or its branch by a reflected or another
   ray. */
static int part_of(const whit_probe_report *report, uint32_t ray)
{
    const whit_probe_ray *rays = report->rays;
    while (rays[ray].parent != WHIT_NONE && rays[ray].parent != 0)
        ray = rays[ray].parent;
    return ray == 0                               ? PART_OWN
           : rays[ray].kind == WHIT_RAY_REFLECTED ? PART_REFLECTED
                                                  : PART_THROUGH;
}

/* Whether shadow rays start at the hit of the camera ray, and none of them reaches its light. */
static bool is_shadowed(const whit_probe_report *report)
{
    bool asked = false;
    for (uint32_t i = 1; i < report->ray_count; ++i) {
        const whit_probe_ray *ray = &report->rays[i];
        if (ray->kind != WHIT_RAY_SHADOW || ray->parent != 0)
            continue;
        asked = true;
        if (sum_of(ray->added) > 0.0)
            return false;
    }
    return asked;
}

static void say_parts(const whit_probe_report *report, struct sentence *to)
{
    const char *const names[PARTS] = {is_shadowed(report) ? "ambient or emitted" : "direct",
                                      "reflected", "transmitted"};
    double parts[PARTS] = {0.0}, all = 0.0;
    for (uint32_t i = 0; i < report->ray_count; ++i) {
        if (report->rays[i].kind != WHIT_RAY_SHADOW)
            parts[part_of(report, i)] += sum_of(report->rays[i].added);
    }
    for (int i = 0; i < PARTS; ++i)
        all += parts[i];
    if (!(all > 0.0)) {
        put(to, "no light comes from it");
        return;
    }
    const char *between = "its light: ";
    for (int i = 0; i < PARTS; ++i) {
        if (parts[i] < PART_MIN * all)
            continue;
        put(to, "%s%.0f %% %s", between, 100.0 * parts[i] / all, names[i]);
        between = ", ";
    }
}

/* ---- Which lights reach it ---- */

/* The light that reaches the hit of the camera ray, by the shadow rays that start there. */
struct reach {
    uint32_t rays, blocker;
    double share; /* share of the light that passes, mean over the rays */
};

static struct reach reach_of(const whit_probe_report *report, uint32_t light)
{
    struct reach reach = {.blocker = WHIT_NONE};
    for (uint32_t i = 1; i < report->ray_count; ++i) {
        const whit_probe_ray *ray = &report->rays[i];
        if (ray->kind != WHIT_RAY_SHADOW || ray->parent != 0 || ray->light != light)
            continue;
        ++reach.rays;
        if (ray->end == WHIT_PROBE_BLOCKED)
            reach.blocker = ray->device.instance;
        else
            reach.share += sum_of(ray->added) / 3.0;
    }
    reach.share = reach.rays > 0 ? reach.share / reach.rays : 0.0;
    return reach;
}

static void say_light(const whit_scene *scene, const char *name, const struct reach *reach,
                      struct sentence *to)
{
    whit_instance_info blocker = {0};
    const char *quote = strchr(name, '`') ? "" : "`"; /* "emission of `panel`" has quotes */
    if (reach->blocker != WHIT_NONE)
        whit_scene_get_instance(scene, reach->blocker, &blocker);
    if (reach->rays == 0)
        put(to, "%s%s%s adds nothing", quote, name, quote);
    else if (reach->share >= 0.995)
        put(to, "%s%s%s reaches it", quote, name, quote);
    else if (reach->share >= PART_MIN)
        put(to, "%.0f %% of %s%s%s reaches it", 100.0 * reach->share, quote, name, quote);
    else
        put(to, "%s%s%s does not reach it", quote, name, quote);
    if (blocker.name && blocker.name[0])
        put(to, ", behind `%s`", blocker.name);
}

/* Says for each light whether it reaches the hit; lights that shadow rays were sent to come
   first. */
static void say_lights(const whit_probe_report *report, const whit_scene *scene,
                       struct sentence *to)
{
    whit_scene_info info;
    uint32_t told = 0;
    whit_scene_get_info(scene, &info);
    if (report->unshadowed && info.light_count > 0) {
        put(to, "; no light is blocked, as there are no shadows");
        return;
    }
    for (int asked = 1; asked >= 0; --asked) {
        for (uint32_t i = 0; i < info.light_count; ++i) {
            whit_light_info light;
            const struct reach reach = reach_of(report, i);
            if ((reach.rays > 0) != (asked == 1) || told++ >= LIGHTS_NAMED)
                continue;
            whit_scene_get_light(scene, i, &light);
            put(to, "; ");
            say_light(scene, light.name ? light.name : "", &reach, to);
        }
    }
    if (told > LIGHTS_NAMED)
        put(to, "; the rays tell of %u more lights", told - LIGHTS_NAMED);
    if (info.light_count == 0)
        put(to, "; the scene has no light but its surroundings");
}

void whit_probe_why(const whit_probe_report *report, const whit_scene *scene, char *text,
                    size_t bytes)
{
    struct sentence to = {.text = text, .bytes = bytes};
    if (bytes == 0)
        return;
    text[0] = '\0';
    if (report->ray_count == 0)
        return;
    if (report->rays[0].device.instance == WHIT_NONE) {
        put(&to, "nothing is there but the surroundings");
        return;
    }
    say_parts(report, &to);
    if (report->shaded)
        put(&to, "; which lights reach it is up to shade()");
    else
        say_lights(report, scene, &to);
}
