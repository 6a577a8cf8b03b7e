#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "frame.h"

static const char closest_name[] = "closest.rays", shadow_name[] = "shadow.rays";

static whit_renderer_params params_of(const struct frame *frame)
{
    return (whit_renderer_params){
        .width = frame->width,
        .height = frame->height,
        .depth = frame->depth,
        .bailout = strtod(frame->bailout, NULL),
        .light_samples = 16,
        .cancel = &cli_cancel,
    };
}

whit_result frame_prepare(struct frame *frame)
{
    const whit_renderer_params params = params_of(frame);
    whit_result result = bench_load_file(frame->path, &frame->loaded);
    if (result == WHIT_OK)
        result = whit_accel_create(frame->loaded.scene, NULL, &frame->accel);
    if (result == WHIT_OK)
        result = whit_reference_create(frame->accel, &params, 0, &frame->reference);
    return result;
}

void frame_finish(struct frame *frame)
{
    peer_end(&frame->peer);
    whit_reference_destroy(frame->reference);
    whit_accel_destroy(frame->accel);
    bench_unload(&frame->loaded);
}

/* ---- Programs ---- */

/* What a device that is no CPU computes shows by the clock alone. */
static whit_result run_child(const struct frame *frame, const struct bench_child *child, double *ms)
{
    struct bench_child_times times = {0};
    whit_result result = bench_child_run(child, &times);
    *ms = frame->is_cpu ? times.cpu_ms : times.clock_ms;
    return result;
}

static double now_ms(const struct frame *frame)
{
    return frame->is_cpu ? whit_clock_cpu_ms() : whit_clock_ms();
}

static whit_result run_whit(const struct frame *frame, enum frame_side side, uint32_t width,
                            uint32_t height, double *ms)
{
    const struct bench *bench = frame->bench;
    char size[32], depth[16];
    snprintf(size, sizeof size, "%ux%u", width, height);
    snprintf(depth, sizeof depth, "%u", frame->depth);
    const char *arguments[32] = {
        "whit", "render", frame->path, "-o",  "whit.pfm",  "--size",       size,
        "--aa", "1",      "--depth",   depth, "--bailout", frame->bailout, "--light-samples",
        "16",   "--quiet"};
    int count = 16;
    if (side == FRAME_FAST || side == FRAME_EXACT) {
        arguments[count++] = "--numerics";
        arguments[count++] = side == FRAME_FAST ? "fast" : "exact";
    }
    /* For small pictures as for large ones: what is made before the first ray is to cancel out. */
    if (side != FRAME_AGAINST) {
        arguments[count++] = "--packets";
        arguments[count++] = "on";
        arguments[count++] = "--classes";
        arguments[count++] = "many";
    }
    if (bench->settings.device[0]) {
        arguments[count++] = "--device";
        arguments[count++] = bench->settings.device;
    }
    if (bench->settings.no_cache)
        arguments[count++] = "--no-cache";
    const struct bench_child child = {.program = side == FRAME_AGAINST ? bench->against : NULL,
                                      .arguments = arguments,
                                      .folder = frame->folder,
                                      .err = "whit.err"};
    return run_child(frame, &child, ms);
}

static whit_result run_pov(const struct frame *frame, uint32_t width, uint32_t height, double *ms)
{
    char home[BENCH_PATH], input[64], wide[32], high[32], threads[32];
    snprintf(home, sizeof home, "HOME=%s", frame->folder);
    snprintf(input, sizeof input, "+I%s.pov", frame->name);
    snprintf(wide, sizeof wide, "+W%u", width);
    snprintf(high, sizeof high, "+H%u", height);
    snprintf(threads, sizeof threads, "+WT%ld", sysconf(_SC_NPROCESSORS_ONLN));
    const char *const arguments[] = {"povray",         home,  "povray", input, "+Opov.ppm",
                                     "+FP16",          wide,  high,     "-A",  "-D",
                                     "File_Gamma=1.0", "-GA", threads,  NULL};
    const struct bench_child child = {.program = "env",
                                      .arguments = arguments,
                                      .folder = frame->folder,
                                      .out = "pov.out",
                                      .err = "pov.err"};
    return run_child(frame, &child, ms);
}

static whit_result run_reference(const struct frame *frame, double *ms)
{
    whit_image *color = NULL;
    double before = now_ms(frame);
    whit_result result = whit_reference_render(frame->reference, &color, NULL);
    *ms = now_ms(frame) - before;
    whit_image_destroy(color);
    return result;
}

/* Single rays; shadow rays from the end where Embree is quicker. */
static whit_result run_embree(struct frame *frame, double *ms)
{
    double closest[2] = {0.0}, forth[2] = {0.0}, back[2] = {0.0};
    whit_result result = peer_rays(&frame->peer, closest_name, false);
    if (result == WHIT_OK)
        result = peer_trace(&frame->peer, "single", false, false, closest);
    if (result == WHIT_OK)
        result = peer_rays(&frame->peer, shadow_name, true);
    if (result == WHIT_OK)
        result = peer_trace(&frame->peer, "single", false, false, forth);
    if (result == WHIT_OK)
        result = peer_trace(&frame->peer, "single", true, false, back);
    int clock = frame->is_cpu ? 0 : 1;
    *ms = closest[clock] + fmin(forth[clock], back[clock]);
    return result;
}

/* ---- Turns ---- */

static whit_result draw(struct frame *frame, enum frame_side side, double *ms)
{
    if (side == FRAME_REFERENCE)
        return run_reference(frame, ms);
    if (side == FRAME_EMBREE)
        return run_embree(frame, ms);
    double small = 0.0;
    uint32_t width = frame->small_width, height = frame->small_height;
    whit_result result = side == FRAME_POV ? run_pov(frame, frame->width, frame->height, ms)
                                           : run_whit(frame, side, frame->width, frame->height, ms);
    if (result == WHIT_OK && width)
        result = side == FRAME_POV ? run_pov(frame, width, height, &small)
                                   : run_whit(frame, side, width, height, &small);
    *ms -= small;
    return result;
}

/* Round 0 fills caches, but in quick benches, which have none to quote. */
static whit_result run_side(void *user, uint32_t index, uint32_t round)
{
    struct frame *frame = user;
    enum frame_side side = frame->sides[index];
    double ms = 0.0;
    whit_result result = draw(frame, side, &ms);
    if (result == WHIT_OK && (round > 0 || frame->bench->quick))
        sample_add(&frame->ms[side], ms);
    return cli_cancel ? WHIT_ERROR_CANCELLED : result;
}

whit_result frame_run(struct frame *frame)
{
    uint32_t rounds = frame->bench->runs + (frame->bench->quick ? 0 : 1);
    return sample_in_turns(frame->side_count, rounds, run_side, frame);
}

/* ---- The picture's own rays ---- */

struct own_ray {
    uint32_t light, index; /* as they are sorted */
    whit_ray ray;
};
struct own_rays {
    struct own_ray *rays;
    size_t count, capacity;
};

static bool add_ray(struct own_rays *to, uint32_t light, const whit_ray *ray)
{
    if (to->count == to->capacity) {
        size_t capacity = 2 * to->capacity + 1024;
        struct own_ray *rays = realloc(to->rays, capacity * sizeof *rays);
        if (!rays)
            return false;
        to->rays = rays;
        to->capacity = capacity;
    }
    to->rays[to->count] = (struct own_ray){light, (uint32_t)to->count, *ray};
    ++to->count;
    return true;
}

/* A shadow ray as long as the way to its light, the others without end. */
static whit_ray ray_of(const struct frame *frame, const whit_tree_ray *from)
{
    bool shadow = from->kind == WHIT_TREE_SHADOW;
    const double *lo = frame->loaded.info.lo, *hi = frame->loaded.info.hi;
    double size = fmax(hi[0] - lo[0], fmax(hi[1] - lo[1], hi[2] - lo[2])), length = size;
    if (shadow) {
        whit_light_info light;
        whit_scene_get_light(frame->loaded.scene, from->light, &light);
        const double *p = light.position, *o = from->origin;
        length = light.kind[0] == 'd'
                     ? 2.0 * size
                     : sqrt((p[0] - o[0]) * (p[0] - o[0]) + (p[1] - o[1]) * (p[1] - o[1]) +
                            (p[2] - o[2]) * (p[2] - o[2]));
    }
    whit_ray ray = {.t_min = from->kind == WHIT_TREE_PRIMARY ? 0.0f : 1e-4f,
                    .t_max = shadow ? 1.0f - 1e-4f : INFINITY};
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = (float)from->origin[k];
        ray.dir[k] = (float)(from->dir[k] * length);
    }
    return ray;
}

static whit_result take_pixel(struct frame *frame, uint32_t x, uint32_t y, struct own_rays *closest,
                              struct own_rays *shadow)
{
    whit_tree_ray *rays;
    uint32_t count;
    whit_result result = whit_reference_rays(frame->reference, x, y, 0, &rays, &count);
    if (result != WHIT_OK)
        return result;
    bool room = true;
    for (uint32_t i = 0; room && i < count; ++i) {
        if (rays[i].end == WHIT_TREE_DEPTH || rays[i].end == WHIT_TREE_BAILOUT)
            continue;
        const whit_ray ray = ray_of(frame, &rays[i]);
        bool is_shadow = rays[i].kind == WHIT_TREE_SHADOW;
        room = add_ray(is_shadow ? shadow : closest, is_shadow ? rays[i].light : 0, &ray);
    }
    whit_memory_destroy(rays);
    if (!room)
        cli_error("out of memory");
    return !room ? WHIT_ERROR_MEMORY : cli_cancel ? WHIT_ERROR_CANCELLED : WHIT_OK;
}

static int by_light(const void *a, const void *b)
{
    const struct own_ray *x = a, *y = b;
    if (x->light != y->light)
        return x->light < y->light ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}

/* Light by light, as one would trace them. */
static whit_result write_rays(const struct frame *frame, const char *name, struct own_rays *rays)
{
    whit_ray *plain = malloc((rays->count + 1) * sizeof *plain);
    if (!plain) {
        cli_error("out of memory");
        return WHIT_ERROR_MEMORY;
    }
    if (rays->count)
        qsort(rays->rays, rays->count, sizeof *rays->rays, by_light);
    for (size_t i = 0; i < rays->count; ++i)
        plain[i] = rays->rays[i].ray;
    whit_result result = peer_write_rays(frame->folder, name, plain, rays->count);
    free(plain);
    return result;
}

whit_result frame_prepare_rays(struct frame *frame)
{
    struct own_rays closest = {0}, shadow = {0};
    whit_result result = WHIT_OK;
    for (uint32_t y = 0; result == WHIT_OK && y < frame->height; y += 8) {
        for (uint32_t x = 0; result == WHIT_OK && x < frame->width; x += 8) {
            for (uint32_t i = 0; result == WHIT_OK && i < 64; ++i)
                if (x + i % 8 < frame->width && y + i / 8 < frame->height)
                    result = take_pixel(frame, x + i % 8, y + i / 8, &closest, &shadow);
        }
    }
    if (result == WHIT_OK)
        result = write_rays(frame, closest_name, &closest);
    if (result == WHIT_OK)
        result = write_rays(frame, shadow_name, &shadow);
    free(closest.rays);
    free(shadow.rays);
    if (result == WHIT_OK)
        result = peer_write_triangles(frame->loaded.scene, frame->folder, "own.triangles");
    return result == WHIT_OK ? peer_begin(&frame->peer, frame->folder, "own.triangles") : result;
}

/* ---- Memory ---- */

static whit_result device_bytes(const struct frame *frame, const whit_renderer_params *params,
                                uint64_t *bytes)
{
    whit_renderer *renderer = NULL;
    whit_stats stats = {0};
    whit_result result =
        whit_renderer_create(frame->bench->device, frame->accel, params, &renderer);
    if (result == WHIT_OK) {
        result = whit_renderer_render(renderer);
        whit_renderer_get_stats(renderer, &stats);
    }
    whit_renderer_destroy(renderer);
    *bytes = stats.device_bytes;
    return result;
}

whit_result frame_memory(const struct frame *frame, double *megabytes)
{
    const whit_renderer_params whole = params_of(frame);
    whit_renderer_params min = whole;
    uint64_t with = 0, without = 0;
    min.width = min.height = 16;
    min.depth = 0;
    min.shadows = WHIT_SHADOWS_NONE;
    whit_result result = device_bytes(frame, &whole, &with);
    if (result == WHIT_OK)
        result = device_bytes(frame, &min, &without);
    /* A pixel takes 24 bytes, its colour and its two ids; the small picture has 256 pixels. */
    double pixels = 24.0 * ((double)frame->width * frame->height - 256.0);
    *megabytes = ((double)with - (double)without - pixels) * 1e-6;
    return result;
}
