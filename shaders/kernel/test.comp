// Runs the tests of a user's file: layer z of the dispatch is test z, with one invocation for each
// seed. There is one row, as another_iteration() of lib/turn.glsl wants it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../bind/stage.glsl"
#include "../bind/queues.glsl"
#include "../hook/declare.glsl"
#include "../hook/check.glsl"

// Calls test `test` of the file. host/shader/tests.c writes the function that replaces this one.
void run_test(uint test, uint seed)
{
}

void main()
{
    load_frame();
    begin_functions();
    uint seed = gl_GlobalInvocationID.x;
    hook_pixel = uvec2(seed % TEST_ROW, seed / TEST_ROW); // so that random() differs between seeds
    hook_ray.dir = vec3(0.0, 0.0, -1.0);
    begin_checks();
    begin_hook();
    run_test(gl_WorkGroupID.z, seed);
    end_hook(true);
    store_checks(gl_WorkGroupID.z, seed);
    report_status(hook_status);
    report_hooks();
}
