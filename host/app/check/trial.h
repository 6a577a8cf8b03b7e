/* One picture more, of an input that is no case of the suite: another scene, other settings. */
#ifndef APP_CHECK_TRIAL_H
#define APP_CHECK_TRIAL_H

#include "app/check/draw.h"

/* All that a picture is made of, and what draws it. Borrowed. */
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

/* Draws it. trial_finish() it either way. */
WHIT_CHECK whit_result trial_draw(struct trial *trial, const struct trial_input *input);
void trial_finish(struct trial *trial);
/* The same hashes, of a drawing that the studio made. */
void trial_hash(const struct drawing *drawing, struct trial *out);
/* Whether ids and colours are the same bytes. */
bool trial_same(const struct trial *a, const struct trial *b);
/* Whether no other picture can be drawn after such a failure. */
bool trial_ends_all(whit_result result);

#endif
