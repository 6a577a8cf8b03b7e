/* The sandbox: resource limits, Landlock, and a filter of system calls (seccomp). Each works
   without the others. */
#define _GNU_SOURCE
#include "base/sandbox.h"

#include <errno.h>
#include <fcntl.h>
#include <seccomp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

/* Calls that are always allowed: they take no descriptor, no path and no other process. The C
   library asks for the machine's processors and memory before it makes heaps and sorts;
   AddressSanitizer for the stack of signal handlers. */
static const int always[] = {
    SCMP_SYS(brk),
    SCMP_SYS(clock_gettime),
    SCMP_SYS(exit),
    SCMP_SYS(exit_group),
    SCMP_SYS(futex),
    SCMP_SYS(getpid),
    SCMP_SYS(getrandom),
    SCMP_SYS(gettid),
    SCMP_SYS(gettimeofday),
    SCMP_SYS(madvise),
    SCMP_SYS(mremap),
    SCMP_SYS(munmap),
    SCMP_SYS(rt_sigprocmask),
    SCMP_SYS(rt_sigreturn),
    SCMP_SYS(sched_getaffinity),
    SCMP_SYS(sched_yield),
    SCMP_SYS(sigaltstack),
    SCMP_SYS(sysinfo),
};

/* Allows calls that depend on one argument. */
static int allow_some(scmp_filter_ctx filter)
{
    const struct scmp_arg_cmp no_code = SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0);
    const struct scmp_arg_cmp known = SCMP_A0(SCMP_CMP_LT, SANDBOX_FD_COUNT, 0);
    const struct scmp_arg_cmp self = SCMP_A0(SCMP_CMP_EQ, (scmp_datum_t)getpid(), 0);
    const struct {
        int call;
        struct scmp_arg_cmp when;
    } rules[] = {
        {SCMP_SYS(mmap), no_code}, {SCMP_SYS(mprotect), no_code}, {SCMP_SYS(write), known},
        {SCMP_SYS(writev), known}, {SCMP_SYS(tgkill), self}, /* these two: abort() */
    };
    int error = 0;
    for (size_t i = 0; !error && i < sizeof rules / sizeof *rules; ++i)
        error = seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, rules[i].call, 1, &rules[i].when);
    return error;
}

static int filter_calls(void)
{
    errno = 0;
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_KILL_PROCESS);
    if (!filter)
        return errno ? errno : ENOSYS;
    int error = allow_some(filter);
    for (size_t i = 0; !error && i < sizeof always / sizeof *always; ++i)
        error = seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, always[i], 0, NULL);
    if (!error)
        error = seccomp_load(filter);
    seccomp_release(filter);
    return -error;
}

/* Landlock (Linux 5.13 and later): gives up all files, ports and other processes. The struct has
   the kernel's layout; a kernel accepts members that it does not know if they are 0. */
static void give_up_files(void)
{
    enum { CREATE_RULESET = 444, RESTRICT_SELF = 446, ASK_VERSION = 1 };
    static const unsigned file_rights[] = {0, 13, 14, 15, 15, 16}; /* [version] */
    struct {
        uint64_t files, ports, scopes;
    } handled = {0};
    long version = syscall(CREATE_RULESET, NULL, 0, ASK_VERSION);
    if (version < 1)
        return;
    handled.files = (UINT64_C(1) << file_rights[version < 5 ? version : 5]) - 1;
    handled.ports = version >= 4 ? 3 : 0;
    handled.scopes = version >= 6 ? 3 : 0;
    int rules = (int)syscall(CREATE_RULESET, &handled, sizeof handled, 0);
    if (rules < 0)
        return;
    (void)syscall(RESTRICT_SELF, rules, 0);
    close(rules);
}

/* Unmaps shared memory. `line`: of /proc/self/maps, the address range, then `rw-s` or the like. */
static void give_up_if_shared(const char *line)
{
    char *end;
    uintptr_t first = strtoul(line, &end, 16);
    uintptr_t behind = *end == '-' ? strtoul(end + 1, &end, 16) : 0;
    if (behind > first && strlen(end) > 4 && end[4] == 's')
        (void)syscall(SYS_munmap, first, behind - first);
}

/* Unmaps all shared memory, since writes to it leave the child: a driver's kernel cache is a mapped
   file of the user, a window's pixels are another process's. 0, or errno. It allocates nothing:
   another thread may have held the allocator's lock at the fork. */
static int give_up_shared_memory(void)
{
    char text[8192];
    size_t used = 0;
    int fd = open("/proc/self/maps", O_RDONLY | O_CLOEXEC);
    if (fd < 0)
        return errno;
    for (ssize_t got; (got = read(fd, text + used, sizeof text - 1 - used)) > 0;) {
        char *line = text;
        used += (size_t)got;
        text[used] = 0;
        for (char *end; (end = strchr(line, '\n')); line = end + 1) {
            *end = 0;
            give_up_if_shared(line);
        }
        used = strlen(line);
        memmove(text, line, used);
    }
    close(fd);
    return 0;
}

void sandbox_close_from(int first)
{
    if (syscall(SYS_close_range, first, ~0u, 0) == 0)
        return;
    long max = sysconf(_SC_OPEN_MAX);
    for (int fd = first; fd < max; ++fd)
        close(fd);
}

int sandbox_enter(void)
{
    const struct rlimit files = {SANDBOX_FD_COUNT, SANDBOX_FD_COUNT}, none = {0, 0};
    sandbox_close_from(SANDBOX_FD_COUNT);
    int shared = give_up_shared_memory();
    (void)prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    give_up_files();
    (void)setrlimit(RLIMIT_NOFILE, &files);
    (void)setrlimit(RLIMIT_NPROC, &none);
    (void)setrlimit(RLIMIT_CORE, &none);
    (void)setrlimit(RLIMIT_FSIZE, &none);
    int error = filter_calls();
    return error ? error : shared;
}
