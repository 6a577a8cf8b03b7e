/* The parts of a 3MF that whit reads itself, since assimp does not import them. */
#ifndef LOAD_THREEMF_H
#define LOAD_THREEMF_H

#include <stddef.h>
#include <stdint.h>

/* unit_m: the model's unit in metres; a millimetre, the format's default, where the model states
   none. color_groups, composites: how many lists of colours and of mixed materials there are.
   mixed: objects whose triangles name several materials; assimp gives them one. refused: why the
   package cannot be drawn as the format demands, or "". */
struct threemf_head {
    double unit_m;
    uint32_t color_groups, composites, mixed;
    char refused[160];
};

/* Only for child processes, since foreign code inflates. Gives the default unit and no more if the
   package cannot be read. */
struct threemf_head threemf_read(const uint8_t *data, size_t size_bytes);

#endif
