#ifndef LIB_TURN_GLSL
#define LIB_TURN_GLSL

// Whether a loop has another iteration, for loops behind which a check asks if work was left:
// lavapipe 22.3 ends all loops of a subgroup after 65,535 iterations. Compilers know that a loop
// ends only when its own condition fails, and would remove that check. They do not know that all
// dispatches have one row of workgroups, which the condition here tests.
bool another_iteration(bool again)
{
    return again && gl_WorkGroupID.y == 0u;
}

// False once the driver has ended a loop of this subgroup early: it then ends all loops behind that
// one after their first iteration. `count`: 2 or more; not a constant, since compilers would unroll
// the loop.
bool loops_go_on(uint count)
{
    uint i = 0u;
    do
        i++;
    while (another_iteration(i < count));
    return i == count;
}

#endif
