/* What a scene gets when its file has no camera, light or environment. */
#include <math.h>
#include <string.h>

#include "base/array.h"
#include "scene/freeze.h"

#define DEFAULT_FOV_Y 0.69813170079773183 /* 40 degrees */

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void unit(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; length > 0.0 && i < 3; ++i)
        v[i] /= length;
}

static void set_color(float out[3], float r, float g, float b)
{
    out[0] = r, out[1] = g, out[2] = b;
}

/* Three-quarter view that holds the bounding sphere. */
static whit_result add_camera(struct scene *scene, const struct scene_pose *pose)
{
    struct scene_camera camera = {
        .name = string_copy("default"),
        .kind = SCENE_CAMERA_PERSPECTIVE,
        .node = SCENE_NONE,
        .up = {0, 1, 0},
        .fov_y = (float)DEFAULT_FOV_Y,
        .made_by_whit = true,
    };
    double toward_eye[3] = {0.5, 0.35, 1.0}, radius2 = 0.0;
    unit(toward_eye);
    bool empty = pose->lo[0] > pose->hi[0];
    for (int i = 0; i < 3; ++i) {
        double half = empty ? 0.0 : 0.5 * (pose->hi[i] - pose->lo[i]);
        camera.target[i] = empty ? 0.0 : pose->lo[i] + half;
        radius2 += half * half;
    }
    double radius = radius2 > 0.0 && isfinite(radius2) ? sqrt(radius2) : 1.0;
    for (int i = 0; i < 3; ++i)
        camera.eye[i] = camera.target[i] + toward_eye[i] * radius / sin(DEFAULT_FOV_Y / 2.0);
    if (scene_add_camera(scene, camera) == SCENE_NONE)
        return WHIT_ERROR_MEMORY;
    scene_note(scene, SCENE_NOTE_INFO, "no camera in the file: one was added that shows all of it");
    return WHIT_OK;
}

/* One directional light from over the camera's left shoulder. */
static whit_result add_key_light(struct scene *scene, const struct scene_camera *camera)
{
    struct scene_light light = {
        .name = string_copy("default key light"),
        .kind = SCENE_LIGHT_DIRECTIONAL,
        .node = SCENE_NONE,
        .color = {0.95f, 0.93f, 0.9f},
        .made_by_whit = true,
    };
    double forward[3], right[3], up[3];
    for (int i = 0; i < 3; ++i)
        forward[i] = camera->target[i] - camera->eye[i];
    unit(forward);
    cross(forward, camera->up, right);
    unit(right);
    cross(right, forward, up);
    for (int i = 0; i < 3; ++i)
        light.direction[i] = 0.6 * forward[i] + 0.6 * right[i] - 0.9 * up[i];
    unit(light.direction);
    return scene_add_light(scene, light) == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

static void add_sky(struct scene *scene)
{
    struct scene_environment *sky = &scene->environment;
    sky->kind = SCENE_ENVIRONMENT_GRADIENT;
    set_color(sky->zenith, 0.22f, 0.40f, 0.72f);
    set_color(sky->horizon, 0.72f, 0.77f, 0.82f);
    set_color(sky->ground, 0.52f, 0.52f, 0.52f);
    set_color(sky->scale, 1.0f, 1.0f, 1.0f);
    sky->made_by_whit = true;
}

static void add_darkness(struct scene *scene)
{
    struct scene_environment *sky = &scene->environment;
    sky->kind = SCENE_ENVIRONMENT_GRADIENT;
    set_color(sky->zenith, 0.0f, 0.0f, 0.0f);
    set_color(sky->horizon, 0.0f, 0.0f, 0.0f);
    set_color(sky->ground, 0.0f, 0.0f, 0.0f);
    set_color(sky->scale, 1.0f, 1.0f, 1.0f);
    sky->made_by_whit = true;
}

static whit_result add_lights(struct scene *scene, const struct scene_pose *pose, bool *key,
                              uint32_t *samples)
{
    *key = false;
    *samples = 0;
    if (scene->light_count)
        return WHIT_OK;
    whit_result result = freeze_sample_emitters(scene, pose, samples);
    if (result != WHIT_OK)
        return result;
    if (*samples) {
        scene_note(
            scene, SCENE_NOTE_INFO,
            "no light in the file: its emissive surfaces light it, as %u points (area lights "
            "are not sampled more finely yet)",
            *samples);
        return WHIT_OK;
    }
    *key = true;
    struct scene_camera camera = pose->camera_count ? pose->cameras[0] : scene->cameras[0];
    result = add_key_light(scene, &camera);
    if (result == WHIT_OK)
        scene_note(scene, SCENE_NOTE_INFO,
                   "no light in the file: a directional one was added, over the camera's left "
                   "shoulder");
    return result;
}

static void add_ambient(struct scene *scene, bool key, uint32_t samples)
{
    float level = key ? 0.1f : samples ? 0.03f : 0.0f;
    set_color(scene->ambient, level, level, level);
    scene->has_ambient = true;
    scene_note(scene, SCENE_NOTE_INFO, "no ambient light in the file: %s",
               key       ? "0.1 was added"
               : samples ? "0.03 was added"
                         : "there is none");
}

whit_result freeze_add_defaults(struct scene *scene)
{
    struct scene_pose pose;
    whit_result result = scene_pose_init(scene, 0.0, &pose);
    if (result != WHIT_OK)
        return result;
    bool key = false;
    uint32_t samples = 0;
    if (!scene->camera_count)
        result = add_camera(scene, &pose);
    if (result == WHIT_OK)
        result = add_lights(scene, &pose, &key, &samples);
    if (result == WHIT_OK && !scene->has_ambient)
        add_ambient(scene, key, samples);
    if (result == WHIT_OK && !scene->has_environment) {
        if (key)
            add_sky(scene);
        else
            add_darkness(scene);
        scene->has_environment = true;
        scene_note(scene, SCENE_NOTE_INFO, "no environment in the file: %s",
                   key ? "a sky was added" : "the background is black");
    }
    scene_pose_finish(&pose);
    return result;
}
