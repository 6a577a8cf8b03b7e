/* PR_SET_PDEATHSIG and SOCK_CLOEXEC are Linux's own. */
#define _GNU_SOURCE
#include "base/keep.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/platform.h"
#include "base/sandbox.h"

enum { SOCKET_FD = 3, POLL_MS = 10, GRACE_S = 5 };

struct keep {
    pid_t pid;
    int fd;
};

struct request_head {
    struct child_limits limits; /* `who` and `cancel` are not valid in the other process */
    uint64_t bytes;
};

struct reply_head {
    struct child_reply reply; /* `data` is not valid in this process */
    uint32_t end;
};

/* --- the process ---------------------------------------------------------------------------- */

static pid_t parent;

/* Ends the process when its parent has ended. The signal also comes when only the thread that
   forked has ended. */
static void on_parent_end(int number)
{
    (void)number;
    if (getppid() != parent)
        _exit(0);
}

static bool settle(int fd, const sigset_t *before)
{
    bool placed = child_settle(fd, SOCKET_FD);
    sandbox_close_from(SOCKET_FD + 1);
    /* Children put a pipe at that number, so the socket moves to a number that they close. */
    int above = fcntl(SOCKET_FD, F_DUPFD_CLOEXEC, SOCKET_FD + 1);
    close(SOCKET_FD);
    signal(SIGUSR1, on_parent_end);
    prctl(PR_SET_PDEATHSIG, SIGUSR1);
    pthread_sigmask(SIG_SETMASK, before, NULL);
    return placed && above == SOCKET_FD + 1 && getppid() == parent;
}

static bool read_whole(int fd, void *to, size_t bytes)
{
    return platform_read(fd, to, bytes) == (ssize_t)bytes;
}

static bool send_all(int fd, const void *from, size_t bytes)
{
    for (size_t done = 0; done < bytes;) {
        ssize_t got = send(fd, (const char *)from + done, bytes - done, MSG_NOSIGNAL);
        if (got < 0 && errno != EINTR)
            return false;
        done += got > 0 ? (size_t)got : 0;
    }
    return true;
}

struct job {
    const struct keep_work *work;
    void *request;
    size_t bytes;
};

static int do_job(void *user, void *to, child_write write)
{
    const struct job *job = user;
    return job->work->answer(job->request, job->bytes, to, write);
}

static bool serve_one(const struct keep_work *work)
{
    const int fd = SOCKET_FD + 1;
    struct request_head head;
    struct reply_head out = {.end = CHILD_NOT_STARTED};
    if (!read_whole(fd, &head, sizeof head))
        return false;
    struct job job = {work, malloc(head.bytes + 1), head.bytes};
    bool whole = job.request && read_whole(fd, job.request, head.bytes);
    if (whole) {
        head.limits.cancel = NULL;
        out.end = child_run(&head.limits, do_job, &job, &out.reply);
        size_t bytes = out.end == CHILD_DONE ? out.reply.size_bytes : 0;
        uint8_t *data = out.reply.data;
        out.reply.size_bytes = bytes;
        whole = send_all(fd, &out, sizeof out) && send_all(fd, data, bytes);
        out.reply.data = data;
        child_reply_free(&out.reply);
    }
    free(job.request);
    return whole;
}

static void serve(const struct keep_work *work, int fd, const sigset_t *before)
{
    if (!settle(fd, before))
        _exit(1);
    if (work->prepare)
        work->prepare();
    while (serve_one(work))
        ;
    _exit(0);
}

/* --- the caller ----------------------------------------------------------------------------- */

struct keep *keep_start(const struct keep_work *work)
{
    int ends[2];
    struct keep *keep = malloc(sizeof *keep);
    if (!keep || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        free(keep);
        return NULL;
    }
    pid_t self = getpid();
    sigset_t before;
    pid_t pid = child_fork(&before);
    if (pid == 0) {
        parent = self;
        serve(work, ends[1], &before);
    }
    close(ends[1]);
    *keep = (struct keep){pid, ends[0]};
    if (pid > 0)
        return keep;
    close(ends[0]);
    free(keep);
    return NULL;
}

static void end_process(struct keep *keep)
{
    if (keep->pid <= 0)
        return;
    kill(keep->pid, SIGKILL);
    while (waitpid(keep->pid, NULL, 0) < 0 && errno == EINTR)
        ;
    keep->pid = 0;
}

void keep_stop(struct keep *keep)
{
    if (!keep)
        return;
    close(keep->fd);
    end_process(keep);
    free(keep);
}

/* Waits until there is something to read: CHILD_DONE; else why it gave up. */
static enum child_end wait_for_reply(const struct keep *keep, const struct child_limits *limits)
{
    double start_ms = clock_ms(), limit_s = child_clock_limit_s(limits);
    for (;;) {
        struct pollfd watched = {.fd = keep->fd, .events = POLLIN};
        if (poll(&watched, 1, POLL_MS) > 0)
            return CHILD_DONE;
        if (limits->cancel && *limits->cancel)
            return CHILD_CANCELLED;
        if (limit_s > 0.0 && clock_ms() - start_ms > (limit_s + GRACE_S) * 1e3)
            return CHILD_TIME;
    }
}

static enum child_end take_reply(const struct keep *keep, const struct child_limits *limits,
                                 struct child_reply *reply, bool *alive)
{
    struct reply_head head;
    *alive = read_whole(keep->fd, &head, sizeof head);
    if (!*alive)
        return CHILD_NOT_STARTED;
    *reply = head.reply;
    reply->data = NULL;
    enum child_end end = head.end <= CHILD_CANCELLED ? (enum child_end)head.end : CHILD_REPLY;
    if (end != CHILD_DONE)
        return end;
    if (head.reply.size_bytes == 0 || head.reply.size_bytes > limits->reply_bytes)
        return CHILD_REPLY;
    void *data = mmap(NULL, head.reply.size_bytes, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (data == MAP_FAILED)
        return CHILD_NOT_STARTED;
    reply->data = data;
    *alive = read_whole(keep->fd, data, head.reply.size_bytes);
    if (*alive)
        return CHILD_DONE;
    child_reply_free(reply);
    return CHILD_NOT_STARTED;
}

enum child_end keep_run(struct keep *keep, const struct child_limits *limits, const void *request,
                        size_t bytes, struct child_reply *reply, bool *alive)
{
    const struct request_head head = {.limits = *limits, .bytes = bytes};
    *reply = (struct child_reply){0};
    *alive = keep->pid > 0 && send_all(keep->fd, &head, sizeof head) &&
             send_all(keep->fd, request, bytes);
    if (!*alive) {
        end_process(keep);
        return CHILD_NOT_STARTED;
    }
    enum child_end end = wait_for_reply(keep, limits);
    if (end == CHILD_DONE)
        end = take_reply(keep, limits, reply, alive);
    else
        *alive = false;
    if (!*alive || end == CHILD_NOT_STARTED)
        end_process(keep);
    return end;
}
