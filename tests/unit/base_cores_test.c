/* Threads as lavapipe starts them: one of a queue, then one for each core. */
#define _GNU_SOURCE /* sched_getaffinity, gettid */
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <unistd.h>

#include "base/cores.h"
#include "base/threads.h"
#include "unit.h"

enum { MAX = 64 };

struct crew {
    char name[CORES_NAME_BYTES];
    struct thread *threads[MAX];
    atomic_int ids[MAX];
    uint32_t count;
    atomic_uint started;
    pthread_barrier_t end;
};

static void wait_for_end(void *context)
{
    struct crew *crew = context;
    uint32_t at = atomic_load(&crew->started);
    crew->ids[at] = gettid();
    atomic_store(&crew->started, at + 1);
    pthread_barrier_wait(&crew->end);
}

/* Starts threads one after another, under a name of their own. */
static void start(struct crew *crew, uint32_t count)
{
    char before[CORES_NAME_BYTES], after[CORES_NAME_BYTES];
    *crew = (struct crew){.count = count};
    pthread_barrier_init(&crew->end, NULL, count + 1);
    assert_int_equal(pthread_getname_np(pthread_self(), before, sizeof before), 0);
    char kept[CORES_NAME_BYTES];
    cores_name_threads(crew->name, kept);
    for (uint32_t i = 0; i < count; ++i) {
        crew->threads[i] = thread_start(wait_for_end, crew);
        assert_non_null(crew->threads[i]);
        while (atomic_load(&crew->started) <= i)
            sched_yield();
    }
    cores_end_names(kept);
    assert_int_equal(pthread_getname_np(pthread_self(), after, sizeof after), 0);
    assert_string_equal(before, after);
}

static void end(struct crew *crew)
{
    pthread_barrier_wait(&crew->end);
    for (uint32_t i = 0; i < crew->count; ++i)
        thread_join(crew->threads[i]);
    pthread_barrier_destroy(&crew->end);
}

static cpu_set_t cores_of(int id)
{
    cpu_set_t cores;
    assert_int_equal(sched_getaffinity(id, sizeof cores, &cores), 0);
    return cores;
}

TEST(each_thread_behind_the_first_gets_a_core)
{
    cpu_set_t all = cores_of(0), taken;
    uint32_t count = (uint32_t)CPU_COUNT(&all);
    struct crew crew;
    if (count < 2 || count >= MAX)
        skip();
    start(&crew, count + 1);
    assert_true(cores_spread(crew.name));
    CPU_ZERO(&taken);
    for (uint32_t i = 0; i <= count; ++i) {
        cpu_set_t own = cores_of(crew.ids[i]);
        assert_int_equal(CPU_COUNT(&own), i == 0 ? count : 1);
        if (i > 0)
            CPU_OR(&taken, &taken, &own);
    }
    assert_true(CPU_EQUAL(&taken, &all));
    cpu_set_t own = cores_of(0);
    assert_true(CPU_EQUAL(&own, &all));
    end(&crew);
}

/* As where the caller is bound to cores after it started the threads. */
TEST(threads_with_cores_of_their_own_stay_there)
{
    cpu_set_t all = cores_of(0), first;
    uint32_t count = (uint32_t)CPU_COUNT(&all);
    struct crew crew;
    size_t core = 0;
    if (count < 2 || count >= MAX)
        skip();
    while (!CPU_ISSET(core, &all))
        ++core;
    CPU_ZERO(&first);
    CPU_SET(core, &first);
    start(&crew, count + 1);
    assert_int_equal(sched_setaffinity(crew.ids[2], sizeof first, &first), 0);
    assert_false(cores_spread(crew.name));
    for (uint32_t i = 0; i <= count; ++i) {
        cpu_set_t own = cores_of(crew.ids[i]);
        assert_true(CPU_EQUAL(&own, i == 2 ? &first : &all));
    }
    end(&crew);
}

TEST(another_number_of_threads_stays_as_it_is)
{
    cpu_set_t all = cores_of(0);
    uint32_t count = (uint32_t)CPU_COUNT(&all);
    if (count < 2 || count + 2 >= MAX)
        skip();
    for (uint32_t threads = count; threads <= count + 2; threads += 2) {
        struct crew crew, others;
        start(&crew, threads);
        start(&others, 1); /* have another name, so that they do not count */
        assert_false(cores_spread(crew.name));
        for (uint32_t i = 0; i < threads; ++i) {
            cpu_set_t own = cores_of(crew.ids[i]);
            assert_true(CPU_EQUAL(&own, &all));
        }
        end(&others);
        end(&crew);
    }
}
