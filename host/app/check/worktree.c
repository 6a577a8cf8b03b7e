/* pipe2 is Linux's own. */
#define _GNU_SOURCE
#include "app/check/worktree.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/cli.h"
#include "base/array.h"

/* The worktree's folder inside of `holder`. */
#define TREE "/tree"

/* Takes variables that git sets for its hooks (`git rev-parse --local-env-vars`) from the
   environment. With them `git worktree add` would write into the index and the repository of the
   commit that is being made. */
static void leave_hook(void)
{
    static const char *const names[] = {"GIT_ALTERNATE_OBJECT_DIRECTORIES",
                                        "GIT_COMMON_DIR",
                                        "GIT_CONFIG",
                                        "GIT_CONFIG_COUNT",
                                        "GIT_CONFIG_PARAMETERS",
                                        "GIT_DIR",
                                        "GIT_GRAFT_FILE",
                                        "GIT_IMPLICIT_WORK_TREE",
                                        "GIT_INDEX_FILE",
                                        "GIT_INTERNAL_SUPER_PREFIX",
                                        "GIT_NO_REPLACE_OBJECTS",
                                        "GIT_OBJECT_DIRECTORY",
                                        "GIT_PREFIX",
                                        "GIT_REPLACE_REF_BASE",
                                        "GIT_SHALLOW_FILE",
                                        "GIT_WORK_TREE"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        unsetenv(names[i]);
}

/* Starts the program `words` with `in` as its standard input and `out` as its output; -1:
   /dev/null. Returns 0 or an errno. */
static int start(const char *const *words, int in, int out, pid_t *pid)
{
    posix_spawn_file_actions_t actions;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed)
        return failed;
    const int from[] = {in, out, out};
    for (int i = 0; !failed && i < 3; ++i)
        failed = from[i] < 0 ? posix_spawn_file_actions_addopen(&actions, i, "/dev/null", O_RDWR, 0)
                             : posix_spawn_file_actions_adddup2(&actions, from[i], i);
    if (!failed)
        failed = posix_spawnp(pid, words[0], &actions, NULL, (char *const *)words, environ);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

/* Reads the first line of a program's output; the rest is read and dropped. */
static void read_line(int from, char *text, size_t bytes)
{
    char buffer[512];
    size_t used = 0;
    ssize_t got;
    while ((got = read(from, buffer, sizeof buffer)) > 0 || (got < 0 && errno == EINTR)) {
        for (ssize_t i = 0; i < got && used + 1 < bytes; ++i)
            text[used++] = buffer[i];
    }
    text[used] = 0;
    text[strcspn(text, "\n")] = 0;
}

/* Sends a number to the shell that removes the worktree in the end. If that is gone, nobody needs
   to be told. */
static void tell_keeper(int keeper, long number)
{
    if (keeper >= 0)
        (void)!dprintf(keeper, "%ld\n", number);
}

/* Runs git to its end and gives the first line of its output. False: it failed, and the line says
   why. `keeper`: the worktree's, which is told the process and its end; or -1. */
static bool run_git(const char *const *words, int keeper, char *line, size_t bytes)
{
    int ends[2], status = -1;
    pid_t pid;
    line[0] = 0;
    if (pipe2(ends, O_CLOEXEC) != 0) {
        snprintf(line, bytes, "%s", strerror(errno));
        return false;
    }
    int failed = start(words, -1, ends[1], &pid);
    close(ends[1]);
    if (failed) {
        snprintf(line, bytes, "%s: %s", words[0], strerror(failed));
    } else {
        tell_keeper(keeper, pid);
        read_line(ends[0], line, bytes);
    }
    close(ends[0]);
    while (!failed && waitpid(pid, &status, 0) < 0 && errno == EINTR)
        ;
    tell_keeper(keeper, 0);
    return !failed && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* Starts a shell that waits until this process ends or closes `line`, and then removes the
   worktree. This also works after a second signal or a crash. If this process ended while git still
   made the worktree, the shell waits for git, up to a minute: else git would go on writing there,
   and its lock would keep the worktree on the list. */
static bool start_keeper(struct worktree *tree, const char *folder)
{
    static const char script[] =
        "trap '' INT TERM HUP QUIT; "
        "if read -r git && ! read -r ended; then i=0; "
        "while [ $i -lt 1200 ] && kill -0 \"$git\"; do sleep 0.05; i=$((i + 1)); done; fi; "
        "read -r end; git -C \"$1\" worktree remove --force --force \"$2" TREE
        "\"; rm -rf \"$2\"; git -C \"$1\" worktree prune";
    const char *const words[] = {"sh", "-c", script, "sh", folder, tree->holder, NULL};
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return false;
    int failed = start(words, ends[0], -1, &tree->keeper);
    close(ends[0]);
    if (failed) {
        close(ends[1]);
        tree->keeper = 0;
        errno = failed;
        return false;
    }
    tree->line = ends[1];
    return true;
}

static whit_result refuse(const char *revision, const char *why)
{
    if (cli_cancel) /* git was interrupted as well */
        return WHIT_ERROR_CANCELLED;
    return CLI_FAIL(WHIT_ERROR_INPUT, "--base %s: %s", cli_shown(revision), cli_shown(why));
}

static bool make_holder(struct worktree *tree)
{
    const char *place = getenv("TMPDIR");
    tree->holder = string_format("%s/whit-base-XXXXXX", place && place[0] ? place : "/tmp");
    if (tree->holder && mkdtemp(tree->holder))
        return true;
    cli_error("--base: %s: no folder can be made there: %s",
              cli_shown(tree->holder ? tree->holder : ""), strerror(errno));
    free(tree->holder);
    tree->holder = NULL;
    return false;
}

/* The folder's path in its repository, such as "tests/check/"; "" at the top. */
static bool find_prefix(const char *folder, char *line, size_t bytes)
{
    const char *const words[] = {"git",           "-C", folder[0] ? folder : ".", "rev-parse",
                                 "--show-prefix", NULL};
    return run_git(words, -1, line, bytes);
}

char *worktree_folder(const struct worktree *tree, const char *folder)
{
    char line[1024];
    char *path = NULL;
    if (!find_prefix(folder, line, sizeof line))
        (void)refuse(tree->revision, line);
    else if (!(path = string_format("%s" TREE "/%s", tree->holder, line)))
        cli_error("out of memory");
    return path;
}

const char *worktree_name(const struct worktree *tree, const char *path)
{
    size_t length = strlen(tree->holder) + strlen(TREE "/");
    if (strncmp(path, tree->holder, strlen(tree->holder)) != 0)
        return path;
    return path + length + strspn(path + length, "/");
}

whit_result worktree_add(struct worktree *tree, const char *folder, const char *revision)
{
    char line[1024];
    *tree = (struct worktree){.revision = revision, .line = -1};
    folder = folder[0] ? folder : ".";
    if (revision[0] == '-' || !revision[0])
        return refuse(revision, "no revision is called that");
    leave_hook();
    if (!find_prefix(folder, line, sizeof line))
        return refuse(revision, line);
    if (!make_holder(tree))
        return WHIT_ERROR_OUTPUT;
    char *path = string_format("%s" TREE, tree->holder);
    if (!path)
        return cli_no_memory();
    const char *const add[] = {"git",     "-C",       folder, "worktree", "add",
                               "--quiet", "--detach", path,   revision,   NULL};
    whit_result result = WHIT_OK;
    if (!start_keeper(tree, folder))
        result = refuse(revision, strerror(errno));
    else if (!run_git(add, tree->line, line, sizeof line))
        result = refuse(revision, line[0] ? line : "git has failed");
    free(path);
    return result;
}

void worktree_remove(struct worktree *tree)
{
    if (tree->keeper) {
        close(tree->line);
        while (waitpid(tree->keeper, NULL, 0) < 0 && errno == EINTR)
            ;
    } else if (tree->holder) {
        rmdir(tree->holder);
    }
    free(tree->holder);
    *tree = (struct worktree){.line = -1};
}
