#include "view/price_strip.h"

#include <stdio.h>
#include <stdlib.h>

#include "view/palette.h"
#include "view/ui.h"

enum { LINE = 32 };

/* Cuts the crop out of the picture; NULL: there is no picture, or no memory. */
static uint32_t *cut(const whit_image *picture, const struct cost_crop *crop)
{
    uint32_t *part = picture ? malloc((size_t)crop->width * crop->height * sizeof *part) : NULL;
    if (part && palette_cut(picture, crop->x, crop->y, crop->width, crop->height,
                            (uint8_t *)part) == WHIT_OK)
        return part;
    free(part);
    return NULL;
}

void price_strip_init(struct price_strip *strip, const struct cost_report *report)
{
    const struct cost_crop crop = cost_crop(report);
    strip->width = crop.width;
    strip->height = crop.height;
    cost_strip(report, strip->shares);
    for (uint32_t i = 0; i < COST_STRIP; ++i)
        if (strip->shares[i].row != WHIT_NONE)
            strip->rgba[i] = cut(report->rows[strip->shares[i].row].picture, &crop);
}

void price_strip_finish(struct price_strip *strip)
{
    for (uint32_t i = 0; i < COST_STRIP; ++i)
        free(strip->rgba[i]);
}

static void write_title(const struct cost_share *share, char title[LINE])
{
    if (share->of_usual == 1.0)
        snprintf(title, LINE, "usual time");
    else if (share->of_usual < 1.0)
        snprintf(title, LINE, "1/%.0f the time", 1.0 / share->of_usual);
    else
        snprintf(title, LINE, "%.0f x the time", share->of_usual);
}

void price_strip_name(const struct price_strip *strip, const struct cost_report *report,
                      const struct cost_row *row, char name[COST_NAME])
{
    uint32_t index = (uint32_t)(row - report->rows);
    snprintf(name, COST_NAME, "%s%s%s", row->knob, row->setting[0] ? " " : "", row->setting);
    for (uint32_t i = 0; i < COST_STRIP; ++i)
        if (index > 0 && row->knob_index == WHIT_NONE && strip->shares[i].row == index)
            write_title(&strip->shares[i], name);
}

static void say_time(double ms, char text[LINE])
{
    snprintf(text, LINE, ms < 999.5 ? "%.3g ms" : "%.3g s", ms < 999.5 ? ms : 1e-3 * ms);
}

static void draw_share(const struct price_strip *strip, uint32_t index,
                       const struct cost_report *report)
{
    const struct cost_share *share = &strip->shares[index];
    char title[LINE], time[LINE] = "nothing is as quick", flip[LINE] = "";
    const char *const lines[] = {title, time, flip};
    bool found = share->row != WHIT_NONE && report->rows[share->row].measured;
    const struct cost_row *row = &report->rows[found ? share->row : 0];
    write_title(share, title);
    if (found) {
        say_time(row->ms[COST_WALL], time);
        snprintf(flip, LINE, cost_is_judged(report, row) ? "FLIP %.3g" : "FLIP unknown",
                 cost_error_of(&row->error, COST_FLIP));
    }
    ui_picture(strip->rgba[index], strip->width, strip->rgba[index] ? strip->height : 0, lines,
               found ? 3 : 2);
    if (found)
        ui_paragraph(row->option);
}

void price_strip_draw(const struct price_strip *strip, const struct cost_report *report)
{
    static const int widths[COST_STRIP] = {13, 13, 13, 13};
    if (ui_table_begin("strip", COST_STRIP)) {
        ui_table_columns(NULL, widths, COST_STRIP);
        for (uint32_t i = 0; i < COST_STRIP; ++i) {
            ui_table_next();
            draw_share(strip, i, report);
        }
        ui_table_end();
    }
}
