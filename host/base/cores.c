#define _GNU_SOURCE /* sched_setaffinity, gettid */
#include "base/cores.h"

#include <dirent.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

enum { THREADS_MAX = 65 };

void cores_name_threads(char name[CORES_NAME_BYTES], char before[CORES_NAME_BYTES])
{
    static atomic_uint calls;
    memset(before, 0, CORES_NAME_BYTES);
    (void)prctl(PR_GET_NAME, before);
    snprintf(name, CORES_NAME_BYTES, "whit driver %u", atomic_fetch_add(&calls, 1) % 1000);
    (void)prctl(PR_SET_NAME, name);
}

void cores_end_names(const char before[CORES_NAME_BYTES])
{
    (void)prctl(PR_SET_NAME, before);
}

static bool has_name(const char *thread, const char *name)
{
    char path[64], line[2 * CORES_NAME_BYTES] = "";
    snprintf(path, sizeof path, "/proc/self/task/%.20s/comm", thread);
    FILE *file = fopen(path, "re");
    bool read = file && fgets(line, sizeof line, file);
    if (file)
        fclose(file);
    line[strcspn(line, "\n")] = '\0';
    return read && strcmp(line, name) == 0;
}

/* Lists the other threads of a name, in the order in which they were started. Returns their number,
   of which at most THREADS_MAX are listed. */
static uint32_t find_named(const char *name, pid_t threads[THREADS_MAX])
{
    uint32_t count = 0;
    DIR *folder = opendir("/proc/self/task");
    for (const struct dirent *entry; folder && (entry = readdir(folder)) != NULL;) {
        pid_t thread = (pid_t)atoi(entry->d_name);
        if (thread <= 0 || thread == gettid() || !has_name(entry->d_name, name))
            continue;
        if (count < THREADS_MAX)
            threads[count] = thread;
        ++count;
    }
    if (folder)
        closedir(folder);
    return count;
}

/* Whether all the threads may run on just these cores. */
static bool may_run_on(const pid_t *threads, uint32_t count, const cpu_set_t *cores)
{
    cpu_set_t own;
    for (uint32_t i = 0; i < count; ++i) {
        if (sched_getaffinity(threads[i], sizeof own, &own) != 0 || !CPU_EQUAL(&own, cores))
            return false;
    }
    return true;
}

bool cores_spread(const char name[CORES_NAME_BYTES])
{
    cpu_set_t cores, own;
    pid_t threads[THREADS_MAX];
    if (sched_getaffinity(0, sizeof cores, &cores) != 0)
        return false;
    uint32_t count = (uint32_t)CPU_COUNT(&cores);
    if (count < 2 || count >= THREADS_MAX || find_named(name, threads) != count + 1 ||
        !may_run_on(threads, count + 1, &cores))
        return false;
    for (size_t core = 0, i = 1; core < CPU_SETSIZE; ++core) {
        if (!CPU_ISSET(core, &cores))
            continue;
        CPU_ZERO(&own);
        CPU_SET(core, &own);
        (void)sched_setaffinity(threads[i++], sizeof own, &own);
    }
    return true;
}
