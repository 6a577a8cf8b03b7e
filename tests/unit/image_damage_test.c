/* Damaged pictures give either one error and no picture, or a picture and no error. Under
   sanitizers this also finds accesses out of bounds. */
#include "../child_in_place.h"
#include "image/image_reply.h"
#include "image_fixture.h"

enum { FLIPS = 3000 };

static void (*change_reply)(struct child_reply *reply);

enum child_end __wrap_child_run(const struct child_limits *limits,
                                int (*fn)(void *user, void *to, child_write write), void *user,
                                struct child_reply *reply)
{
    (void)limits;
    return child_in_place(fn, user, reply, change_reply);
}

struct sample {
    const char *name;
    uint8_t *data;
    size_t size_bytes;
};

static struct sample sample_of(const char *name, const struct image *image)
{
    static const whit_text text = {"scene", "a.json"};
    struct sample sample = {.name = name};
    char *path = in_folder(name);
    assert_int_equal(image_save(&warnings_log, image, NULL, 0, path, &text, 1), WHIT_OK);
    assert_int_equal(file_read(&warnings_log, NULL, path, 0, &sample.data, &sample.size_bytes),
                     WHIT_OK);
    return sample;
}

static struct sample hdr_sample(void)
{
    static const char header[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n";
    struct sample sample = {.name = "a.hdr", .data = malloc(512)};
    assert_non_null(sample.data);
    sample.size_bytes = sizeof header - 1;
    memcpy(sample.data, header, sample.size_bytes);
    for (int y = 0; y < 8; ++y) {
        memcpy(sample.data + sample.size_bytes,
               "\2\2\0\x10\x90\x80\x88\x40\x88\x20\x90\x10\x90\x81", 14);
        sample.size_bytes += 14;
    }
    return sample;
}

/* Tries to load a picture; true if it loads. Checks that result, messages and image agree. */
static bool try_load(const char *path, const uint8_t *data, size_t size_bytes)
{
    struct image image;
    whit_text *texts;
    uint32_t text_count;
    fixture_put(path, data, size_bytes);
    messages.errors = 0;
    whit_result result = image_load(&warnings_log, NULL, path, NULL, &image);
    assert_int_equal(messages.errors, result == WHIT_OK ? 0 : 1);
    if (result == WHIT_OK) {
        assert_true(image.width > 0 && image.height > 0 && !image.pixels != !image.words);
    } else {
        assert_true(result == WHIT_ERROR_INPUT || result == WHIT_ERROR_MEMORY);
        assert_non_null(strstr(messages.last, path));
        assert_true(!image.pixels && !image.words);
    }
    image_finish(&image);
    messages.errors = 0;
    whit_result texts_result = image_load_texts(&warnings_log, path, NULL, &texts, &text_count);
    assert_int_equal(messages.errors, texts_result == WHIT_OK ? 0 : 1);
    free(texts);
    return result == WHIT_OK;
}

static void damage(struct sample sample)
{
    print_message("%s\n", sample.name);
    char *path = in_folder(sample.name);
    assert_true(try_load(path, sample.data, sample.size_bytes));
    for (size_t length = 0; length < sample.size_bytes; ++length)
        assert_false(try_load(path, sample.data, length));
    uint64_t seed = 99;
    own_memory uint8_t *copy = malloc(sample.size_bytes);
    assert_non_null(copy);
    for (int i = 0; i < FLIPS; ++i) {
        memcpy(copy, sample.data, sample.size_bytes);
        /* Every other time in the first bytes, where the sizes are. */
        size_t range = i % 2 && sample.size_bytes > 64 ? 64 : sample.size_bytes;
        for (uint32_t n = 1 + random_below(&seed, 3); n; --n)
            copy[random_bits(&seed) % range] = (uint8_t)random_bits(&seed);
        try_load(path, copy, sample.size_bytes);
    }
    free(sample.data);
}

TEST_IN(damaged_files_load_or_are_refused, folder_begin, folder_end)
{
    static const char *const names[] = {"a.png", "a.exr", "ids.exr", "a.pfm"};
    struct image images[] = {fixture_floats(7, 5, 4), fixture_floats(7, 5, 3),
                             fixture_words(5, 20, 2), fixture_floats(7, 5, 3)};
    memset(images[2].words, 0, 5 * 20 * 2 * sizeof(uint32_t)); /* compresses well */
    for (int i = 0; i < 4; ++i) {
        damage(sample_of(names[i], &images[i]));
        image_finish(&images[i]);
    }
    damage(hdr_sample());
}

static uint64_t reply_seed;

/* Simulates a child that a hostile file has taken over: random numbers and length in its reply. */
static void answer_anything(struct child_reply *reply)
{
    uint8_t *answer = reply->data + reply->size_bytes - sizeof(struct foreign_answer);
    for (uint32_t n = 1 + random_below(&reply_seed, 3); n; --n)
        answer[random_below(&reply_seed, 20)] ^= (uint8_t)(1u << random_below(&reply_seed, 8));
    if (random_below(&reply_seed, 2))
        reply->size_bytes -= random_below(&reply_seed, (uint32_t)reply->size_bytes);
}

TEST_IN(replies_are_not_believed, folder_begin, folder_end)
{
    own_image image = fixture_floats(7, 5, 4);
    struct sample sample = sample_of("a.png", &image);
    char *path = in_folder(sample.name);
    int refused = 0;
    reply_seed = 7;
    change_reply = answer_anything;
    for (int i = 0; i < FLIPS; ++i)
        refused += !try_load(path, sample.data, sample.size_bytes);
    change_reply = NULL;
    assert_true(refused > FLIPS / 2);
    assert_true(try_load(path, sample.data, sample.size_bytes));
    free(sample.data);
}

TEST_IN(headers_that_lie, folder_begin, folder_end)
{
    static const char *const files[] = {
        "PF\n-3 4\n-1.0\n",
        "PF\n99999999999999999999 1\n-1.0\n",
        "PF\n65535 65535\n-1.0\n",
        "PF\n0 4\n-1.0\n",
        "PF\n2 2\nnan\n",
        "PF\n2 2\n0\n",
        "PFx\n1 1\n-1.0\n............",
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 999999999 +X 999999999\n....",
        "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n....",
        "#?RADIANCE\n\n",
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 1 -Y 1\n....",
        "\x89PNG\r\n\x1a\n",
        "\x76\x2f\x31\x01",
        "GIF89a",
        "",
    };
    char *path = in_folder("a.png");
    for (size_t i = 0; i < sizeof files / sizeof *files; ++i)
        assert_false(try_load(path, (const uint8_t *)files[i], strlen(files[i])));
}
