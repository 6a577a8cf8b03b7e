/* The picture that `render` makes and `scene --effects` prices. */
#ifndef APP_PICTURE_H
#define APP_PICTURE_H

#include "app/document.h"
#include "app/job.h"

struct picture {
    const char *camera; /* NULL: the first */
    uint32_t width, height, samples, depth;
    double adaptive; /* 0: off; else `samples` is not used */
};

/* --aa of the current option; on nonsense misuse, and false. */
bool picture_read_aa(struct cli_reader *reader, struct picture *picture);

/* A renderer of the picture at the time of `job`, within what is left of its time limit. Borrows
   from both. */
whit_renderer_params picture_params(const struct picture *picture, const struct job *job);

/* Adds what decides its pixels to an object. */
void picture_describe(const struct picture *picture, const struct job *job, json_t *object);

#endif
