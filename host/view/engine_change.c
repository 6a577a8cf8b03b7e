/* What a switch changed. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/engine_private.h"

struct text {
    char *at;
    size_t bytes;
};

WHIT_PRINTF(2, 3)
static void add(struct text *text, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    int n = vsnprintf(text->at, text->bytes, format, args);
    va_end(args);
    size_t used = n < 0 ? 0 : (size_t)n < text->bytes ? (size_t)n : text->bytes - 1;
    text->at += used;
    text->bytes -= used;
}

static const char *builder(const struct view_settings *settings, const whit_accel_info *accel)
{
    return settings->trees.build == WHIT_BUILD_NONE ? "none" : accel->builder;
}

static void aa_name(const whit_renderer_params *p, char *text, size_t bytes)
{
    if (p->adaptive > 0.0)
        snprintf(text, bytes, "adaptive:%g", p->adaptive);
    else
        snprintf(text, bytes, "%u", p->samples ? p->samples : 1);
}

static void describe(const struct engine_kept *a, const struct engine_frame *b, char *out,
                     size_t bytes)
{
    const whit_renderer_params *p = &a->settings.picture, *q = &b->settings.picture;
    struct text text = {out, bytes};
    char from[32], to[32];
    out[0] = '\0';
    if (p->traversal != q->traversal)
        add(&text, "traversal %s -> %s ", settings_traversal_name(p->traversal),
            settings_traversal_name(q->traversal));
    if (p->numerics != q->numerics)
        add(&text, "numerics %s -> %s ", settings_numerics_name(p->numerics),
            settings_numerics_name(q->numerics));
    const char *old = builder(&a->settings, &a->accel), *new = builder(&b->settings, &b->accel);
    if (strcmp(old, new) != 0)
        add(&text, "builder %s -> %s ", old, new);
    if (a->settings.trees.flatten != b->settings.trees.flatten)
        add(&text, "instance tree %s ", b->settings.trees.flatten ? "off" : "on");
    if (p->depth != q->depth || p->no_bounces != q->no_bounces)
        add(&text, "depth %u -> %u ",
            p->no_bounces ? 0
            : p->depth    ? p->depth
                          : 8,
            q->no_bounces ? 0
            : q->depth    ? q->depth
                          : 8);
    if (p->samples != q->samples || p->adaptive != q->adaptive) {
        aa_name(p, from, sizeof from);
        aa_name(q, to, sizeof to);
        add(&text, "anti-aliasing %s -> %s ", from, to);
    }
    if (strcmp(a->settings.effects, b->settings.effects) != 0)
        add(&text, "effects %s ", b->settings.effects[0] ? b->settings.effects : "auto");
    size_t length = strlen(out);
    if (length > 0)
        out[length - 1] = '\0'; /* the blank */
}

static void compare_ids(const struct engine_kept *a, const struct engine_frame *b,
                        struct engine_change *change)
{
    const uint32_t *p = a->ids, *q = whit_image_words(b->ids);
    for (uint64_t i = 0; i < change->pixels; ++i)
        change->other_ids += p[2 * i] != q[2 * i] || p[2 * i + 1] != q[2 * i + 1];
}

static void compare_colors(const struct engine_kept *a, const struct engine_frame *b,
                           struct engine_change *change)
{
    const float *p = a->color, *q = whit_image_floats(b->color);
    double sum = 0.0;
    for (uint64_t i = 0; i < change->pixels; ++i) {
        bool other = false;
        for (uint64_t c = 4 * i; c < 4 * i + 3; ++c) {
            double d = fabs((double)p[c] - (double)q[c]);
            other = other || p[c] != q[c];
            sum += d;
            if (!(d <= change->largest))
                change->largest = d;
        }
        change->other_colors += other;
    }
    change->mean = sum / (3.0 * (double)change->pixels);
}

static double drawn_ms(const whit_stats *stats)
{
    return stats->render_device_ms >= 0.0 ? stats->render_device_ms : stats->render_ms;
}

void engine_compare(const struct engine_kept *before, const struct engine_frame *after,
                    struct engine_change *change)
{
    char what[sizeof change->what];
    if (!before->ids || !after->ids || before->width != after->width ||
        before->height != after->height ||
        !settings_same_place(&before->settings, &after->settings))
        return;
    describe(before, after, what, sizeof what);
    if (!what[0])
        return;
    *change = (struct engine_change){
        .number = change->number + 1,
        .pixels = (uint64_t)after->width * after->height,
        .before_ms = drawn_ms(&before->stats),
        .after_ms = drawn_ms(&after->stats),
    };
    memcpy(change->what, what, sizeof what);
    compare_ids(before, after, change);
    if (before->color && after->settings.paint == VIEW_PAINT_COLOR)
        compare_colors(before, after, change);
}

void engine_keep(struct engine_kept *kept, const struct engine_frame *frame)
{
    size_t pixels = (size_t)frame->width * frame->height;
    bool colors = frame->settings.paint == VIEW_PAINT_COLOR;
    engine_kept_finish(kept);
    *kept = (struct engine_kept){.settings = frame->settings,
                                 .stats = frame->stats,
                                 .accel = frame->accel,
                                 .width = frame->width,
                                 .height = frame->height};
    kept->ids = malloc(pixels * 2 * sizeof *kept->ids);
    kept->color = colors ? malloc(pixels * 4 * sizeof *kept->color) : NULL;
    if (!kept->ids || (colors && !kept->color)) {
        engine_kept_finish(kept);
        return;
    }
    memcpy(kept->ids, whit_image_words(frame->ids), pixels * 2 * sizeof *kept->ids);
    if (colors)
        memcpy(kept->color, whit_image_floats(frame->color), pixels * 4 * sizeof *kept->color);
}

void engine_kept_finish(struct engine_kept *kept)
{
    free(kept->ids);
    free(kept->color);
    kept->ids = NULL;
    kept->color = NULL;
}
