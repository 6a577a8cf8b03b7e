/* Names in foreign files: whatever they are, and through whatever links, nothing is opened but
   regular files below the folder of the model, or below one that was allowed. */
#include "fuzz.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/roots.h"
#include "load/picture.h"

enum { PATH_BYTES = 4096, NAME_BYTES = 600 };

static char base[PATH_BYTES], model[PATH_BYTES];
static struct roots roots;

static const char *at(const char *name)
{
    static char path[PATH_BYTES];
    snprintf(path, sizeof path, "%.120s/%.120s", base, name);
    return path;
}

static void make_links(void)
{
    static const struct {
        const char *name, *target;
    } links[] = {
        {"in/out", "../out"}, {"in/leak", "../out/secret"}, {"in/good", "sub/a.png"},
        {"in/self", "."},     {"in/loop", "loop"},          {"in/sub/up", ".."},
        {"in/to", "../ok"},   {"in/null", "/dev/null"},     {"in/proc", "/proc/self/root"},
    };
    for (size_t i = 0; i < sizeof links / sizeof *links; i++)
        fuzz_check(symlink(links[i].target, at(links[i].name)) == 0, "no link");
    fuzz_check(mkfifo(at("in/pipe"), 0600) == 0, "no pipe");
}

static void prepare(void)
{
    static const char *const folders[] = {"in", "in/sub", "out", "ok"};
    static const char *const names[] = {"in/m.obj", "in/sub/a.png", "out/secret",
                                        "ok/b.png", "secret",       "in/B.PNG"};
    fuzz_check(realpath(fuzz_folder(), base), "no folder");
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        fuzz_check(mkdir(at(folders[i]), 0700) == 0, "no folder");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        int fd = open(at(names[i]), O_CREAT | O_WRONLY, 0600);
        fuzz_check(fd >= 0 && close(fd) == 0, "no file");
    }
    make_links();
    strcpy(model, at("in/m.obj"));
    fuzz_check(roots_init(&roots, model) == WHIT_OK, "no roots");
    fuzz_check(roots_allow(&fuzz_log, &roots, at("ok")) == WHIT_OK, "no roots");
}

static bool is_below(const char *path, const char *folder)
{
    size_t length = strlen(at(folder));
    return strncmp(path, at(folder), length) == 0 && path[length] == '/';
}

static void check_opened(int fd)
{
    char link[64], path[PATH_BYTES];
    struct stat info;
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t length = readlink(link, path, sizeof path - 1);
    fuzz_check(length > 0 && fstat(fd, &info) == 0, "what was opened?");
    path[length] = 0;
    fuzz_check(S_ISREG(info.st_mode), "%s is no file", path);
    fuzz_check(is_below(path, "in") || is_below(path, "ok"), "%s was opened", path);
}

static enum reach try_to_open(const char *path)
{
    enum reach reach, looked = roots_reach(&roots, path);
    int fd = roots_open(&roots, path, &reach);
    fuzz_check(reach == looked && (fd >= 0) == (reach == REACH_FILE), "%d, %d: `%s`", (int)reach,
               (int)looked, path);
    fuzz_check((roots_why_not(&roots, path) == NULL) == (fd >= 0), "a reason with a file");
    if (fd < 0)
        return reach;
    check_opened(fd);
    close(fd);
    return reach;
}

static void run(const uint8_t *data, size_t size_bytes)
{
    char name[NAME_BYTES + 1];
    size_t length = size_bytes < NAME_BYTES ? size_bytes : NAME_BYTES;
    memcpy(name, data, length);
    name[length] = 0;
    char *joined = roots_join(model, name), *found = joined ? picture_find(&roots, joined) : NULL;
    fuzz_check(joined && found, "out of memory");
    if (try_to_open(joined) == REACH_FILE)
        fuzz_check(strcmp(joined, found) == 0, "`%s` became `%s`", joined, found);
    try_to_open(found);
    try_to_open(name); /* an option's, an absolute one */
    free(joined);
    free(found);
}

const struct fuzz_target fuzz_target = {
    .run = run, .prepare = prepare, .memory_bytes = UINT64_C(1) << 20};
