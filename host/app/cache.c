#include "app/cache.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <time.h>
#include <unistd.h>

#include "app/cli.h"
#include "app/document.h"
#include "base/hash.h"
#include "base/store.h"

/* whit keeps at most this many folders of Mesa's cache; Mesa's size limit applies to each. */
enum { MESA_FOLDERS = 4, MESA_IN_USE_S = 3600 };
static const char mesa_size[] = "MESA_SHADER_CACHE_MAX_SIZE", mesa_size_text[] = "128M";
static const char gallivm_how[] = "GALLIVM_PERF", plain[] = "nopt";
static const char mesa_place[] = "MESA_SHADER_CACHE_DIR", mesa_off[] = "MESA_SHADER_CACHE_DISABLE";

/* ---- Which driver ---- */

static uint64_t file_hash(const char *path)
{
    struct stat info;
    char text[4200];
    if (stat(path, &info) != 0)
        return 0;
    snprintf(text, sizeof text, "%.4000s %lld.%09ld %lld", path, (long long)info.st_mtim.tv_sec,
             info.st_mtim.tv_nsec, (long long)info.st_size);
    return hash_bytes(HASH_START, text, strlen(text));
}

/* A hash of the .json files in a folder, or of a single file. The hashes of files are added up,
   for folders have no order. */
static uint64_t manifests_hash(const char *path)
{
    uint64_t sum = file_hash(path);
    DIR *dir = opendir(path);
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        char file[4200];
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        sum += strstr(entry->d_name, ".json") ? file_hash(file) : 0;
    }
    if (dir)
        closedir(dir);
    return sum;
}

/* Tells versions of drivers apart without starting them: each comes with a manifest of its own, at
   the places where the Vulkan loader looks. */
static uint64_t drivers_hash(void)
{
    static const char *const folders[] = {"/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d",
                                          "/usr/share/vulkan/icd.d"};
    static const char *const names[] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES",
                                        "VK_ADD_DRIVER_FILES"};
    uint64_t hash = 0;
    for (int i = 0; i < 3; ++i) {
        const char *value = getenv(names[i]);
        char *list = strdup(value ? value : ""), *rest = list;
        for (char *path; list && (path = strsep(&rest, ":"));)
            hash = (hash + manifests_hash(path)) * 31;
        free(list);
        hash = (hash + manifests_hash(folders[i])) * 31;
    }
    return hash;
}

/* ---- Mesa's folders ---- */

/* Sums the bytes of all files below folder `name`; `removes`: also removes the files and their
   folders. */
static uint64_t walk(int parent, const char *name, bool removes)
{
    uint64_t bytes = 0;
    struct stat info;
    int fd = openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR *dir = fd >= 0 ? fdopendir(fd) : NULL;
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0 ||
            fstatat(fd, entry->d_name, &info, AT_SYMLINK_NOFOLLOW) != 0)
            continue;
        bytes += S_ISDIR(info.st_mode) ? walk(fd, entry->d_name, removes) : (uint64_t)info.st_size;
        if (removes && !S_ISDIR(info.st_mode))
            (void)unlinkat(fd, entry->d_name, 0);
    }
    if (dir)
        closedir(dir);
    else if (fd >= 0)
        close(fd);
    if (removes)
        (void)unlinkat(parent, name, AT_REMOVEDIR);
    return bytes;
}

/* Counts Mesa's folders. `oldest` gets the name of the one whose last start of whit is longest ago;
   "" where that is less than MESA_IN_USE_S ago, as that process may still use it. */
static uint32_t count_folders(int folder, char oldest[256])
{
    uint32_t count = 0;
    time_t oldest_time = 0;
    struct stat info;
    DIR *dir = fdopendir(openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        if (strncmp(entry->d_name, "mesa-", 5) != 0 ||
            fstatat(folder, entry->d_name, &info, AT_SYMLINK_NOFOLLOW) != 0)
            continue;
        if (count++ == 0 || info.st_mtime < oldest_time) {
            oldest_time = info.st_mtime;
            snprintf(oldest, 256, "%s", entry->d_name);
        }
    }
    if (dir)
        closedir(dir);
    if (count > 0 && time(NULL) - oldest_time < MESA_IN_USE_S)
        oldest[0] = 0;
    return count;
}

/* Creates the folder for these drivers and this vector width, or marks it as used, and removes the
   oldest folder where there are too many. */
static void choose_folder(const char *folder)
{
    char path[4200], oldest[256];
    const char *width = getenv("LP_NATIVE_VECTOR_WIDTH"), *how = getenv(gallivm_how);
    snprintf(path, sizeof path, "%s/mesa-%016llx-%u%s", folder, (unsigned long long)drivers_hash(),
             width ? (unsigned)strtoul(width, NULL, 0) : 0, how && strstr(how, plain) ? plain : "");
    if (mkdir(path, 0700) != 0)
        (void)utimensat(AT_FDCWD, path, NULL, AT_SYMLINK_NOFOLLOW);
    (void)setenv(mesa_place, path, 0);
    (void)setenv(mesa_size, mesa_size_text, 0);
    int fd = open(folder, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    for (uint32_t i = 0; fd >= 0 && i < 8 && count_folders(fd, oldest) > MESA_FOLDERS && oldest[0];
         ++i)
        (void)walk(fd, oldest, true);
    if (fd >= 0)
        close(fd);
}

void cache_plain_code(void)
{
    (void)setenv(gallivm_how, plain, 0);
}

/* Mesa maps a sparse index of 1.3 MiB in its folder, and the process ends by SIGBUS where the disk
   has no room for a page of it. */
static bool has_room(const char *place)
{
    static const uint64_t room_bytes = (uint64_t)4 << 20;
    struct statvfs info;
    return statvfs(place, &info) != 0 || info.f_blocks == 0 || /* it does not say */
           (uint64_t)info.f_bavail * info.f_frsize >= room_bytes;
}

void cache_prepare(bool off)
{
    if (off)
        (void)setenv("WHIT_NO_CACHE", "1", 1);
    char *folder = getenv(mesa_place) && !off ? NULL : store_folder(NULL);
    if (folder)
        choose_folder(folder);
    free(folder);
    const char *place = getenv(mesa_place);
    if (off || !place || !has_room(place))
        (void)setenv(mesa_off, "true", 0);
}

/* ---- For `whit devices` ---- */

static uint64_t mesa_bytes(void)
{
    const char *place = getenv(mesa_place);
    return place ? walk(AT_FDCWD, place, false) : 0;
}

json_t *cache_document(void)
{
    struct store_info info;
    store_get_info(&info);
    json_t *cache = document_object();
    document_text(cache, "folder", info.folder[0] ? info.folder : NULL);
    document_text(cache, "why_not", info.why_not[0] ? info.why_not : NULL);
    document_count(cache, "used_bytes", info.used_bytes);
    document_count(cache, "limit_bytes", info.limit_bytes);
    document_text(cache, "mesa_folder", getenv(mesa_place));
    document_count(cache, "mesa_used_bytes", mesa_bytes());
    document_text(cache, "mesa_limit", getenv(mesa_size));
    return cache;
}

void cache_print(void)
{
    struct store_info info;
    store_get_info(&info);
    const char *place = getenv(mesa_place), *limit = getenv(mesa_size);
    fputs("\ncache  ", stdout);
    if (info.why_not[0]) {
        fputs(cli_shown(info.folder), stdout);
        printf("%snot used: %s\n", info.folder[0] ? ": " : "", info.why_not);
    } else {
        fputs(cli_shown(info.folder), stdout);
        printf(": %.1f of %.0f MiB\n", (double)info.used_bytes / 1048576.0,
               (double)info.limit_bytes / 1048576.0);
    }
    if (place) {
        fputs("       Mesa's ", stdout);
        fputs(cli_shown(place), stdout);
        printf(": %.1f MiB, limit %s\n", (double)mesa_bytes() / 1048576.0,
               limit ? limit : "Mesa's");
    }
}
