/* Which functions of whit's a user's functions call, and which members of Surface and Optics they
   read. */
#ifndef SHADER_REACH_H
#define SHADER_REACH_H

#include "shader/module.h"

enum { REACH_RECORDS = 2, REACH_MEMBERS_MAX = 32 };

/* The structs of lib/records.glsl whose members cost something to have, in one module. */
struct reach {
    struct {
        uint32_t type;                       /* its id; 0: the module has none */
        uint32_t members[REACH_MEMBERS_MAX]; /* bits SHADER_REACHES_* of what each is made of */
    } records[REACH_RECORDS];
};

void reach_begin(struct reach *reach, const struct spv_module *m);

/* Bits SHADER_REACHES_* of an instruction of a user's function: what it calls, and members that it
   names, be it to read or to write. */
uint32_t reach_of(const struct reach *reach, const struct spv_module *m, const uint32_t *words);

#endif
