#include "image/legend.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "image/heat.h"

/* Never popped: unused functions are reported at the end of the file. */
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wcast-align"
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

/* Layout in pixels of the font; *_TOP count from the top of the strip. */
enum {
    MARGIN = 4,
    UNIT_GAP = 8, /* least gap between title and unit */
    TITLE_TOP = 5,
    BAR_TOP = 17,
    BAR_ROWS = 8,
    TICK_ROWS = 3,
    NUMBER_TOP = BAR_TOP + BAR_ROWS + TICK_ROWS + 2,
    STRIP_ROWS = NUMBER_TOP + 11,
    WIDTH_MIN = 120,   /* least width of the strip, also below narrower pictures; */
    WIDTH_WANTED = 320 /* up to this width if the title needs it */
};
enum { BACKGROUND = 20, INK = 225 };

static uint32_t letter_width(char letter)
{
    char text[2] = {letter, 0};
    return (uint32_t)stb_easy_font_width(text);
}

static uint32_t text_width(const char *text)
{
    uint32_t width = 0;
    for (; *text; ++text)
        width += letter_width(*text);
    return width;
}

/* Copies a text; characters other than ASCII, which the font lacks, become `?`. */
static void copy_text(char to[LEGEND_TEXT_MAX], const char *text)
{
    snprintf(to, LEGEND_TEXT_MAX, "%s", text ? text : "");
    for (char *c = to; *c; ++c) {
        if (*c < ' ' || *c > '~')
            *c = '?';
    }
}

static void shorten(char text[LEGEND_TEXT_MAX], uint32_t room)
{
    size_t length = strlen(text);
    while (length > 3 && text_width(text) > room)
        memcpy(text + --length - 3, "...", 4);
}

static uint32_t zoom_for(uint32_t picture_width)
{
    return picture_width < 512 ? 1 : 1 + (picture_width / 2 + 256) / 512;
}

void legend_init(struct legend *legend, uint32_t picture_width, const char *title, const char *unit,
                 double scale)
{
    *legend = (struct legend){.scale = scale, .zoom = zoom_for(picture_width)};
    copy_text(legend->title, title);
    copy_text(legend->unit, unit);
    uint32_t gap = legend->unit[0] ? UNIT_GAP : 0;
    uint32_t wanted = text_width(legend->title) + gap + text_width(legend->unit) + 2 * MARGIN;
    wanted = wanted > WIDTH_WANTED ? WIDTH_WANTED : wanted < WIDTH_MIN ? WIDTH_MIN : wanted;
    wanted *= legend->zoom;
    legend->width = picture_width > wanted ? picture_width : wanted;
    legend->height = STRIP_ROWS * legend->zoom;
    uint32_t room = legend->width / legend->zoom - 2 * MARGIN;
    shorten(legend->unit, room / 2);
    shorten(legend->title, room - gap - text_width(legend->unit));
}

struct canvas {
    struct image *image;
    uint32_t top, zoom;
    const float *linear;
};

static void fill(const struct canvas *canvas, uint32_t x, uint32_t y, uint32_t width,
                 uint32_t height, const uint8_t codes[3])
{
    struct image *image = canvas->image;
    uint32_t right = x + width < image->width ? x + width : image->width;
    uint32_t bottom = y + height < image->height ? y + height : image->height;
    for (uint32_t row = y; row < bottom; ++row) {
        for (uint32_t column = x; column < right; ++column) {
            float *pixel = image->pixels + 3 * ((size_t)row * image->width + column);
            for (int c = 0; c < 3; ++c)
                pixel[c] = canvas->linear[codes[c]];
        }
    }
}

struct corner {
    float x, y, z;
    uint8_t color[4];
};
enum { QUADS_MAX = 16 }; /* rectangles per letter */

/* Draws a text. `x`: in pixels of the picture; `y`: in font pixels from the top of the strip. */
static void draw_text(const struct canvas *canvas, uint32_t x, uint32_t y, const char *text)
{
    static const uint8_t ink[3] = {INK, INK, INK};
    struct corner corners[4 * QUADS_MAX];
    for (; *text; ++text) {
        char letter[2] = {*text, 0};
        int quads = stb_easy_font_print(0.0f, 0.0f, letter, NULL, corners, (int)sizeof corners);
        for (int i = 0; i < quads; ++i) {
            const struct corner *from = &corners[4 * i], *to = &corners[4 * i + 2];
            fill(canvas, x + canvas->zoom * (uint32_t)from->x,
                 canvas->top + canvas->zoom * (y + (uint32_t)from->y),
                 canvas->zoom * (uint32_t)(to->x - from->x),
                 canvas->zoom * (uint32_t)(to->y - from->y), ink);
        }
        x += canvas->zoom * letter_width(*text);
    }
}

struct bar {
    uint32_t left, width; /* pixels of the picture */
};

static void draw_bar(const struct legend *legend, const struct canvas *canvas,
                     const struct bar *bar)
{
    for (uint32_t x = 0; x < bar->width; ++x) {
        uint8_t codes[3];
        double share = bar->width > 1 ? (double)x / (bar->width - 1) : 0.0;
        if (legend->is_signed)
            heat_signed_color(2.0 * share - 1.0, codes);
        else
            heat_color(share, codes);
        fill(canvas, bar->left + x, canvas->top + BAR_TOP * canvas->zoom, 1,
             BAR_ROWS * canvas->zoom, codes);
    }
}

struct number {
    char text[32];
};

static struct number number_of(double value)
{
    struct number number = {""};
    text_add(number.text, sizeof number.text, "%g", value);
    return number;
}

/* Draws a number centred under its tick, but within the bar. */
static void draw_number(const struct legend *legend, const struct canvas *canvas,
                        const struct bar *bar, double value)
{
    static const uint8_t ink[3] = {INK, INK, INK};
    const struct number number = number_of(value);
    const char *text = number.text;
    uint32_t width = text_width(text) * canvas->zoom, last = bar->width - canvas->zoom;
    double share = fmin(value / legend->scale, 1.0);
    if (legend->is_signed)
        share = 0.5 * (share + 1.0);
    uint32_t at = (uint32_t)((double)last * share + 0.5);
    fill(canvas, bar->left + at, canvas->top + (BAR_TOP + BAR_ROWS) * canvas->zoom, canvas->zoom,
         TICK_ROWS * canvas->zoom, ink);
    uint32_t left = at > width / 2 ? at - width / 2 : 0;
    if (left + width > bar->width)
        left = bar->width > width ? bar->width - width : 0;
    draw_text(canvas, bar->left + left, NUMBER_TOP, text);
}

/* The smallest of 1, 2 and 5 times powers of ten that is at least `min`. */
static double tick_step(double min)
{
    double power = pow(10.0, floor(log10(min)));
    double digit = min / power;
    return power * (digit <= 1.0 ? 1.0 : digit <= 2.0 ? 2.0 : digit <= 5.0 ? 5.0 : 10.0);
}

/* Draws ticks at multiples of a step, and one at the end of the scale. */
static void draw_ticks(const struct legend *legend, const struct canvas *canvas,
                       const struct bar *bar)
{
    uint32_t number_width = (text_width(number_of(legend->scale).text) + 14) * canvas->zoom;
    uint32_t room = legend->is_signed ? bar->width / 2 : bar->width;
    uint32_t max = room / number_width < 10 ? room / number_width : 10;
    double step = tick_step(legend->scale / (max ? max : 1) * (1.0 - 1e-9));
    double end = legend->scale * (1.0 - 1.5 * number_width / (double)room);
    draw_number(legend, canvas, bar, 0.0);
    for (int side = legend->is_signed ? -1 : 1; side <= 1; side += 2) {
        for (uint32_t i = 1; i < 16 && i * step < end; ++i)
            draw_number(legend, canvas, bar, side * (i * step));
        draw_number(legend, canvas, bar, side * legend->scale);
    }
}

void legend_draw(const struct legend *legend, const float linear[256], uint32_t top,
                 struct image *to)
{
    static const uint8_t background[3] = {BACKGROUND, BACKGROUND, BACKGROUND};
    const struct canvas canvas = {.image = to, .top = top, .zoom = legend->zoom, .linear = linear};
    const struct bar bar = {.left = MARGIN * legend->zoom,
                            .width = legend->width - 2 * MARGIN * legend->zoom};
    fill(&canvas, 0, 0, to->width, to->height, background);
    draw_text(&canvas, bar.left, TITLE_TOP, legend->title);
    draw_text(&canvas, bar.left + bar.width - text_width(legend->unit) * canvas.zoom, TITLE_TOP,
              legend->unit);
    draw_bar(legend, &canvas, &bar);
    draw_ticks(legend, &canvas, &bar);
}
