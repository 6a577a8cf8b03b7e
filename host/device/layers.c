#define _GNU_SOURCE /* for PTHREAD_RWLOCK_WRITER_NONRECURSIVE_INITIALIZER_NP */
#include "device/layers.h"

#include <pthread.h>
#include <stdatomic.h>

/* Writers come first. Otherwise a thread that creates a device waits as long as other threads go on
   calling Vulkan. Nobody is blocked for ever, since no call of Vulkan waits for a call in another
   thread. */
static pthread_rwlock_t lock = PTHREAD_RWLOCK_WRITER_NONRECURSIVE_INITIALIZER_NP;
static atomic_bool expected;

void layers_expect(void)
{
    atomic_store(&expected, true);
}

bool layers_enter(void)
{
    return atomic_load_explicit(&expected, memory_order_relaxed) && !pthread_rwlock_rdlock(&lock);
}

bool layers_enter_alone(void)
{
    return atomic_load_explicit(&expected, memory_order_relaxed) && !pthread_rwlock_wrlock(&lock);
}

void layers_leave(bool entered)
{
    if (entered)
        pthread_rwlock_unlock(&lock);
}
