#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "base/threads.h"
#include "render/portable.h"
#include "whit/whit_program.h"

whit_result whit_device_list(const whit_log *log, whit_device_info **infos, uint32_t *count)
{
    return device_list(log, infos, count);
}

whit_result whit_device_create(const whit_device_params *params, const whit_log *log,
                               whit_device **out)
{
    *out = NULL;
    whit_device *device = calloc(1, sizeof *device);
    if (!device)
        return API_FAIL(log, WHIT_ERROR_MEMORY, "out of memory");
    device->log = log_or_silence(log);
    whit_result result = device_create(&device->log, params, NULL, &device->device);
    if (result == WHIT_OK)
        *out = device;
    else
        whit_device_destroy(device);
    return result;
}

/* ---- In a thread ---- */

struct held_message {
    struct held_message *next;
    whit_log_level level;
    char text[];
};

/* Keeps log messages of another thread until the caller's thread asks for them; later ones go to
   `to` at once. log_message makes one call at a time. */
struct log_relay {
    whit_log to;
    bool passes, lost; /* passes: goes to `to` at once; lost: memory ran out for a message */
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
    whit_log log; /* writes to `relay` */
    struct log_relay *relay;
    struct thread *thread;
    whit_device *device; /* like `result` used by the thread alone until it is joined */
    whit_result result;
};

static void open_in_thread(void *context)
{
    whit_device_opening *opening = context;
    opening->result = whit_device_create(&opening->params, &opening->log, &opening->device);
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
    return device_get_info(device->device)->kind == WHIT_DEVICE_CPU &&
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
    *info = *device_get_info(device->device);
}

whit_result whit_device_find_floats(whit_device *device, whit_device_floats *floats)
{
    return portable_find(&device->log, device->device, floats);
}

uint32_t whit_device_validation_messages(const whit_device *device)
{
    return device_validation_messages(device->device);
}
