#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "base/threads.h"
#include "render/portable.h"
#include "whit/whit_program.h"

static void describe(const struct device_info *from, whit_device_info *to)
{
    *to = (whit_device_info){
        .index = from->index,
        .memory_bytes = from->memory_bytes,
        .max_storage_range_bytes = from->max_storage_range_bytes,
        .subgroup_size = from->subgroup_size,
        .float64 = from->float64,
        .int64 = from->int64,
        .timestamps = from->timestamps,
        .usable = from->usable,
    };
    snprintf(to->name, sizeof to->name, "%s", from->name);
    snprintf(to->driver, sizeof to->driver, "%s", from->driver);
    snprintf(to->api_version, sizeof to->api_version, "%s", from->api_version);
    const char *kind = device_kind_name(from->kind);
    for (size_t i = 0; kind[i] && i + 1 < sizeof to->kind; ++i)
        to->kind[i] = (char)tolower((unsigned char)kind[i]);
    snprintf(to->why_not, sizeof to->why_not, "%s", from->why_not);
}

/* The rule of "auto": the first usable device of the best kind, and kinds are listed best first. */
static void mark_automatic(const struct device_info *from, whit_device_info *to, uint32_t count)
{
    uint32_t best = count;
    for (uint32_t i = 0; i < count; ++i) {
        if (from[i].usable && (best == count || from[i].kind < from[best].kind))
            best = i;
    }
    if (best < count)
        to[best].automatic = true;
}

whit_result whit_device_list(const whit_log *log, whit_device_info **infos, uint32_t *count)
{
    struct device_info *found = NULL;
    *infos = NULL;
    *count = 0;
    uint32_t found_count = 0;
    whit_result result = device_list(log, &found, &found_count);
    if (result != WHIT_OK)
        return result;
    whit_device_info *described = calloc(found_count ? found_count : 1, sizeof *described);
    if (!described) {
        log_error(log, "out of memory");
        free(found);
        return WHIT_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < found_count; ++i)
        describe(&found[i], &described[i]);
    mark_automatic(found, described, found_count);
    free(found);
    *infos = described;
    *count = found_count;
    return WHIT_OK;
}

static whit_result open_device(const whit_device_params *params, const whit_log *log,
                               whit_device **out)
{
    const whit_device_params defaults = {0};
    if (!params)
        params = &defaults;
    *out = NULL;
    whit_device *device = calloc(1, sizeof *device);
    if (!device) {
        log_error(log, "out of memory");
        return WHIT_ERROR_MEMORY;
    }
    device->log = log_or_silence(log);
    const struct device_params wanted = {
        .selector = params->selector,
        .validation = params->validation,
    };
    whit_result result = device_create(&device->log, &wanted, &device->device);
    if (result != WHIT_OK) {
        whit_device_destroy(device);
        return result;
    }
    *out = device;
    return WHIT_OK;
}

whit_result whit_device_create(const whit_device_params *params, const whit_log *log,
                               whit_device **out)
{
    return open_device(params, log, out);
}

/* ---- In a thread ---- */

struct held_message {
    struct held_message *next;
    whit_log_level level;
    char text[];
};

/* Keeps messages until the caller's thread asks for them; from then on they pass. Calls of `fn` are
   one at a time (log_message). */
struct log_relay {
    whit_log to;
    bool passes, lost; /* lost: no memory to keep one */
    struct held_message *first, **end;
};

static void relay_message(void *user, whit_log_level level, const char *text)
{
    struct log_relay *relay = user;
    if (relay->passes) {
        relay->to.fn(relay->to.user, level, text);
        return;
    }
    size_t bytes = strlen(text) + 1;
    struct held_message *held = malloc(sizeof *held + bytes);
    if (!held) {
        relay->lost = true;
        return;
    }
    held->next = NULL;
    held->level = level;
    memcpy(held->text, text, bytes);
    *relay->end = held;
    relay->end = &held->next;
}

static struct log_relay *relay_create(const whit_log *to)
{
    struct log_relay *relay = calloc(1, sizeof *relay);
    if (relay) {
        relay->to = *to;
        relay->end = &relay->first;
    }
    return relay;
}

static void relay_pass(struct log_relay *relay)
{
    for (const struct held_message *held = relay->first; held; held = held->next)
        log_message(&relay->to, held->level, "%s", held->text);
    if (relay->lost)
        log_error(&relay->to, "out of memory");
    relay->passes = true;
}

static void relay_destroy(struct log_relay *relay)
{
    if (!relay)
        return;
    for (struct held_message *held = relay->first, *next; held; held = next) {
        next = held->next;
        free(held);
    }
    free(relay);
}

struct whit_device_opening {
    whit_device_params params;
    whit_log log; /* into the relay */
    struct log_relay *relay;
    struct thread *thread;
    whit_device *device; /* of the thread until it is joined, as is `result` */
    whit_result result;
};

static void open_in_thread(void *context)
{
    whit_device_opening *opening = context;
    opening->result = open_device(&opening->params, &opening->log, &opening->device);
}

whit_device_opening *whit_device_open_begin(const whit_device_params *params, const whit_log *log)
{
    whit_log to = log_or_silence(log);
    whit_device_opening *opening = calloc(1, sizeof *opening);
    if (!opening)
        return NULL;
    if (params)
        opening->params = *params;
    opening->relay = relay_create(&to);
    opening->log = (whit_log){.fn = to.fn ? relay_message : NULL, .level = to.level};
    opening->log.user = opening->relay;
    if (opening->relay)
        opening->thread = thread_start(open_in_thread, opening);
    if (opening->thread)
        return opening;
    relay_destroy(opening->relay);
    free(opening);
    return NULL;
}

whit_result whit_device_open_end(whit_device_opening *opening, whit_device **out)
{
    thread_join(opening->thread);
    whit_result result = opening->result;
    *out = opening->device;
    relay_pass(opening->relay);
    if (*out)
        (*out)->relay = opening->relay;
    else
        relay_destroy(opening->relay);
    free(opening);
    return result;
}

void whit_device_open_abandon(whit_device_opening *opening)
{
    if (!opening)
        return;
    thread_join(opening->thread);
    whit_device_destroy(opening->device);
    relay_destroy(opening->relay);
    free(opening);
}

void whit_device_keep_kernels(whit_device *device)
{
    device_keep_pipelines(device->device);
}

uint64_t whit_device_kernels_made(const whit_device *device)
{
    return device_pipelines_made(device->device);
}

bool whit_device_takes_peers(const whit_device *device)
{
    return device_get_info(device->device)->kind == DEVICE_CPU &&
           device_compile_threads(device->device) != 1;
}

void whit_device_destroy(whit_device *device)
{
    if (!device)
        return;
    device_destroy(device->device);
    relay_destroy(device->relay);
    free(device);
}

void whit_device_get_info(const whit_device *device, whit_device_info *info)
{
    describe(device_get_info(device->device), info);
}

whit_result whit_device_find_floats(whit_device *device, whit_device_floats *floats)
{
    struct portable_device found = {0};
    whit_result result = portable_find(&device->log, device->device, &found);
    *floats = (whit_device_floats){found.own_division, found.keeps_denormals, found.rounds_nearest,
                                   found.own_comparison};
    return result;
}

uint32_t whit_device_validation_messages(const whit_device *device)
{
    return device_validation_messages(device->device);
}
