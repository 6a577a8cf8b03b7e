/* Devices that are created and destroyed in one thread while other threads use theirs. The
   validation layers, under which this test runs, look devices up in a table without a lock:
   device/layers.h. */
#include <stdatomic.h>

#include "base/threads.h"

#include "device_fixture.h"

enum { USERS = 2, CREATED = 150 };

struct user {
    struct device *device;
    struct messages messages;
    struct thread *thread;
    atomic_bool *stop;
    uint32_t made;
};

static void use(void *context)
{
    struct user *user = context;
    while (!atomic_load(user->stop)) {
        own_buffer *buffer = NULL;
        if (buffer_create(user->device, 256, BUFFER_STORAGE, "one of many", &buffer) == WHIT_OK)
            ++user->made;
    }
}

TEST(devices_come_and_go_beside_others)
{
    struct user users[USERS] = {{0}};
    atomic_bool stop = false;
    for (int i = 0; i < USERS; ++i) {
        users[i].device = device_open(&users[i].messages, false);
        users[i].stop = &stop;
    }
    for (int i = 0; i < USERS; ++i) {
        users[i].thread = thread_start(use, &users[i]);
        assert_non_null(users[i].thread);
    }
    for (int i = 0; i < CREATED; ++i) {
        struct device *device = device_open(&messages, false);
        device_close(device, &messages);
    }
    stop = true;
    for (int i = 0; i < USERS; ++i) {
        thread_join(users[i].thread);
        assert_true(users[i].made > 0);
        device_close(users[i].device, &users[i].messages);
    }
}
