/* Sanitized tests preload this. */
#define _GNU_SOURCE
#include <ctype.h>
#include <dirent.h>
#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

int dlclose(void *handle);
pid_t fork(void);

/* Drivers stay loaded, so that leaks in them can be told by name (lsan.supp) from leaks of whit. */
int dlclose(void *handle)
{
    (void)handle;
    return 0;
}

static bool task_sleeps(const char *tid)
{
    char path[64], line[256] = "";
    snprintf(path, sizeof path, "/proc/self/task/%.16s/stat", tid);
    FILE *file = fopen(path, "r");
    if (!file)
        return true; /* it has ended */
    const char *state = fgets(line, sizeof line, file) ? strrchr(line, ')') : NULL;
    fclose(file);
    return !state || state[1] == '\0' || state[2] != 'R';
}

static bool others_sleep(void)
{
    DIR *tasks = opendir("/proc/self/task");
    char own[16];
    snprintf(own, sizeof own, "%ld", (long)gettid());
    bool sleep = true;
    for (struct dirent *task; tasks && sleep && (task = readdir(tasks)) != NULL;)
        if (isdigit((unsigned char)task->d_name[0]) && strcmp(task->d_name, own) != 0)
            sleep = task_sleeps(task->d_name);
    if (tasks)
        closedir(tasks);
    return sleep;
}

/* The sanitizer's allocator keeps its locks over a fork: where another thread, such as one that a
   driver has just started, was in it, the child waits for ever at its first malloc. A thread that
   sleeps is hardly ever in it. Threads that never sleep are waited for 2 s. */
pid_t fork(void)
{
    for (int tries = 0; tries < 2000 && !others_sleep(); tries++)
        usleep(1000);
    pid_t (*next)(void) = (pid_t(*)(void))dlsym(RTLD_NEXT, "fork");
    return next();
}
