#include "base/threads.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/platform.h"

enum { THREADS_MAX = 64 };

struct loop {
    void (*fn)(void *, uint32_t);
    void *context;
    uint32_t count;
    _Atomic uint32_t next;
};

uint32_t threads_available(void)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores < 1 ? 1 : cores > THREADS_MAX ? THREADS_MAX : (uint32_t)cores;
}

bool threads_have_room(uint32_t count)
{
    pthread_attr_t usual;
    size_t stack_bytes = 8 << 20;
    if (pthread_attr_init(&usual) == 0) {
        (void)pthread_attr_getstacksize(&usual, &stack_bytes);
        pthread_attr_destroy(&usual);
    }
    return platform_has_room(count * stack_bytes);
}

static void *run(void *user)
{
    struct loop *loop = user;
    for (;;) {
        uint32_t index = atomic_fetch_add(&loop->next, 1);
        if (index >= loop->count)
            return NULL;
        loop->fn(loop->context, index);
    }
}

void threads_for(uint32_t thread_count, uint32_t count, void (*fn)(void *context, uint32_t index),
                 void *context)
{
    if (thread_count == 0) /* the number of cores comes from a file, which takes 5 us */
        thread_count = count > 1 ? threads_available() : 1;
    if (thread_count > THREADS_MAX)
        thread_count = THREADS_MAX;
    if (thread_count > count)
        thread_count = count;
    struct loop loop = {.fn = fn, .context = context, .count = count};
    atomic_init(&loop.next, 0);
    pthread_t threads[THREADS_MAX];
    uint32_t started = 0;
    while (started + 1 < thread_count) {
        if (pthread_create(&threads[started], NULL, run, &loop) != 0)
            break;
        ++started;
    }
    run(&loop);
    for (uint32_t i = 0; i < started; ++i)
        pthread_join(threads[i], NULL);
}

struct thread {
    pthread_t id;
    void (*fn)(void *);
    void *context;
};

static void *run_once(void *user)
{
    struct thread *thread = user;
    thread->fn(thread->context);
    return NULL;
}

struct thread *thread_start(void (*fn)(void *context), void *context)
{
    struct thread *thread = calloc(1, sizeof *thread);
    if (!thread)
        return NULL;
    thread->fn = fn;
    thread->context = context;
    if (pthread_create(&thread->id, NULL, run_once, thread) == 0)
        return thread;
    free(thread);
    return NULL;
}

void thread_join(struct thread *thread)
{
    if (!thread)
        return;
    pthread_join(thread->id, NULL);
    free(thread);
}
