#include "app/trace/ray_file.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "app/cli.h"

_Static_assert(sizeof(whit_ray) == 32 && sizeof(whit_hit) == 32, "records on disk");

static whit_result refuse_size(const struct ray_file *file, uint64_t size_bytes)
{
    cli_error("%s: %llu bytes are no whole number of 32-byte rays: the last one, at byte %llu, "
              "is cut short",
              file->path, (unsigned long long)size_bytes,
              (unsigned long long)(size_bytes - size_bytes % sizeof(whit_ray)));
    return WHIT_ERROR_INPUT;
}

whit_result ray_file_open(const char *path, struct ray_file *file)
{
    struct stat info;
    errno = 0;
    *file = (struct ray_file){.path = path, .stream = fopen(path, "rb")};
    if (!file->stream || fstat(fileno(file->stream), &info) != 0)
        return CLI_FAIL(WHIT_ERROR_INPUT, "%s: cannot read: %s", path, strerror(errno));
    if (S_ISDIR(info.st_mode))
        return CLI_FAIL(WHIT_ERROR_INPUT, "%s: cannot read: %s", path, strerror(EISDIR));
    if (!S_ISREG(info.st_mode))
        return WHIT_OK;
    if ((uint64_t)info.st_size % sizeof(whit_ray) != 0)
        return refuse_size(file, (uint64_t)info.st_size);
    file->ray_count = (uint64_t)info.st_size / sizeof(whit_ray);
    return WHIT_OK;
}

whit_result ray_file_read(struct ray_file *file, whit_ray *rays, uint64_t max, uint64_t *count)
{
    errno = 0;
    *count = 0;
    size_t bytes = fread(rays, 1, (size_t)max * sizeof *rays, file->stream);
    if (ferror(file->stream))
        return CLI_FAIL(WHIT_ERROR_INPUT, "%s: cannot read: %s", file->path,
                        strerror(errno ? errno : EIO));
    if (bytes % sizeof *rays != 0)
        return refuse_size(file, file->read_count * sizeof *rays + bytes);
    *count = bytes / sizeof *rays;
    file->read_count += *count;
    return WHIT_OK;
}

void ray_file_close(struct ray_file *file)
{
    if (file->stream)
        fclose(file->stream);
    file->stream = NULL;
}
