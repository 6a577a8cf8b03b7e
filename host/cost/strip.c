/* The strip of a report: crops of pictures that took different times, which the HTML page and the
   viewer's panel show side by side. */
#include <stdio.h>
#include <string.h>

#include "cost/cost.h"

enum { CROP_SHARE = 5, CROP_MIN = 32, CROP_STEP = 8 };

/* The strip shows the best picture within each of these multiples of the usual picture's time. */
static const double STEPS[] = {0.25, 1.0, 4.0, 16.0};
_Static_assert(sizeof STEPS / sizeof *STEPS == COST_STRIP, "a step each");

void cost_strip_ask(struct cost_request *request)
{
    request->keep_pictures = true;
    for (uint32_t i = 0; i < COST_STRIP; ++i)
        if (STEPS[i] != 1.0)
            request->goals[request->goal_count++] =
                (struct cost_goal){.kind = COST_WITHIN, .metric = COST_FLIP, .of_usual = STEPS[i]};
}

void cost_strip(const struct cost_report *report, struct cost_share strip[COST_STRIP])
{
    for (uint32_t i = 0; i < COST_STRIP; ++i)
        strip[i] =
            (struct cost_share){.of_usual = STEPS[i], .row = STEPS[i] == 1.0 ? 0 : WHIT_NONE};
    for (uint32_t a = 0; a < report->answer_count; ++a)
        for (uint32_t i = 0; i < COST_STRIP; ++i)
            if (report->answers[a].found && report->answers[a].goal.of_usual == STEPS[i])
                strip[i].row = report->answers[a].row;
}

uint32_t cost_samples(const struct cost_row *row)
{
    struct settings settings = settings_usual();
    const whit_sampling *sampling = &settings.picture.sampling;
    const char *option = strstr(row->option, "--aa ");
    char value[COST_NAME], why[SETTING_WHY_BYTES];
    if (!option)
        return 1;
    option += strlen("--aa ");
    snprintf(value, sizeof value, "%.*s", (int)strcspn(option, " "), option);
    setting_read(settings_row("aa"), value, &settings, why);
    return sampling->kind == WHIT_SAMPLING_ADAPTIVE ? sampling->count_max : sampling->count;
}

bool cost_is_judged(const struct cost_report *report, const struct cost_row *row)
{
    return cost_samples(row) < report->reference_samples;
}

/* ---- The crop ---- */

static double sum_of(const whit_image *map, const whit_image_info *info, uint32_t x, uint32_t y,
                     const struct cost_crop *crop)
{
    double sum = 0.0;
    for (uint32_t row = y; row < y + crop->height; ++row)
        for (uint32_t column = x; column < x + crop->width; ++column)
            sum += (double)whit_image_floats(map)[(size_t)row * info->width + column];
    return sum;
}

static uint32_t side_of(uint32_t whole)
{
    uint32_t side = whole / CROP_SHARE > CROP_MIN ? whole / CROP_SHARE : CROP_MIN;
    return side < whole ? side : whole;
}

struct cost_crop cost_crop(const struct cost_report *report)
{
    uint32_t width = report->judged_width, height = report->judged_height;
    struct cost_crop crop = {.width = side_of(width), .height = side_of(height)};
    const whit_image *map = report->rows[0].flip;
    double most = -1.0;
    whit_image_info info;
    if (map)
        whit_image_get_info(map, &info);
    for (uint32_t y = 0; map && y + crop.height <= height; y += CROP_STEP) {
        for (uint32_t x = 0; x + crop.width <= width; x += CROP_STEP) {
            double sum = sum_of(map, &info, x, y, &crop);
            if (sum > most) {
                most = sum;
                crop.x = x;
                crop.y = y;
            }
        }
    }
    return crop;
}
