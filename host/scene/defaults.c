/* Defaults for a scene whose file has no camera, light or environment. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/same.h"
#include "base/vec.h"
#include "scene/exposure.h"
#include "scene/freeze.h"
#include "scene/lit.h"
#include "scene/pose.h"
#include "scene/viewpoint.h"

/* World units; see docs/numerics.md, what is not promised. */
#define SMALLEST_SIDE 1e-17

/* whit adds a light where the model's own lights reach less than this share of what is seen. */
static const double LIT_ENOUGH = 0.5;
/* Below this share, what they do not reach gets ambient light, and is not black. */
static const double LIT_NEARLY = 0.9;
/* Where even with the added directional light less than this share is lit, the camera is taken to
   be in a closed box, and a lamp is added: shadows alone would leave more lit. */
static const double BOXED = 0.25;
static const double WIDEST = 4.0;

/* Lights that were added to a scene: whit's own light (`key`), lights made from emissive surfaces
   (`emitters`), whose intensity was scaled (`exposed`). `partial`: lights of a model leave more
   than a tenth of what is seen dark. */
struct light_kinds {
    bool key, emitters, exposed, partial;
};

static void set_color(float out[3], float r, float g, float b)
{
    out[0] = r, out[1] = g, out[2] = b;
}

static void note_viewpoint(struct scene *scene, const struct viewpoint *viewpoint)
{
    static const char *const places[] = {
        [VIEWPOINT_CORNER] = "",
        [VIEWPOINT_TURNED] = ", from the side that shows most fronts of surfaces",
        [VIEWPOINT_STRAIGHT] = ", straight on",
    };
    if (viewpoint->kind == VIEWPOINT_INSIDE)
        scene_note(scene, SCENE_NOTE_INFO,
                   "no camera in the file: one was added that looks along it from inside, for it "
                   "is a room");
    else
        scene_note(scene, SCENE_NOTE_INFO, "no camera in the file: one was added that shows %s%s",
                   viewpoint->part ? "the small part of it that nearly all triangles are in, floor "
                                     "and sky aside"
                                   : "all of it",
                   places[viewpoint->kind]);
}

/* Whether a part of the scene's box may be in a camera's picture, which is at most WIDEST times as
   wide as high. */
static bool may_see(const struct scene_camera *camera, const struct scene_pose *pose)
{
    double forward[3], right[3], up[3];
    uint32_t outside[5] = {0}; /* corners that are behind, to the right, left, above, below */
    bool parallel = camera->kind == WHIT_CAMERA_ORTHOGRAPHIC;
    double half = parallel ? 0.5 * (double)camera->height : same_tan(0.5 * (double)camera->fov_y);
    scene_camera_axes(camera, forward, right, up);
    for (int corner = 0; corner < 8; ++corner) {
        double way[3];
        for (int k = 0; k < 3; ++k)
            way[k] = (corner >> k & 1 ? pose->hi[k] : pose->lo[k]) - camera->eye[k];
        double along = double3_dot(way, forward), tall = parallel ? half : half * along;
        double aside = double3_dot(way, right), rise = double3_dot(way, up);
        outside[0] += along <= 0.0;
        outside[1] += aside > WIDEST * tall, outside[2] += -aside > WIDEST * tall;
        outside[3] += rise > tall, outside[4] += -rise > tall;
    }
    for (int i = 0; i < 5; ++i) {
        if (outside[i] == 8)
            return false;
    }
    return true;
}

/* Drops the cameras of a model in which nothing moves if all of them look past it. */
static void drop_blind_cameras(struct scene *scene, struct scene_pose *pose)
{
    bool any = !scene->is_model || scene->channel_count > 0 || pose->lo[0] > pose->hi[0];
    for (uint32_t i = 0; i < pose->camera_count; ++i)
        any = any || pose->cameras[i].kind == WHIT_CAMERA_PANORAMA ||
              may_see(&pose->cameras[i], pose);
    if (any || !scene->camera_count)
        return;
    scene_note(scene, SCENE_NOTE_WARNING, "no camera of the file sees anything: dropped %u",
               scene->camera_count);
    for (uint32_t i = 0; i < scene->camera_count; ++i)
        free(scene->cameras[i].name);
    scene->camera_count = pose->camera_count = 0;
}

static whit_result add_camera(struct scene *scene, const struct scene_pose *pose,
                              struct viewpoint *viewpoint)
{
    whit_result result = viewpoint_choose(scene, pose, viewpoint);
    if (result != WHIT_OK)
        return result;
    struct scene_camera camera = {
        .name = scene_text(scene, "default"),
        .kind = WHIT_CAMERA_PERSPECTIVE,
        .node = SCENE_NONE,
        .up = {0, 1, 0},
        .fov_y = (float)viewpoint->fov_y,
        .made_by_whit = true,
    };
    memcpy(camera.eye, viewpoint->eye, sizeof camera.eye);
    memcpy(camera.target, viewpoint->target, sizeof camera.target);
    memcpy(scene->shown_lo, viewpoint->lo, sizeof scene->shown_lo);
    memcpy(scene->shown_hi, viewpoint->hi, sizeof scene->shown_hi);
    if (scene_add_camera(scene, camera) == SCENE_NONE)
        return WHIT_ERROR_MEMORY;
    note_viewpoint(scene, viewpoint);
    return WHIT_OK;
}

static whit_result add_lamp(struct scene *scene, const char *name, const double position[3],
                            float r, float g, float b)
{
    struct scene_light light = {
        .name = scene_text(scene, name),
        .kind = WHIT_LIGHT_POINT,
        .node = SCENE_NONE,
        .direction = {0, -1, 0},
        .made_by_whit = true,
    };
    set_color(light.color, r, g, b);
    memcpy(light.position, position, sizeof light.position);
    return scene_add_light(scene, light) == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

/* Lights a room, whose walls keep out light from outside, or what is under a modelled sky: one lamp
   at the eye, and a stronger one to the left and above, so that its shadows are seen. `why`:
   beginning of the note. */
static whit_result add_room_lights(struct scene *scene, const struct viewpoint *viewpoint,
                                   const char *why)
{
    whit_result result =
        add_lamp(scene, "default lamp ahead", viewpoint->lamp, 0.6f, 0.98f * 0.6f, 0.94f * 0.6f);
    if (result == WHIT_OK)
        result = add_lamp(scene, "default lamp", viewpoint->eye, 0.3f, 0.98f * 0.3f, 0.94f * 0.3f);
    if (result == WHIT_OK)
        scene_note(scene, SCENE_NOTE_INFO,
                   "%s: two lamps were added, at the camera and %s to the left", why,
                   viewpoint->kind == VIEWPOINT_INSIDE ? "ahead of it" : "above it");
    return result;
}

/* Adds a directional light from over the camera's left shoulder. VIEWPOINT_STRAIGHT may look into
   an open box: there the light comes from closer to the view's axis, so that it reaches inside. */
static whit_result add_key_light(struct scene *scene, const struct scene_camera *camera,
                                 enum viewpoint_kind kind)
{
    const double aside = kind == VIEWPOINT_STRAIGHT ? 0.3 : 1.0;
    struct scene_light light = {
        .name = scene_text(scene, "default key light"),
        .kind = WHIT_LIGHT_DIRECTIONAL,
        .node = SCENE_NONE,
        .color = {0.95f, 0.93f, 0.9f},
        .made_by_whit = true,
    };
    double forward[3], right[3], up[3];
    scene_camera_axes(camera, forward, right, up);
    for (int i = 0; i < 3; ++i)
        light.direction[i] = 0.6 * forward[i] + aside * (0.6 * right[i] - 0.9 * up[i]);
    double3_unit(light.direction);
    return scene_add_light(scene, light) == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

const struct scene_environment scene_sky = {.kind = WHIT_ENVIRONMENT_GRADIENT,
                                            .zenith = {0.22f, 0.40f, 0.72f},
                                            .horizon = {0.72f, 0.77f, 0.82f},
                                            .ground = {0.52f, 0.52f, 0.52f},
                                            .scale = {1.0f, 1.0f, 1.0f}};

static void add_environment(struct scene *scene, bool sky)
{
    static const struct scene_environment black = {.kind = WHIT_ENVIRONMENT_GRADIENT,
                                                   .scale = {1.0f, 1.0f, 1.0f}};
    scene->environment = sky ? scene_sky : black;
    scene->environment.made_by_whit = true;
    scene_note(scene, SCENE_NOTE_INFO, "no environment in the file: %s",
               sky ? "a sky was added" : "the background is black");
}

static whit_result expose_stated_lights(struct scene *scene)
{
    double factor = 1.0;
    whit_result result = freeze_expose(scene, false, &factor);
    if (result == WHIT_OK && factor != 1.0)
        scene_note(scene, SCENE_NOTE_WARNING,
                   "the lights would leave the picture %s: they are drawn %.3g times as strong",
                   factor < 1.0 ? "burnt out" : "black", factor);
    return result;
}

static whit_result add_emitters(struct scene *scene, const struct scene_pose *pose,
                                struct light_kinds *found)
{
    uint32_t samples = 0;
    double factor = 1.0;
    whit_result result = freeze_sample_emitters(scene, pose, &samples);
    if (result == WHIT_OK && samples)
        result = freeze_expose(scene, true, &factor);
    if (result != WHIT_OK || !samples)
        return result;
    found->emitters = true;
    found->exposed = factor != 1.0;
    char strength[64];
    snprintf(strength, sizeof strength, "%.3g", factor);
    bool stated = strcmp(strength, "1") == 0;
    bool flat = scene_light_is_flat(&scene->lights[scene->light_count - 1]);
    snprintf(strength, sizeof strength, ", %.3g times as strongly as stated", factor);
    scene_note(scene, SCENE_NOTE_INFO,
               "no light in the file: its emissive surfaces light it, as %u %s%s%s", samples,
               flat ? "flat light" : "point", samples == 1 ? "" : "s", stated ? "" : strength);
    return WHIT_OK;
}

/* Adds whit's own light: lamps where the camera is in a room, else a directional light. */
static whit_result add_own_light(struct scene *scene, const struct scene_pose *pose,
                                 const struct viewpoint *viewpoint, const char *why)
{
    if (viewpoint->kind == VIEWPOINT_INSIDE || viewpoint->under_sky)
        return add_room_lights(scene, viewpoint, why);
    struct scene_camera camera = pose->camera_count ? pose->cameras[0] : scene->cameras[0];
    scene_note(scene, SCENE_NOTE_INFO,
               "%s: a directional one was added, over the camera's left shoulder", why);
    return add_key_light(scene, &camera, viewpoint->kind);
}

/* Adds a lamp at a camera of the file that sees a closed box, which the directional light does not
   reach. `share`: how much of what is seen it did reach. */
static whit_result add_lamp_at_eye(struct scene *scene, const struct scene_pose *pose, double share)
{
    const struct scene_camera *camera = pose->camera_count ? pose->cameras : scene->cameras;
    scene_note(scene, SCENE_NOTE_INFO,
               "light from outside reaches %.0f %% of what is seen: a lamp was added at the camera",
               100.0 * share);
    return add_lamp(scene, "default lamp", camera->eye, 0.6f, 0.59f, 0.56f);
}

/* Adds whit's own light where a model's lights leave most of what is seen dark. */
static whit_result help_lights(struct scene *scene, const struct scene_pose *pose,
                               const struct viewpoint *viewpoint, struct light_kinds *found)
{
    double share = 1.0;
    char why[96];
    whit_result result = WHIT_OK;
    if (!found->key)
        result = freeze_lit_share(scene, &share);
    found->partial = share < LIT_NEARLY;
    if (result == WHIT_OK && share < LIT_ENOUGH) {
        snprintf(why, sizeof why, "the file's light reaches %.0f %% of what is seen",
                 100.0 * share);
        found->key = true;
        result = add_own_light(scene, pose, viewpoint, why);
    }
    /* Only a camera of the file can be in a box without lamps: where whit puts its own camera
       inside a box, it adds a lamp. */
    bool boxed = found->key && !scene->cameras[0].made_by_whit;
    if (result == WHIT_OK && boxed)
        result = freeze_lit_share(scene, &share);
    if (result == WHIT_OK && boxed && share < BOXED)
        result = add_lamp_at_eye(scene, pose, share);
    return result;
}

static whit_result add_lights(struct scene *scene, const struct scene_pose *pose,
                              const struct viewpoint *viewpoint, struct light_kinds *found)
{
    bool own = scene->lights_wanted == WHIT_LIGHTS_KEY;
    whit_result result = WHIT_OK;
    if (scene->lights_wanted == WHIT_LIGHTS_NONE)
        return WHIT_OK;
    if (scene->light_count)
        result = expose_stated_lights(scene);
    else if (!own)
        result = add_emitters(scene, pose, found);
    if (scene->lights_wanted == WHIT_LIGHTS_FILE)
        return result;
    if (result == WHIT_OK && scene->light_count == 0) {
        found->key = true;
        result = add_own_light(scene, pose, viewpoint,
                               own ? "in place of the file's light" : "no light in the file");
    }
    return result == WHIT_OK && (scene->is_model || own)
               ? help_lights(scene, pose, viewpoint, found)
               : result;
}

static void add_ambient(struct scene *scene, const struct light_kinds *lights)
{
    /* Scaled emission stands for the lights of a bright picture, which has more ambient light;
       emission at its stated strength is a lamp in the dark. */
    bool bright = lights->key || lights->exposed || lights->partial;
    float level = bright ? 0.1f : lights->emitters ? 0.03f : 0.0f;
    set_color(scene->ambient, level, level, level);
    if (level > 0.0f)
        scene_note(scene, SCENE_NOTE_INFO, "no ambient light in the file: %g was added",
                   (double)level);
    else
        scene_note(scene, SCENE_NOTE_INFO, "no ambient light in the file: there is none");
}

/* Warns of a scene so small that rays miss its triangles. */
static void note_tiny(struct scene *scene, const struct scene_pose *pose)
{
    double side = -1.0;
    for (int k = 0; k < 3; ++k)
        side = fmax(side, pose->hi[k] - pose->lo[k]);
    if (side >= 0.0 && side < SMALLEST_SIDE)
        scene_note(scene, SCENE_NOTE_WARNING,
                   "the scene is only %.2g wide: below %g products of floats underflow, and rays "
                   "miss triangles",
                   side, SMALLEST_SIDE);
}

whit_result freeze_add_defaults(struct scene *scene)
{
    struct scene_pose pose;
    whit_result result = scene_pose_init(scene, 0.0, &pose);
    if (result != WHIT_OK)
        return result;
    note_tiny(scene, &pose);
    struct light_kinds lights = {0};
    struct viewpoint viewpoint = {.kind = VIEWPOINT_CORNER};
    double3_no_box(scene->shown_lo, scene->shown_hi);
    drop_blind_cameras(scene, &pose);
    if (!scene->camera_count)
        result = add_camera(scene, &pose, &viewpoint);
    if (result == WHIT_OK)
        result = add_lights(scene, &pose, &viewpoint, &lights);
    if (result == WHIT_OK && !scene->has_ambient)
        add_ambient(scene, &lights);
    if (result == WHIT_OK && !scene->has_environment)
        add_environment(scene, lights.key);
    scene_pose_finish(&pose);
    return result;
}
