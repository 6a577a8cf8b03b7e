#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "bench/process.h"
#include "whit/whit_program.h"

extern char **environ;

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *where)
{
    (void)info, (void)kind, (void)where;
    return remove(path);
}

void process_remove_folder(const char *folder)
{
    (void)nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

/* ---- Start ---- */

void process_add(struct process *process, ...)
{
    va_list args;
    va_start(args, process);
    for (const char *text; (text = va_arg(args, const char *)) != NULL;)
        if (process->argument_count + 1 < PROCESS_ARGUMENTS)
            process->arguments[process->argument_count++] = text;
    va_end(args);
}

void process_add_device(struct process *process, const struct bench *bench)
{
    if (bench->ask.settings.device[0])
        process_add(process, "--device", bench->ask.settings.device, NULL);
}

static int prepare(const struct process *process, posix_spawn_file_actions_t *actions)
{
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    int failed = 0;
    if (process->folder)
        failed = posix_spawn_file_actions_addchdir_np(actions, process->folder);
    if (!failed && process->out)
        failed =
            posix_spawn_file_actions_addopen(actions, STDOUT_FILENO, process->out, flags, 0600);
    if (!failed && process->err)
        failed =
            posix_spawn_file_actions_addopen(actions, STDERR_FILENO, process->err, flags, 0600);
    for (int i = STDIN_FILENO; !failed && process->socket && i <= STDOUT_FILENO; ++i)
        failed = posix_spawn_file_actions_adddup2(actions, process->socket, i);
    return failed;
}

whit_result process_start(struct process *process)
{
    posix_spawn_file_actions_t actions;
    pid_t pid;
    posix_spawn_file_actions_init(&actions);
    int failed = prepare(process, &actions);
    if (!failed)
        failed = posix_spawnp(&pid, process->program, &actions, NULL,
                              (char *const *)(uintptr_t)process->arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed && !process->is_tried)
        cli_error("%s: cannot be run: %s", process->program, strerror(failed));
    process->pid = failed ? 0 : pid;
    return failed ? WHIT_ERROR_INPUT : WHIT_OK;
}

/* ---- End ---- */

/* The last line of the process's messages, for the error. */
static void last_line(const struct process *process, char *line, size_t bytes)
{
    static const char head[] = "whit: error: "; /* dropped, as the error that quotes the line has it
                                                   too */
    char path[BENCH_PATH], next[256];
    bool is_whole = process->err && process->err[0] == '/';
    line[0] = 0;
    snprintf(path, sizeof path, "%s%s%s", is_whole || !process->folder ? "" : process->folder,
             is_whole || !process->folder ? "" : "/", process->err ? process->err : "");
    FILE *from = process->err ? fopen(path, "r") : NULL;
    while (from && fgets(next, sizeof next, from)) {
        next[strcspn(next, "\n")] = 0;
        size_t skipped = strncmp(next, head, sizeof head - 1) == 0 ? sizeof head - 1 : 0;
        if (next[0])
            snprintf(line, bytes, ": %s", next + skipped);
    }
    if (from)
        fclose(from);
}

static whit_result judge_end(const struct process *process, int status)
{
    char name[80], said[300];
    bool is_whit = strcmp(process->arguments[0], "whit") == 0;
    snprintf(name, sizeof name, is_whit ? "whit %s" : "%s", process->arguments[is_whit]);
    if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_FINE)
        return WHIT_OK;
    if (cli_cancel)
        return WHIT_ERROR_CANCELLED;
    if (process->is_tried)
        return WHIT_ERROR_FAILED;
    last_line(process, said, sizeof said);
    bool no_device = is_whit && WIFEXITED(status) && WEXITSTATUS(status) == EXIT_DEVICE;
    if (no_device && strcmp(process->arguments[1], "view") == 0) /* so the window is missing, as the
                                                                    bench itself has a device */
        cli_error("this bench needs a window, and `whit view` opens none%s; where there is no "
                  "screen, `xvfb-run -s '-screen 0 1280x1024x24' whit bench ...` makes one up",
                  said);
    else if (WIFEXITED(status))
        cli_error("`%s` ended with exit code %d%s", name, WEXITSTATUS(status), said);
    else
        cli_error("`%s` died of signal %d%s", name, WTERMSIG(status), said);
    return no_device ? WHIT_ERROR_NO_DEVICE : WHIT_ERROR_FAILED;
}

/* Waits for a process, polling every 2 ms so that an interrupt can be passed on. */
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

whit_result process_end(struct process *process, struct process_times *times)
{
    struct rusage usage = {0};
    int status = wait_for((pid_t)process->pid, &usage);
    process->pid = 0;
    if (times)
        times->cpu_ms = ms_of(usage.ru_utime) + ms_of(usage.ru_stime);
    return judge_end(process, status);
}

whit_result process_run(struct process *process, struct process_times *times)
{
    double start_ms = whit_clock_ms();
    whit_result result = process_start(process);
    if (result == WHIT_OK)
        result = process_end(process, times);
    if (times)
        times->clock_ms = whit_clock_ms() - start_ms;
    return result;
}
