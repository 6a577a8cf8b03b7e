// What dbg(x) of a user's file is, for the first sample of a pixel that is looked at (hook/dbg.glsl).
#ifndef HOOK_RECORD_GLSL
#define HOOK_RECORD_GLSL

#include "../abi/bindings.h"
#include "../abi/shade.h"

layout(set = 0, binding = BIND_DBG, std430) buffer DbgBuffer
{
    uint dbg_counts[DBG_CALLS]; // how often each was reached
    gpu_dbg dbg_values[];       // DBG_VALUES of each
};

bool hook_records = false; // the function in hand is called for a ray of the picture
uint hook_id = 0u;         // of that ray
uint hook_order = 0u;      // records of the invocation

// The functions that are called next are for ray `id`, or with `alive` false for none.
void record_for(uint id, bool alive)
{
    hook_records = alive && chunk.sample_index == 0u;
    hook_id = id;
}

void whit_record(uint call, uint type, uvec4 bits)
{
    if (!hook_records)
        return;
    uint at = atomicAdd(dbg_counts[call], 1u);
    if (at < DBG_VALUES)
        dbg_values[call * DBG_VALUES + at] =
            gpu_dbg(bits, hook_id, HOOK_KERNEL << 24 | min(hook_order, 0xffffffu), chunk.generation, type);
    hook_order++;
}

#endif
