/* pipe2 and PR_SET_PDEATHSIG are Linux's own. */
#define _GNU_SOURCE
#include "base/child.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <malloc.h>
#include <math.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/platform.h"
#include "base/sandbox.h"

/* No limit under AddressSanitizer, which reserves terabytes of address space. */
#if defined(__SANITIZE_ADDRESS__)
#define LIMIT_ADDRESS_SPACE 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LIMIT_ADDRESS_SPACE 0
#endif
#endif
#ifndef LIMIT_ADDRESS_SPACE
#define LIMIT_ADDRESS_SPACE 1
#endif

enum { EXIT_REPLY = 121, EXIT_OPEN, POLL_MS = 10, PIPE_BYTES = 1 << 20, ROOM_MIN = 1 << 20 };
enum { STATUS_UNKNOWN = -1 };

/* The child's last words. The program may ignore SIGCHLD, or wait for all children: then waitpid()
   does not tell how this one ended. */
struct farewell {
    char mark[7];
    uint8_t exit_code;
};
static const char FAREWELL_MARK[7] = "the end";

struct child {
    pid_t pid;
    int read_fd, write_fd; /* the pipe: first one byte, errno of the sandbox or 0; then the reply,
                              and a farewell */
    uint8_t *data;         /* received so far, at the start of `room_bytes` of address space */
    size_t size_bytes, room_bytes;
    uint8_t open_because;
    bool heard, over; /* the first byte was received; more was received than there is room for */
};

/* A child_write. `to`: a bool, whether all earlier writes arrived. */
static bool write_reply(void *to, const void *data, size_t size_bytes)
{
    bool *whole = to;
    *whole = *whole && platform_write(SANDBOX_REPLY_FD, data, size_bytes);
    return *whole;
}

static void limit(__rlimit_resource_t resource, uint64_t value)
{
    struct rlimit limits;
    if (getrlimit(resource, &limits) != 0)
        return;
    if (limits.rlim_max == RLIM_INFINITY || value < limits.rlim_max)
        limits.rlim_max = (rlim_t)value;
    limits.rlim_cur = limits.rlim_max;
    setrlimit(resource, &limits);
}

/* The address space that this process has mapped already, with its libraries and drivers: it does
   not count against the child. The child asks, as other threads of its parent go on mapping. */
static uint64_t mapped_bytes(void)
{
    char text[32] = "";
    int fd = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (fd < 0)
        return 0;
    (void)platform_read(fd, text, sizeof text - 1);
    close(fd);
    return strtoull(text, NULL, 10) * (uint64_t)sysconf(_SC_PAGESIZE);
}

bool child_settle(int fd, int at)
{
    bool placed = dup2(fd, at) == at;
    int nowhere = open("/dev/null", O_RDWR);
    for (int i = 0; i < at; ++i) {
        if (nowhere < 0 || dup2(nowhere, i) != i)
            close(i);
    }
    for (int i = 1; i < NSIG; ++i)
        signal(i, SIG_DFL);
    /* Ctrl+C reaches the whole group; the parent decides what becomes of the child. */
    signal(SIGINT, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
    return placed;
}

static void confine(const struct child *child, const struct child_limits *limits, pid_t parent)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    close(child->read_fd);
    if (getppid() != parent || !child_settle(child->write_fd, SANDBOX_REPLY_FD))
        _exit(EXIT_FAILURE);
    /* A limit that holds even while the parent is stopped. */
    limit(RLIMIT_CPU, 1 + (uint64_t)fmin(ceil(fmax(limits->cpu_s, 0.0)), 1e6));
    if (LIMIT_ADDRESS_SPACE && limits->memory_bytes)
        limit(RLIMIT_AS, mapped_bytes() + limits->memory_bytes);
}

/* Runs fn in the sandbox; without it where it cannot be set up and is not required. */
static int run_inside(const struct child_limits *limits, child_fn fn, void *user)
{
    bool whole = true;
    /* Without this glibc reads /proc before it gives memory back, which the filter of system calls
       forbids. */
    (void)mallopt(M_TRIM_THRESHOLD, INT_MAX);
    uint8_t error = (uint8_t)sandbox_enter();
    int code = EXIT_OPEN;
    if (platform_write(SANDBOX_REPLY_FD, &error, 1) && !(error && limits->require_sandbox)) {
        code = fn(user, &whole, write_reply);
        code = whole ? code : EXIT_REPLY;
    }
    struct farewell farewell = {.exit_code = (uint8_t)code};
    memcpy(farewell.mark, FAREWELL_MARK, sizeof farewell.mark);
    (void)platform_write(SANDBOX_REPLY_FD, &farewell, sizeof farewell);
    return code;
}

static void close_fd(int *fd)
{
    if (*fd >= 0)
        close(*fd);
    *fd = -1;
}

/* Reserves address space for a reply, which takes no memory before it is used. Under limits on
   address space it may be less than `reply_bytes`. */
static bool make_room(struct child *child, uint64_t reply_bytes)
{
    size_t room = (size_t)(reply_bytes > ROOM_MIN ? reply_bytes : ROOM_MIN);
    for (; room >= ROOM_MIN; room /= 2) {
        void *data = mmap(NULL, room, PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (data == MAP_FAILED)
            continue;
        child->data = data;
        child->room_bytes = room;
        return true;
    }
    return false;
}

static bool open_channels(struct child *child, const struct child_limits *limits)
{
    int ends[2];
    *child = (struct child){.pid = -1, .read_fd = -1, .write_fd = -1};
    if (!make_room(child, limits->reply_bytes + sizeof(struct farewell)) ||
        pipe2(ends, O_CLOEXEC) != 0)
        return false;
    child->read_fd = ends[0];
    child->write_fd = ends[1];
    (void)fcntl(child->read_fd, F_SETPIPE_SZ, PIPE_BYTES); /* a smaller one is slower */
    return fcntl(child->read_fd, F_SETFL, O_NONBLOCK) == 0;
}

static void close_channels(struct child *child)
{
    close_fd(&child->read_fd);
    close_fd(&child->write_fd);
    if (child->data)
        munmap(child->data, child->room_bytes);
}

static pthread_rwlock_t fork_lock = PTHREAD_RWLOCK_INITIALIZER;

void child_hold_forks(void)
{
    pthread_rwlock_rdlock(&fork_lock);
}

void child_release_forks(void)
{
    pthread_rwlock_unlock(&fork_lock);
}

pid_t child_fork(sigset_t *before)
{
    pthread_rwlock_wrlock(&fork_lock);
    /* No handler of the parent may run in the child: it would remove the parent's files. */
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, before);
    pid_t pid = fork();
    if (pid == 0) {
        fork_lock = (pthread_rwlock_t)PTHREAD_RWLOCK_INITIALIZER;
        return 0;
    }
    pthread_rwlock_unlock(&fork_lock);
    pthread_sigmask(SIG_SETMASK, before, NULL);
    return pid;
}

static bool start(struct child *child, const struct child_limits *limits, child_fn fn, void *user)
{
    if (!open_channels(child, limits))
        return false;
    pid_t parent = getpid();
    sigset_t before;
    child->pid = child_fork(&before);
    if (child->pid == 0) {
        confine(child, limits, parent);
        pthread_sigmask(SIG_SETMASK, &before, NULL);
        _exit(run_inside(limits, fn, user));
    }
    close_fd(&child->write_fd);
    return child->pid > 0;
}

/* Reads what is in the pipe. False: there was nothing. */
static bool hear(struct child *child)
{
    uint8_t more;
    size_t room = child->room_bytes - child->size_bytes;
    bool direct = child->heard && room > 0;
    if (child->read_fd < 0)
        return false;
    ssize_t got =
        read(child->read_fd, direct ? child->data + child->size_bytes : &more, direct ? room : 1);
    if (got == 0)
        close_fd(&child->read_fd);
    if (got <= 0)
        return false;
    if (direct) {
        bool was_little = child->size_bytes < PIPE_BYTES;
        child->size_bytes += (size_t)got;
        if (was_little && child->size_bytes >= PIPE_BYTES)
            platform_expect_much(child->data + child->size_bytes,
                                 child->room_bytes - child->size_bytes);
    } else if (child->heard) {
        child->over = true;
    } else {
        child->heard = true;
        child->open_because = more;
    }
    return !child->over;
}

/* Waits until the child has written something or is about to end, at most for a moment. */
static void wait_a_moment(struct child *child)
{
    struct pollfd watched = {.fd = child->read_fd, .events = POLLIN};
    if (child->read_fd < 0)
        nanosleep(&(struct timespec){.tv_nsec = 50000}, NULL);
    else if (poll(&watched, 1, POLL_MS) > 0)
        while (hear(child))
            ;
}

static bool reap(pid_t pid, int flags, int *status)
{
    pid_t ended;
    do
        ended = waitpid(pid, status, flags);
    while (ended < 0 && errno == EINTR);
    if (ended < 0)
        *status = STATUS_UNKNOWN;
    return ended != 0;
}

/* Takes the farewell off the reply. Gives the status of waitpid(), or else what the child said. */
static int hear_farewell(struct child *child, int status)
{
    struct farewell farewell = {0};
    if (!child->over && child->size_bytes >= sizeof farewell)
        memcpy(&farewell, child->data + child->size_bytes - sizeof farewell, sizeof farewell);
    bool said = memcmp(farewell.mark, FAREWELL_MARK, sizeof farewell.mark) == 0;
    if (said)
        child->size_bytes -= sizeof farewell;
    if (status != STATUS_UNKNOWN)
        return status;
    return said ? W_EXITCODE(farewell.exit_code, 0) : SIGABRT;
}

double child_clock_limit_s(const struct child_limits *limits)
{
    return limits->clock_s > 0.0 ? limits->clock_s : 10.0 * limits->cpu_s;
}

/* Waits for the child's end, and kills it at a limit. CHILD_DONE when it ended by itself. */
static enum child_end wait_for_end(struct child *child, const struct child_limits *limits,
                                   int *status)
{
    double start_ms = clock_ms(), clock_s = child_clock_limit_s(limits);
    enum child_end why = CHILD_DONE;
    while (!reap(child->pid, WNOHANG, status)) {
        if (limits->cancel && *limits->cancel)
            why = CHILD_CANCELLED;
        else if (limits->cpu_s > 0.0 && clock_of_process_ms(child->pid) > limits->cpu_s * 1e3)
            why = CHILD_TIME;
        else if (clock_s > 0.0 && clock_ms() - start_ms > clock_s * 1e3)
            why = CHILD_TIME;
        else if (child->over)
            why = CHILD_REPLY;
        if (why != CHILD_DONE) {
            kill(child->pid, SIGKILL);
            reap(child->pid, 0, status);
            return why;
        }
        wait_a_moment(child);
    }
    while (hear(child))
        ;
    return CHILD_DONE;
}

static enum child_end end_of_signal(int number)
{
    if (number == SIGXCPU)
        return CHILD_TIME;
    if (number == SIGSYS)
        return CHILD_FORBIDDEN;
    /* Not sent by this process: Linux kills processes when the machine runs out of memory. */
    if (number == SIGKILL)
        return CHILD_MEMORY;
    return CHILD_CRASHED;
}

/* Gives the received bytes to the reply, and unmaps the address space behind them. */
static enum child_end take_reply(struct child *child, const struct child_limits *limits,
                                 struct child_reply *reply)
{
    if (child->size_bytes == 0 || child->over || child->size_bytes > limits->reply_bytes)
        return CHILD_REPLY;
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    size_t used = (child->size_bytes + page - 1) / page * page;
    if (used < child->room_bytes)
        munmap(child->data + used, child->room_bytes - used);
    reply->data = child->data;
    reply->size_bytes = child->size_bytes;
    child->data = NULL;
    return CHILD_DONE;
}

enum child_end child_run(const struct child_limits *limits, child_fn fn, void *user,
                         struct child_reply *reply)
{
    struct child child;
    int status = 0;
    *reply = (struct child_reply){0};
    enum child_end end = CHILD_NOT_STARTED;
    if (!start(&child, limits, fn, user))
        goto done;
    end = wait_for_end(&child, limits, &status);
    reply->open_because = child.open_because;
    if (end != CHILD_DONE)
        goto done;
    status = hear_farewell(&child, status);
    if (WIFSIGNALED(status)) {
        reply->signal = WTERMSIG(status);
        end = limits->cancel && *limits->cancel ? CHILD_CANCELLED : end_of_signal(reply->signal);
        goto done;
    }
    reply->exit_code = WEXITSTATUS(status);
    if (reply->exit_code == CHILD_EXIT_MEMORY)
        end = CHILD_MEMORY;
    else if (reply->exit_code == EXIT_OPEN)
        end = CHILD_OPEN;
    else if (reply->exit_code == EXIT_REPLY)
        end = CHILD_REPLY;
    else
        end = take_reply(&child, limits, reply);
done:
    close_channels(&child);
    return end;
}

void child_reply_free(struct child_reply *reply)
{
    if (reply && reply->data)
        munmap(reply->data, reply->size_bytes);
    if (reply)
        *reply = (struct child_reply){0};
}
