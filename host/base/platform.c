/* memfd_create and PR_SET_PDEATHSIG are Linux's own. */
#define _GNU_SOURCE
#include "base/platform.h"

#include <errno.h>
#include <fcntl.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <math.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"

/* AddressSanitizer reserves terabytes of address space for its shadow. */
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

enum { EXIT_REPLY = 121, POLL_MS = 10 };

struct child {
    pid_t pid;
    int reply_fd; /* anonymous file, written by the child and mapped by the parent */
    int alive_fd; /* reading end of a pipe that the child holds open while it lives */
    int held_fd;
};

struct reply_writer {
    int fd;
    uint64_t left_bytes;
    bool over;
};

static bool write_reply(void *to, const void *data, size_t size_bytes)
{
    struct reply_writer *writer = to;
    if (size_bytes > writer->left_bytes) {
        writer->over = true;
        return false;
    }
    const uint8_t *from = data;
    size_t done = 0;
    while (done < size_bytes) {
        ssize_t got = write(writer->fd, from + done, size_bytes - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0) {
            writer->over = true;
            return false;
        }
        done += (size_t)got;
    }
    writer->left_bytes -= size_bytes;
    return true;
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

/* What is mapped already, by this process and the libraries and drivers in it, does not count
   against the child. */
static uint64_t mapped_bytes(void)
{
    unsigned long pages = 0;
    FILE *stream = fopen("/proc/self/statm", "re");
    if (!stream)
        return 0;
    if (fscanf(stream, "%lu", &pages) != 1)
        pages = 0;
    fclose(stream);
    return (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

static void confine(const struct child_limits *limits, uint64_t already_bytes, pid_t parent)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(EXIT_FAILURE);
    for (int i = 1; i < NSIG; ++i)
        signal(i, SIG_DFL);
    /* Ctrl+C reaches the whole group; the parent decides what becomes of the child. */
    signal(SIGINT, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    int null_fd = open("/dev/null", O_RDWR);
    if (null_fd >= 0) {
        for (int i = 0; i <= 2; ++i)
            dup2(null_fd, i);
    }
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, limits->reply_bytes);
    /* A backstop for when the parent is stopped. */
    limit(RLIMIT_CPU, 2 + 2 * (uint64_t)fmin(ceil(fmax(limits->time_s, 0.0)), 1e6));
    if (LIMIT_ADDRESS_SPACE && limits->memory_bytes)
        limit(RLIMIT_AS, already_bytes + limits->memory_bytes);
}

static void close_fd(int *fd)
{
    if (*fd >= 0)
        close(*fd);
    *fd = -1;
}

static int anonymous_file(void)
{
    int fd = memfd_create("whit-reply", MFD_CLOEXEC);
    if (fd >= 0)
        return fd;
    FILE *stream = tmpfile();
    if (!stream)
        return -1;
    fd = fcntl(fileno(stream), F_DUPFD_CLOEXEC, 3);
    fclose(stream);
    return fd;
}

static bool open_channels(struct child *child)
{
    int ends[2];
    *child = (struct child){.pid = -1, .reply_fd = -1, .alive_fd = -1, .held_fd = -1};
    child->reply_fd = anonymous_file();
    if (child->reply_fd < 0 || pipe(ends) != 0)
        return false;
    child->alive_fd = ends[0];
    child->held_fd = ends[1];
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    return true;
}

static void close_channels(struct child *child)
{
    close_fd(&child->reply_fd);
    close_fd(&child->alive_fd);
    close_fd(&child->held_fd);
}

static pthread_rwlock_t fork_lock = PTHREAD_RWLOCK_INITIALIZER;

void platform_hold_forks(void)
{
    pthread_rwlock_rdlock(&fork_lock);
}

void platform_release_forks(void)
{
    pthread_rwlock_unlock(&fork_lock);
}

static bool start(struct child *child, const struct child_limits *limits,
                  int (*fn)(void *user, void *to, child_write write), void *user)
{
    if (!open_channels(child))
        return false;
    pthread_rwlock_wrlock(&fork_lock);
    uint64_t already_bytes = mapped_bytes();
    pid_t parent = getpid();
    /* No handler of the parent may run in the child: it would remove the parent's files. */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    child->pid = fork();
    if (child->pid == 0) {
        close_fd(&child->alive_fd);
        confine(limits, already_bytes, parent);
        pthread_sigmask(SIG_SETMASK, &before, NULL);
        struct reply_writer writer = {.fd = child->reply_fd, .left_bytes = limits->reply_bytes};
        int code = fn(user, &writer, write_reply);
        _exit(writer.over ? EXIT_REPLY : code);
    }
    pthread_rwlock_unlock(&fork_lock);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    close_fd(&child->held_fd);
    return child->pid > 0;
}

/* Returns when the child's pipe closed, or after a moment. */
static void wait_a_moment(struct child *child)
{
    struct pollfd watched = {.fd = child->alive_fd, .events = POLLIN};
    if (child->alive_fd < 0) {
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
        return;
    }
    if (poll(&watched, 1, POLL_MS) > 0)
        close_fd(&child->alive_fd);
}

static bool reap(pid_t pid, int flags, int *status)
{
    pid_t ended;
    do
        ended = waitpid(pid, status, flags);
    while (ended < 0 && errno == EINTR);
    if (ended < 0)
        *status = SIGABRT; /* somebody else waited for it: its end is unknown */
    return ended != 0;
}

/* CHILD_DONE when it ended by itself. */
static enum child_end wait_for_end(struct child *child, const struct child_limits *limits,
                                   int *status)
{
    double start_ms = clock_ms();
    enum child_end why = CHILD_DONE;
    while (!reap(child->pid, WNOHANG, status)) {
        if (limits->cancel && *limits->cancel)
            why = CHILD_CANCELLED;
        else if (limits->time_s > 0.0 && clock_ms() - start_ms > limits->time_s * 1e3)
            why = CHILD_TIME;
        if (why != CHILD_DONE) {
            kill(child->pid, SIGKILL);
            reap(child->pid, 0, status);
            return why;
        }
        wait_a_moment(child);
    }
    return CHILD_DONE;
}

static enum child_end end_of_signal(int number)
{
    if (number == SIGXCPU)
        return CHILD_TIME;
    /* Nobody here sent it: the kernel kills when the machine runs out of memory. */
    if (number == SIGKILL)
        return CHILD_MEMORY;
    return CHILD_CRASHED;
}

static enum child_end map_reply(int fd, uint64_t limit_bytes, struct child_reply *reply)
{
    struct stat info;
    if (fstat(fd, &info) != 0 || info.st_size <= 0 || (uint64_t)info.st_size > limit_bytes)
        return CHILD_REPLY;
    /* Private: nothing can change it any more. */
    void *data = mmap(NULL, (size_t)info.st_size, PROT_READ | PROT_WRITE, MAP_PRIVATE, fd, 0);
    if (data == MAP_FAILED)
        return CHILD_REPLY;
    reply->data = data;
    reply->size_bytes = (size_t)info.st_size;
    return CHILD_DONE;
}

enum child_end child_run(const struct child_limits *limits,
                         int (*fn)(void *user, void *to, child_write write), void *user,
                         struct child_reply *reply)
{
    struct child child;
    int status = 0;
    *reply = (struct child_reply){0};
    enum child_end end = CHILD_NOT_STARTED;
    if (!start(&child, limits, fn, user))
        goto done;
    end = wait_for_end(&child, limits, &status);
    if (end != CHILD_DONE)
        goto done;
    if (WIFSIGNALED(status)) {
        reply->signal = WTERMSIG(status);
        end = limits->cancel && *limits->cancel ? CHILD_CANCELLED : end_of_signal(reply->signal);
        goto done;
    }
    reply->exit_code = WEXITSTATUS(status);
    if (reply->exit_code == CHILD_EXIT_MEMORY)
        end = CHILD_MEMORY;
    else if (reply->exit_code == EXIT_REPLY)
        end = CHILD_REPLY;
    else
        end = map_reply(child.reply_fd, limits->reply_bytes, reply);
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

void platform_share_heaps(void)
{
#ifdef __GLIBC__ /* else up to 8 a core, each as large as its threads ever were */
    (void)mallopt(M_ARENA_MAX, 2);
    /* Pictures and trees come from the system and go back to it, whatever was freed before: else
       each that does not fit into a gap makes another one. */
    (void)mallopt(M_MMAP_THRESHOLD, 128 << 10);
    (void)mallopt(M_TRIM_THRESHOLD, 4 << 20);
#endif
}

void platform_trim_heaps(void)
{
#ifdef __GLIBC__
    (void)malloc_trim(0);
#endif
}

bool platform_is_terminal(int fd)
{
    return isatty(fd) == 1;
}

uint64_t platform_peak_memory_bytes(void)
{
    struct rusage own, children;
    if (getrusage(RUSAGE_SELF, &own) != 0 || getrusage(RUSAGE_CHILDREN, &children) != 0)
        return 0;
    long most = own.ru_maxrss > children.ru_maxrss ? own.ru_maxrss : children.ru_maxrss;
    return (uint64_t)most * 1024; /* Linux counts in KiB */
}

void platform_memory_bytes(uint64_t *all, uint64_t *own)
{
    char line[128];
    unsigned long long all_kib = 0, own_kib = 0;
    FILE *from = fopen("/proc/self/status", "r");
    while (from && fgets(line, sizeof line, from)) {
        (void)sscanf(line, "VmRSS: %llu kB", &all_kib);
        (void)sscanf(line, "RssAnon: %llu kB", &own_kib);
    }
    if (from)
        (void)fclose(from);
    *all = (uint64_t)all_kib * 1024;
    *own = (uint64_t)own_kib * 1024;
}

static volatile bool *volatile interrupt_flag;
static volatile sig_atomic_t interrupt_count;

static void on_interrupt(int number)
{
    int reason = errno;
    volatile bool *flag = interrupt_flag;
    if (flag)
        *flag = true;
    if (++interrupt_count > 1) {
        file_abandon_all();
        /* Delivered when the handler returns: the shell sees what ended the process. */
        signal(number, SIG_DFL);
        raise(number);
    }
    errno = reason;
}

void platform_catch_interrupts(volatile bool *flag)
{
    interrupt_flag = flag;
    interrupt_count = 0;
    struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaddset(&action.sa_mask, SIGINT);
    sigaddset(&action.sa_mask, SIGTERM);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}
