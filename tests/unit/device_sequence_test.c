/* shaders/lib/sequence.glsl on the device equals host/picture/sequence.c bit for bit. */
#include "device_fixture.h"
#include "picture/sequence.h"

#include "device_sequence.h"
#include "unit.h"

enum { SMALL = 1 << 15, LARGE = 1 << 15, POINTS = SMALL + LARGE };

static uint32_t indices[POINTS], points[POINTS][2];

TEST(points_are_those_of_the_host)
{
    struct device *device = device_open(&messages, false);
    for (uint32_t i = 0; i < POINTS; ++i)
        indices[i] = i < SMALL ? i : i * 0x9e3779b9u;
    kernel_answer(device, device_sequence, sizeof device_sequence, POINTS, indices, sizeof *indices,
                  points, sizeof *points);
    for (uint32_t i = 0; i < POINTS; ++i) {
        uint32_t expected[2];
        sequence_point(indices[i], expected);
        assert_memory_equal(points[i], expected, sizeof expected);
    }
    device_close(device, &messages);
}
