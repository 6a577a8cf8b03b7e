/* Runs a command over and over, and makes another one of its calls fail each time:
       fault_sweep INJECT KIND [options] -- COMMAND...
   KIND is alloc, write, or the number of a VkResult. The command works in a folder of its own,
   where its outputs hold something old. Of each run it is checked that
   - it exits, with the code that is expected, and with one line of error that says why;
   - each output is the old one, or the whole new one; no other file is there;
   - all that the program itself allocated was given back;
   - where it went well nevertheless, the outputs are those of a run without a fault; the viewer
     shows the pictures of such a run, or says why not (--stdout pictures).
   How many runs there were, how many failed as they should and how many went well is printed. */
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fault.h"

enum { OUTPUTS_MOST = 4, TEXT_MOST = 1 << 16, RUN_LIMIT_S = 120, SHOWN = 8 };
static const char old_text[] = "old\n";

struct content {
    char *data;
    size_t bytes;
};

struct sweep {
    struct fault_shared *shared;
    int shared_fd;
    const char *inject, *say;
    const char *outputs[OUTPUTS_MOST];
    struct content whole[OUTPUTS_MOST]; /* of the run without a fault */
    uint32_t output_count;
    bool same_stdout; /* what is printed is an output too */
    bool pictures;    /* it prints states of the viewer: see judge_states */
    bool may_leak;
    struct content printed;
    int expect;
    uint32_t every, shown;
    char **command;
    uint32_t runs, failed, fine, said, defects; /* said: fine, but a picture is missing */
};

static void stop(const char *what)
{
    fprintf(stderr, "fault_sweep: %s: %s\n", what, strerror(errno));
    exit(2);
}

static struct content read_whole(const char *path)
{
    struct content content = {NULL, 0};
    FILE *stream = fopen(path, "rb");
    size_t capacity = 0, got = 1;
    while (stream && got > 0) {
        if (content.bytes + TEXT_MOST > capacity)
            content.data = realloc(content.data, capacity += 4 * TEXT_MOST);
        if (!content.data)
            stop(path);
        got = fread(content.data + content.bytes, 1, TEXT_MOST - 1, stream);
        content.bytes += got;
        content.data[content.bytes] = '\0';
    }
    if (stream)
        fclose(stream);
    return content;
}

static bool same(const struct content *a, const struct content *b)
{
    return a->data && b->data && a->bytes == b->bytes && memcmp(a->data, b->data, a->bytes) == 0;
}

static void lay_out(const struct sweep *sweep)
{
    for (uint32_t i = 0; i < sweep->output_count; ++i) {
        FILE *stream = fopen(sweep->outputs[i], "wb");
        if (!stream || fputs(old_text, stream) == EOF || fclose(stream) != 0)
            stop(sweep->outputs[i]);
    }
}

static void run_child(const struct sweep *sweep)
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
    alarm(RUN_LIMIT_S);
    execvp(sweep->command[0], sweep->command);
    _exit(126);
}

/* What waitpid says. */
static int run_once(struct sweep *sweep, uint32_t at)
{
    int status = 0;
    struct fault_shared *shared = sweep->shared;
    lay_out(sweep);
    shared->at = at;
    atomic_store(&shared->seen, 0);
    atomic_store(&shared->fired, 0);
    shared->live = -1;
    shared->what[0] = '\0';
    pid_t pid = fork();
    if (pid < 0)
        stop("fork");
    if (pid == 0)
        run_child(sweep);
    if (waitpid(pid, &status, 0) != pid)
        stop("waitpid");
    return status;
}

static bool is_output(const struct sweep *sweep, const char *name)
{
    for (uint32_t i = 0; i < sweep->output_count; ++i)
        if (strcmp(sweep->outputs[i], name) == 0)
            return true;
    return false;
}

/* The name of a file that should not be there; removes it. */
static bool find_stray(const struct sweep *sweep, char *name, size_t name_bytes)
{
    bool found = false;
    DIR *folder = opendir(".");
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0 ||
            is_output(sweep, entry->d_name))
            continue;
        snprintf(name, name_bytes, "%s", entry->d_name);
        unlink(entry->d_name);
        found = true;
    }
    if (folder)
        closedir(folder);
    return found;
}

static uint32_t count_errors(const char *text)
{
    uint32_t count = 0;
    for (const char *at = text; (at = strstr(at, "whit: error: ")); ++at)
        ++count;
    return count;
}

/* What is wrong with a run, NULL: nothing. */
static const char *judge(const struct sweep *sweep, int status, const char *errors)
{
    static char text[512];
    char stray[256];
    const struct fault_shared *shared = sweep->shared;
    bool fine = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (find_stray(sweep, stray, sizeof stray)) {
        snprintf(text, sizeof text, "the file %s is left", stray);
        return text;
    }
    if (WIFSIGNALED(status)) {
        snprintf(text, sizeof text, "it died of signal %d", WTERMSIG(status));
        return text;
    }
    if (!fine && WEXITSTATUS(status) != sweep->expect) {
        snprintf(text, sizeof text, "exit code %d", WEXITSTATUS(status));
        return text;
    }
    uint32_t lines = count_errors(errors);
    if (lines != (fine ? 0 : 1) || (!fine && sweep->say && !strcasestr(errors, sweep->say))) {
        snprintf(text, sizeof text, "%u errors, exit code %d", lines, WEXITSTATUS(status));
        return text;
    }
    if (shared->live != 0 && !sweep->may_leak) {
        snprintf(text, sizeof text, "%lld blocks were not given back", (long long)shared->live);
        return text;
    }
    return NULL;
}

/* The text of the first `"name":"text"` of a line; NULL: it has none. */
static const char *field(const char *line, const char *name, size_t *length)
{
    char key[32];
    snprintf(key, sizeof key, "\"%s\":\"", name);
    const char *end = line + strcspn(line, "\n"), *at = strstr(line, key);
    if (!at || at >= end)
        return NULL;
    at += strlen(key);
    *length = strcspn(at, "\"\n");
    return at;
}

static bool same_field(const char *a, const char *b, const char *name)
{
    size_t a_length = 0, b_length = 0;
    const char *a_text = field(a, name, &a_length), *b_text = field(b, name, &b_length);
    return a_text && b_text && a_length == b_length && memcmp(a_text, b_text, a_length) == 0;
}

/* Something is said in the window that is not said without a fault. */
static bool is_said(const char *whole, const char *now, const char *name)
{
    size_t length = 0;
    return field(now, name, &length) && length > 0 && !same_field(whole, now, name);
}

/* Each state has the picture that it has without a fault, or the window says why not. */
static const char *judge_states(const char *whole, const char *now, bool *said)
{
    *said = false;
    for (; whole && now && whole[0]; whole = strchr(whole, '\n'), now = strchr(now, '\n')) {
        whole += whole[0] == '\n';
        now += now[0] == '\n';
        bool shown = same_field(whole, now, "ids") && same_field(whole, now, "pixels");
        if (whole[0] && !now[0])
            return "a state is missing";
        if (whole[0] && !shown && !is_said(whole, now, "error") && !is_said(whole, now, "toast"))
            return "it shows something else and does not say why";
        *said |= whole[0] && !shown;
    }
    return NULL;
}

static const char *judge_outputs(struct sweep *sweep, bool fine)
{
    static char text[512];
    struct content old = {(char *)(uintptr_t)old_text, sizeof old_text - 1};
    text[0] = '\0';
    for (uint32_t i = 0; i < sweep->output_count; ++i) {
        struct content now = read_whole(sweep->outputs[i]);
        bool whole = same(&now, &sweep->whole[i]);
        if (!whole && (fine || !same(&now, &old)))
            snprintf(text, sizeof text, "%s is neither the old one nor whole", sweep->outputs[i]);
        free(now.data);
    }
    struct content printed = read_whole("../stdout");
    if (fine && sweep->same_stdout && !same(&printed, &sweep->printed))
        snprintf(text, sizeof text, "it printed something else");
    bool said = false;
    const char *states =
        fine && sweep->pictures ? judge_states(sweep->printed.data, printed.data, &said) : NULL;
    if (states)
        snprintf(text, sizeof text, "%s: %.400s", states, printed.data);
    sweep->said += said;
    free(printed.data);
    return text[0] ? text : NULL;
}

static void show(const struct fault_shared *shared, uint32_t at, const char *defect,
                 const char *errors)
{
    printf("call %u, %s from", at, shared->what);
    for (int i = 0; i < FAULT_CALLERS && shared->callers[i]; ++i)
        printf(" %#llx", (unsigned long long)shared->callers[i]);
    printf(": %s\n%.600s", defect, errors);
}

static void check_run(struct sweep *sweep, uint32_t at)
{
    int status = run_once(sweep, at);
    struct content errors = read_whole("../stderr");
    const struct fault_shared *shared = sweep->shared;
    bool fired = atomic_load(&sweep->shared->fired) > 0;
    bool fine = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    const char *text = errors.data ? errors.data : "";
    const char *defect = judge(sweep, status, text);
    if (!defect)
        defect = judge_outputs(sweep, fine);
    if (!defect && !fired && !fine)
        defect = "it failed without a fault";
    ++sweep->runs;
    sweep->fine += fine;
    sweep->failed += !fine;
    if (defect && ++sweep->defects <= sweep->shown)
        show(shared, at, defect, text);
    fflush(stdout);
    free(errors.data);
}

/* The run that all others are held against. */
static void run_without_fault(struct sweep *sweep)
{
    int status = run_once(sweep, 0);
    struct content errors = read_whole("../stderr");
    for (uint32_t i = 0; i < sweep->output_count; ++i)
        sweep->whole[i] = read_whole(sweep->outputs[i]);
    sweep->printed = read_whole("../stdout");
    const char *defect = judge(sweep, status, errors.data ? errors.data : "");
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        defect = "it does not even work without a fault";
    if (!defect)
        defect = judge_outputs(sweep, true);
    if (defect) {
        printf("no fault: %s\n%s", defect, errors.data ? errors.data : "");
        exit(1);
    }
    free(errors.data);
}

static void make_folder(char *folder)
{
    char inner[64];
    if (!mkdtemp(folder))
        stop(folder);
    snprintf(inner, sizeof inner, "%s/work", folder);
    if (mkdir(inner, 0700) != 0 || chdir(inner) != 0)
        stop(inner);
}

static void remove_folder(const struct sweep *sweep, const char *folder)
{
    static const char *const names[] = {"stdout", "stderr"};
    for (uint32_t i = 0; i < sweep->output_count; ++i)
        unlink(sweep->outputs[i]);
    for (int i = 0; i < 2; ++i) {
        char path[64];
        snprintf(path, sizeof path, "../%s", names[i]);
        unlink(path);
    }
    if (chdir("/") == 0) {
        char inner[64];
        snprintf(inner, sizeof inner, "%s/work", folder);
        rmdir(inner);
        rmdir(folder);
    }
}

static void share(struct sweep *sweep)
{
    sweep->shared_fd = memfd_create("fault", 0);
    if (sweep->shared_fd < 0 || ftruncate(sweep->shared_fd, sizeof *sweep->shared) != 0)
        stop("memfd_create");
    void *memory =
        mmap(NULL, sizeof *sweep->shared, PROT_READ | PROT_WRITE, MAP_SHARED, sweep->shared_fd, 0);
    if (memory == MAP_FAILED)
        stop("mmap");
    sweep->shared = memory;
}

static void read_kind(struct sweep *sweep, const char *kind)
{
    struct fault_shared *shared = sweep->shared;
    shared->kind = strcmp(kind, "alloc") == 0   ? FAULT_ALLOC
                   : strcmp(kind, "write") == 0 ? FAULT_WRITE
                                                : FAULT_VULKAN;
    shared->code = atoi(kind);
}

static void read_options(struct sweep *sweep, int argc, char **argv)
{
    int i = 3;
    for (; i + 1 < argc && strcmp(argv[i], "--") != 0; i += 2) {
        const char *name = argv[i], *value = argv[i + 1];
        if (strcmp(name, "--output") == 0 && sweep->output_count < OUTPUTS_MOST)
            sweep->outputs[sweep->output_count++] = value;
        else if (strcmp(name, "--from") == 0)
            snprintf(sweep->shared->from, sizeof sweep->shared->from, "%s", value);
        else if (strcmp(name, "--expect") == 0)
            sweep->expect = atoi(value);
        else if (strcmp(name, "--say") == 0)
            sweep->say = value;
        else if (strcmp(name, "--every") == 0)
            sweep->every = (uint32_t)atoi(value);
        else if (strcmp(name, "--show") == 0)
            sweep->shown = (uint32_t)atoi(value);
        else if (strcmp(name, "--leaks") == 0)
            sweep->may_leak = strcmp(value, "ignore") == 0;
        else if (strcmp(name, "--stdout") == 0) {
            sweep->same_stdout = strcmp(value, "same") == 0;
            sweep->pictures = strcmp(value, "pictures") == 0;
        } else
            break;
    }
    if (i + 1 >= argc || strcmp(argv[i], "--") != 0) {
        fprintf(stderr, "fault_sweep: what is `%s`?\n", i < argc ? argv[i] : "");
        exit(2);
    }
    sweep->command = argv + i + 1;
}

int main(int argc, char **argv)
{
    char folder[] = "/tmp/whit-fault-XXXXXX";
    if (argc < 5) {
        fprintf(stderr, "usage: fault_sweep INJECT KIND [options] -- COMMAND...\n");
        return 2;
    }
    struct sweep sweep = {.inject = argv[1], .expect = 2, .every = 1, .shown = SHOWN};
    share(&sweep);
    read_kind(&sweep, argv[2]);
    read_options(&sweep, argc, argv);
    make_folder(folder);
    run_without_fault(&sweep);
    uint32_t calls = atomic_load(&sweep.shared->seen);
    for (uint32_t at = 1; at <= calls; at += sweep.every)
        check_run(&sweep, at);
    remove_folder(&sweep, folder);
    printf("%u of %u runs wrong; %u calls, one in %u made to fail: %u ended in an error, %u went "
           "well",
           sweep.defects, sweep.runs, calls, sweep.every, sweep.failed, sweep.fine);
    if (sweep.pictures)
        printf(", %u of these without a picture, as their windows said", sweep.said);
    printf("\n");
    return sweep.defects > 0 || sweep.failed + sweep.said == 0;
}
