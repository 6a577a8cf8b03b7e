// Traversal without trees: every record of every instance, a range of runs at a time. The kernel
// keeps the hit from range to range. accel/traverse.c: traverse_records.
#ifndef BIND_RUNS_GLSL
#define BIND_RUNS_GLSL

#include "traverse.glsl"

gpu_run fetch_run(uint index); // defined by the kernel

// Goes on with `hit` through the range that starts at `first_run`; `begin`: it is the first one.
void traverse_runs(const uint mode, vec3 origin, vec3 dir, float t_min, uint first_run, uint begin,
                   uint skip_instance, uint skip_primitive, inout Hit hit)
{
    if (SPEC_COUNT != 0u)
        traversal_cost = gpu_cost(begin, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
    bool done = !is_usable(origin, dir) || (mode != TRAVERSE_CLOSEST && hit.primitive != HIT_NONE);
    uint at = first_run;
    gpu_run run = fetch_run(at);
    do {
        if (run.count != 0u && !done) {
            uint record = run.first;
            uint end = run.first + run.count;
            RaySetup ray;
            if (SPEC_INSTANCED != 0u)
                ray = make_local_setup(run.instance, origin, dir);
            else
                ray = make_ray_setup(origin, dir);
            if (SPEC_COUNT != 0u && SPEC_INSTANCED != 0u)
                traversal_cost.instances += run.begins;
            do {
                bool waits;
                done = test_record(mode, ray, t_min, record, run.instance, skip_instance,
                                   skip_primitive, hit, waits);
                if (has_looks(mode) && waits)
                    done = look_at_record(mode, ray, origin, dir, t_min, record, run.instance,
                                          skip_instance, skip_primitive, hit);
                record = done ? end : record + 1u;
            } while (record < end);
            if (record < end)
                hit.status |= STATUS_UNFINISHED_TRAVERSAL;
            at++;
            run = fetch_run(at);
        }
    } while (run.count != 0u && !done);
    if (run.count != 0u && !done)
        hit.status |= STATUS_UNFINISHED_TRAVERSAL;
}

#endif
