#include <stdlib.h>
#include <string.h>

#include "base/sample.h"
#include "base/text.h"
#include "view/choices.h"
#include "view/difference.h"
#include "view/engine_change.h"
#include "view/engine_private.h"

/* Whether `b` is `a` with another remark, as "live.glsl, read again" after "live.glsl". */
static bool is_of_same_file(const char *a, const char *b)
{
    const char *end = strstr(b, ", ");
    size_t length = end ? (size_t)(end - b) : 0;
    return end && strncmp(a, b, length) == 0 && (a[length] == '\0' || a[length] == ',');
}

static void describe(const struct settings *a, const struct settings *b, char *out, size_t bytes)
{
    struct choice_change changes[CHOICE_CHANGES_MAX];
    uint32_t count = choice_changes(a, b, changes);
    out[0] = '\0';
    for (uint32_t i = 0; i < count; ++i) {
        bool same = is_of_same_file(changes[i].a, changes[i].b);
        if (!changes[i].painted)
            text_add(out, bytes, "%s%s %s%s%s", out[0] ? ", " : "", changes[i].name,
                     same ? "" : changes[i].a, same ? "" : " -> ", changes[i].b);
    }
}

double engine_drawn_ms(const whit_stats *stats)
{
    return stats->render_device_ms >= 0.0 ? stats->render_device_ms : stats->render_ms;
}

void engine_compare(const struct engine_frame *before, const struct engine_frame *after,
                    struct engine_change *change)
{
    char what[sizeof change->what];
    if (!before->ids || !after->ids || before->width != after->width ||
        before->height != after->height ||
        !settings_same_place(&before->settings, &after->settings))
        return;
    describe(&before->settings, &after->settings, what, sizeof what);
    if (!what[0])
        return;
    bool colors = before->color && after->settings.paint == PAINT_COLOR;
    struct difference difference;
    difference_measure(colors ? before->color : NULL, colors ? after->color : NULL, before->ids,
                       after->ids, &difference);
    *change = (struct engine_change){
        .number = change->number + 1,
        .settings = after->settings,
        .difference = difference,
        .before_ms = engine_drawn_ms(&before->stats),
        .after_ms = engine_drawn_ms(&after->stats),
        .has_colors = colors,
        .over = !colors, /* costs and pictures are painted by different kernels */
    };
    memcpy(change->what, what, sizeof what);
}

/* Pairs of pictures that take longer than this are drawn when nothing is left to refine, unless the
   picture has not changed. */
static const double SOON_MS = 2e3;

bool engine_change_waits(const struct engine *engine)
{
    const struct engine_change *change = &engine->status.change;
    return engine->params.times && change->number > 0 && !change->over && !engine->change_left;
}

bool engine_change_step(struct engine *engine, bool late)
{
    struct engine_change *change = &engine->status.change;
    bool same = change->difference.other_colors == 0 && change->difference.other_ids == 0;
    bool soon = (change->before_ms + change->after_ms) * ENGINE_PAIRS_MIN <= SOON_MS;
    if (!engine_change_waits(engine) || !(late || same || soon) || !engine_is_idle(engine))
        return false;
    engine->changing.stopped = false;
    const char *why = engine_turns_measure(engine, &engine->changing, &change->ms);
    if (!why[0]) {
        change->before_ms = sample_of(&engine->changing.ms[0]).median;
        change->after_ms = sample_of(&engine->changing.ms[1]).median;
    }
    change->over = why != ENGINE_TURNS_STOPPED; /* stopped, as by a clicked pixel: once more */
    engine_wake(engine);
    return true;
}

void engine_change_stop(struct engine *engine)
{
    engine->changing.stopped = true;
    if (engine->timing == &engine->changing)
        engine->drawing->cancel = true;
}

bool engine_is_same(const struct engine_frame *before, const struct engine_frame *after)
{
    size_t pixels = (size_t)after->width * after->height;
    return before->ids && before->color && after->ids && after->settings.paint == PAINT_COLOR &&
           before->width == after->width && before->height == after->height &&
           settings_same_place(&before->settings, &after->settings) &&
           memcmp(whit_image_words(before->ids), whit_image_words(after->ids),
                  pixels * 2 * sizeof(uint32_t)) == 0 &&
           memcmp(whit_image_floats(before->color), whit_image_floats(after->color),
                  pixels * 4 * sizeof(float)) == 0;
}

void engine_keep(struct engine_frame *kept, const struct engine_frame *frame)
{
    bool colors = frame->settings.paint == PAINT_COLOR;
    engine_frame_finish(kept);
    *kept = (struct engine_frame){.settings = frame->settings,
                                  .stats = frame->stats,
                                  .width = frame->width,
                                  .height = frame->height,
                                  .color = colors ? whit_image_share(frame->color) : NULL,
                                  .plain = whit_image_share(frame->plain),
                                  .cuts = whit_image_share(frame->cuts),
                                  .ids = whit_image_share(frame->ids)};
}
