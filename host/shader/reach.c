#include "shader/reach.h"

#include <string.h>

#include "shader/compile.h"

/* Beginnings of names of hook/interface.glsl as glslang writes them, and what their functions need
   in the kernel. */
static const struct {
    const char *name;
    uint32_t bits;
} needs[] = {
    {"light(", SHADER_REACHES_LIGHTS},
    {"light_points(", SHADER_REACHES_LIGHTS},
    {"lit_by(", SHADER_REACHES_ALL},
    {"whit_shade(", SHADER_REACHES_ALL},
    {"visible(", SHADER_REACHES_SHADOWS | SHADER_REACHES_RAYS},
    {"trace(", SHADER_REACHES_RAYS},
};

uint32_t reach_of(const char *name)
{
    uint32_t bits = 0;
    for (size_t i = 0; i < sizeof needs / sizeof *needs; ++i)
        bits |= strncmp(name, needs[i].name, strlen(needs[i].name)) == 0 ? needs[i].bits : 0;
    return bits;
}
