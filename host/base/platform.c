#include "base/platform.h"

#include <errno.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

void platform_share_heaps(void)
{
#ifdef __GLIBC__ /* the default is up to 8 heaps per core, each of which keeps the size it once    \
                    had */
    (void)mallopt(M_ARENA_MAX, 2);
    /* Large blocks, such as pictures and trees, always come from the system and go back to it: in
       the heap, each that fits into no gap would leave another gap. */
    (void)mallopt(M_MMAP_THRESHOLD, 128 << 10);
    (void)mallopt(M_TRIM_THRESHOLD, 4 << 20);
#endif
}

void platform_trim_heaps(void)
{
#ifdef __GLIBC__
    (void)malloc_trim(0);
#endif
}

void platform_expect_much(void *data, size_t size_bytes)
{
#ifdef MADV_HUGEPAGE
    uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), from = ((uintptr_t)data + page - 1) & -page;
    uintptr_t to = ((uintptr_t)data + size_bytes) & -page;
    if (from < to)
        (void)madvise((void *)from, to - from, MADV_HUGEPAGE);
#endif
}

void platform_zero(void *data, size_t size_bytes)
{
#ifdef MADV_DONTNEED
    uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), from = ((uintptr_t)data + page - 1) & -page;
    uintptr_t to = ((uintptr_t)data + size_bytes) & -page;
    if (from < to) {
        /* On pages of a file or of shared memory MADV_DONTNEED succeeds, but they keep their
           contents, which the last byte shows. */
        volatile uint8_t *last = (uint8_t *)to - 1;
        *last = 1;
        if (madvise((void *)from, to - from, MADV_DONTNEED) == 0 && *last == 0) {
            memset(data, 0, from - (uintptr_t)data);
            memset((void *)to, 0, (uintptr_t)data + size_bytes - to);
            return;
        }
    }
#endif
    memset(data, 0, size_bytes);
}

bool platform_reads_back_slowly(void)
{
#if defined(__x86_64__) && defined(__GNUC__)
    return __builtin_cpu_is("intel") && __builtin_cpu_supports("avx512f");
#else
    return false;
#endif
}

bool platform_has_room(size_t bytes)
{
    void *room = mmap(NULL, bytes, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return room != MAP_FAILED && munmap(room, bytes) == 0;
}

ssize_t platform_read(int fd, void *data, size_t bytes)
{
    size_t done = 0;
    while (done < bytes) {
        ssize_t got = read(fd, (char *)data + done, bytes - done);
        if (got == 0)
            break;
        if (got < 0 && errno != EINTR)
            return -1;
        done += got > 0 ? (size_t)got : 0;
    }
    return (ssize_t)done;
}

bool platform_write(int fd, const void *data, size_t bytes)
{
    for (size_t done = 0; done < bytes;) {
        ssize_t put = write(fd, (const char *)data + done, bytes - done);
        if (put == 0 || (put < 0 && errno != EINTR))
            return false;
        done += put > 0 ? (size_t)put : 0;
    }
    return true;
}

uint64_t platform_peak_memory_bytes(void)
{
    struct rusage own, children;
    if (getrusage(RUSAGE_SELF, &own) != 0 || getrusage(RUSAGE_CHILDREN, &children) != 0)
        return 0;
    long max = own.ru_maxrss > children.ru_maxrss ? own.ru_maxrss : children.ru_maxrss;
    return (uint64_t)max * 1024; /* Linux counts in KiB */
}

void platform_memory_bytes(uint64_t *all, uint64_t *anonymous)
{
    char line[128];
    unsigned long long all_kib = 0, anonymous_kib = 0;
    FILE *from = fopen("/proc/self/status", "r");
    while (from && fgets(line, sizeof line, from)) {
        (void)sscanf(line, "VmRSS: %llu kB", &all_kib);
        (void)sscanf(line, "RssAnon: %llu kB", &anonymous_kib);
    }
    if (from)
        (void)fclose(from);
    *all = (uint64_t)all_kib * 1024;
    *anonymous = (uint64_t)anonymous_kib * 1024;
}
