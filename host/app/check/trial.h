/* Draws an extra picture of an input that is no case of the suite: another scene or other
   settings. */
#ifndef APP_CHECK_TRIAL_H
#define APP_CHECK_TRIAL_H

#include "app/check/draw.h"

/* The complete input of a picture, and the device that draws it. Borrowed. */
struct trial_input {
    struct settings settings;
    whit_scene *scene;
    whit_shader *shader; /* NULL: none */
    whit_device *device; /* NULL: the reference */
};

/* The picture, with the trees and the renderer that it needed. */
struct trial {
    struct drawing drawing;
    uint64_t colors, ids; /* hashes */
};

/* Draws the picture. Call trial_finish() in any case. */
WHIT_CHECK whit_result trial_draw(struct trial *trial, const struct trial_input *input);
void trial_finish(struct trial *trial);
/* Sets the hashes of `out` from a drawing that the studio made. */
void trial_hash(const struct drawing *drawing, struct trial *out);
/* Whether ids and colours are the same bytes. */
bool trial_same(const struct trial *a, const struct trial *b);
/* Whether, after such an error, no other picture can be drawn either. */
bool trial_ends_all(whit_result result);

#endif
