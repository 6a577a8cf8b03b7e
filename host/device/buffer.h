/* Buffers of a device. */
#ifndef DEVICE_BUFFER_H
#define DEVICE_BUFFER_H

#include "device/device.h"

/* The uses of a buffer, or-ed. */
enum buffer_use {
    BUFFER_STORAGE = 1,  /* storage buffer descriptor */
    BUFFER_TEXELS = 2,   /* uniform texel buffer view, four uint32 per element */
    BUFFER_INDIRECT = 4, /* arguments of a dispatch */
    BUFFER_HOST = 8, /* the host reads or writes it often: placed in host memory, unless kernels use
                        it on a device with a memory of its own */
    BUFFER_ZEROED = 16, /* contents start as zeros; without it they are undefined */
};

/* A size over the device's limits gives WHIT_ERROR_DEVICE, logged with name, size and limit. `name`
   is copied and becomes the debug name. */
WHIT_CHECK whit_result buffer_create(struct device *device, uint64_t size_bytes, uint32_t uses,
                                     const char *name, struct buffer **out);
struct buffer_request {
    struct buffer **buffer;
    uint64_t size_bytes; /* 0: the buffer is not needed, and left out */
    uint32_t uses;
    const char *name;
};
/* Creates those of the buffers that do not exist yet, up to the first error, and adds the sizes of
   all that exist then to *bytes. */
WHIT_CHECK whit_result buffer_create_all(struct device *device, const struct buffer_request *all,
                                         size_t count, uint64_t *bytes);
void buffer_destroy(struct buffer *buffer); /* NULL is fine; not while in flight */
/* In bytes: the requested size, rounded up to a multiple of 16, at least 16. */
uint64_t buffer_size(const struct buffer *buffer);
/* Both go through a staging buffer where the memory is not host-visible, and return when the copy
   is done. */
WHIT_CHECK whit_result buffer_write(struct buffer *buffer, uint64_t offset_bytes, const void *data,
                                    uint64_t size_bytes);
WHIT_CHECK whit_result buffer_read(struct buffer *buffer, uint64_t offset_bytes, void *data,
                                   uint64_t size_bytes);
/* The contents, where the host reads the buffer's memory itself; else NULL. They change when
   kernels write them, and are gone with the buffer. */
void *buffer_contents(const struct buffer *buffer);

#endif
