/* What --camera takes: a name, a number, or ten numbers with commas between them. */
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
