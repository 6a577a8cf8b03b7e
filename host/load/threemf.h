/* The parts of a 3MF that whit reads itself, since assimp does not import them. */
#ifndef LOAD_THREEMF_H
#define LOAD_THREEMF_H

#include <stddef.h>
#include <stdint.h>

/* unit_m: the model's unit in metres; a millimetre, the format's default, where the model states
   none. color_groups: how many lists of colours stand in the first 16 KiB of the model file. */
struct threemf_head {
    double unit_m;
    uint32_t color_groups;
};

/* Gives the default unit and no group if the package cannot be read. */
struct threemf_head threemf_read(const uint8_t *data, size_t size_bytes);

#endif
