/* Finds out which functions of whit's own a user's functions call, and which members of Surface and
   Optics they read. */
#ifndef SHADER_REACH_H
#define SHADER_REACH_H

#include "shader/module.h"

enum { REACH_RECORDS = 2, REACH_MEMBERS_MAX = 32 };

/* The structs of lib/records.glsl whose members take work to compute, in one module. */
struct reach {
    struct {
        uint32_t type; /* id of the struct's type; 0: the module does not have it */
        uint32_t members[REACH_MEMBERS_MAX]; /* by member: SHADER_REACHES_* bits of what it is
                                                computed from */
    } records[REACH_RECORDS];
};

void reach_begin(struct reach *reach, const struct spv_module *m);

/* Bits SHADER_REACHES_* of an instruction of a user's function: of functions that it calls, and of
   members that it accesses, to read or to write. */
uint32_t reach_of(const struct reach *reach, const struct spv_module *m, const uint32_t *words);

/* Whether a function of whit's own, by its name as glslang writes it, traces rays. */
bool reach_traces(const char *name);

#endif
