#include "app/scene/receipt_output.h"
#include "app/render/stats.h"
#include "app/settings_json.h"

static void print_head(const struct receipt *receipt)
{
    const whit_renderer_params *picture = &receipt->job->settings.picture;
    printf("%s\n  picture   %u x %u, ", cli_shown(receipt->job->settings.scene), picture->width,
           picture->height);
    if (picture->sampling.kind == WHIT_SAMPLING_ADAPTIVE)
        printf("adaptive samples, ");
    else
        printf("%u sample%s a pixel, ", picture->sampling.count,
               picture->sampling.count == 1 ? "" : "s");
    printf("depth %u\n", picture->depth);
    stats_print_device("  device    ", receipt->job->device);
    printf("  kernel    %u of %u instructions, %u of %u bindings\n", receipt->kernel.instructions,
           receipt->kernel.general_instructions, receipt->kernel.bindings,
           receipt->kernel.general_bindings);
    printf("  frame     %.2f ms (%.2f to %.2f)\n\n", receipt->frame_ms.median,
           receipt->frame_ms.low, receipt->frame_ms.high);
}

/* The time of a frame with the effect less that of one without it. */
static struct sample_median cost_of(const struct cost_effect *row)
{
    struct sample_median cost = row->price.difference[row->clock];
    if (row->compiled) /* the priced picture is the one without the effect */
        cost = (struct sample_median){.median = -cost.median,
                                      .low = -cost.high,
                                      .high = -cost.low,
                                      .coverage = cost.coverage,
                                      .count = cost.count};
    return cost;
}

static void print_price(const struct cost_effect *row)
{
    char loss[64] = "";
    unsigned long long pixels = row->error.differing_pixels;
    if (!row->priced) {
        printf("%9s %19s  %-32s", "-", "", row->compiled ? "not to be left out" : "");
        return;
    }
    if (row->compiled && pixels)
        snprintf(loss, sizeof loss, "%llu pixel%s, by up to %.3g", pixels, pixels == 1 ? "" : "s",
                 row->error.largest);
    else if (row->compiled)
        snprintf(loss, sizeof loss, "nothing in this picture");
    else if (pixels)
        snprintf(loss, sizeof loss, "NOT THE SAME PICTURE");
    const struct sample_median cost = cost_of(row);
    printf("%+9.2f %+9.2f %+9.2f  %-32s", cost.median, cost.low, cost.high, loss);
}

#define NOT_ASKED "; the shader does not ask for it"

/* Whether the scene needs the effect, but the kernel leaves it out because no function of the
   shader reads it. */
static bool is_left_out(const struct receipt *receipt, const whit_effect_info *effect,
                        const struct cost_effect *row)
{
    return receipt->job->shader && effect->called && !row->compiled;
}

int receipt_print_text(const struct receipt *receipt)
{
    print_head(receipt);
    printf("  %-19s%-9s%8s %19s  %-32s%s\n", "effect", "compiled", "ms here", "interval",
           "the picture without it loses", "where it comes from");
    for (uint32_t i = 0; i < receipt->row_count; ++i) {
        const struct cost_effect *row = &receipt->rows[i];
        whit_effect_info effect;
        whit_scene_get_effect(receipt->job->scene, i, &effect);
        printf("  %-19s%-8s", effect.name, row->compiled ? "yes" : "-");
        print_price(row);
        printf("%s%s\n", cli_shown(effect.reason),
               is_left_out(receipt, &effect, row) ? NOT_ASKED : "");
    }
    puts("\n  ms of one frame, with the effect less without it, measured in turns, and the interval"
         "\n  that holds the median 19 times of 20; of what is not compiled: what it would cost if"
         "\n  it were on.");
    return cli_finish_stdout(EXIT_FINE);
}

static json_t *times_document(const struct sample_median *times, uint32_t rounds)
{
    json_t *object = document_object();
    document_ms(object, "median", times->median);
    document_ms(object, "low", times->low);
    document_ms(object, "high", times->high);
    document_count(object, "rounds", rounds);
    return object;
}

static json_t *row_document(const struct receipt *receipt, const whit_effect_info *effect,
                            const struct cost_effect *row)
{
    json_t *object = document_object(), *difference = NULL;
    const struct sample_median cost = cost_of(row);
    document_text(object, "name", effect->name);
    document_flag(object, "called", effect->called);
    document_flag(object, "compiled", row->compiled);
    document_text(object, "reason", effect->reason);
    document_flag(object, "asked", !is_left_out(receipt, effect, row));
    document_put(object, "cost_ms",
                 row->priced ? times_document(&cost, row->price.rounds) : json_null());
    if (row->priced) {
        difference = document_object();
        document_count(difference, "pixels", row->error.differing_pixels);
        document_number(difference, "largest", row->error.largest);
    }
    document_put(object, "difference", difference ? difference : json_null());
    return object;
}

int receipt_print_json(const struct receipt *receipt)
{
    whit_scene_info scene;
    whit_device_info info;
    whit_scene_get_info(receipt->job->scene, &scene);
    whit_device_get_info(receipt->job->device, &info);
    json_t *root = document_root();
    document_text(root, "file", receipt->job->settings.scene);
    document_hash(root, "hash", scene.hash);
    document_put(root, "device", document_device(&info));
    settings_describe(&receipt->job->settings, IN_SCENE, document_child(root, "picture"));
    json_t *kernel = document_child(root, "kernel");
    document_count(kernel, "instructions", receipt->kernel.instructions);
    document_count(kernel, "general_instructions", receipt->kernel.general_instructions);
    document_count(kernel, "bindings", receipt->kernel.bindings);
    document_count(kernel, "general_bindings", receipt->kernel.general_bindings);
    document_put(root, "frame_ms", times_document(&receipt->frame_ms, COST_ROUNDS_MIN));
    json_t *effects = document_list(root, "effects");
    for (uint32_t i = 0; i < receipt->row_count; ++i) {
        whit_effect_info effect;
        whit_scene_get_effect(receipt->job->scene, i, &effect);
        document_append(effects, row_document(receipt, &effect, &receipt->rows[i]));
    }
    return cli_print_json(root);
}
