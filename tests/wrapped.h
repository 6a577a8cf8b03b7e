/* A function that stands in for one of whit's or of a library, by --wrap at link time: every call
   of NAME runs it. Its body follows the macro, and may call the function itself as __real_NAME. */
#ifndef TESTS_WRAPPED_H
#define TESTS_WRAPPED_H

#define WRAPPED(type, name, ...)                                                                   \
    type __real_##name(__VA_ARGS__);                                                               \
    type __wrap_##name(__VA_ARGS__);                                                               \
    type __wrap_##name(__VA_ARGS__)

#endif
