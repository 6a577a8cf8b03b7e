/* Sandboxed children that try everything which foreign code must not do. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <time.h>

#include <seccomp.h>

#include "../wrapped.h"
#include "base/array.h"
#include "base/file.h"
#include "base/foreign.h"
#include "base/sandbox.h"
#include "folder_fixture.h"

static bool no_filter; /* makes loading of the seccomp filter fail */

WRAPPED(int, seccomp_load, const scmp_filter_ctx filter)
{
    return no_filter ? -EPERM : __real_seccomp_load(filter);
}

static const struct child_limits ordinary = {
    .who = "test", .cpu_s = 20.0, .memory_bytes = 256u << 20, .reply_bytes = 1u << 20};

/* Targets of the trials: two files, an inherited descriptor of one of them, and this process. */
static struct {
    char *secret, *other;
    int fd;
    pid_t pid;
} victim;

static int begin(void **state)
{
    int result = folder_begin(state);
    victim.secret = string_format("%s/secret", folder);
    victim.other = string_format("%s/other", folder);
    put_file(victim.secret, "secret", 6);
    /* The child inherits it. Its number is none of those that the sandbox keeps for the reply. */
    int low = open(victim.secret, O_RDWR);
    victim.fd = fcntl(low, F_DUPFD, 2 * SANDBOX_FD_COUNT);
    close(low);
    victim.pid = getpid();
    no_filter = false;
    return victim.fd < 0 ? -1 : result;
}

static int end(void **state)
{
    close(victim.fd);
    free(victim.secret);
    free(victim.other);
    return folder_end(state);
}

/* --- trials --------------------------------------------------------------------------------- */

static char room[8];
static int numbers[2];

/* Each trial's name, and the call that it makes. */
#define TRIALS(TRY)                                                                                \
    TRY(open_to_read, open(victim.secret, O_RDONLY))                                               \
    TRY(open_to_write, open(victim.other, O_WRONLY | O_CREAT, 0600))                               \
    TRY(open_by_openat2, syscall(SYS_openat2, AT_FDCWD, victim.secret, 0, 0))                      \
    TRY(read_inherited, read(victim.fd, room, 1))                                                  \
    TRY(write_inherited, write(victim.fd, "x", 1))                                                 \
    TRY(write_inherited_at, pwrite(victim.fd, "x", 1, 0))                                          \
    TRY(empty_inherited, ftruncate(victim.fd, 0))                                                  \
    TRY(duplicate, dup(0))                                                                         \
    TRY(steer_device, ioctl(0, FIONREAD, numbers))                                                 \
    TRY(look_for_file, access(victim.secret, R_OK))                                                \
    TRY(read_link, readlink("/proc/self/exe", room, sizeof room))                                  \
    TRY(remove_file, unlink(victim.secret))                                                        \
    TRY(rename_file, rename(victim.secret, victim.other))                                          \
    TRY(link_file, link(victim.secret, victim.other))                                              \
    TRY(symlink_file, symlink(victim.secret, victim.other))                                        \
    TRY(change_mode, chmod(victim.secret, 0777))                                                   \
    TRY(change_owner, chown(victim.secret, 1, 1))                                                  \
    TRY(make_folder, mkdir(victim.other, 0700))                                                    \
    TRY(make_fifo, mkfifo(victim.other, 0600))                                                     \
    TRY(change_folder, chdir("/"))                                                                 \
    TRY(change_root, chroot("/"))                                                                  \
    TRY(empty_file, truncate(victim.secret, 0))                                                    \
    TRY(make_memory_file, memfd_create("x", 0))                                                    \
    TRY(make_pipe, pipe(numbers))                                                                  \
    TRY(make_socket, socket(AF_INET, SOCK_STREAM, 0))                                              \
    TRY(make_local_sockets, socketpair(AF_UNIX, SOCK_STREAM, 0, numbers))                          \
    TRY(connect_out, connect(3, (const struct sockaddr *)&address, sizeof address))                \
    TRY(send_out, send(3, "x", 1, 0))                                                              \
    TRY(fork_one, fork())                                                                          \
    TRY(clone_one, syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0))                                        \
    TRY(clone_by_clone3, syscall(SYS_clone3, NULL, 0))                                             \
    TRY(start_thread, pthread_create(&thread, NULL, idle, NULL))                                   \
    TRY(run_program, execve("/bin/true", no_words, no_words))                                      \
    TRY(kill_parent, kill(victim.pid, SIGKILL))                                                    \
    TRY(kill_parents_thread, syscall(SYS_tgkill, victim.pid, victim.pid, SIGKILL))                 \
    TRY(kill_all, kill(-1, 0))                                                                     \
    TRY(hold_parent, ptrace(PTRACE_ATTACH, victim.pid, NULL, NULL))                                \
    TRY(be_held, ptrace(PTRACE_TRACEME, 0, NULL, NULL))                                            \
    TRY(read_parent, process_vm_readv(victim.pid, &here, 1, &here, 1, 0))                          \
    TRY(map_code, (intptr_t)mmap(NULL, 4096, PROT_READ | PROT_EXEC, ANONYMOUS, -1, 0))             \
    TRY(make_code, mprotect(mmap(NULL, 4096, PROT_WRITE, ANONYMOUS, -1, 0), 4096, PROT_EXEC))      \
    TRY(change_itself, prctl(PR_SET_DUMPABLE, 0))                                                  \
    TRY(raise_limit, setrlimit(RLIMIT_NOFILE, &one_file))                                          \
    TRY(change_user, setuid(1))                                                                    \
    TRY(catch_signal, signal(SIGSYS, SIG_IGN) == SIG_ERR)                                          \
    TRY(set_timer, alarm(1))                                                                       \
    TRY(change_filter, syscall(SYS_seccomp, 0, 0, NULL))                                           \
    TRY(ask_by_ring, syscall(SYS_io_uring_setup, 1, NULL))                                         \
    TRY(share_memory, syscall(SYS_shmget, 0, 4096, 0600))                                          \
    TRY(load_kernel_code, syscall(SYS_bpf, 0, NULL, 0))                                            \
    TRY(make_namespace, unshare(CLONE_NEWUSER))                                                    \
    TRY(read_kernel_log, syscall(SYS_syslog, 3, NULL, 0))                                          \
    TRY(call_what_is_not_there, syscall(9999))

enum { ANONYMOUS = MAP_PRIVATE | MAP_ANONYMOUS };
static const struct sockaddr_in address = {.sin_family = AF_INET};
static const struct rlimit one_file = {1, 1};
static const struct iovec here = {room, 1};
static char *const no_words[] = {NULL};
static pthread_t thread;

static void *idle(void *user)
{
    return user;
}

#define FUNCTION(name, call)                                                                       \
    static long name(void)                                                                         \
    {                                                                                              \
        return (long)(call);                                                                       \
    }
TRIALS(FUNCTION)

#define ROW(name, call) {#name, name},
static const struct trial {
    const char *name;
    long (*fn)(void);
} trials[] = {TRIALS(ROW)};

/* The result and errno of a child's call. */
struct outcome {
    long result;
    int error;
};

static int attempt(void *user, void *to, child_write write)
{
    const struct trial *trial = user;
    struct outcome outcome = {.result = trial->fn()};
    outcome.error = errno;
    return write(to, &outcome, sizeof outcome) ? 0 : 1;
}

static void nothing_was_harmed(const char *by)
{
    struct stat info;
    char text[16] = "";
    if (stat(victim.secret, &info) != 0 || info.st_size != 6 || (info.st_mode & 0777) == 0777 ||
        pread(victim.fd, text, sizeof text, 0) != 6 || strcmp(text, "secret") != 0 ||
        access(victim.other, F_OK) == 0)
        fail_msg("%s did harm", by);
}

TEST_IN(each_forbidden_thing_is_stopped, begin, end)
{
    for (size_t i = 0; i < sizeof trials / sizeof *trials; ++i) {
        struct child_reply reply;
        struct trial trial = trials[i];
        enum child_end how = child_run(&ordinary, attempt, &trial, &reply);
        if (how != CHILD_FORBIDDEN)
            fail_msg("%s was not stopped: %d", trial.name, (int)how);
        nothing_was_harmed(trial.name);
    }
}

/* --- allowed calls -------------------------------------------------------------------------- */

static int compare_bytes(const void *a, const void *b)
{
    return *(const unsigned char *)a - *(const unsigned char *)b;
}

static int work(void *user, void *to, child_write write)
{
    (void)user;
    struct timespec now;
    size_t bytes = 1u << 20;
    unsigned char *data = malloc(bytes);
    for (; data && bytes < 64u << 20; bytes *= 2)
        data = realloc(data, 2 * bytes); /* by brk, mmap and mremap */
    if (!data || clock_gettime(CLOCK_MONOTONIC, &now) != 0 || sched_yield() != 0)
        return 1;
    for (size_t i = 0; i < 5000; ++i)
        data[i] = (unsigned char)(i * 37);
    qsort(data, 5000, 1, compare_bytes);
    fprintf(stderr, "nobody reads this: %g\n", 0.5);
    printf("nor this\n");
    (void)fflush(stdout);
    bool written = write(to, data, 5000);
    free(data);
    return written ? 0 : 1;
}

TEST_IN(what_decoding_needs_is_allowed, begin, end)
{
    struct child_reply reply;
    assert_int_equal(child_run(&ordinary, work, NULL, &reply), CHILD_DONE);
    assert_int_equal(reply.exit_code, 0);
    assert_int_equal(reply.size_bytes, 5000);
    assert_int_equal(reply.data[4999], 255);
    assert_int_equal(reply.open_because, 0);
    child_reply_free(&reply);
}

static int give_up(void *user, void *to, child_write write)
{
    (void)user, (void)to, (void)write;
    abort();
}

TEST_IN(crashes_are_still_crashes, begin, end)
{
    struct child_reply reply;
    assert_int_equal(child_run(&ordinary, give_up, NULL, &reply), CHILD_CRASHED);
    assert_int_equal(reply.signal, SIGABRT);
}

/* --- without the filter --------------------------------------------------------------------- */

static struct outcome outcome_of(long (*fn)(void))
{
    struct trial trial = {"", fn};
    struct child_reply reply;
    struct outcome outcome;
    assert_int_equal(child_run(&ordinary, attempt, &trial, &reply), CHILD_DONE);
    assert_int_equal(reply.open_because, EPERM);
    assert_int_equal(reply.size_bytes, sizeof outcome);
    memcpy(&outcome, reply.data, sizeof outcome);
    child_reply_free(&reply);
    return outcome;
}

static long new_privileges(void)
{
    return prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0);
}

static long limits_of_processes_and_files(void)
{
    struct rlimit processes, files;
    return getrlimit(RLIMIT_NPROC, &processes) == 0 && getrlimit(RLIMIT_NOFILE, &files) == 0
               ? (long)(processes.rlim_max * 100 + files.rlim_max)
               : -1;
}

/* Descriptors, privileges and limits are taken away even where the filter cannot be loaded. */
TEST_IN(the_rest_holds_without_the_filter, begin, end)
{
    no_filter = true;
    struct outcome outcome = outcome_of(read_inherited);
    assert_true(outcome.result == -1 && outcome.error == EBADF);
    assert_int_equal(outcome_of(new_privileges).result, 1);
    assert_int_equal(outcome_of(limits_of_processes_and_files).result, 4);
    assert_int_equal(outcome_of(duplicate).error, EMFILE);
}

TEST_IN(landlock_holds_without_the_filter, begin, end)
{
    if (syscall(444, NULL, 0, 1) < 1) {
        print_message("skipped: this kernel has no Landlock\n");
        skip();
    }
    no_filter = true;
    assert_int_equal(outcome_of(empty_file).error, EACCES);
    assert_int_equal(outcome_of(make_folder).error, EACCES);
    assert_int_equal(outcome_of(remove_file).error, EACCES);
    nothing_was_harmed("a child without a filter");
}

static volatile int *shared_with_child;

static int write_shared(void *user, void *to, child_write write)
{
    (void)user;
    *shared_with_child = 1;
    return write(to, "", 1) ? 0 : 1;
}

/* Shared mappings, such as a driver's cache, are not in the child. */
TEST_IN(shared_memory_is_gone, begin, end)
{
    struct child_reply reply;
    void *memory = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(memory != MAP_FAILED);
    shared_with_child = memory;
    for (int i = 0; i < 2; ++i) {
        no_filter = i;
        assert_int_equal(child_run(&ordinary, write_shared, NULL, &reply), CHILD_CRASHED);
        assert_int_equal(*shared_with_child, 0);
    }
    munmap(memory, 4096);
}

static int give_memory_back(void *user, void *to, child_write write)
{
    enum { BLOCKS = 16384, BYTES = 1024 };
    static void *blocks[BLOCKS];
    (void)user;
    for (int i = 0; i < BLOCKS; ++i)
        blocks[i] = malloc(BYTES);
    for (int i = BLOCKS; i > 0; --i)
        free(blocks[i - 1]);
    return write(to, "", 1) ? 0 : 1;
}

static void *run_there(void *user)
{
    struct child_reply reply;
    free(malloc(100)); /* its own arena */
    *(enum child_end *)user = child_run(&ordinary, give_memory_back, NULL, &reply);
    child_reply_free(&reply);
    return NULL;
}

/* Before glibc shrinks a thread's arena, it asks the system how memory is counted: the sandbox must
   not end the child for that. */
TEST_IN(memory_is_given_back_in_threads, begin, end)
{
    enum child_end end = CHILD_NOT_STARTED;
    pthread_t other;
    assert_int_equal(pthread_create(&other, NULL, run_there, &end), 0);
    assert_int_equal(pthread_join(other, NULL), 0);
    assert_int_equal(end, CHILD_DONE);
}

TEST_IN(a_filter_that_cannot_be_set_is_said_once, begin, end)
{
    char reason[FOREIGN_REASON_BYTES] = "";
    struct child_reply reply;
    for (int i = 0; i < 3; ++i) {
        no_filter = i > 0;
        assert_int_equal(foreign_run(&warnings_log, &ordinary, work, NULL, &reply, reason),
                         WHIT_OK);
        child_reply_free(&reply);
        assert_int_equal(messages.warnings, i > 0);
        assert_int_equal(messages.errors, 0);
    }
    assert_non_null(strstr(messages.last, strerror(EPERM)));
    assert_non_null(strstr(messages.last, "--require-sandbox"));
}

TEST_IN(a_filter_that_is_required_is_an_error, begin, end)
{
    struct foreign_params params = {.require_sandbox = true};
    struct child_limits limits = foreign_limits(&params, "importer", 0, 1u << 20);
    char reason[FOREIGN_REASON_BYTES] = "";
    struct child_reply reply;
    assert_int_equal(foreign_run(NULL, &limits, work, NULL, &reply, reason), WHIT_OK);
    child_reply_free(&reply);
    no_filter = true;
    assert_int_equal(child_run(&limits, work, NULL, &reply), CHILD_OPEN);
    assert_null(reply.data);
    assert_int_equal(foreign_run(NULL, &limits, work, NULL, &reply, reason), WHIT_ERROR_USAGE);
    assert_non_null(strstr(reason, "the importer cannot be locked in"));
    assert_non_null(strstr(reason, strerror(EPERM)));
}
