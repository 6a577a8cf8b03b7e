// Records the values of dbg(x) in a user's file, for the first sample of a probed pixel
// (hook/dbg.glsl).
#ifndef HOOK_RECORD_GLSL
#define HOOK_RECORD_GLSL

#include "../abi/bindings.h"
#include "../abi/shade.h"

layout(set = 0, binding = BIND_DBG, std430) buffer DbgBuffer
{
    uint dbg_counts[DBG_CALLS]; // how often each call was reached
    gpu_dbg dbg_values[];       // DBG_VALUES for each call
};

bool hook_records = false; // the current function is called for a ray of the picture
uint hook_id = 0u;         // id of that ray
uint hook_order = 0u;      // number of records of the invocation so far

// The next functions are called for ray `id`, or, with `alive` false, for no ray.
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
