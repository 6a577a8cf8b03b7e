/* Buffers of a device. */
#ifndef DEVICE_BUFFER_H
#define DEVICE_BUFFER_H

#include "device/device.h"

/* What a buffer is used for, or-ed. */
enum buffer_use {
    BUFFER_STORAGE = 1,  /* storage buffer descriptor */
    BUFFER_TEXELS = 2,   /* uniform texel buffer view, four uint32 per element */
    BUFFER_INDIRECT = 4, /* arguments of a dispatch */
    BUFFER_HOST = 8, /* read or written by the host often: the host's memory, where kernels do not
                        reach the buffer, or reach that memory as fast as any */
    BUFFER_ZEROED = 16, /* contents start as zeros, else as they come */
};

/* Over the device's limits is WHIT_ERROR_DEVICE, logged with name, size
   and limit. `name` is copied and becomes the debug name. */
WHIT_CHECK whit_result buffer_create(struct device *device, uint64_t size_bytes, uint32_t uses,
                                     const char *name, struct buffer **out);
void buffer_destroy(struct buffer *buffer); /* NULL is fine; not while in flight */
/* What was asked for, rounded up to a multiple of 16, at least 16. */
uint64_t buffer_size(const struct buffer *buffer);
/* Through a staging buffer where the memory is not host-visible. Both wait until done. */
WHIT_CHECK whit_result buffer_write(struct buffer *buffer, uint64_t offset_bytes, const void *data,
                                    uint64_t size_bytes);
WHIT_CHECK whit_result buffer_read(struct buffer *buffer, uint64_t offset_bytes, void *data,
                                   uint64_t size_bytes);

#endif
