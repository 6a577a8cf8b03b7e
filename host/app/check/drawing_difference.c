#include "app/check/drawing_difference.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- Pixels ---- */

/* The largest difference of a channel. All NaN are equal; a value that is not finite on one side
   only is infinitely far off. Below 0: all bits are equal. */
static double distance_of(const float *a, const float *b, uint32_t channels)
{
    double largest = -1.0;
    for (uint32_t i = 0; i < channels; ++i) {
        double by = fabs((double)b[i] - (double)a[i]);
        if (memcmp(&a[i], &b[i], sizeof *a) != 0 && !(isnan(a[i]) && isnan(b[i])))
            largest = isnan(by) ? INFINITY : fmax(largest, by);
    }
    return largest;
}

void drawing_difference_find(const struct drawing *before, const struct drawing *after,
                             struct drawing_difference *out)
{
    whit_image_info a, b;
    double largest = -2.0;
    whit_image_get_info(before->color, &a);
    whit_image_get_info(after->color, &b);
    *out = (struct drawing_difference){.same_size = a.width == b.width && a.height == b.height &&
                                                    a.channels == b.channels};
    const float *x = whit_image_floats(before->color), *y = whit_image_floats(after->color);
    const uint32_t *p = whit_image_words(before->ids), *q = whit_image_words(after->ids);
    size_t pixels = out->same_size ? (size_t)a.width * a.height : 0;
    for (size_t i = 0; i < pixels; ++i, x += a.channels, y += a.channels, p += 2, q += 2) {
        bool hit = p[0] != q[0] || p[1] != q[1];
        double by = distance_of(x, y, a.channels);
        if (!hit && by < 0.0)
            continue;
        ++out->others;
        if (hit && !out->hits++)
            largest = -2.0; /* from now on the largest among pixels with another hit */
        if (!(by > largest) || hit != (out->hits > 0))
            continue;
        largest = by;
        out->x = (uint32_t)(i % a.width);
        out->y = (uint32_t)(i / a.width);
    }
}

void drawing_difference_write(const struct drawing_difference *difference, FILE *to)
{
    if (!difference->same_size)
        fprintf(to, "another size");
    else if (difference->hits)
        fprintf(to, "%" PRIu64 " pixel%s other, %" PRIu64 " hit%s something else",
                difference->others, difference->others == 1 ? "" : "s", difference->hits,
                difference->hits == 1 ? "s" : "");
    else
        fprintf(to, "%" PRIu64 " pixel%s other, of the same hits", difference->others,
                difference->others == 1 ? "" : "s");
}

/* ---- One pixel ---- */

struct seen {
    whit_probe_hit hit;
    char value[80]; /* the pixel's colour or count as text */
    char name[256];
};

static bool probe(const struct drawing *drawing, const struct drawing_difference *at,
                  struct seen *out)
{
    whit_probe_ray ray;
    whit_image_info info;
    whit_instance_info instance = {.name = ""};
    if (drawing_probe(drawing, at->x, at->y, &ray) != WHIT_OK)
        return false;
    out->hit = ray.device;
    whit_image_get_info(drawing->color, &info);
    size_t pixel = (size_t)at->y * info.width + at->x;
    const float *value = whit_image_floats(drawing->color) + pixel * info.channels;
    if (info.channels < 3)
        snprintf(out->value, sizeof out->value, "%.6g", (double)value[0]);
    else
        snprintf(out->value, sizeof out->value, "%.6g %.6g %.6g", (double)value[0],
                 (double)value[1], (double)value[2]);
    if (out->hit.instance != WHIT_NONE)
        whit_scene_get_instance(drawing->job.scene, out->hit.instance, &instance);
    snprintf(out->name, sizeof out->name, "%s", instance.name);
    return true;
}

/* "ball 5532 at 4.1021" */
static void write_hit(const struct seen *seen, char *text, size_t bytes)
{
    if (seen->hit.instance == WHIT_NONE)
        snprintf(text, bytes, "nothing");
    else
        snprintf(text, bytes, "%s%s%" PRIu32 " at %.5g", seen->name, seen->name[0] ? " " : "#",
                 seen->hit.primitive, seen->hit.t);
}

void drawing_difference_write_pixel(const struct drawing_difference *difference,
                                    const struct drawing *before, const struct drawing *after,
                                    FILE *to)
{
    struct seen was, is;
    char hit_before[400], hit_after[400];
    if (!difference->same_size || !difference->others || !probe(before, difference, &was) ||
        !probe(after, difference, &is))
        return;
    write_hit(&was, hit_before, sizeof hit_before);
    write_hit(&is, hit_after, sizeof hit_after);
    if (strcmp(hit_before, hit_after) != 0)
        fprintf(to, "; pixel %u,%u: was %s, is %s", difference->x, difference->y, hit_before,
                hit_after);
    else
        fprintf(to, "; pixel %u,%u: %s, was %s, is %s", difference->x, difference->y, hit_after,
                was.value, is.value);
}
