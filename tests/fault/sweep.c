/* Runs a command over and over. Something else happens in each run, at another of its calls:
       fault_sweep INJECT FAULTS [options] -- COMMAND...
   FAULTS are names of the table below, with commas between them; the calls take them in turn. The
   command works in a folder of its own, where its outputs hold something old. Of each run it is
   checked that
   - it exits, with the code that is expected, and with one line that says why;
   - each output is the old one, or the whole new one, and as many are new as it says; no other file
     is there;
   - all that the program itself allocated was given back, unless it had to end at once;
   - killed, it leaves whole outputs, and nothing that the run behind it does not remove;
   - after a signal its timer ends it soon, and later only where it keeps what it has measured;
   - it went on for at most as many submissions to a queue as are allowed (--submits);
   - where it went well nevertheless, the outputs are those of a run without a fault; the viewer
     shows the pictures of such a run, or says why not (--stdout pictures).
   --cache cold: each run has an empty cache, so that all that is kept there is written.
   --runs N: at most so many runs, evenly spread over all calls. WHIT_TEST_OFFSET, a whole number,
   says which of them: as many successive numbers as the stride is cover all calls, and then the
   next fault in turn. --every N: each N-th call, with each of the faults. The run without a fault
   is under the validation layers, if they are asked for; the others are not, unless --validated
   says so. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "judge.h"

enum { TEXT_MAX = 1 << 16, RUN_LIMIT_S = 120, SHOWN = 8 };

static const struct fault faults[] = {
    {"memory", FAULT_CALLS_MEMORY, FAULT_FAILS, 0, 0, 2, NULL, false},
    {"write", FAULT_CALLS_WRITE, FAULT_FAILS, 0, 0, 2, "cannot write", false},
    /* An output is looked at too. Caches that cannot be read are made anew. */
    {"read", FAULT_CALLS_READ, FAULT_FAILS, EIO, 0, 2, "cannot write", false},
    {"descriptors", FAULT_CALLS_READ, FAULT_FAILS, EMFILE, 0, 2, "cannot write", false},
    /* Another run then finds what it left. */
    {"kill", FAULT_CALLS_WRITE, FAULT_SIGNAL, SIGKILL, 0, 0, NULL, true},
    {"pipe", FAULT_CALLS_WRITE, FAULT_SIGNAL, SIGPIPE, 0, 0, NULL, true},
    /* A driver or a library got no memory, and did not look. */
    {"crash", FAULT_CALLS_WRITE, FAULT_SIGNAL, SIGSEGV, 0, 2, "out of memory, ", true},
    {"host-memory", FAULT_CALLS_VULKAN, FAULT_FAILS, -1, 0, 2, "VK_ERROR_OUT_OF_HOST", false},
    {"device-memory", FAULT_CALLS_VULKAN, FAULT_FAILS, -2, 0, 2, "VK_ERROR_OUT_OF_DEVICE", false},
    {"lost-device", FAULT_CALLS_VULKAN, FAULT_FAILS, -4, 0, 3, "VK_ERROR_DEVICE_LOST", false},
    /* Ctrl+C: the program ends by itself. */
    {"int", FAULT_CALLS_ALL, FAULT_SIGNAL, SIGINT, 0, 130, "interrupted", false},
    {"term", FAULT_CALLS_ALL, FAULT_SIGNAL, SIGTERM, 0, 143, "interrupted", false},
    {"hup", FAULT_CALLS_ALL, FAULT_SIGNAL, SIGHUP, 0, 129, "interrupted", false},
    /* It has not ended by itself when its time to do so is over. */
    {"int-late", FAULT_CALLS_ALL, FAULT_SIGNAL, SIGINT, SIGALRM, 130, "interrupted", true},
    /* A second Ctrl+C. */
    {"int-int", FAULT_CALLS_ALL, FAULT_SIGNAL, SIGINT, SIGINT, 130, "", true},
    /* A time limit: the program ends by itself; the timer behind the limit ends it. */
    {"limit", FAULT_CALLS_ALL, FAULT_CLOCK, 0, 0, 5, "time limit", false},
    {"limit-late", FAULT_CALLS_ALL, FAULT_CLOCK, 0, SIGALRM, 5, "time limit", true},
};

void sweep_stop(const char *what)
{
    fprintf(stderr, "fault_sweep: %s: %s\n", what, strerror(errno));
    exit(2);
}

struct content sweep_read(const char *path)
{
    struct content content = {NULL, 0};
    FILE *stream = fopen(path, "rb");
    size_t capacity = 0, got = 1;
    while (stream && got > 0) {
        if (content.bytes + TEXT_MAX > capacity)
            content.data = realloc(content.data, capacity += 4 * TEXT_MAX);
        if (!content.data)
            sweep_stop(path);
        got = fread(content.data + content.bytes, 1, TEXT_MAX - 1, stream);
        content.bytes += got;
        content.data[content.bytes] = '\0';
    }
    if (stream)
        fclose(stream);
    return content;
}

static void lay_out(const struct sweep *sweep)
{
    for (uint32_t i = 0; i < sweep->output_count; ++i) {
        FILE *stream = fopen(sweep->outputs[i], "wb");
        if (!stream || fputs(OLD_TEXT, stream) == EOF || fclose(stream) != 0)
            sweep_stop(sweep->outputs[i]);
    }
}

static void empty_cache(const struct sweep *sweep)
{
    if (sweep->cold && system("rm -rf ../cache && mkdir ../cache") != 0)
        sweep_stop("../cache");
}

static void run_child(const struct sweep *sweep, bool validated)
{
    char number[16], preload[4096];
    const char *before = getenv("LD_PRELOAD");
    int out = open("../stdout", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    int err = open("../stderr", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (out < 0 || err < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0)
        _exit(126);
    snprintf(number, sizeof number, "%d", sweep->shared_fd);
    snprintf(preload, sizeof preload, "%s%s%s", sweep->inject, before ? ":" : "",
             before ? before : "");
    setenv(FAULT_VARIABLE, number, 1);
    setenv("LD_PRELOAD", preload, 1);
    if (!validated)
        unsetenv("WHIT_VALIDATION");
    char *cache = sweep->cold ? realpath("../cache", NULL) : NULL;
    if (cache) {
        setenv("XDG_CACHE_HOME", cache, 1);
        unsetenv("MESA_SHADER_CACHE_DIR");
    }
    alarm(RUN_LIMIT_S);
    execvp(sweep->command[0], sweep->command);
    _exit(126);
}

/* Runs the program once, with the event at call `at` (0: without one). Returns the status that
   waitpid gives. */
static int run_once(struct sweep *sweep, const struct fault *fault, uint32_t at, bool validated)
{
    int status = 0;
    struct fault_shared *shared = sweep->shared;
    lay_out(sweep);
    sweep->fault = fault;
    shared->counted = fault->calls;
    shared->event = fault->event;
    shared->code = fault->code;
    shared->then = fault->then;
    shared->at = at;
    atomic_store(&shared->seen, 0);
    atomic_store(&shared->fired, 0);
    atomic_store(&shared->submits_later, 0);
    shared->live = -1;
    shared->timer_ms = 0;
    shared->what[0] = '\0';
    memset(shared->callers, 0, sizeof shared->callers);
    pid_t pid = fork();
    if (pid < 0)
        sweep_stop("fork");
    if (pid == 0)
        run_child(sweep, validated);
    if (waitpid(pid, &status, 0) != pid)
        sweep_stop("waitpid");
    return status;
}

static void show(const struct sweep *sweep, uint32_t at, const char *defect, const char *errors)
{
    const struct fault_shared *shared = sweep->shared;
    printf("%s at call %u, %s from", sweep->fault->name, at, shared->what);
    for (int i = 0; i < FAULT_CALLERS && shared->callers[i]; ++i)
        printf(" %#llx", (unsigned long long)shared->callers[i]);
    printf(": %s\n%.600s", defect, errors);
}

static bool has_unfinished(void)
{
    glob_t names;
    bool found = glob(".*.tmp", 0, NULL, &names) == 0;
    globfree(&names);
    return found;
}

/* A killed run leaves whole files, and unfinished ones under names of their own. The run behind it
   is then judged, and may leave nothing. What is wrong with the first; NULL: nothing. */
static const char *run_again(struct sweep *sweep, const struct fault *fault, int *status)
{
    bool killed = WIFSIGNALED(*status) && WTERMSIG(*status) == SIGKILL;
    const char *defect = killed ? judge_outputs(sweep, false, "") : NULL;
    sweep->left += killed && has_unfinished();
    if (killed)
        *status = run_once(sweep, fault, 0, sweep->validated);
    return defect;
}

static void check_run(struct sweep *sweep, const struct fault *fault, uint32_t at)
{
    empty_cache(sweep);
    int status = run_once(sweep, fault, at, sweep->validated);
    const char *first = deadly(fault) == SIGKILL ? run_again(sweep, fault, &status) : NULL;
    struct content errors = sweep_read("../stderr");
    bool fired = atomic_load(&sweep->shared->fired) > 0;
    bool fine = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    const char *text = errors.data ? errors.data : "";
    const char *defect = first ? first : judge_run(sweep, status, text);
    if (!defect)
        defect = judge_outputs(sweep, fine, text);
    /* In a child of the program the fault is not seen, but for what it makes the program say. */
    bool in_child = strstr(text, "the importer") || strstr(text, "the decoder") ||
                    strstr(text, "out of memory");
    if (!defect && !fired && !fine && !in_child)
        defect = "it failed without a fault";
    ++sweep->runs;
    sweep->fired += fired;
    sweep->fine += fine;
    sweep->failed += !fine;
    uint32_t submits = atomic_load(&sweep->shared->submits_later);
    sweep->submits = submits > sweep->submits ? submits : sweep->submits;
    if (defect && ++sweep->defects <= sweep->shown)
        show(sweep, at, defect, text);
    fflush(stdout);
    free(errors.data);
}

static void stop_without_fault(const char *defect, const char *errors)
{
    printf("no fault: %s\n%s", defect, errors);
    exit(1);
}

/* The run that all others are held against. */
static void run_without_fault(struct sweep *sweep)
{
    empty_cache(sweep);
    int status = run_once(sweep, sweep->faults[0], 0, true);
    struct content errors = sweep_read("../stderr");
    const char *text = errors.data ? errors.data : "";
    for (uint32_t i = 0; i < sweep->output_count; ++i)
        sweep->whole[i] = sweep_read(sweep->outputs[i]);
    sweep->printed = sweep_read("../stdout");
    const char *defect = judge_run(sweep, status, text);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        defect = "it does not even work without a fault";
    if (!defect)
        defect = judge_outputs(sweep, true, text);
    if (defect)
        stop_without_fault(defect, text);
    free(errors.data);
}

/* Counts the calls that can fail, in a run that is set up as those with a fault are. All faults of
   a sweep are at the same kinds of calls. */
static uint32_t count_calls(struct sweep *sweep)
{
    empty_cache(sweep);
    int status = run_once(sweep, sweep->faults[0], 0, sweep->validated);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        stop_without_fault("it does not work without validation", "");
    return atomic_load(&sweep->shared->seen);
}

/* At most so many runs as are asked for: call `offset % stride + 1`, and each stride-th after it.
 */
static void check_some(struct sweep *sweep, uint32_t calls)
{
    const char *value = getenv("WHIT_TEST_OFFSET");
    uint32_t offset = value ? (uint32_t)strtoul(value, NULL, 10) : 0;
    uint32_t stride = (calls + sweep->max_runs - 1) / sweep->max_runs;
    stride = stride ? stride : 1;
    printf("%u calls: each %u-th from the %u-th on; the same again: WHIT_TEST_OFFSET=%u\n", calls,
           stride, offset % stride + 1, offset);
    for (uint32_t at = offset % stride + 1; at <= calls; at += stride) {
        uint32_t turn = (at - 1) / stride + offset / stride;
        check_run(sweep, sweep->faults[turn % sweep->fault_count], at);
    }
}

static void check_each(struct sweep *sweep, uint32_t calls)
{
    printf("%u calls: each %u-th, with each fault\n", calls, sweep->every);
    for (uint32_t at = 1; at <= calls; at += sweep->every)
        for (uint32_t i = 0; i < sweep->fault_count; ++i)
            check_run(sweep, sweep->faults[i], at);
}

static void make_folder(char *folder)
{
    char inner[64];
    if (!mkdtemp(folder))
        sweep_stop(folder);
    snprintf(inner, sizeof inner, "%s/work", folder);
    if (mkdir(inner, 0700) != 0 || chdir(inner) != 0)
        sweep_stop(inner);
}

static void remove_folder(const char *folder)
{
    char command[64];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    if (chdir("/") != 0 || system(command) != 0)
        sweep_stop(folder);
}

static void share(struct sweep *sweep)
{
    sweep->shared_fd = memfd_create("fault", 0);
    if (sweep->shared_fd < 0 || ftruncate(sweep->shared_fd, sizeof *sweep->shared) != 0)
        sweep_stop("memfd_create");
    void *memory =
        mmap(NULL, sizeof *sweep->shared, PROT_READ | PROT_WRITE, MAP_SHARED, sweep->shared_fd, 0);
    if (memory == MAP_FAILED)
        sweep_stop("mmap");
    sweep->shared = memory;
}

static void read_faults(struct sweep *sweep, const char *names)
{
    while (names[0]) {
        size_t length = strcspn(names, ",");
        uint32_t i = 0, count = sizeof faults / sizeof faults[0];
        while (i < count &&
               (strlen(faults[i].name) != length || strncmp(faults[i].name, names, length) != 0))
            ++i;
        if (i == count || sweep->fault_count == FAULTS_MAX ||
            (sweep->fault_count > 0 && faults[i].calls != sweep->faults[0]->calls)) {
            fprintf(stderr, "fault_sweep: the faults `%s`?\n", names);
            exit(2);
        }
        sweep->faults[sweep->fault_count++] = &faults[i];
        names += length + (names[length] == ',');
    }
}

static bool read_option(struct sweep *sweep, const char *name, const char *value)
{
    const struct {
        const char *name, *word; /* sets `to` where the value is this word */
        bool *to;
    } words[] = {
        {"--leaks", "ignore", &sweep->may_leak},   {"--validated", "yes", &sweep->validated},
        {"--cache", "cold", &sweep->cold},         {"--outputs", "reports", &sweep->reports},
        {"--outputs", "figures", &sweep->figures}, {"--stdout", "same", &sweep->same_stdout},
        {"--stdout", "pictures", &sweep->pictures}};
    const struct {
        const char *name;
        uint32_t *to;
    } numbers[] = {{"--runs", &sweep->max_runs},
                   {"--every", &sweep->every},
                   {"--show", &sweep->shown},
                   {"--submits", &sweep->max_submits},
                   {"--step-ms", &sweep->step_ms}};
    for (size_t i = 0; i < sizeof words / sizeof *words; ++i) {
        if (strcmp(name, words[i].name) == 0 && strcmp(value, words[i].word) == 0)
            return *words[i].to = true;
    }
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
        if (strcmp(name, numbers[i].name) == 0) {
            *numbers[i].to = (uint32_t)strtoul(value, NULL, 10);
            return true;
        }
    }
    if (strcmp(name, "--output") == 0 && sweep->output_count < OUTPUTS_MAX)
        sweep->outputs[sweep->output_count++] = value;
    else if (strcmp(name, "--from") == 0)
        snprintf(sweep->shared->from, sizeof sweep->shared->from, "%s", value);
    else if (strcmp(name, "--say") == 0)
        sweep->say = value;
    else
        return false;
    return true;
}

static void read_options(struct sweep *sweep, int argc, char **argv)
{
    int i = 3;
    while (i + 1 < argc && strcmp(argv[i], "--") != 0 && read_option(sweep, argv[i], argv[i + 1]))
        i += 2;
    if (i + 1 >= argc || strcmp(argv[i], "--") != 0) {
        fprintf(stderr, "fault_sweep: what is `%s`?\n", i < argc ? argv[i] : "");
        exit(2);
    }
    sweep->command = argv + i + 1;
}

static void print_sum(const struct sweep *sweep)
{
    printf("%u of %u runs wrong: %u ended in an error, %u went well", sweep->defects, sweep->runs,
           sweep->failed, sweep->fine);
    if (sweep->pictures)
        printf(", %u of these without a picture, as their windows said", sweep->said);
    if (sweep->reports)
        printf(", %u reports were kept", sweep->kept);
    if (sweep->faults[0]->event != FAULT_FAILS)
        printf("; at most %u submissions after the event", sweep->submits);
    if (deadly(sweep->faults[0]) == SIGKILL)
        printf("; %u left an unfinished file for the next run", sweep->left);
    printf("\n");
}

int main(int argc, char **argv)
{
    char folder[] = "/tmp/whit-fault-XXXXXX";
    if (argc < 5) {
        fprintf(stderr, "usage: fault_sweep INJECT FAULTS [options] -- COMMAND...\n");
        return 2;
    }
    struct sweep sweep = {.inject = argv[1],
                          .max_runs = 1 << 20,
                          .max_submits = UINT32_MAX,
                          .step_ms = 1,
                          .shown = SHOWN};
    share(&sweep);
    read_faults(&sweep, argv[2]);
    read_options(&sweep, argc, argv);
    sweep.shared->step_ns = 1000000 * (int64_t)sweep.step_ms;
    make_folder(folder);
    run_without_fault(&sweep);
    uint32_t calls = count_calls(&sweep);
    if (sweep.every)
        check_each(&sweep, calls);
    else
        check_some(&sweep, calls);
    remove_folder(folder);
    print_sum(&sweep);
    /* Few runs may all go well; all of them may not. */
    bool kills = deadly(sweep.faults[0]) == SIGKILL;
    return sweep.defects > 0 || (kills ? sweep.left == 0 : sweep.fired == 0) ||
           (sweep.reports && sweep.kept == 0) ||
           (sweep.every == 1 && !kills && sweep.failed + sweep.said == 0);
}
