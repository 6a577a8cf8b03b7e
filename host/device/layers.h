/* A lock for calls of Vulkan while other threads create devices. Vulkan allows that, but
   VK_LAYER_KHRONOS_validation does not: it looks each call's device up in a table without a lock,
   into which vkCreateInstance and vkCreateDevice write (Vulkan-ValidationLayers, issue 4391; seen
   as a segmentation fault with 1.3.239 of Debian 12). So while layers check, calls that create or
   destroy an instance or a device run alone; all other calls share the lock (the test `layers`
   looks for calls that do not). Without validation nothing is locked. Included by device/vulkan.h.
 */
#ifndef DEVICE_LAYERS_H
#define DEVICE_LAYERS_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Turns the locking on; call it before the first instance with validation is created. */
void layers_expect(void);
/* Take the lock, shared or alone. They return whether it was taken, which layers_leave gets. Not
   recursive. */
bool layers_enter(void);
bool layers_enter_alone(void);
void layers_leave(bool entered);

#ifdef __cplusplus
}
#endif

#define LAYERS_LOCKED(enter, ...)                                                                  \
    __extension__({                                                                                \
        __attribute__((cleanup(layers_cleanup), unused)) bool locked_ = enter();                   \
        __VA_ARGS__;                                                                               \
    })
/* Make a call of Vulkan with the lock: one that creates or destroys an instance or a device; any
   other one. Neither may be inside the other. */
#define LAYERS_ALONE(...)  LAYERS_LOCKED(layers_enter_alone, __VA_ARGS__)
#define LAYERS_BESIDE(...) LAYERS_LOCKED(layers_enter, __VA_ARGS__)

static inline void layers_cleanup(bool *locked)
{
    layers_leave(*locked);
}

#endif
