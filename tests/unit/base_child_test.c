/* __rlimit_resource_t is an enumeration only there. */
#define _GNU_SOURCE
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "../wrapped.h"
#include "base/child.h"
#include "base/threads.h"
#include "unit.h"

#if defined(__SANITIZE_ADDRESS__)
#define HAS_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HAS_ASAN 1
#endif
#endif

static const struct child_limits ordinary = {
    .who = "test", .cpu_s = 20.0, .memory_bytes = 256u << 20, .reply_bytes = 64u << 20};

/* Functions are wrapped at link time: the clocks by which a child's time is measured, which these
   tests advance, and fork, to see whether a child is started while forks are held. */
static double now_ms, step_ms;       /* the clock, which each reading advances by a step */
static double used_ms, used_step_ms; /* likewise the child's processor time */
static uint32_t reading_count, cancel_at;
static bool child_stops;         /* the child stops itself until the third reading */
static pid_t child;              /* the child started last */
static volatile bool cancelled;  /* set at reading `cancel_at` */
static size_t mapped_late_bytes; /* what is mapped just before a fork, as by another thread */
static atomic_bool forks_are_held, child_is_wanted, forked_while_held;

static void set_clock(double step)
{
    now_ms = used_ms = used_step_ms = 0.0;
    step_ms = step;
    reading_count = cancel_at = 0;
    cancelled = false;
}

WRAPPED(double, clock_ms, void)
{
    if (++reading_count == cancel_at)
        cancelled = true;
    if (child_stops && reading_count >= 3)
        kill(child, SIGCONT); /* repeatedly, since the child may not have stopped yet */
    now_ms += reading_count <= 3 || !child_stops ? step_ms : 0.0;
    return now_ms;
}

WRAPPED(double, clock_of_process_ms, pid_t pid)
{
    (void)pid;
    return used_ms += used_step_ms;
}

WRAPPED(pid_t, fork, void)
{
    if (atomic_load(&forks_are_held))
        atomic_store(&forked_while_held, true);
    atomic_store(&child_is_wanted, true);
    void *late = mmap(NULL, mapped_late_bytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    pid_t pid = __real_fork();
    if (pid > 0 && late != MAP_FAILED)
        munmap(late, mapped_late_bytes);
    child = pid > 0 ? pid : child;
    return pid;
}

WRAPPED(int, pthread_rwlock_wrlock, pthread_rwlock_t *lock)
{
    atomic_store(&child_is_wanted, true);
    return __real_pthread_rwlock_wrlock(lock);
}

static int reply_words(void *user, void *to, child_write write)
{
    uint32_t count = *(uint32_t *)user;
    for (uint32_t i = 0; i < count; ++i) {
        if (!write(to, &i, sizeof i))
            return 3;
    }
    return 0;
}

TEST(reply_arrives_whole)
{
    for (uint32_t count = 1; count <= 100000; count *= 10) {
        struct child_reply reply;
        assert_int_equal(child_run(&ordinary, reply_words, &count, &reply), CHILD_DONE);
        assert_int_equal(reply.exit_code, 0);
        assert_int_equal(reply.size_bytes, count * sizeof(uint32_t));
        for (uint32_t i = 0; i < count; ++i)
            assert_int_equal(((uint32_t *)(void *)reply.data)[i], i);
        child_reply_free(&reply);
        assert_null(reply.data);
    }
}

/* Holds forks until another thread asks for the lock of children, or starts a child without it. */
static void hold_forks(void *context)
{
    atomic_bool *holds = context;
    child_hold_forks();
    atomic_store(&forks_are_held, true);
    atomic_store(holds, true);
    while (!atomic_load(&child_is_wanted))
        sched_yield();
    atomic_store(&forks_are_held, false);
    child_release_forks();
}

/* The child replies whether forks were held when it started. */
static int reply_held(void *user, void *to, child_write write)
{
    (void)user;
    uint8_t held = atomic_load(&forks_are_held);
    return write(to, &held, sizeof held) ? 0 : 3;
}

TEST(no_child_while_forks_are_held)
{
    atomic_bool holds = false;
    struct child_reply reply;
    atomic_store(&child_is_wanted, false);
    struct thread *thread = thread_start(hold_forks, &holds);
    assert_non_null(thread);
    while (!atomic_load(&holds))
        sched_yield();
    assert_int_equal(child_run(&ordinary, reply_held, NULL, &reply), CHILD_DONE);
    thread_join(thread);
    assert_false(atomic_load(&forked_while_held));
    assert_int_equal(reply.size_bytes, 1);
    assert_int_equal(reply.data[0], 0);
    child_reply_free(&reply);
}

TEST(reply_limit_is_exact)
{
    uint32_t count = 1000;
    struct child_limits limits = ordinary;
    struct child_reply reply;
    limits.reply_bytes = count * sizeof(uint32_t);
    assert_int_equal(child_run(&limits, reply_words, &count, &reply), CHILD_DONE);
    child_reply_free(&reply);
    --limits.reply_bytes;
    assert_int_equal(child_run(&limits, reply_words, &count, &reply), CHILD_REPLY);
    assert_null(reply.data);
}

static int silent(void *user, void *to, child_write write)
{
    (void)to, (void)write;
    return *(int *)user;
}

TEST(exit_codes_arrive)
{
    struct child_reply reply;
    int code = 7;
    assert_int_equal(child_run(&ordinary, silent, &code, &reply), CHILD_REPLY);
    assert_int_equal(reply.exit_code, 7);
    code = CHILD_EXIT_MEMORY;
    assert_int_equal(child_run(&ordinary, silent, &code, &reply), CHILD_MEMORY);
}

static int die(void *user, void *to, child_write write)
{
    write(to, "some", 4);
    raise(*(int *)user);
    return 0;
}

TEST(crashes_are_told_apart)
{
    static const struct {
        int number;
        enum child_end end;
    } rows[] = {{SIGABRT, CHILD_CRASHED},
                {SIGSEGV, CHILD_CRASHED}, /* a sanitizer's handler must not get it */
                {SIGXCPU, CHILD_TIME},
                {SIGKILL, CHILD_MEMORY}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        struct child_reply reply;
        int number = rows[i].number;
        assert_int_equal(child_run(&ordinary, die, &number, &reply), rows[i].end);
        assert_int_equal(reply.signal, number);
        assert_null(reply.data);
    }
}

/* A program that ignores SIGCHLD leaves nothing to wait for. */
TEST(ends_are_known_without_a_status)
{
    struct child_reply reply;
    uint32_t count = 100000;
    int code = CHILD_EXIT_MEMORY, number = SIGSEGV;
    signal(SIGCHLD, SIG_IGN);
    assert_int_equal(child_run(&ordinary, reply_words, &count, &reply), CHILD_DONE);
    assert_int_equal(reply.exit_code, 0);
    assert_int_equal(reply.size_bytes, count * sizeof count);
    child_reply_free(&reply);
    assert_int_equal(child_run(&ordinary, silent, &code, &reply), CHILD_MEMORY);
    assert_int_equal(child_run(&ordinary, die, &number, &reply), CHILD_CRASHED);
    signal(SIGCHLD, SIG_DFL);
}

static int spin(void *user, void *to, child_write write)
{
    (void)user, (void)to, (void)write;
    for (volatile unsigned i = 0;; ++i)
        ;
    return 0;
}

TEST(hangs_end_at_the_limit)
{
    struct child_limits limits = ordinary;
    struct child_reply reply;
    limits.clock_s = 0.2;
    set_clock(50.0);
    assert_int_equal(child_run(&limits, spin, NULL, &reply), CHILD_TIME);
    assert_int_equal(reading_count, 6); /* 0 ms after the start, 50, 100, 150, 200, 250 */
    set_clock(0.0);
}

/* Limits are of processor time, since on a busy machine a child may wait for the processor. */
TEST(time_of_the_processor_counts)
{
    struct child_limits limits = ordinary;
    struct child_reply reply;
    limits.cpu_s = 0.2;
    set_clock(150.0);
    used_step_ms = 50.0;
    assert_int_equal(child_run(&limits, spin, NULL, &reply), CHILD_TIME);
    assert_float_equal(used_ms, 250.0, 0.0); /* by the clock, 600 ms */
    set_clock(150.0);
    used_step_ms = 1e-3;
    assert_int_equal(child_run(&limits, spin, NULL, &reply), CHILD_TIME);
    assert_float_equal(now_ms, 150.0 + 2100.0, 0.0); /* ten times as much */
    set_clock(0.0);
}

static int wait_for_readings(void *user, void *to, child_write write)
{
    (void)user;
    raise(SIGSTOP);
    return write(to, "k", 1) ? 0 : 1;
}

/* A regression: valid files were refused while other programs used the processor. */
TEST(a_busy_machine_refuses_nothing)
{
    struct child_limits limits = ordinary;
    struct child_reply reply;
    limits.cpu_s = 0.2;
    child_stops = true;
    set_clock(600.0); /* 600 ms at the start, 1800 at the third reading */
    enum child_end end = child_run(&limits, wait_for_readings, NULL, &reply);
    child_stops = false;
    set_clock(0.0);
    assert_int_equal(end, CHILD_DONE);
    child_reply_free(&reply);
}

TEST(time_of_the_processor_is_the_childs)
{
    int ends[2];
    char none;
    assert_int_equal(pipe(ends), 0);
    pid_t pid = __real_fork();
    if (pid == 0) {
        const clock_t second = CLOCKS_PER_SEC;
        while (clock() < second / 20)
            ;
        (void)!write(ends[1], "x", 1);
        for (;;)
            pause();
    }
    assert_int_equal(read(ends[0], &none, 1), 1);
    assert_true(__real_clock_of_process_ms(pid) >= 49.0);
    kill(pid, SIGKILL);
    assert_int_equal(waitpid(pid, NULL, 0), pid);
    close(ends[0]);
    close(ends[1]);
}

TEST(cancel_ends_it_soon)
{
    struct child_limits limits = ordinary;
    struct child_reply reply;
    limits.cancel = &cancelled;
    set_clock(1000.0);
    cancel_at = 3;
    assert_int_equal(child_run(&limits, spin, NULL, &reply), CHILD_CANCELLED);
    assert_int_equal(reading_count, cancel_at);
    set_clock(0.0);
}

static uint64_t processor_limit_s; /* as the child set it */

WRAPPED(int, setrlimit, __rlimit_resource_t resource, const struct rlimit *limit)
{
    if (resource == RLIMIT_CPU)
        processor_limit_s = limit->rlim_cur;
    return __real_setrlimit(resource, limit);
}

static int reply_processor_limit(void *user, void *to, child_write write)
{
    (void)user;
    return write(to, &processor_limit_s, sizeof processor_limit_s) ? 0 : 3;
}

/* The kernel ends a child by RLIMIT_CPU even while its parent is stopped. */
TEST(processor_time_is_limited_too)
{
    struct child_reply reply;
    uint64_t seconds;
    assert_int_equal(child_run(&ordinary, reply_processor_limit, NULL, &reply), CHILD_DONE);
    assert_int_equal(reply.size_bytes, sizeof seconds);
    memcpy(&seconds, reply.data, sizeof seconds);
    assert_true(seconds > 0 && seconds <= 1 + (uint64_t)ordinary.cpu_s);
    child_reply_free(&reply);
}

static int allocate(void *user, void *to, child_write write)
{
    size_t bytes = *(size_t *)user;
    char *memory = malloc(bytes);
    if (!memory)
        return CHILD_EXIT_MEMORY;
    memory[bytes / 2] = 'x';
    bool written = write(to, &memory[bytes / 2], 1);
    free(memory);
    return written ? 0 : 1;
}

TEST(memory_is_limited)
{
    struct child_reply reply;
    size_t bytes = 128u << 20;
    assert_int_equal(child_run(&ordinary, allocate, &bytes, &reply), CHILD_DONE);
    child_reply_free(&reply);
    mapped_late_bytes = 512u << 20; /* not the child's own memory */
    assert_int_equal(child_run(&ordinary, allocate, &bytes, &reply), CHILD_DONE);
    child_reply_free(&reply);
    mapped_late_bytes = 0;
#ifndef HAS_ASAN
    bytes = 512u << 20;
    assert_int_equal(child_run(&ordinary, allocate, &bytes, &reply), CHILD_MEMORY);
#endif
}

static int chatter(void *user, void *to, child_write writer)
{
    (void)user;
    static const char noise[] = "noise\n";
    if (write(STDOUT_FILENO, noise, sizeof noise) < 0 ||
        write(STDERR_FILENO, noise, sizeof noise) < 0)
        return 1;
    return writer(to, "k", 1) ? 0 : 1;
}

TEST(output_goes_nowhere)
{
    int ends[2], kept = dup(STDERR_FILENO);
    assert_int_equal(pipe(ends), 0);
    dup2(ends[1], STDERR_FILENO);
    close(ends[1]);
    struct child_reply reply;
    enum child_end end = child_run(&ordinary, chatter, NULL, &reply);
    dup2(kept, STDERR_FILENO);
    close(kept);
    assert_int_equal(end, CHILD_DONE);
    child_reply_free(&reply);
    char text[8];
    assert_int_equal(read(ends[0], text, sizeof text), 0);
    close(ends[0]);
}
