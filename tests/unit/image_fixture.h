/* Pictures for the image tests. */
#ifndef IMAGE_FIXTURE_H
#define IMAGE_FIXTURE_H

#include <fcntl.h>

#include "../random.h"
#include "base/array.h"
#include "base/file.h"
#include "folder_fixture.h"
#include "owned_image.h"

/* Overwrites a file in place: creating files is slow, and some file systems wait for the disk when
   a file is truncated to 0 and filled again. */
static inline void fixture_put(const char *path, const void *data, size_t size_bytes)
{
    int file = open(path, O_WRONLY | O_CREAT, 0666);
    assert_true(file >= 0);
    assert_int_equal(write(file, data, size_bytes), size_bytes);
    assert_int_equal(ftruncate(file, (off_t)size_bytes), 0);
    assert_int_equal(close(file), 0);
}

/* A picture of floats that are all the same. */
static inline struct image fixture_flat(uint32_t width, uint32_t height, uint32_t channels,
                                        float value)
{
    struct image image;
    assert_int_equal(image_init(&image, width, height, channels, false), WHIT_OK);
    for (size_t i = 0; i < (size_t)width * height * channels; ++i) {
        assert_true(image.pixels[i] == 0.0f);
        image.pixels[i] = value;
    }
    return image;
}

/* Values on [-0.1, 1.1], all different. */
static inline struct image fixture_floats(uint32_t width, uint32_t height, uint32_t channels)
{
    struct image image = fixture_flat(width, height, channels, 0.0f);
    uint64_t seed = 12345;
    for (size_t i = 0; i < (size_t)width * height * channels; ++i)
        image.pixels[i] = random_float(&seed) * 1.2f - 0.1f;
    return image;
}

static inline struct image fixture_words(uint32_t width, uint32_t height, uint32_t channels)
{
    struct image image;
    uint64_t seed = 54321;
    assert_int_equal(image_init(&image, width, height, channels, true), WHIT_OK);
    for (size_t i = 0; i < (size_t)width * height * channels; ++i)
        image.words[i] = random_bits(&seed);
    return image;
}

static inline void assert_images_equal(const struct image *a, const struct image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->channels, b->channels);
    assert_int_equal(!a->pixels, !b->pixels);
    size_t bytes = (size_t)a->width * a->height * a->channels * 4;
    assert_memory_equal(a->pixels ? (void *)a->pixels : (void *)a->words,
                        b->pixels ? (void *)b->pixels : (void *)b->words, bytes);
}

#endif
