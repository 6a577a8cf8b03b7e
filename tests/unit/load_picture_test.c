/* JPEG: pixels of files by two encoders, and damaged files; PNGs that ask for too much memory. */
#include "load_model_fixture.h"

#include <errno.h>
#include <jpeglib.h>
#include <malloc.h>
#include <sys/socket.h>

#include "../random.h"
#include "../wrapped.h"
#include "base/sandbox.h"
#include "image/formats.h"
#include "load/jpeg.h"
#include "load/texture.h"
#include "stb_write_fixture.h"
#include "unit.h"

enum { WIDTH = 37, HEIGHT = 21, FLIPS = 2000, SCANS = 250 };

struct bytes {
    uint8_t *data;
    size_t count;
};

static void drop_bytes(struct bytes *bytes)
{
    free(bytes->data);
}

#define own_bytes __attribute__((cleanup(drop_bytes), unused)) struct bytes

/* A test picture: smooth, so that JPEG keeps it, and different in every channel. */
static uint8_t texel(int x, int y, int channel)
{
    int values[] = {40 + 5 * x, 220 - 7 * y, 60 + 2 * x + 3 * y, 200 - 2 * x};
    return (uint8_t)values[channel];
}

static void fill(uint8_t *pixels, int channels)
{
    for (int i = 0; i < WIDTH * HEIGHT * channels; i++)
        pixels[i] = texel(i / channels % WIDTH, i / channels / WIDTH, i % channels);
}

static void append(void *user, void *data, int size)
{
    struct bytes *bytes = user;
    bytes->data = realloc(bytes->data, bytes->count + (size_t)size);
    assert_non_null(bytes->data);
    memcpy(bytes->data + bytes->count, data, (size_t)size);
    bytes->count += (size_t)size;
}

/* Encodes with stb, which subsamples colours at quality 90 or less. */
static struct bytes write_stb(int quality)
{
    uint8_t pixels[WIDTH * HEIGHT * 3];
    struct bytes bytes = {0};
    fill(pixels, 3);
    assert_true(stbi_write_jpg_to_func(append, &bytes, WIDTH, HEIGHT, 3, pixels, quality));
    return bytes;
}

struct options {
    int channels;
    J_COLOR_SPACE space, stored;
    bool progressive;
    unsigned restart;
};

static struct bytes write_libjpeg(struct options options)
{
    uint8_t pixels[WIDTH * HEIGHT * 4];
    unsigned char *data = NULL;
    unsigned long count = 0;
    struct jpeg_compress_struct info;
    struct jpeg_error_mgr errors;
    fill(pixels, options.channels);
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    jpeg_mem_dest(&info, &data, &count);
    info.image_width = WIDTH;
    info.image_height = HEIGHT;
    info.input_components = options.channels;
    info.in_color_space = options.space;
    jpeg_set_defaults(&info);
    jpeg_set_colorspace(&info, options.stored);
    jpeg_set_quality(&info, 95, TRUE);
    info.restart_interval = options.restart;
    if (options.progressive)
        jpeg_simple_progression(&info);
    jpeg_start_compress(&info, TRUE);
    for (int y = 0; y < HEIGHT; y++) {
        JSAMPROW row = pixels + y * WIDTH * options.channels;
        assert_int_equal(jpeg_write_scanlines(&info, &row, 1), 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    return (struct bytes){data, count};
}

static struct bytes progressive_file(void)
{
    return write_libjpeg((struct options){3, JCS_RGB, JCS_YCbCr, true, 0});
}

/* The expected value of a decoded channel. CMYK as Adobe writes it has inverted inks. */
static int expected(int x, int y, int channel, int channels)
{
    if (channel == 3)
        return 255;
    if (channels == 4)
        return (texel(x, y, channel) * texel(x, y, 3) + 127) / 255;
    return texel(x, y, channels == 1 ? 0 : channel);
}

/* Decodes a JPEG, checks its pixels, and frees its bytes. */
static void check(struct bytes bytes, int channels, int off_max)
{
    struct picture picture;
    const char *reason = "";
    int off = 0;
    assert_int_equal(picture_decode(bytes.data, bytes.count, UINT64_MAX, &picture, &reason),
                     WHIT_OK);
    assert_true(picture.width == WIDTH && picture.height == HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT * 4; i++) {
        int wanted = expected(i / 4 % WIDTH, i / 4 / WIDTH, i % 4, channels);
        int error = abs(picture.rgba[i] - wanted);
        off = error > off ? error : off;
    }
    print_message("off by at most %d of 255, of %d allowed\n", off, off_max);
    assert_true(off <= off_max);
    picture_finish(&picture);
    free(bytes.data);
}

TEST(jpegs_have_their_pixels)
{
    check(write_stb(95), 3, 3);
    check(write_stb(90), 3, 8);
    check(write_libjpeg((struct options){3, JCS_RGB, JCS_YCbCr, false, 0}), 3, 6);
    check(progressive_file(), 3, 6);
    check(write_libjpeg((struct options){3, JCS_RGB, JCS_RGB, false, 2}), 3, 3);
    check(write_libjpeg((struct options){1, JCS_GRAYSCALE, JCS_GRAYSCALE, false, 0}), 1, 3);
    check(write_libjpeg((struct options){4, JCS_CMYK, JCS_CMYK, false, 0}), 4, 3);
    check(write_libjpeg((struct options){4, JCS_CMYK, JCS_YCCK, false, 0}), 4, 6);
}

/* Whether the data can be decoded; checks that result, picture and reason agree. */
static bool decodes(const uint8_t *data, size_t size_bytes, const char **reason)
{
    struct picture picture;
    uint8_t *exact = malloc(size_bytes ? size_bytes : 1); /* sanitizers see its end */
    assert_non_null(exact);
    memcpy(exact, data, size_bytes);
    whit_result result = picture_decode(exact, size_bytes, UINT64_MAX, &picture, reason);
    free(exact);
    assert_true(result == WHIT_OK || (result == WHIT_ERROR_INPUT && **reason));
    assert_int_equal(result == WHIT_OK, picture.rgba != NULL);
    picture_finish(&picture);
    return result == WHIT_OK;
}

TEST(cut_jpegs_are_refused)
{
    struct bytes files[] = {write_stb(95), progressive_file()};
    for (size_t i = 0; i < 2; i++) {
        const char *reason = "";
        for (size_t length = 0; length < files[i].count; length++)
            assert_false(decodes(files[i].data, length, &reason));
        print_message("0 of %zu cut files decode; the last: %s\n", files[i].count, reason);
        free(files[i].data);
    }
}

TEST(changed_jpegs_end)
{
    struct bytes files[] = {write_stb(95), progressive_file()};
    uint64_t random = 3;
    for (size_t i = 0; i < 2; i++) {
        int decoded = 0;
        for (int k = 0; k < FLIPS; k++) {
            const char *reason = "";
            size_t at = random_bits(&random) % files[i].count;
            uint8_t kept = files[i].data[at];
            files[i].data[at] = (uint8_t)random_bits(&random);
            decoded += decodes(files[i].data, files[i].count, &reason);
            files[i].data[at] = kept;
        }
        print_message("%d of %d changed files decode\n", decoded, FLIPS);
        assert_true(decoded < FLIPS);
        free(files[i].data);
    }
}

/* The offset of a JPEG marker, from `at` on. */
static size_t find(const struct bytes *bytes, uint8_t marker, size_t at)
{
    for (; at + 1 < bytes->count; at++)
        if (bytes->data[at] == 0xff && bytes->data[at + 1] == marker)
            return at;
    fail_msg("no marker %#x", marker);
    return 0;
}

static void check_reason(const struct bytes *bytes, const char *wanted)
{
    const char *reason = "";
    assert_false(decodes(bytes->data, bytes->count, &reason));
    if (!strstr(reason, wanted))
        fail_msg("`%s` is not in `%s`", wanted, reason);
}

/* JPEGs with few bytes that need much memory or time are refused. */
TEST(greedy_jpegs_are_refused)
{
    own_bytes file = write_stb(95);
    uint8_t *sides = file.data + find(&file, 0xc0, 0) + 5; /* height, width: 2 bytes each */
    memcpy(sides, (uint8_t[]){0x3f, 0xff, 0x3f, 0xff}, 4);
    check_reason(&file, "more than 2^26 pixels");
    memcpy(sides, (uint8_t[]){0x0f, 0xf0, 0x40, 1}, 4);
    check_reason(&file, "a side has more than 16384");
    memcpy(sides, (uint8_t[]){0x20, 0, 0x20, 0}, 4);
    check_reason(&file, "more than there is in it");

    /* One scan with its tables, repeated. */
    own_bytes scans = progressive_file(), longer = {0};
    size_t begin = find(&scans, 0xc4, find(&scans, 0xda, 0));
    size_t end = find(&scans, 0xc4, find(&scans, 0xda, begin));
    append(&longer, scans.data, (int)begin);
    for (int i = 0; i < SCANS; i++)
        append(&longer, scans.data + begin, (int)(end - begin));
    append(&longer, scans.data + end, (int)(scans.count - end));
    check_reason(&longer, "too many scans");
}

TEST(jpegs_over_the_limit_tell_their_size_alone)
{
    own_bytes file = write_stb(95);
    struct picture picture;
    const char *reason;
    assert_int_equal(picture_decode(file.data, file.count, WIDTH * HEIGHT - 1, &picture, &reason),
                     WHIT_ERROR_INPUT);
    assert_true(picture.width == WIDTH && picture.height == HEIGHT && !picture.rgba);
}

static size_t largest_block;

WRAPPED(void *, realloc, void *block, size_t size_bytes)
{
    largest_block = size_bytes > largest_block ? size_bytes : largest_block;
    return __real_realloc(block, size_bytes);
}

WRAPPED(void *, calloc, size_t count, size_t size_bytes)
{
    largest_block = count * size_bytes > largest_block ? count * size_bytes : largest_block;
    return __real_calloc(count, size_bytes);
}

/* stb_image gives a picture whose last row the file lacks. malloc fills its blocks meanwhile, so
   that pixels that were never written show. */
TEST(pixels_that_a_file_lacks_are_zero)
{
    enum { SIDE = 8, HELD = SIDE * (SIDE - 1) * 3 };
    uint8_t file[18 + HELD] = {[2] = 2, [12] = SIDE, [14] = SIDE, [16] = 24, [17] = 0x20};
    struct picture picture;
    const char *reason = "";
    memset(file + 18, 77, HELD);
    mallopt(M_PERTURB, 0xa5);
    whit_result result = picture_decode(file, sizeof file, UINT64_MAX, &picture, &reason);
    mallopt(M_PERTURB, 0);
    assert_int_equal(result, WHIT_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_memory_equal(picture.rgba + i * 4,
                            i < SIDE * (SIDE - 1) ? "\115\115\115\377" : "\0\0\0\377", 4);
    picture_finish(&picture);
}

/* A PNG with 2x2 pixels by its header, and data for 4 million. stb_image ignores checksums. */
TEST(pngs_take_what_their_header_tells_of)
{
    enum { SIDE = 2048, IHDR_WIDTH = 16 };
    own_bytes file = {0};
    own_memory uint8_t *pixels = array_alloc_zeroed((size_t)SIDE * SIDE, 1);
    const char *reason = "";
    assert_non_null(pixels);
    assert_true(stbi_write_png_to_func(append, &file, SIDE, SIDE, 1, pixels, SIDE));
    assert_true(decodes(file.data, file.count, &reason));
    memcpy(file.data + IHDR_WIDTH, (uint8_t[]){0, 0, 0, 2, 0, 0, 0, 2}, 8);
    largest_block = 0;
    check_reason(&file, "more than its header tells of");
    assert_in_range(largest_block, 1, (1 << 18) + 2 * file.count + 16 * 3 * 2);
}

TEST_IN(damaged_textures_are_named, fixture_begin, fixture_end)
{
    own_bytes file = write_stb(95);
    const char *path = put_data("cut.jpg", file.data, file.count / 2);
    uint32_t index;
    assert_int_equal(load_texture(fixture.scene, path, NULL, 0, NULL, &index, NULL), WHIT_OK);
    assert_memory_equal(fixture.scene->textures[index].rgba, "\377\0\377\377", 4);
    assert_true(fixture_noted("texture `cut.jpg`: "));
    assert_true(fixture_noted("magenta takes its place"));
    assert_int_equal(messages.errors, 0);
    assert_int_equal(load_environment(fixture.scene, path, NULL), WHIT_ERROR_INPUT);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last_error, path));
}

/* --- decoders that reach out ---------------------------------------------------------------- */

/* Wrapped at link time: replacements of decoders, and a system that refuses the sandbox. */
static bool decoders_connect, sandbox_is_refused;

WRAPPED(whit_result, jpeg_decode, const uint8_t *data, size_t size_bytes, uint64_t pixels_max,
        struct picture *out, const char **reason)
{
    if (decoders_connect && socket(AF_INET, SOCK_STREAM, 0) >= 0)
        *reason = "it is out";
    return __real_jpeg_decode(data, size_bytes, pixels_max, out, reason);
}

WRAPPED(whit_result, image_decode, const struct image_source *source, struct image *image)
{
    if (decoders_connect)
        (void)socket(AF_INET, SOCK_STREAM, 0);
    return __real_image_decode(source, image);
}

WRAPPED(int, sandbox_enter, void)
{
    return sandbox_is_refused ? EPERM : __real_sandbox_enter();
}

static const char hdr[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81";

TEST_IN(environments_too_large_are_refused, fixture_begin, fixture_end)
{
    const char *sky = put_data("a.hdr", hdr, sizeof hdr - 1);
    fixture.scene->memory_limit = 23; /* three floats, on host and device */
    assert_int_equal(load_environment(fixture.scene, sky, NULL), WHIT_ERROR_INPUT);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last_error, "a.hdr` of 1x1 pixels would take"));
    fixture.scene->memory_limit = 24;
    assert_int_equal(load_environment(fixture.scene, sky, NULL), WHIT_OK);
}

/* It is halved to 4096 pixels, and the second one takes the place of the first. */
TEST_IN(environments_take_what_is_kept_of_them, fixture_begin, fixture_end)
{
    static const char header[] = "Pf\n8192 1\n-1.0\n";
    uint8_t file[sizeof header - 1 + 8192 * sizeof(float)] = {0};
    memcpy(file, header, sizeof header - 1);
    const char *sky = put_data("a.pfm", file, sizeof file);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(load_environment(fixture.scene, sky, NULL), WHIT_OK);
        assert_int_equal(fixture.scene->memory_taken, 24 * 4096);
    }
}

TEST_IN(decoders_that_reach_out_are_stopped, fixture_begin, fixture_end)
{
    static const char why[] = "the decoder tried on this file what it may not, and was stopped";
    own_bytes file = write_stb(95);
    const char *jpeg = put_data("a.jpg", file.data, file.count);
    const char *sky = put_data("a.hdr", hdr, sizeof hdr - 1);
    uint32_t index;
    decoders_connect = true;
    assert_int_equal(load_texture(fixture.scene, jpeg, NULL, 0, NULL, &index, NULL), WHIT_OK);
    assert_memory_equal(fixture.scene->textures[index].rgba, "\377\0\377\377", 4);
    assert_true(fixture_noted(why));
    assert_int_equal(load_environment(fixture.scene, jpeg, NULL), WHIT_ERROR_INPUT);
    assert_int_equal(load_environment(fixture.scene, sky, NULL), WHIT_ERROR_INPUT);
    assert_int_equal(messages.errors, 2);
    assert_non_null(strstr(messages.last_error, sky));
    assert_non_null(strstr(messages.last_error, why));
    decoders_connect = false;
    assert_int_equal(load_environment(fixture.scene, jpeg, NULL), WHIT_OK);
    assert_int_equal(load_environment(fixture.scene, sky, NULL), WHIT_OK);
}

/* A texture that cannot be decoded is magenta, but a required sandbox that is missing is an
   error. */
TEST_IN(a_sandbox_that_is_required_is_an_error, fixture_begin, fixture_end)
{
    const whit_load_params params = {.require_sandbox = true};
    own_bytes file = write_stb(95);
    const char *jpeg = put_data("a.jpg", file.data, file.count);
    const char *sky = put_data("a.hdr", hdr, sizeof hdr - 1);
    uint32_t index;
    sandbox_is_refused = true;
    assert_int_equal(load_texture(fixture.scene, jpeg, NULL, 0, &params, &index, NULL),
                     WHIT_ERROR_USAGE);
    assert_int_equal(load_environment(fixture.scene, sky, &params), WHIT_ERROR_USAGE);
    assert_int_equal(messages.errors, 2);
    assert_non_null(strstr(messages.last_error, "the decoder cannot be locked in"));
    assert_int_equal(load_texture(fixture.scene, jpeg, NULL, 0, NULL, &index, NULL), WHIT_OK);
    sandbox_is_refused = false;
}
