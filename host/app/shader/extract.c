#include "app/shader/extract.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/render/recipe.h"
#include "base/file.h"
#include "base/path.h"
#include "base/text.h"

enum { PATH_BYTES = 4096 };

/* Gives the folder's path without trailing slashes; false: it has no name. */
static bool name_folder(const char *picture, const char *into, char folder[PATH_BYTES])
{
    const char *name = path_name(picture), *dot = strrchr(name, '.');
    int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
    int written = into ? snprintf(folder, PATH_BYTES, "%s", into)
                       : snprintf(folder, PATH_BYTES, "%.*s", length, name);
    size_t bytes = written > 0 && written < PATH_BYTES / 2 ? (size_t)written : 0;
    while (bytes > 1 && folder[bytes - 1] == '/')
        folder[--bytes] = 0;
    if (!bytes)
        cli_error("%s: no folder can be called so", into ? into : picture);
    return bytes;
}

/* Makes a hidden folder beside `folder`, with the permissions of any new folder. */
static bool make_beside(const char *folder, char beside[PATH_BYTES])
{
    const char *name = path_name(folder);
    snprintf(beside, PATH_BYTES, "%.*s.%.200s.XXXXXX", (int)(name - folder), folder, name);
    mode_t mask = umask(0);
    umask(mask);
    if (mkdtemp(beside) && chmod(beside, 0777 & ~mask) == 0)
        return true;
    return CLI_FAIL(false, "%s: cannot be made: %s", folder, strerror(errno));
}

/* Joins `root` and the first `bytes` of `name` into `path`; both are short enough to fit. */
static void join(char path[PATH_BYTES], const char *root, const char *name, size_t bytes)
{
    size_t used = strlen(root);
    memcpy(path, root, used);
    path[used] = '/';
    memcpy(path + used + 1, name, bytes);
    path[used + 1 + bytes] = 0;
}

/* Makes the folders on the way to file `name` below `root`; `name` was checked not to leave it. */
static bool make_folders(const char *root, const char *name, char path[PATH_BYTES])
{
    for (const char *slash = strchr(name, '/'); slash; slash = strchr(slash + 1, '/')) {
        join(path, root, name, (size_t)(slash - name));
        if (mkdir(path, 0777) != 0 && errno != EEXIST)
            return CLI_FAIL(false, "%s: cannot be made: %s", path, strerror(errno));
    }
    join(path, root, name, strlen(name));
    return true;
}

static bool write_files(const char *root, const whit_shader_file *files, uint32_t count)
{
    char path[PATH_BYTES];
    for (uint32_t i = 0; i < count; ++i) {
        if (!make_folders(root, files[i].name, path) ||
            file_write_whole(&cli_log, path, files[i].text, files[i].bytes) != WHIT_OK)
            return false;
    }
    return true;
}

/* Removes what write_files may have made, files before their folders. */
static void remove_files(const char *root, const whit_shader_file *files, uint32_t count)
{
    char path[PATH_BYTES];
    for (uint32_t i = 0; i < count; ++i) {
        join(path, root, files[i].name, strlen(files[i].name));
        unlink(path);
    }
    for (uint32_t i = 0; i < count; ++i) {
        join(path, root, files[i].name, strlen(files[i].name));
        while (strlen(path) > strlen(root)) {
            *strrchr(path, '/') = 0;
            if (rmdir(path) != 0)
                break;
        }
    }
    rmdir(root);
}

static bool put_in_place(const char *beside, const char *folder)
{
    if (rename(beside, folder) == 0)
        return true;
    bool there = errno == ENOTEMPTY || errno == EEXIST || errno == ENOTDIR || errno == EBUSY;
    return CLI_FAIL(false, "%s: %s%s", folder, there ? "is there already" : "cannot be made: ",
                    there ? ", and nothing is written over: `--into FOLDER` names another"
                          : strerror(errno));
}

static int write_folder(const char *folder, const whit_shader_file *files, uint32_t count)
{
    char beside[PATH_BYTES];
    if (!make_beside(folder, beside))
        return EXIT_USAGE;
    if (!write_files(beside, files, count) || !put_in_place(beside, folder)) {
        remove_files(beside, files, count);
        return EXIT_USAGE;
    }
    for (uint32_t i = 0; i < count; ++i)
        printf("%s/%s\n", cli_shown(folder), cli_shown(files[i].name));
    return cli_finish_stdout(EXIT_FINE);
}

/* Gives the files that the picture carries, for whit_memory_destroy. */
static whit_result unpack(const char *picture, const whit_load_params *params,
                          whit_shader_file **files, uint32_t *count)
{
    whit_text *texts;
    uint32_t text_count;
    whit_result result = whit_image_load_texts(picture, params, &cli_log, &texts, &text_count);
    if (result != WHIT_OK)
        return result;
    const char *packed = text_value(texts, text_count, WHIT_SHADER_KEY);
    if (packed)
        result = whit_shader_unpack(packed, picture, &cli_log, files, count);
    else
        result = CLI_FAIL(WHIT_ERROR_INPUT, "%s: a picture without `" WHIT_SHADER_KEY "` in it",
                          picture);
    whit_memory_destroy(texts);
    return result;
}

int extract_run(const char *picture, const char *into, const whit_load_params *params)
{
    char folder[PATH_BYTES];
    whit_shader_file *files;
    uint32_t count;
    if (!name_folder(picture, into, folder))
        return EXIT_USAGE;
    whit_result result = unpack(picture, params, &files, &count);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    int status = write_folder(folder, files, count);
    whit_memory_destroy(files);
    return status;
}
