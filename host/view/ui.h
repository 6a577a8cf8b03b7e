/* Dear ImGui behind C: what the viewer draws over its picture. One at a time, of the window's
   thread. Places are in pixels from the window's upper left, colours 0xAABBGGRR. */
#ifndef VIEW_UI_H
#define VIEW_UI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "whit/whit_base.h"

#ifdef __cplusplus
extern "C" {
#endif

struct swapchain;
struct ui;

/* `scale`: of text and all else, 1 on a screen of 96 dots an inch. `font`: a TrueType file, read
   here alone; NULL: Dear ImGui's own. Errors are logged. */
WHIT_CHECK whit_result ui_create(struct swapchain *swapchain, float scale, const uint8_t *font,
                                 size_t font_bytes, struct ui **out);
void ui_destroy(struct ui *ui); /* before the swapchain; NULL is fine */

/* What the user does, since the last frame. Keys are those of ui_key. */
enum ui_key {
    UI_KEY_TAB,
    UI_KEY_LEFT,
    UI_KEY_RIGHT,
    UI_KEY_UP,
    UI_KEY_DOWN,
    UI_KEY_HOME,
    UI_KEY_END,
    UI_KEY_DELETE,
    UI_KEY_BACKSPACE,
    UI_KEY_ENTER,
    UI_KEY_ESCAPE,
    UI_KEY_COUNT,
};
void ui_mouse(struct ui *ui, float x, float y);
void ui_button_event(struct ui *ui, int button, bool down); /* 0 left, 1 right, 2 middle */
void ui_wheel(struct ui *ui, float x, float y);
void ui_key_event(struct ui *ui, enum ui_key key, bool down);
void ui_character(struct ui *ui, uint32_t code_point);
/* Whether a panel has the mouse, or a text field the keys: the picture is then left alone. */
bool ui_has_mouse(const struct ui *ui);
/* Closes the list of choices that is open; false where none is. */
bool ui_close_menus(struct ui *ui);
bool ui_has_keys(const struct ui *ui);

/* Everything below is drawn between these two. False: there is no memory for it, and no frame. */
WHIT_CHECK bool ui_begin(struct ui *ui, uint32_t width, uint32_t height, double seconds);
/* True where it gave back memory that many lines had needed. */
bool ui_end(struct ui *ui);
/* Whether panels found their sizes only now, and the next frame has them where they belong; or a
   button went up already that this frame has down. */
bool ui_wants_again(const struct ui *ui);
float ui_scale(const struct ui *ui);
/* Where the middle of a button or other thing to click was drawn in the last frame, by its label
   up to "##", for tests; false past the last one. */
bool ui_item(uint32_t index, const char **label, float *x, float *y);
/* Where the panels of the last frame were: left, top, right, bottom; likewise. *cut: one has to
   scroll sideways to see all of it. */
bool ui_panel(uint32_t index, const char **title, float rectangle[4], bool *cut);
/* A swapchain_draw: what was drawn since the last ui_begin. */
void ui_draw(void *ui, void *commands);
/* What came of it, logged; after a failure there is only ui_destroy. */
WHIT_CHECK whit_result ui_result(const struct ui *ui);

/* A panel whose corner nearest to (x, y) of 0..1 stands at that part of the window, a little
   inside, and beside those that were begun before it: further down where y is 0, up where it is 1.
   It cannot be moved. Where there is no room beside them it is not seen; nor in ui_panel. */
enum ui_panel {
    UI_PANEL_PLAIN = 0, /* no title, lets the mouse through; text that is too long is wrapped */
    UI_PANEL_STAYS = 1, /* is seen all the same */
    UI_PANEL_HOLD = 2,  /* likewise; with a title, takes the mouse, scrolls where the window is
                           too small */
};
bool ui_panel_begin(const char *title, float x, float y, enum ui_panel kind);
/* The same with a cross that sets *open to false. Whoever dragged it finds it there, unless it
   `moves`. */
bool ui_window_begin(const char *title, float x, float y, float width, float height, bool moves,
                     bool *open);
void ui_panel_end(void);
/* No panel that ui_panel_begin begins later in this frame covers what is so near, where there is
   room beside it. */
void ui_keep_free(float x, float y, float radius);

/* What these say is shown by whit_text_show, and so is one line; labels and titles are whit's own.
 */
void ui_text(const char *format, ...) WHIT_PRINTF(1, 2);
void ui_paragraph(const char *text); /* wrapped at the end of the window */
void ui_text_dim(const char *format, ...) WHIT_PRINTF(1, 2);
void ui_text_color(uint32_t color, const char *format, ...) WHIT_PRINTF(2, 3);
/* On the line of what stands before where that has room for it, else on the next one. */
void ui_text_beside(uint32_t color, const char *format, ...) WHIT_PRINTF(2, 3);
void ui_separator(void);
void ui_same_line(float x); /* 0: right behind; else from the panel's left, in characters */
bool ui_button(const char *label);
bool ui_selectable(const char *label, bool selected);
/* A line that shows or hides what follows it, at first as `open` says. Whether it shows it. */
bool ui_fold(const char *label, bool open);
bool ui_checkbox(const char *label, bool *value);
/* `preview`: what it says closed. */
bool ui_choice(const char *label, const char *preview, const char *const *names, int count,
               int *value);
bool ui_slider(const char *label, double *value, double lo, double hi, bool logarithmic);
bool ui_color(const char *label, float rgb[3]); /* sRGB, 0..1 */
bool ui_slider_count(const char *label, uint32_t *value, uint32_t lo, uint32_t hi);
/* A bar of colours with labels below, evenly from its left to its right end. */
void ui_ramp(const uint32_t *colors, int count, const char *const *labels, int label_count);
/* Points of 0..1 from the lower left in a box. */
struct ui_point {
    float x, y;
    uint32_t color;
    float radius;
    bool joined;       /* by a line with the joined one before it */
    const char *name;  /* stands beside it, and is found by ui_item; or NULL */
    const char *about; /* what is said of it under the mouse; or NULL */
};
/* A line across the box, with what it stands for below or on the left. */
struct ui_tick {
    float at;
    char label[16];
};
enum { UI_TICKS_MAX = 16 };
struct ui_plot {
    float width, height; /* of the box, in heights of letters */
    uint32_t line_color;
    const struct ui_point *points;
    uint32_t count, tick_count[2]; /* ticks: from left to right, upwards */
    struct ui_tick ticks[2][UI_TICKS_MAX];
};
void ui_plot_points(const struct ui_plot *plot);
/* The place of a value on a logarithmic axis from `low` to `high`, 0..1; 0.5 where both are equal.
 */
float ui_log_place(double value, double low, double high);
/* A picture as wide as the cell of a table, with `lines` of text below it. ui_item finds it by
   these, joined: "a, b". */
void ui_picture(const uint32_t *rgba, uint32_t width, uint32_t height, const char *const *lines,
                uint32_t line_count);
void ui_progress(float part, const char *text); /* part < 0: not known */
bool ui_table_begin(const char *id, int columns);
/* Instead of a header: how wide columns are, text that is longer is wrapped by ui_cell. */
void ui_table_widths(const int *characters, int count);
void ui_cell(uint32_t color, const char *text); /* ui_table_next and a text */
int ui_characters(int columns); /* that fit into a table of so many columns, as wide as the panel */
void ui_table_header(const char *const *names, int count);
void ui_table_next(void); /* cell */
void ui_table_end(void);

/* Over the picture, under the panels. Text as above. */
void ui_line(float x0, float y0, float x1, float y1, uint32_t color, float width);
void ui_rectangle(float x0, float y0, float x1, float y1, uint32_t color, bool filled);
void ui_text_size(const char *text, float *width, float *height);

#ifdef __cplusplus
}
#endif

#endif
