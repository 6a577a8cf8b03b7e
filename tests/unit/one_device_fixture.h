/* One device for all tests of a program. */
#ifndef ONE_DEVICE_FIXTURE_H
#define ONE_DEVICE_FIXTURE_H

#include "device_fixture.h"

static struct device *device;

static inline int device_begin(void **state)
{
    (void)state;
    device = device_open(&messages, false);
    return 0;
}

static inline int device_end(void **state)
{
    (void)state;
    device_close(device, &messages);
    return 0;
}

#endif
