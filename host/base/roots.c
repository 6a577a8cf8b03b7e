/* O_PATH is Linux's own. */
#define _GNU_SOURCE
#include "base/roots.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/file.h"

/* Whether `name` starts with a URI scheme (RFC 3986, section 3.1) of at least two letters; a single
   letter is a drive. */
static bool has_scheme(const char *name)
{
    size_t length = 0;
    while (isalnum((unsigned char)name[length]) ||
           (length && name[length] && strchr("+-.", name[length])))
        length++;
    return length > 1 && isalpha((unsigned char)name[0]) && name[length] == ':';
}

char *roots_join(const char *from, const char *relative)
{
    return has_scheme(relative) ? string_copy(relative) : path_beside(from, relative);
}

static bool starts_with(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

/* Whether `path` is a name with a scheme, before which roots_join put no folder. */
static bool is_uri(const struct roots *roots, const char *path)
{
    char *folder = roots->named ? path_folder(roots->named) : NULL;
    bool beside = folder && folder[0] && starts_with(path, folder);
    free(folder);
    return !beside && has_scheme(path);
}

/* The part of `path` below `folder`, both without symbolic links; NULL: it is not below. */
static const char *part_below(const char *folder, const char *path)
{
    size_t length = strlen(folder);
    if (length == 1)
        return path + 1;
    if (!starts_with(path, folder))
        return NULL;
    return path[length] == '/' ? path + length + 1 : path[length] ? NULL : path + length;
}

static const char *find_below(const struct roots *roots, const char *path, const char **folder)
{
    for (uint32_t i = 0; i < roots->count; i++) {
        const char *part = part_below(roots->folders[i], path);
        *folder = roots->folders[i];
        if (part)
            return part;
    }
    return NULL;
}

/* `path` as an absolute path without `.` and `..`, whether it exists or not. */
static char *make_absolute(const char *path)
{
    char *here = path[0] == '/' ? string_copy("") : realpath(".", NULL);
    char *whole = here ? string_format("%s/%s", here, path) : NULL;
    free(here);
    if (!whole)
        return NULL;
    char *to = whole;
    for (const char *at = whole; *at;) {
        const char *start = at + strspn(at, "/");
        size_t length = strcspn(start, "/");
        at = start + length;
        if (length == 2 && start[0] == '.' && start[1] == '.') {
            while (to > whole && *--to != '/')
                continue;
        } else if (length && !(length == 1 && start[0] == '.')) {
            *to++ = '/';
            memmove(to, start, length);
            to += length;
        }
    }
    if (to == whole)
        *to++ = '/';
    *to = 0;
    return whole;
}

/* The absolute path of `path`, with links resolved where it exists (*exists). NULL, with errno: it
   cannot be determined. */
static char *resolve(const char *path, bool *exists)
{
    char *resolved = realpath(path, NULL);
    *exists = resolved != NULL;
    if (resolved || errno == ENOMEM)
        return resolved;
    int reason = errno;
    resolved = make_absolute(path);
    errno = reason;
    return resolved;
}

/* Opens a regular file. It checks the kind first, since opening a device may have effects. Returns
   -1 with errno. */
static int open_regular(int folder_fd, const char *name, bool follow_links, bool read,
                        enum reach *reach)
{
    struct stat info;
    *reach = REACH_MISSING;
    if (fstatat(folder_fd, name, &info, follow_links ? 0 : AT_SYMLINK_NOFOLLOW) != 0)
        return -1;
    *reach = S_ISREG(info.st_mode) ? REACH_FILE : REACH_NOT_A_FILE;
    if (*reach != REACH_FILE || !read)
        return -1;
    /* Non-blocking: else open would wait for ever on a pipe that has taken the file's place. */
    int fd = openat(folder_fd, name,
                    O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC | (follow_links ? 0 : O_NOFOLLOW));
    if (fd < 0)
        *reach = REACH_MISSING;
    return fd;
}

/* Opens a file from the folder down, one name at a time, and follows no link: a folder may have
   become a link since the path was resolved. Returns -1 with errno. */
static int open_below(const char *folder, const char *part, bool read, enum reach *reach)
{
    int at = open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
    const char *slash;
    for (; at >= 0 && (slash = strchr(part, '/')); part = slash + 1) {
        char name[NAME_MAX + 1];
        snprintf(name, sizeof name, "%.*s", (int)(slash - part), part);
        int next = openat(at, name, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        close(at);
        at = next;
    }
    *reach = REACH_MISSING;
    int fd = at < 0 ? -1 : open_regular(at, *part ? part : ".", false, read, reach);
    int reason = errno;
    if (at >= 0)
        close(at);
    errno = reason;
    return fd;
}

static int find(const struct roots *roots, const char *path, bool read, enum reach *reach)
{
    if (!roots || (roots->named && strcmp(path, roots->named) == 0))
        return open_regular(AT_FDCWD, path, true, read, reach);
    *reach = REACH_URI;
    if (is_uri(roots, path))
        return -1;
    bool exists;
    const char *folder, *part;
    char *resolved = resolve(path, &exists);
    int fd = -1, reason = errno;
    *reach = resolved ? REACH_OUTSIDE : REACH_MISSING;
    part = resolved ? find_below(roots, resolved, &folder) : NULL;
    if (part && exists) {
        fd = open_below(folder, part, read, reach);
        reason = errno;
    } else if (part) {
        *reach = REACH_MISSING;
    }
    free(resolved);
    errno = reason;
    return fd;
}

static int follow(const struct roots *roots, const char *path, bool read, enum reach *reach)
{
    int fd = find(roots, path, read, reach), reason = errno;
    if (roots && roots->found && (*reach == REACH_FILE || *reach == REACH_MISSING))
        roots->found(roots->found_user, path);
    errno = reason;
    return fd;
}

int roots_open(const struct roots *roots, const char *path, enum reach *reach)
{
    return follow(roots, path, true, reach);
}

enum reach roots_reach(const struct roots *roots, const char *path)
{
    enum reach reach;
    (void)follow(roots, path, false, &reach);
    return reach;
}

/* Writes the option that would allow `folder`, quoted for a shell. A folder whose name has a
   quotation mark is left for the user to write: the name may be crafted to be pasted. */
static void write_hint(const struct roots *roots, const char *folder, char *to, size_t bytes)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "/._-+,@%";
    bool quoted = folder[strspn(folder, plain)] != 0, known = !strchr(folder, '\'');
    const char *mark = quoted && known ? "'" : "";
    const char *why = roots->is_input ? "what standard input names has no folder"
                                      : "it lies outside of the folder of what is loaded";
    static const char text[] = "%s; --allow-path %s%s%s lets whit read it";
    if ((size_t)snprintf(to, bytes, text, why, mark, known ? folder : "FOLDER", mark) >= bytes)
        snprintf(to, bytes, text, why, "", "FOLDER", "");
}

static const char *refuse(struct roots *roots, const char *path)
{
    bool exists;
    char *folder = resolve(path, &exists);
    char *slash = folder ? strrchr(folder, '/') : NULL;
    if (slash)
        slash[slash == folder] = 0;
    write_hint(roots, folder ? folder : "FOLDER", roots->reason, sizeof roots->reason);
    roots->refused_count++;
    if (roots->refused_folder)
        free(folder);
    else
        roots->refused_folder = folder;
    return roots->reason;
}

const char *reach_words(enum reach reach)
{
    switch (reach) {
    case REACH_FILE:
        return NULL;
    case REACH_OUTSIDE:
        return "it lies outside of the folder of what is loaded";
    case REACH_URI:
        return "it is a URI; whit reads files only";
    case REACH_NOT_A_FILE:
        return "it is a folder, a device or a pipe, not a file";
    case REACH_MISSING:
    default:
        return errno == ENOENT || errno == ENOTDIR ? "there is no such file" : strerror(errno);
    }
}

const char *roots_why_not(struct roots *roots, const char *path)
{
    enum reach reach = roots_reach(roots, path);
    return reach == REACH_OUTSIDE ? refuse(roots, path) : reach_words(reach);
}

static whit_result add_folder(struct roots *roots, const char *folder)
{
    char *resolved = realpath(*folder ? folder : ".", NULL);
    if (!resolved)
        return errno == ENOMEM ? WHIT_ERROR_MEMORY : WHIT_ERROR_INPUT;
    if (ARRAY_PUSH(roots->folders, roots->count, roots->capacity, resolved))
        return WHIT_OK;
    free(resolved);
    return WHIT_ERROR_MEMORY;
}

whit_result roots_init(struct roots *roots, const char *named)
{
    *roots = (struct roots){.named = string_copy(named)};
    char *folder = path_folder(named);
    whit_result result = roots->named && folder ? add_folder(roots, folder) : WHIT_ERROR_MEMORY;
    free(folder);
    return result == WHIT_ERROR_MEMORY ? result : WHIT_OK;
}

whit_result roots_init_input(struct roots *roots, const char *named)
{
    *roots = (struct roots){.named = string_copy(named), .is_input = true};
    return roots->named ? WHIT_OK : WHIT_ERROR_MEMORY;
}

bool roots_is_input(const struct roots *roots, const char *path)
{
    return roots && roots->is_input && strcmp(path, roots->named) == 0;
}

whit_result roots_allow(const whit_log *log, struct roots *roots, const char *folder)
{
    struct stat info;
    whit_result result = WHIT_ERROR_INPUT;
    if (stat(folder, &info) == 0) { /* a folder "" is none, not the current one */
        errno = ENOTDIR;
        if (S_ISDIR(info.st_mode))
            result = add_folder(roots, folder);
    }
    if (result != WHIT_OK)
        log_error(log, "%s: cannot be allowed: %s", folder, strerror(errno));
    return result;
}

void roots_finish(struct roots *roots)
{
    for (uint32_t i = 0; i < roots->count; i++)
        free(roots->folders[i]);
    free(roots->folders);
    free(roots->named);
    free(roots->refused_folder);
    *roots = (struct roots){0};
}
