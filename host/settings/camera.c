/* Reads the values of --camera: a name, a number, auto, or ten numbers with commas between them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "settings/settings.h"

enum { NUMBERS = 10 };

static bool read_numbers(const char *text, double numbers[NUMBERS])
{
    for (int i = 0; i < NUMBERS; ++i) {
        char *end;
        numbers[i] = strtod(text, &end);
        if (end == text || !isfinite(numbers[i]) || *end != (i + 1 < NUMBERS ? ',' : '\0'))
            return false;
        text = end + 1;
    }
    return true;
}

whit_camera camera_of_text(const char *text)
{
    double n[NUMBERS];
    whit_camera camera = {.name = text[0] ? text : NULL};
    if (!read_numbers(text, n))
        return camera;
    camera = (whit_camera){.own = true, .fov_y_degrees = n[9]};
    memcpy(camera.eye, n, sizeof camera.eye);
    memcpy(camera.target, n + 3, sizeof camera.target);
    memcpy(camera.up, n + 6, sizeof camera.up);
    return camera;
}

static void write_numbers(const whit_camera *camera, char text[SETTING_TEXT_BYTES])
{
    const double *e = camera->eye, *t = camera->target, *u = camera->up;
    const double n[NUMBERS] = {e[0], e[1], e[2], t[0], t[1],
                               t[2], u[0], u[1], u[2], camera->fov_y_degrees};
    size_t used = 0;
    for (int i = 0; i < NUMBERS; ++i) {
        if (i > 0)
            text[used++] = ',';
        setting_write_number(n[i], text + used, SETTING_TEXT_BYTES - used);
        used += strlen(text + used);
    }
}

bool settings_name_camera(struct settings *settings, const whit_camera *camera)
{
    bool pinhole = camera->kind == WHIT_CAMERA_PERSPECTIVE && !(camera->lens_radius > 0.0);
    settings->camera[0] = '\0';
    if (pinhole)
        write_numbers(camera, settings->camera);
    return pinhole;
}

whit_result settings_choose_camera(struct settings *settings, const whit_scene *scene)
{
    whit_camera camera;
    whit_camera_info first;
    if (strcmp(settings->camera, "auto") != 0)
        return WHIT_OK;
    whit_scene_get_camera(scene, 0, &first);
    settings->camera[0] = '\0';
    if (first.made_by_whit)
        return WHIT_OK;
    whit_result result = whit_scene_choose_camera(scene, &camera);
    if (result == WHIT_OK)
        write_numbers(&camera, settings->camera);
    return result;
}
