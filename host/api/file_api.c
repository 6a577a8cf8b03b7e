#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "base/clock.h"
#include "base/platform.h"
#include "base/store.h"
#include "whit/whit_program.h"

whit_result whit_file_begin(const char *path, const whit_log *log, whit_file **out)
{
    *out = NULL;
    whit_file *file = calloc(1, sizeof *file);
    if (!file) {
        log_error(log, "%s: out of memory", path);
        return WHIT_ERROR_MEMORY;
    }
    file->log = log_or_silence(log);
    whit_result result = file_write_begin(log, path, &file->write);
    if (result != WHIT_OK) {
        free(file);
        return result;
    }
    *out = file;
    return WHIT_OK;
}

whit_result whit_file_append(whit_file *file, const void *data, size_t size_bytes)
{
    errno = 0;
    if (size_bytes == 0 || fwrite(data, 1, size_bytes, file->write.stream) == size_bytes)
        return WHIT_OK;
    log_error(&file->log, "%s: cannot write: %s", file->write.path, strerror(errno ? errno : EIO));
    return WHIT_ERROR_OUTPUT;
}

whit_result whit_file_commit(whit_file *file)
{
    whit_result result = file_write_commit(&file->log, &file->write);
    free(file);
    return result;
}

void whit_file_abandon(whit_file *file)
{
    if (!file)
        return;
    file_write_abandon(&file->write);
    free(file);
}

whit_result whit_file_write(const char *path, const void *data, size_t size_bytes,
                            const whit_log *log)
{
    whit_file *file;
    whit_result result = whit_file_begin(path, log, &file);
    if (result != WHIT_OK)
        return result;
    result = whit_file_append(file, data, size_bytes);
    if (result == WHIT_OK)
        return whit_file_commit(file);
    whit_file_abandon(file);
    return result;
}

void whit_file_abandon_all(void)
{
    file_abandon_all();
}

uint64_t whit_peak_memory_bytes(void)
{
    return platform_peak_memory_bytes();
}

double whit_clock_ms(void)
{
    return clock_ms();
}

double whit_clock_cpu_ms(void)
{
    return clock_cpu_ms();
}

/* ---- The cache ---- */

bool whit_cache_read(const char *name, const whit_log *log, uint8_t **data, size_t *size_bytes)
{
    return store_read(log, name, data, size_bytes);
}

void whit_cache_write(const char *name, const void *data, size_t size_bytes, const whit_log *log)
{
    store_write(log, name, data, size_bytes);
}

char *whit_cache_folder(void)
{
    return store_folder(NULL);
}

void whit_cache_get_info(whit_cache_info *info)
{
    store_get_info(info);
}

const char *whit_version(void)
{
    return WHIT_VERSION;
}

void whit_memory_destroy(void *memory)
{
    free(memory);
}
