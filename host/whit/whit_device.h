/* Part of whit.h: devices. */
#ifndef WHIT_DEVICE_H
#define WHIT_DEVICE_H

#include "whit_types.h"

WHIT_C_BEGIN

/* In order of preference: "auto" takes a device of the first kind that there is. */
typedef enum whit_device_kind {
    WHIT_DEVICE_DISCRETE = 0,
    WHIT_DEVICE_INTEGRATED,
    WHIT_DEVICE_VIRTUAL,
    WHIT_DEVICE_CPU,
    WHIT_DEVICE_OTHER,
} whit_device_kind;
/* "discrete gpu", "integrated gpu", "virtual gpu", "cpu", "other" */
const char *whit_device_kind_name(whit_device_kind kind);

typedef struct whit_device_info {
    uint32_t index; /* in the order Vulkan lists them; what `--device N` takes */
    char name[256];
    char driver[256]; /* name and version text */
    char api_version[32];
    whit_device_kind kind;
    uint64_t memory_bytes;            /* size of its largest device-local heap */
    uint64_t max_storage_range_bytes; /* of one storage buffer */
    uint32_t subgroup_size;
    bool float64, int64, timestamps, usable;
    bool automatic;    /* the one that "auto" takes */
    char why_not[128]; /* the reason where `usable` is false */
} whit_device_info;

/* *infos is one block for whit_memory_destroy. WHIT_ERROR_NO_DEVICE where there is no Vulkan, or no
   device; WHIT_ERROR_DEVICE where a call of Vulkan fails. */
WHIT_CHECK whit_result whit_device_list(const whit_log *log, whit_device_info **infos,
                                        uint32_t *count);

typedef struct whit_device_params {
    const char *selector; /* NULL or "auto": the first usable one of the best kind; a number: that
                             index; else part of a name, any case */
    bool validation;      /* Vulkan validation layers, with their messages in the log */
} whit_device_params;

/* WHIT_ERROR_NO_DEVICE where no device answers the selector, or the one that does cannot be used;
   WHIT_ERROR_DEVICE where a call of Vulkan fails, or validation layers are missing. */
WHIT_CHECK whit_result whit_device_create(const whit_device_params *params, const whit_log *log,
                                          whit_device **out);
void whit_device_destroy(whit_device *device);
void whit_device_get_info(const whit_device *device, whit_device_info *info);

/* A device's arithmetic with 32-bit floats where Vulkan leaves it a choice.
   whit_renderer_params.portable asks the driver for keeps_denormals and rounds_nearest, and
   replaces division, square root and comparison by functions of whit's where own_division or
   own_comparison is false. */
typedef struct whit_device_floats {
    bool own_division;    /* division and square root are correctly rounded, tested on 43 million
                             values */
    bool keeps_denormals; /* sums and products do not flush numbers below 2^-126 to 0 */
    bool rounds_nearest;  /* sums and products are rounded to nearest */
    bool own_comparison;  /* comparisons and absolute values distinguish numbers below 2^-126 from
                             0 */
} whit_device_floats;

/* Measured once for a device and its driver, which takes about a second; the result is kept in the
   cache folder. WHIT_ERROR_DEVICE, WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_device_find_floats(whit_device *device, whit_device_floats *floats);

uint32_t whit_device_validation_messages(const whit_device *device);

WHIT_C_END

#endif
