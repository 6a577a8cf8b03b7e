/* A C interface to Dear ImGui, which draws over the viewer's picture. There is one at a time, for
   the window's thread. Positions are pixels from the window's upper left, colours 0xAABBGGRR. */
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

#define UI_COLOR_TEXT    0xFFFFFFFFu
#define UI_COLOR_DIM     0xFF808080u
#define UI_COLOR_GOOD    0xFFD0E090u
#define UI_COLOR_WARNING 0xFF40C0FFu
#define UI_COLOR_ERROR   0xFF6070FFu

/* `scale`: size of text and everything else, 1 on a screen of 96 dots an inch. `font`: a TrueType
   file, read during this call only; NULL: Dear ImGui's own font. Errors are logged. */
WHIT_CHECK whit_result ui_create(struct swapchain *swapchain, float scale, const uint8_t *font,
                                 size_t font_bytes, struct ui **out);
/* font.c: finds a monospaced font of this system by fontconfig. *data: a TrueType file; free() it.
   False: there is none. */
bool font_load(uint8_t **data, size_t *size_bytes);
void ui_destroy(struct ui *ui); /* call it before destroying the swapchain; NULL is fine */

/* Input of the user since the last frame. Keys are those of view_event. */
void ui_mouse(struct ui *ui, float x, float y);
void ui_button_event(struct ui *ui, int button, bool down); /* 0 left, 1 right, 2 middle */
void ui_wheel(struct ui *ui, float x, float y);
void ui_key_event(struct ui *ui, int key, bool down);
void ui_character(struct ui *ui, uint32_t code_point);
/* Whether a panel uses the mouse, or a text field the keys: the picture then ignores them. */
bool ui_has_mouse(const struct ui *ui);
/* Closes the open list of choices; false: none is open. */
bool ui_close_menus(struct ui *ui);
bool ui_has_keys(const struct ui *ui);

/* Everything below is drawn between ui_begin and ui_end. `settles`: the frame is drawn only as
   ui_wants_again said so, for nothing else has changed. False: no memory; there is no frame. */
WHIT_CHECK bool ui_begin(struct ui *ui, uint32_t width, uint32_t height, double seconds,
                         bool settles);
/* True: it freed memory that many lines had needed. */
bool ui_end(struct ui *ui);
/* Whether another frame has to be drawn: panels found their sizes only in this one, or a mouse
   button that it drew as down is up already. */
bool ui_wants_again(const struct ui *ui);
float ui_scale(const struct ui *ui);
/* Whether a panel that takes the mouse had no room beside earlier ones, since ui_begin. */
bool ui_is_crowded(const struct ui *ui);
/* The height that the content of a panel needed when it was last drawn, with the panel's frame, in
   pixels; 0: it was not drawn yet. */
float ui_panel_height(const char *title);
void ui_forget_panel(const char *title); /* as if it was not drawn yet */
/* For tests: the label, up to "##", and the middle of the button or other item number `index` of
   the last frame; false: there are fewer items. */
bool ui_item(uint32_t index, const char **label, float *x, float *y);
/* Likewise for panels: left, top, right, bottom. *cut: it has to be scrolled sideways to see all of
   it. */
bool ui_panel(uint32_t index, const char **title, float rectangle[4], bool *cut);
/* A swapchain_draw function: draws everything since the last ui_begin. */
void ui_draw(void *ui, void *commands);
/* The result of ui_draw; errors are logged. After an error only ui_destroy may be called. */
WHIT_CHECK whit_result ui_result(const struct ui *ui);

/* Begins a panel that cannot be moved. (x, y), 0..1, is its anchor in the window, with a small
   margin; it avoids panels that were begun before, by moving down if y is 0 and up if y is 1. If
   there is no room it is invisible, and not in ui_panel. */
enum ui_panel {
    UI_PANEL_PLAIN = 0, /* no title, lets the mouse through; long text is wrapped */
    UI_PANEL_STAYS = 1, /* as UI_PANEL_PLAIN, but visible even without room */
    /* Visible even without room; has a title, takes the mouse, scrolls if the window is too
       small. */
    UI_PANEL_HOLD = 2,
};
bool ui_panel_begin(const char *title, float x, float y, enum ui_panel kind);
/* The same, but it can be dragged and stays there, unless it `moves`; a close button sets *open to
   false. */
bool ui_window_begin(const char *title, float x, float y, float width, float height, bool moves,
                     bool *open);
void ui_panel_end(void);
/* Panels that ui_panel_begin begins later in this frame do not cover this circle, if there is room
   beside it. */
void ui_keep_free(float x, float y, float radius);

/* Texts, and the names of ui_choice, go through whit_text_show, so each is one line; labels and
   titles are whit's own. */
void ui_text(const char *format, ...) WHIT_PRINTF(1, 2);
void ui_paragraph(const char *text); /* wrapped at the end of the window */
void ui_text_dim(const char *format, ...) WHIT_PRINTF(1, 2);
void ui_text_color(uint32_t color, const char *format, ...) WHIT_PRINTF(2, 3);
/* Text on the line of the item before if it fits, else on the next line. */
void ui_text_beside(uint32_t color, const char *format, ...) WHIT_PRINTF(2, 3);
void ui_separator(void);
void ui_same_line(float x); /* 0: just behind; else position from the panel's left, in characters */
bool ui_button(const char *label);
bool ui_selectable(const char *label, bool selected);
/* A line that shows or hides what follows it, initially by `open`. Returns whether it is shown. */
bool ui_fold(const char *label, bool open);
bool ui_checkbox(const char *label, bool *value);
/* `preview`: its text while it is closed. */
bool ui_choice(const char *label, const char *preview, const char *const *names, int count,
               int *value);
bool ui_slider(const char *label, double *value, double lo, double hi, bool logarithmic);
bool ui_color(const char *label, float rgb[3]); /* sRGB, 0..1 */
bool ui_slider_count(const char *label, uint32_t *value, uint32_t lo, uint32_t hi);
/* A bar of colours, with labels below it at equal distances from its left to its right end. */
void ui_ramp(const uint32_t *colors, int count, const char *const *labels, int label_count);
/* A point of a plot; x and y are 0..1 from the lower left of its box. */
struct ui_point {
    float x, y;
    uint32_t color;
    float radius;
    bool joined;       /* a line joins it with the last joined point before it */
    const char *name;  /* text beside it, by which ui_item finds it; or NULL */
    const char *about; /* text that is shown when the mouse is over it; or NULL */
};
/* A line across the box of a plot, with a label below or on the left. */
struct ui_tick {
    float at;
    char label[16];
};
enum { UI_TICKS_MAX = 16 };
struct ui_plot {
    float width, height; /* size of the box, in font heights */
    uint32_t line_color;
    const struct ui_point *points;
    uint32_t count, tick_count[2]; /* ticks: along x, along y */
    struct ui_tick ticks[2][UI_TICKS_MAX];
};
void ui_plot_points(const struct ui_plot *plot);
/* The position of a value on a logarithmic axis from `low` to `high`, 0..1; 0.5 if both are
   equal. */
float ui_log_place(double value, double low, double high);
/* A picture as wide as the cell of a table, with `lines` of text below it. ui_item finds it by
   these, joined: "a, b". */
void ui_picture(const uint32_t *rgba, uint32_t width, uint32_t height, const char *const *lines,
                uint32_t line_count);
void ui_progress(float part, const char *text); /* part < 0: not known */
bool ui_table_begin(const char *id, int columns);
/* Sets the widths of columns in characters, 0: as wide as their texts; ui_cell wraps longer text.
   `heads`: a header; NULL: none. */
void ui_table_columns(const char *const *heads, const int *characters, int count);
void ui_cell(uint32_t color, const char *text); /* ui_table_next and a text */
/* Number of characters that fit into a table of `columns` columns that is as wide as the window
   allows. */
int ui_characters(int columns);
/* The same for the panel or window as it is, whose width its content does not change. */
int ui_characters_here(int columns);
void ui_table_next(void); /* cell */
void ui_table_end(void);

/* Drawn over the picture, under the panels. Text as above. */
void ui_line(float x0, float y0, float x1, float y1, uint32_t color, float width);
void ui_rectangle(float x0, float y0, float x1, float y1, uint32_t color);
void ui_text_size(const char *text, float *width, float *height);

#ifdef __cplusplus
}
#endif

#endif
