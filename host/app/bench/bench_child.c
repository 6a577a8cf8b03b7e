/* Programs that a bench runs, and the folder where they may write. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "app/bench/bench.h"

extern char **environ;

/* ---- Scratch ---- */

whit_result bench_scratch_make(char folder[BENCH_SCRATCH])
{
    const char *scratch = getenv("TMPDIR");
    snprintf(folder, BENCH_SCRATCH, "%.480s/whit-bench-XXXXXX",
             scratch && scratch[0] ? scratch : "/tmp");
    if (mkdtemp(folder))
        return WHIT_OK;
    cli_error("%s cannot be made: %s", folder, strerror(errno));
    return WHIT_ERROR_OUTPUT;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *where)
{
    (void)info, (void)kind, (void)where;
    return remove(path);
}

void bench_scratch_remove(const char *folder)
{
    (void)nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

/* ---- Children ---- */

/* The last line of what it said, for the error. */
static void last_line(const struct bench_child *child, char *line, size_t bytes)
{
    char path[BENCH_PATH], next[256];
    line[0] = 0;
    snprintf(path, sizeof path, "%s%s%s", child->folder ? child->folder : "",
             child->folder ? "/" : "", child->err ? child->err : "");
    FILE *from = child->err ? fopen(path, "r") : NULL;
    while (from && fgets(next, sizeof next, from)) {
        next[strcspn(next, "\n")] = 0;
        if (next[0])
            snprintf(line, bytes, ": %s", next);
    }
    if (from)
        fclose(from);
}

static whit_result judge_end(const struct bench_child *child, int status)
{
    char name[64], said[300];
    snprintf(name, sizeof name, child->program ? "%s" : "whit %s",
             child->program ? child->program : child->arguments[1]);
    if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_FINE)
        return WHIT_OK;
    if (cli_cancel)
        return WHIT_ERROR_CANCELLED;
    last_line(child, said, sizeof said);
    if (child->is_tried)
        return WHIT_ERROR_FAILED;
    if (WIFEXITED(status))
        cli_error("`%s` ended with exit code %d%s", name, WEXITSTATUS(status), said);
    else
        cli_error("`%s` died of signal %d%s", name, WTERMSIG(status), said);
    bool no_device = !child->program && WIFEXITED(status) && WEXITSTATUS(status) == EXIT_DEVICE;
    return no_device ? WHIT_ERROR_NO_DEVICE : WHIT_ERROR_FAILED;
}

/* Looks every 2 ms, so that an interrupt reaches it. */
static int wait_for(pid_t pid, struct rusage *usage)
{
    const struct timespec pause = {.tv_nsec = 2000000};
    int status = 0;
    bool told = false;
    for (pid_t ended = 0; ended != pid;) {
        ended = wait4(pid, &status, WNOHANG, usage);
        if (ended < 0 && errno != EINTR)
            return -1;
        if (ended != pid)
            nanosleep(&pause, NULL);
        if (cli_cancel && !told)
            told = kill(pid, SIGTERM) == 0;
    }
    return status;
}

static double ms_of(struct timeval time)
{
    return (double)time.tv_sec * 1e3 + (double)time.tv_usec * 1e-3;
}

whit_result bench_child_run(const struct bench_child *child, struct bench_child_times *times)
{
    double start_ms = whit_clock_ms();
    posix_spawn_file_actions_t actions;
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    pid_t pid;
    posix_spawn_file_actions_init(&actions);
    int failed = child->folder ? posix_spawn_file_actions_addchdir_np(&actions, child->folder) : 0;
    if (!failed && child->out)
        failed = posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, child->out, flags, 0600);
    if (!failed && child->err)
        failed = posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, child->err, flags, 0600);
    if (!failed)
        failed = posix_spawnp(&pid, child->program ? child->program : "/proc/self/exe", &actions,
                              NULL, (char *const *)(uintptr_t)child->arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed && child->is_tried)
        return WHIT_ERROR_INPUT;
    if (failed) {
        cli_error("%s: cannot be run: %s", child->program ? child->program : "whit",
                  strerror(failed));
        return WHIT_ERROR_INPUT;
    }
    struct rusage usage = {0};
    int status = wait_for(pid, &usage);
    if (times)
        *times = (struct bench_child_times){
            .cpu_ms = ms_of(usage.ru_utime) + ms_of(usage.ru_stime),
            .clock_ms = whit_clock_ms() - start_ms,
        };
    return judge_end(child, status);
}
