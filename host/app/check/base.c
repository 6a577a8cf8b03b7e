#include "app/check/base.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/check/cause.h"
#include "app/check/describe.h"
#include "base/array.h"
#include "base/file.h"
#include "base/path.h"

static void say_wrong(void *user, const char *text)
{
    const struct base *base = user;
    cli_error("--base %s: %s", cli_shown(base->tree.revision),
              cli_shown(worktree_name(&base->tree, text)));
}

/* For suite_read: a file that the revision lacks matters only to a case that differs. */
static bool needs_no_files(const void *user, const char *name)
{
    (void)user;
    (void)name;
    return false;
}

/* A golden that cannot be read, as one of an older format, counts as none. */
static void read_golden(struct base *base, enum golden_kind kind)
{
    char *path = golden_path(base->path, kind);
    atomic_bool said = false;
    cli_mute(&said);
    if (path && !golden_read(&base->golden, path, kind))
        golden_finish(&base->golden);
    cli_mute(NULL);
    free(path);
}

whit_result base_open(struct base *base, const char *suite, const char *root, const char *revision,
                      enum golden_kind kind)
{
    char *folder = path_folder(suite);
    *base = (struct base){.folder = NULL};
    if (!folder)
        return WHIT_ERROR_MEMORY;
    whit_result result = worktree_add(&base->tree, folder, revision);
    if (result == WHIT_OK) {
        base->folder = worktree_folder(&base->tree, folder);
        base->root = root ? worktree_folder(&base->tree, root) : NULL;
        base->path = base->folder ? string_format("%s%s", base->folder, path_name(suite)) : NULL;
        if (base->path && !file_exists(base->path)) {
            cli_error("--base %s: it has no %s", cli_shown(revision), suite);
            result = WHIT_ERROR_INPUT;
        } else if (!base->path || (root && !base->root) ||
                   !suite_read(&base->suite, base->path, base->root, needs_no_files, say_wrong,
                               base)) {
            result = WHIT_ERROR_INPUT;
        } else {
            read_golden(base, kind);
        }
    }
    free(folder);
    return result;
}

void base_close(struct base *base)
{
    suite_finish(&base->suite);
    golden_finish(&base->golden);
    worktree_remove(&base->tree);
    free(base->folder);
    free(base->root);
    free(base->path);
    *base = (struct base){.folder = NULL};
}

/* ---- How two pictures differ ---- */

struct difference {
    bool same_size;
    uint64_t others; /* pixels whose colour or hit differs in any bit */
    uint64_t hits;   /* those of them with another hit */
    uint32_t x, y;   /* pixel with the largest colour difference, among those with another hit if
                        there are any */
};

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

static void find_difference(const struct drawing *before, const struct drawing *after,
                            struct difference *out)
{
    whit_image_info a, b;
    double largest = -2.0;
    whit_image_get_info(before->color, &a);
    whit_image_get_info(after->color, &b);
    *out = (struct difference){.same_size = a.width == b.width && a.height == b.height &&
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

/* "214 pixels other, 96 hit something else" */
static void write_difference(const struct difference *difference, FILE *to)
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

struct seen {
    char hit[400];  /* "ball 5532 at 4.1021" */
    char value[80]; /* the pixel's colour or count */
};

static bool probe(const struct drawing *drawing, const struct difference *at, struct seen *out)
{
    whit_probe_ray ray;
    whit_image_info info;
    whit_instance_info instance;
    if (drawing_probe(drawing, at->x, at->y, &ray) != WHIT_OK)
        return false;
    whit_image_get_info(drawing->color, &info);
    size_t pixel = (size_t)at->y * info.width + at->x;
    const float *value = whit_image_floats(drawing->color) + pixel * info.channels;
    if (info.channels < 3)
        snprintf(out->value, sizeof out->value, "%.6g", (double)value[0]);
    else
        snprintf(out->value, sizeof out->value, "%.6g %.6g %.6g", (double)value[0],
                 (double)value[1], (double)value[2]);
    snprintf(out->hit, sizeof out->hit, "nothing");
    if (ray.device.instance == WHIT_NONE)
        return true;
    whit_scene_get_instance(drawing->job.scene, ray.device.instance, &instance);
    snprintf(out->hit, sizeof out->hit, "%.255s%s%" PRIu32 " at %.5g", instance.name,
             instance.name[0] ? " " : "#", ray.device.primitive, ray.device.t);
    return true;
}

/* Writes "; pixel 212,87: was ball 5532 at 4.1021, is floor 0 at 5.87": the two hits of the pixel,
   probed by both renderers; nothing where one cannot. Names are as the files have them. */
static void write_pixel(const struct difference *difference, const struct drawing *before,
                        const struct drawing *after, FILE *to)
{
    struct seen was, is;
    if (!difference->same_size || !difference->others || !probe(before, difference, &was) ||
        !probe(after, difference, &is))
        return;
    if (strcmp(was.hit, is.hit) != 0)
        fprintf(to, "; pixel %u,%u: was %s, is %s", difference->x, difference->y, was.hit, is.hit);
    else
        fprintf(to, "; pixel %u,%u: %s, was %s, is %s", difference->x, difference->y, is.hit,
                was.value, is.value);
}

/* ---- A case as it was ---- */

struct past {
    struct job job; /* has borrowed the studio's device and compiler */
    struct drawing picture;
};

static whit_result draw_past(struct past *past, const struct studio *studio,
                             const struct check_case *item)
{
    struct job *job = &past->job;
    *past = (struct past){
        .job = {.settings = studio_settings(studio, item), .compiler = studio->job.compiler}};
    whit_result result = job_load_shader(job);
    if (result == WHIT_OK)
        result = job_load(job);
    job->device = studio->job.device;
    return result == WHIT_OK ? trial_draw(&past->picture, job) : result;
}

static void finish_past(struct past *past, const struct studio *studio)
{
    trial_finish(&past->picture);
    past->job.device = NULL;
    if (past->job.compiler == studio->job.compiler)
        past->job.compiler = NULL;
    job_finish(&past->job);
}

static whit_result write_all(const struct past *past, const struct studio *studio,
                             const struct check_case *item, const struct drawing *drawing, FILE *to)
{
    const struct job now = studio_input(studio, item, drawing);
    struct difference difference;
    struct cause cause;
    find_difference(&past->picture, drawing, &difference);
    write_difference(&difference, to);
    fputs("; ", to);
    whit_result result = cause_find(&cause, &past->job, &past->picture, &now);
    if (result == WHIT_OK)
        cause_write(&cause, to);
    cause_finish(&cause);
    if (result != WHIT_OK)
        return result;
    cli_hush(true);
    write_pixel(&difference, &past->picture, drawing, to);
    cli_hush(false);
    return WHIT_OK;
}

/* Whether a golden has the picture that was drawn; `item`: its case, or NULL. */
static bool has_picture(const struct golden_case *item, const struct drawing *picture)
{
    return item && item->ids == picture->ids_hash && item->colors == picture->color_hash;
}

/* Writes why a picture that the revision draws too is not the golden's. */
static void write_same(const struct base *base, const struct past *past, const char *name, FILE *to)
{
    bool fits = has_picture(golden_find(&base->golden, name), &past->picture);
    fprintf(to, "%s gives this picture too, %s", base->tree.revision,
            fits ? "and its golden has it: the present golden is another one"
                 : "but its golden does not have it: an older revision may tell the cause, or whit "
                   "or the device is other");
}

/* The first file of the case that the revision lacks; NULL: it has them all. */
static const char *missing_file(const struct base *base, const struct check_case *item)
{
    const struct settings *of = item->settings;
    const char *const files[] = {of->scene, of->environment, of->shader};
    for (size_t i = 0; i < sizeof files / sizeof *files; ++i) {
        if (files[i][0] && !file_exists(files[i]))
            return worktree_name(&base->tree, files[i]);
    }
    return NULL;
}

whit_result base_explain(const struct base *base, struct studio *studio,
                         const struct check_case *item, const struct golden_case *accepted,
                         const struct drawing *drawing, char **text, whit_image **before)
{
    const struct check_case *old = suite_find(&base->suite, item->name);
    const char *revision = base->tree.revision;
    struct past past;
    size_t size;
    *text = NULL;
    *before = NULL;
    const char *missing = old ? missing_file(base, old) : "such case";
    if (missing) {
        *text = string_format("%s has no %s", revision, missing);
        return *text ? WHIT_OK : WHIT_ERROR_MEMORY;
    }
    FILE *to = open_memstream(text, &size);
    if (!to)
        return WHIT_ERROR_MEMORY;
    whit_result result = draw_past(&past, studio, old);
    if (result == WHIT_OK) {
        bool same = drawing_same(drawing, &past.picture);
        if (same)
            write_same(base, &past, item->name, to);
        else
            result = write_all(&past, studio, item, drawing, to);
        if (accepted && !same && !has_picture(accepted, &past.picture))
            fprintf(to, "; at %s the picture is not the golden's either", revision);
    }
    *before = past.picture.color;
    past.picture.color = NULL;
    finish_past(&past, studio);
    bool written = fclose(to) == 0;
    if (result == WHIT_OK && written)
        return WHIT_OK;
    free(*text);
    *text = NULL;
    return result == WHIT_OK ? WHIT_ERROR_MEMORY : trial_ends_all(result) ? result : WHIT_OK;
}
