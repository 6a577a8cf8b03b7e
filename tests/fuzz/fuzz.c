/* nftw is POSIX and X/Open. */
#define _GNU_SOURCE
#include "fuzz.h"

#include <ftw.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <zlib.h>

#include "accel/accel.h"
#include "base/hash.h"
#include "load/load.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define WATCH_MEMORY 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define WATCH_MEMORY 1
#endif
#if defined(WATCH_MEMORY) && defined(__has_include)
#if !__has_include(<sanitizer/allocator_interface.h>)
#undef WATCH_MEMORY /* GCC brings the sanitizer without this header */
#endif
#endif
#ifdef WATCH_MEMORY
#include <sanitizer/allocator_interface.h>
#endif

void fuzz_check(bool good, const char *format, ...)
{
    if (good)
        return;
    va_list args;
    va_start(args, format);
    fputs("fuzz: ", stderr);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
    abort();
}

/* --- files ---------------------------------------------------------------------------------- */

enum { FILES_MAX = 8, PATH_BYTES = 96 };

static struct {
    char folder[PATH_BYTES];
    char paths[FILES_MAX][PATH_BYTES];
    int count;
} files;

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info, (void)kind, (void)place;
    return remove(path);
}

static void remove_files(void)
{
    nftw(files.folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
}

/* In memory where the system has a place for that: a disk would be most of the time. */
const char *fuzz_folder(void)
{
    if (files.folder[0])
        return files.folder;
    const char *place = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
    snprintf(files.folder, sizeof files.folder, "%s/whit-fuzz-XXXXXX", place);
    fuzz_check(mkdtemp(files.folder), "%s: no folder can be made", files.folder);
    atexit(remove_files);
    return files.folder;
}

static const char *path_of(const char *name)
{
    char path[PATH_BYTES];
    snprintf(path, sizeof path, "%.40s/%.40s", fuzz_folder(), name);
    for (int i = 0; i < files.count; i++)
        if (strcmp(files.paths[i], path) == 0)
            return files.paths[i];
    fuzz_check(files.count < FILES_MAX, "too many files");
    return strcpy(files.paths[files.count++], path);
}

const char *fuzz_file(const char *name, const void *data, size_t size_bytes)
{
    const char *path = path_of(name);
    FILE *file = fopen(path, "wb");
    bool good = file && fwrite(data, 1, size_bytes, file) == size_bytes;
    fuzz_check(file && fclose(file) == 0 && good, "%s: cannot be written", path);
    return path;
}

/* --- errors --------------------------------------------------------------------------------- */

static struct {
    uint32_t count;
    char text[1024];
} errors;

static void hear(void *user, whit_log_level level, const char *message)
{
    (void)user;
    if (level != WHIT_LOG_ERROR)
        return;
    errors.count++;
    snprintf(errors.text, sizeof errors.text, "%s", message);
}

const whit_log fuzz_log = {.fn = hear, .level = WHIT_LOG_DEBUG};

void fuzz_log_clear(void)
{
    errors.count = 0;
    errors.text[0] = 0;
}

const char *fuzz_log_last(void)
{
    return errors.text;
}

void fuzz_check_errors(whit_result result, const char *path)
{
    if (result == WHIT_OK) {
        fuzz_check(errors.count == 0, "an error, and yet success: %s", errors.text);
        return;
    }
    fuzz_check(result == WHIT_ERROR_INPUT, "the result is %d: %s", (int)result, errors.text);
    fuzz_check(errors.count == 1, "%u errors, the last one: %s", errors.count, errors.text);
    bool named = path ? strstr(errors.text, path) != NULL : errors.text[0] == '/';
    fuzz_check(named, "`%s` does not name %s", errors.text, path ? path : "a file");
}

/* --- scenes --------------------------------------------------------------------------------- */

void fuzz_check_trees(const struct scene *scene)
{
    enum { PRIMITIVES_MAX = 4096, INSTANCES_MAX = 4096 };
    uint64_t primitives = 0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        primitives += scene_mesh_primitives(&scene->meshes[i]);
    if (primitives > PRIMITIVES_MAX || scene->instance_count > INSTANCES_MAX)
        return;
    const whit_accel_params params = {.validate = true, .threads = 1};
    struct accel *accel = NULL;
    whit_result result = accel_create(&fuzz_log, scene, &params, &accel);
    fuzz_check(result == WHIT_OK, "a scene that cannot have trees (%d): %s", (int)result,
               errors.text);
    accel_destroy(accel);
}

void fuzz_load(const char *path)
{
    struct scene *scene = NULL;
    fuzz_log_clear();
    whit_result result = load_scene(&fuzz_log, path, NULL, &scene);
    fuzz_check_errors(result, NULL); /* of a model it may be another file that is at fault */
    fuzz_check((result == WHIT_OK) == (scene != NULL), "a result without its scene");
    if (scene)
        fuzz_check_trees(scene);
    scene_destroy(scene);
}

/* --- checksums: else nothing behind the first change is read -----------------------------------
 */

enum { PNG_HEAD = 8, CHUNK_HEAD = 8, CHUNK_TAIL = 4 };

static void put_u32(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> (24 - 8 * i));
}

static uint32_t get_u32(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static void sign_png(uint8_t *data, size_t size_bytes)
{
    static const uint8_t magic[PNG_HEAD] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
    if (size_bytes < PNG_HEAD || memcmp(data, magic, PNG_HEAD) != 0)
        return;
    for (size_t at = PNG_HEAD; size_bytes - at >= CHUNK_HEAD + CHUNK_TAIL;) {
        size_t bytes = get_u32(data + at);
        if (bytes > size_bytes - at - CHUNK_HEAD - CHUNK_TAIL)
            return;
        uint8_t *end = data + at + CHUNK_HEAD + bytes;
        put_u32(end, (uint32_t)crc32(0, data + at + 4, (uInt)(bytes + 4)));
        at += CHUNK_HEAD + bytes + CHUNK_TAIL;
    }
}

uint8_t *fuzz_signed(const uint8_t *data, size_t size_bytes)
{
    uint8_t *copy = malloc(size_bytes ? size_bytes : 1);
    fuzz_check(copy, "out of memory");
    memcpy(copy, data, size_bytes);
    sign_png(copy, size_bytes);
    return copy;
}

/* --- memory --------------------------------------------------------------------------------- */

#ifdef WATCH_MEMORY
static struct {
    bool watching;
    uint64_t now_bytes, peak_bytes;
} memory;

static void on_malloc(const volatile void *block, size_t bytes)
{
    (void)block;
    if (!memory.watching)
        return;
    memory.now_bytes += bytes;
    if (memory.now_bytes > memory.peak_bytes)
        memory.peak_bytes = memory.now_bytes;
}

static void on_free(const volatile void *block)
{
    if (!memory.watching || !block)
        return;
    uint64_t bytes = __sanitizer_get_allocated_size(block);
    memory.now_bytes -= bytes < memory.now_bytes ? bytes : memory.now_bytes;
}

static void memory_begin(void)
{
    static bool installed;
    if (!installed)
        fuzz_check(__sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) > 0,
                   "memory cannot be watched");
    installed = true;
    memory.now_bytes = memory.peak_bytes = 0;
    memory.watching = true;
}

static void memory_end(size_t size_bytes)
{
    memory.watching = false;
    uint64_t max = fuzz_target.memory_bytes + 10 * (uint64_t)size_bytes;
    fuzz_check(memory.peak_bytes <= max, "%zu bytes of input took %llu bytes of memory, over %llu",
               size_bytes, (unsigned long long)memory.peak_bytes, (unsigned long long)max);
}
#else
static void memory_begin(void) {}

static void memory_end(size_t size_bytes)
{
    (void)size_bytes;
}
#endif

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size_bytes)
{
    static bool prepared;
    if (!prepared && fuzz_target.prepare)
        fuzz_target.prepare();
    prepared = true;
    memory_begin();
    fuzz_target.run(data, size_bytes);
    memory_end(size_bytes);
    return 0;
}
