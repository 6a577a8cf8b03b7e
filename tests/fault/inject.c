/* Preloaded into a program: something happens at its n-th call. The call fails, or a signal is
   raised before it, or the clock jumps (fault.h). Only calls from the program's own code count, and
   calls from libraries that are named: drivers get what they ask for. */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <vulkan/vulkan.h>

#include "fault.h"

#define CALLER ((uintptr_t)__builtin_return_address(0))
/* The function of this name that would have been called. */
#define NEXT(type, name)                                                                           \
    static type next;                                                                              \
    if (!next)                                                                                     \
    *(void **)&next = dlsym(RTLD_NEXT, name)

/* A function that gives `failed` where the condition holds, and else is the one of its name. */
#define CALL(result, name, parameters, arguments, condition, failed)                               \
    result name parameters                                                                         \
    {                                                                                              \
        typedef result(*fn) parameters;                                                            \
        NEXT(fn, #name);                                                                           \
        return (condition) ? (failed) : next arguments;                                            \
    }

struct range {
    uintptr_t begin, end;
};

enum { RANGES_MAX = 16, BLOCKS_MAX = 1 << 18 };
static const int64_t start_ns = 1000000000000, hour_ns = 3600000000000;
static struct fault_shared *shared;
static struct range ranges[RANGES_MAX]; /* The first one is the program. */
static uint32_t range_count;
static pid_t program;          /* Its children inherit this library. */
static void *_Atomic lost;     /* what the handles of a lost device have in common; NULL: none is */
static _Atomic int64_t now_ns; /* what a clock that the sweep turns shows */
static atomic_bool timer_runs; /* The program has set its timer. */
static atomic_bool must_stop;  /* The event has happened: no more submissions but those allowed. */
static _Atomic int next_signal; /* raised at the next call; 0: none */

/* ---- Who calls ---- */

static bool is_named(const char *path)
{
    char list[sizeof shared->from], *rest = list;
    memcpy(list, shared->from, sizeof list);
    for (char *part; (part = strtok_r(rest, ",", &rest));)
        if (strstr(path, part))
            return true;
    return false;
}

static int add_range(struct dl_phdr_info *info, size_t bytes, void *user)
{
    (void)bytes;
    bool *first = user;
    bool wanted = *first || is_named(info->dlpi_name);
    *first = false;
    struct range range = {UINTPTR_MAX, 0};
    for (int i = 0; wanted && i < info->dlpi_phnum; ++i) {
        const ElfW(Phdr) *part = &info->dlpi_phdr[i];
        uintptr_t begin = info->dlpi_addr + part->p_vaddr, end = begin + part->p_memsz;
        if (part->p_type != PT_LOAD)
            continue;
        range.begin = begin < range.begin ? begin : range.begin;
        range.end = end > range.end ? end : range.end;
    }
    if (wanted && range_count < RANGES_MAX)
        ranges[range_count++] = range;
    return 0;
}

/* A lock of its own for the blocks that the program holds, so that they may be noted in malloc. It
   is held at each fork: a child has no thread that would give it back. */
static pthread_spinlock_t blocks_lock;

static void lock_blocks(void)
{
    pthread_spin_lock(&blocks_lock);
}

static void unlock_blocks(void)
{
    pthread_spin_unlock(&blocks_lock);
}

/* A child of the program gives shared memory up before it works: faults go on in a copy, of which
   the sweep sees no more than what the program makes of them. */
static void keep_copy(void)
{
    static struct fault_shared copy;
    memcpy(&copy, shared, sizeof copy);
    shared = &copy;
}

__attribute__((constructor)) static void begin(void)
{
    const char *number = getenv(FAULT_VARIABLE);
    bool first = true;
    if (!number)
        return;
    void *memory = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED, atoi(number), 0);
    if (memory == MAP_FAILED)
        abort();
    shared = memory;
    pthread_spin_init(&blocks_lock, PTHREAD_PROCESS_PRIVATE);
    pthread_atfork(lock_blocks, unlock_blocks, unlock_blocks);
    pthread_atfork(NULL, NULL, keep_copy);
    program = getpid();
    atomic_store(&now_ns, start_ns);
    dl_iterate_phdr(add_range, &first);
}

static bool is_own(uintptr_t caller)
{
    return range_count > 0 && caller >= ranges[0].begin && caller < ranges[0].end;
}

/* Is called after the count: what backtrace() itself allocates does not fail. */
static void note_callers(void)
{
    void *frames[24];
    int count = backtrace(frames, 24);
    memset(shared->callers, 0, sizeof shared->callers);
    for (int i = 0, kept = 0; i < count && kept < FAULT_CALLERS; ++i)
        if (is_own((uintptr_t)frames[i]))
            shared->callers[kept++] = (uintptr_t)frames[i] - ranges[0].begin;
}

/* ---- What happens ---- */

static bool is_counted(enum fault_calls kind, uintptr_t caller)
{
    bool counts = false;
    for (uint32_t i = 0; i < range_count; ++i)
        counts = counts || (caller >= ranges[i].begin && caller < ranges[i].end);
    /* Signals go to the program; a child of it is its own affair. */
    return counts && (shared->counted & kind) &&
           (shared->event == FAULT_FAILS || getpid() == program);
}

/* Raises the signal that follows the event, at the next call of any thread. */
static void raise_next(void)
{
    int number = atomic_exchange(&next_signal, 0);
    if (number && (number != SIGALRM || atomic_load(&timer_runs)))
        raise(number);
}

/* Counts a call. Returns whether the call is to fail. */
static bool fails(enum fault_calls kind, uintptr_t caller, const char *what)
{
    if (!is_counted(kind, caller))
        return false;
    raise_next();
    bool now = atomic_fetch_add(&shared->seen, 1) + 1 == shared->at;
    if (now) {
        snprintf(shared->what, sizeof shared->what, "%s", what);
        note_callers();
        atomic_store(&shared->fired, 1);
        /* The clock may be anywhere before the program begins to count its time limit. */
        atomic_store(&must_stop, shared->event != FAULT_CLOCK || atomic_load(&timer_runs));
    }
    if (atomic_load(&must_stop) && strcmp(what, "vkQueueSubmit") == 0)
        atomic_fetch_add(&shared->submits_later, 1);
    if (now && shared->event == FAULT_SIGNAL && shared->code == SIGSEGV)
        setrlimit(RLIMIT_AS, &(struct rlimit){0}); /* It crashes for want of memory. */
    if (now && shared->event == FAULT_SIGNAL)
        raise(shared->code);
    if (now && shared->event == FAULT_CLOCK)
        atomic_fetch_add(&now_ns, hour_ns);
    if (now)
        atomic_store(&next_signal, shared->then);
    return now && shared->event == FAULT_FAILS;
}

/* ---- Time ---- */

/* In the program the clock stands still between two readings; other libraries read the real one. */
int clock_gettime(clockid_t id, struct timespec *now)
{
    typedef int (*fn)(clockid_t, struct timespec *);
    NEXT(fn, "clock_gettime");
    if (!shared || shared->event == FAULT_FAILS || id != CLOCK_MONOTONIC || !is_own(CALLER))
        return next(id, now);
    (void)fails(FAULT_CALLS_CLOCK, CALLER, "clock_gettime");
    int64_t ns = atomic_fetch_add(&now_ns, shared->step_ns);
    *now = (struct timespec){.tv_sec = ns / 1000000000, .tv_nsec = ns % 1000000000};
    return 0;
}

/* The timer runs out when the sweep says so. */
int timer_settime(timer_t timer, int flags, const struct itimerspec *value,
                  struct itimerspec *before)
{
    typedef int (*fn)(timer_t, int, const struct itimerspec *, struct itimerspec *);
    NEXT(fn, "timer_settime");
    if (!shared || shared->event == FAULT_FAILS || !is_own(CALLER))
        return next(timer, flags, value, before);
    shared->timer_ms =
        (uint32_t)(value->it_value.tv_sec * 1000 + value->it_value.tv_nsec / 1000000);
    atomic_store(&timer_runs, value->it_value.tv_sec > 0 || value->it_value.tv_nsec > 0);
    return 0;
}

/* ---- Blocks that the program holds ---- */

static _Atomic int64_t block_count;
#ifndef FAULT_NO_ALLOC

/* Open addressing; 0: free, 1: was taken. */
static uintptr_t blocks[BLOCKS_MAX];
static bool blocks_over;

static void *note_block(void *block, uintptr_t caller)
{
    if (!block || !is_own(caller))
        return block;
    lock_blocks();
    size_t at = ((uintptr_t)block >> 4) * 2654435761u % BLOCKS_MAX;
    while (blocks[at] > 1)
        at = (at + 1) % BLOCKS_MAX;
    blocks[at] = (uintptr_t)block;
    blocks_over = blocks_over || ++block_count > BLOCKS_MAX / 2;
    unlock_blocks();
    return block;
}

static void forget_block(void *block)
{
    if (!block || block_count == 0 || blocks_over)
        return;
    lock_blocks();
    size_t at = ((uintptr_t)block >> 4) * 2654435761u % BLOCKS_MAX;
    for (size_t tries = 0; blocks[at] && tries < BLOCKS_MAX; ++tries, at = (at + 1) % BLOCKS_MAX) {
        if (blocks[at] != (uintptr_t)block)
            continue;
        blocks[at] = 1;
        --block_count;
        break;
    }
    unlock_blocks();
}

#endif

__attribute__((destructor)) static void end(void)
{
    if (shared)
        shared->live = block_count;
}

/* ---- Memory ---- */

#ifndef FAULT_NO_ALLOC

/* Memory for the calls of calloc that dlsym makes while it looks for the next calloc. */
static _Alignas(16) char early[4096];
static size_t early_bytes;
static __thread bool resolving;

static bool is_early(const void *block)
{
    return (const char *)block >= early && (const char *)block < early + sizeof early;
}

static void *take_early(size_t bytes)
{
    void *block = early + early_bytes;
    early_bytes += (bytes + 15) / 16 * 16;
    if (early_bytes > sizeof early)
        abort();
    return block;
}

static void *no_memory(void)
{
    errno = ENOMEM;
    return NULL;
}

#define NEXT_MEMORY(type, name)                                                                    \
    static type next;                                                                              \
    if (!next) {                                                                                   \
        resolving = true;                                                                          \
        *(void **)&next = dlsym(RTLD_NEXT, name);                                                  \
        resolving = false;                                                                         \
    }

void *malloc(size_t bytes)
{
    typedef void *(*fn)(size_t);
    if (resolving)
        return take_early(bytes);
    NEXT_MEMORY(fn, "malloc")
    return fails(FAULT_CALLS_MEMORY, CALLER, "malloc") ? no_memory()
                                                       : note_block(next(bytes), CALLER);
}

void *calloc(size_t count, size_t bytes)
{
    typedef void *(*fn)(size_t, size_t);
    if (resolving)
        return take_early(count * bytes);
    NEXT_MEMORY(fn, "calloc")
    return fails(FAULT_CALLS_MEMORY, CALLER, "calloc") ? no_memory()
                                                       : note_block(next(count, bytes), CALLER);
}

void *realloc(void *block, size_t bytes)
{
    typedef void *(*fn)(void *, size_t);
    NEXT_MEMORY(fn, "realloc")
    if (fails(FAULT_CALLS_MEMORY, CALLER, "realloc"))
        return no_memory();
    forget_block(block);
    void *moved = next(block, bytes);
    return note_block(moved ? moved : block, CALLER) == moved ? moved : NULL;
}

void *aligned_alloc(size_t alignment, size_t bytes)
{
    typedef void *(*fn)(size_t, size_t);
    NEXT_MEMORY(fn, "aligned_alloc")
    return fails(FAULT_CALLS_MEMORY, CALLER, "aligned_alloc")
               ? no_memory()
               : note_block(next(alignment, bytes), CALLER);
}

void free(void *block)
{
    typedef void (*fn)(void *);
    if (is_early(block))
        return;
    NEXT_MEMORY(fn, "free")
    forget_block(block);
    next(block);
}

CALL(int, pthread_create,
     (pthread_t * thread, const pthread_attr_t *how, void *(*run)(void *), void *user),
     (thread, how, run, user), fails(FAULT_CALLS_MEMORY, CALLER, "pthread_create"), EAGAIN)

#endif

/* ---- Files that are written ---- */

static bool disk_full(uintptr_t caller, const char *what)
{
    bool full = fails(FAULT_CALLS_WRITE, caller, what);
    if (full)
        errno = ENOSPC;
    return full;
}

/* Messages and tables are no files, nor are streams in memory. */
static bool is_file(FILE *stream)
{
    return stream && stream != stdout && stream != stderr && fileno(stream) >= 0;
}

static bool unreadable(uintptr_t caller, const char *what)
{
    bool fails_now = fails(FAULT_CALLS_READ, caller, what);
    if (fails_now)
        errno = shared->code;
    return fails_now;
}

static bool cannot_open(int flags, uintptr_t caller, const char *what)
{
    return flags & O_CREAT ? disk_full(caller, what) : unreadable(caller, what);
}

int open(const char *path, int flags, ...)
{
    typedef int (*fn)(const char *, int, ...);
    NEXT(fn, "open");
    va_list args;
    va_start(args, flags);
    mode_t mode = flags & O_CREAT ? va_arg(args, mode_t) : 0;
    va_end(args);
    return cannot_open(flags, CALLER, "open") ? -1 : next(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...)
{
    typedef int (*fn)(int, const char *, int, ...);
    NEXT(fn, "openat");
    va_list args;
    va_start(args, flags);
    mode_t mode = flags & O_CREAT ? va_arg(args, mode_t) : 0;
    va_end(args);
    return cannot_open(flags, CALLER, "openat") ? -1 : next(folder, path, flags, mode);
}

CALL(ssize_t, write, (int file, const void *data, size_t bytes), (file, data, bytes),
     file > STDERR_FILENO && disk_full(CALLER, "write"), -1)

size_t fwrite(const void *data, size_t bytes, size_t count, FILE *stream)
{
    typedef size_t (*fn)(const void *, size_t, size_t, FILE *);
    NEXT(fn, "fwrite");
    if (!is_file(stream) || !disk_full(CALLER, "fwrite"))
        return next(data, bytes, count, stream);
    stream->_flags |= _IO_ERR_SEEN; /* what ferror tells */
    return 0;
}

CALL(int, fflush, (FILE * stream), (stream), is_file(stream) && disk_full(CALLER, "fflush"), EOF)

int fclose(FILE *stream)
{
    typedef int (*fn)(FILE *);
    NEXT(fn, "fclose");
    bool written = is_file(stream) && (fcntl(fileno(stream), F_GETFL) & O_ACCMODE) != O_RDONLY;
    bool full = written && fails(FAULT_CALLS_WRITE, CALLER, "fclose");
    int result = next(stream);
    if (full)
        errno = ENOSPC;
    return full ? EOF : result;
}

CALL(int, fsync, (int file), (file), disk_full(CALLER, "fsync"), -1)
CALL(int, rename, (const char *from, const char *to), (from, to), disk_full(CALLER, "rename"), -1)
CALL(int, renameat, (int from_folder, const char *from, int to_folder, const char *to),
     (from_folder, from, to_folder, to), disk_full(CALLER, "renameat"), -1)

/* ---- Files that are read, folders, and what child processes are made of ---- */

#define READ(result, name, parameters, arguments, failed)                                          \
    CALL(result, name, parameters, arguments, unreadable(CALLER, #name), failed)

READ(ssize_t, read, (int file, void *data, size_t bytes), (file, data, bytes), -1)
READ(int, stat, (const char *path, struct stat *out), (path, out), -1)
READ(int, lstat, (const char *path, struct stat *out), (path, out), -1)
READ(int, fstat, (int file, struct stat *out), (file, out), -1)
READ(int, fstatat, (int folder, const char *path, struct stat *out, int flags),
     (folder, path, out, flags), -1)
READ(int, access, (const char *path, int how), (path, how), -1)
READ(char *, realpath, (const char *path, char *out), (path, out), NULL)
READ(DIR *, opendir, (const char *path), (path), NULL)
READ(DIR *, fdopendir, (int folder), (folder), NULL)
READ(FILE *, fopen, (const char *path, const char *how), (path, how), NULL)
READ(FILE *, fdopen, (int file, const char *how), (file, how), NULL)
READ(int, flock, (int file, int how), (file, how), -1)
READ(int, memfd_create, (const char *name, unsigned flags), (name, flags), -1)
READ(int, pipe, (int ends[2]), (ends), -1)
READ(int, pipe2, (int ends[2], int flags), (ends, flags), -1)
READ(pid_t, fork, (void), (), -1)
READ(int, socket, (int domain, int type, int protocol), (domain, type, protocol), -1)
READ(void *, mmap, (void *at, size_t bytes, int how, int flags, int file, off_t offset),
     (at, bytes, how, flags, file, offset), MAP_FAILED)

size_t fread(void *data, size_t bytes, size_t count, FILE *stream)
{
    typedef size_t (*fn)(void *, size_t, size_t, FILE *);
    NEXT(fn, "fread");
    if (!is_file(stream) || !unreadable(CALLER, "fread"))
        return next(data, bytes, count, stream);
    stream->_flags |= _IO_ERR_SEEN;
    return 0;
}

/* ---- Vulkan ---- */

/* Nothing works on a device once it is lost, but waiting ends; other devices go on. `of`: a handle
   of the device, its queue or its commands, NULL where there is no device as yet: the loader keeps
   what leads to the driver in the first word of each, which is the same for all of one device. */
static bool vulkan_fails(uintptr_t caller, const char *what, const void *of)
{
    bool now = fails(FAULT_CALLS_VULKAN, caller, what);
    void *device = of ? *(void *const *)of : NULL;
    if (now && shared->code == VK_ERROR_DEVICE_LOST)
        atomic_store(&lost, device);
    return now || (device && device == atomic_load(&lost) && is_own(caller));
}

#define VULKAN(name, of, parameters, arguments)                                                    \
    VKAPI_ATTR VkResult VKAPI_CALL name parameters                                                 \
    {                                                                                              \
        NEXT(PFN_##name, #name);                                                                   \
        return vulkan_fails(CALLER, #name, of) ? (VkResult)shared->code : next arguments;          \
    }

/* Submitted work must not be destroyed while it runs: these functions wait, and then fail. */
#define VULKAN_WAIT(name, of, parameters, arguments)                                               \
    VKAPI_ATTR VkResult VKAPI_CALL name parameters                                                 \
    {                                                                                              \
        NEXT(PFN_##name, #name);                                                                   \
        VkResult result = next arguments;                                                          \
        return vulkan_fails(CALLER, #name, of) ? (VkResult)shared->code : result;                  \
    }

VULKAN(vkEnumerateInstanceVersion, NULL, (uint32_t * version), (version))
VULKAN(vkEnumerateInstanceExtensionProperties, NULL,
       (const char *layer, uint32_t *count, VkExtensionProperties *list), (layer, count, list))
VULKAN(vkEnumerateInstanceLayerProperties, NULL, (uint32_t * count, VkLayerProperties *list),
       (count, list))
VULKAN(vkEnumerateDeviceExtensionProperties, NULL,
       (VkPhysicalDevice device, const char *layer, uint32_t *count, VkExtensionProperties *list),
       (device, layer, count, list))
VULKAN(vkEnumeratePhysicalDevices, NULL,
       (VkInstance instance, uint32_t *count, VkPhysicalDevice *list), (instance, count, list))
VULKAN(vkCreateInstance, NULL,
       (const VkInstanceCreateInfo *info, const VkAllocationCallbacks *memory, VkInstance *out),
       (info, memory, out))
VULKAN(vkCreateDevice, NULL,
       (VkPhysicalDevice device, const VkDeviceCreateInfo *info,
        const VkAllocationCallbacks *memory, VkDevice *out),
       (device, info, memory, out))

/* All that make something from a description of it. */
#define VULKAN_CREATE(thing)                                                                       \
    VULKAN(vkCreate##thing, device,                                                                \
           (VkDevice device, const Vk##thing##CreateInfo *info,                                    \
            const VkAllocationCallbacks *memory, Vk##thing *out),                                  \
           (device, info, memory, out))
VULKAN_CREATE(Buffer)
VULKAN_CREATE(BufferView)
VULKAN_CREATE(CommandPool)
VULKAN_CREATE(DescriptorPool)
VULKAN_CREATE(DescriptorSetLayout)
VULKAN_CREATE(Fence)
VULKAN_CREATE(PipelineCache)
VULKAN_CREATE(PipelineLayout)
VULKAN_CREATE(QueryPool)
VULKAN_CREATE(ShaderModule)
VULKAN_CREATE(Framebuffer)
VULKAN_CREATE(Image)
VULKAN_CREATE(ImageView)
VULKAN_CREATE(RenderPass)
VULKAN_CREATE(Sampler)
VULKAN_CREATE(Semaphore)
VULKAN(vkCreateComputePipelines, device,
       (VkDevice device, VkPipelineCache cache, uint32_t count,
        const VkComputePipelineCreateInfo *infos, const VkAllocationCallbacks *memory,
        VkPipeline *out),
       (device, cache, count, infos, memory, out))
VULKAN(vkAllocateMemory, device,
       (VkDevice device, const VkMemoryAllocateInfo *info, const VkAllocationCallbacks *memory,
        VkDeviceMemory *out),
       (device, info, memory, out))
VULKAN(vkAllocateCommandBuffers, device,
       (VkDevice device, const VkCommandBufferAllocateInfo *info, VkCommandBuffer *out),
       (device, info, out))
VULKAN(vkAllocateDescriptorSets, device,
       (VkDevice device, const VkDescriptorSetAllocateInfo *info, VkDescriptorSet *out),
       (device, info, out))
VULKAN(vkBindBufferMemory, device,
       (VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset),
       (device, buffer, memory, offset))
VULKAN(vkMapMemory, device,
       (VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize bytes,
        VkMemoryMapFlags flags, void **out),
       (device, memory, offset, bytes, flags, out))
VULKAN(vkResetCommandPool, device,
       (VkDevice device, VkCommandPool pool, VkCommandPoolResetFlags flags), (device, pool, flags))
VULKAN(vkBeginCommandBuffer, commands,
       (VkCommandBuffer commands, const VkCommandBufferBeginInfo *info), (commands, info))
VULKAN(vkEndCommandBuffer, commands, (VkCommandBuffer commands), (commands))
VULKAN(vkResetFences, device, (VkDevice device, uint32_t count, const VkFence *fences),
       (device, count, fences))
VULKAN(vkQueueSubmit, queue,
       (VkQueue queue, uint32_t count, const VkSubmitInfo *infos, VkFence fence),
       (queue, count, infos, fence))
VULKAN_WAIT(vkWaitForFences, device,
            (VkDevice device, uint32_t count, const VkFence *fences, VkBool32 all, uint64_t ns),
            (device, count, fences, all, ns))
VULKAN_WAIT(vkDeviceWaitIdle, device, (VkDevice device), (device))
VULKAN(vkGetQueryPoolResults, device,
       (VkDevice device, VkQueryPool pool, uint32_t first, uint32_t count, size_t bytes, void *data,
        VkDeviceSize stride, VkQueryResultFlags flags),
       (device, pool, first, count, bytes, data, stride, flags))
VULKAN(vkGetPipelineCacheData, device,
       (VkDevice device, VkPipelineCache cache, size_t *bytes, void *data),
       (device, cache, bytes, data))

/* ---- Windows ---- */

VULKAN(vkGetPhysicalDeviceSurfaceFormatsKHR, NULL,
       (VkPhysicalDevice device, VkSurfaceKHR surface, uint32_t *count, VkSurfaceFormatKHR *list),
       (device, surface, count, list))
VULKAN(vkGetPhysicalDeviceSurfaceCapabilitiesKHR, NULL,
       (VkPhysicalDevice device, VkSurfaceKHR surface, VkSurfaceCapabilitiesKHR *out),
       (device, surface, out))
VULKAN(vkCreateSwapchainKHR, device,
       (VkDevice device, const VkSwapchainCreateInfoKHR *info, const VkAllocationCallbacks *memory,
        VkSwapchainKHR *out),
       (device, info, memory, out))
VULKAN(vkGetSwapchainImagesKHR, device,
       (VkDevice device, VkSwapchainKHR swapchain, uint32_t *count, VkImage *list),
       (device, swapchain, count, list))
VULKAN(vkAcquireNextImageKHR, device,
       (VkDevice device, VkSwapchainKHR swapchain, uint64_t ns, VkSemaphore semaphore,
        VkFence fence, uint32_t *index),
       (device, swapchain, ns, semaphore, fence, index))
VULKAN_WAIT(vkQueuePresentKHR, queue, (VkQueue queue, const VkPresentInfoKHR *info), (queue, info))
VULKAN_WAIT(vkQueueWaitIdle, queue, (VkQueue queue), (queue))
VULKAN(vkCreateGraphicsPipelines, device,
       (VkDevice device, VkPipelineCache cache, uint32_t count,
        const VkGraphicsPipelineCreateInfo *infos, const VkAllocationCallbacks *memory,
        VkPipeline *out),
       (device, cache, count, infos, memory, out))
VULKAN(vkBindImageMemory, device,
       (VkDevice device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset),
       (device, image, memory, offset))
VULKAN(vkFlushMappedMemoryRanges, device,
       (VkDevice device, uint32_t count, const VkMappedMemoryRange *list), (device, count, list))
