#ifndef LIB_TURN_GLSL
#define LIB_TURN_GLSL

// Whether a loop has another iteration, where a check behind it asks if there was one left to do: lavapipe
// 22.3 ends all loops of an invocation after 65,535 iterations. Compilers know that a loop ends where its own
// condition fails, and would take that check out. What they do not know is that all dispatches are one row of
// workgroups.
bool another_iteration(bool again)
{
    return again && gl_WorkGroupID.y == 0u;
}

#endif
