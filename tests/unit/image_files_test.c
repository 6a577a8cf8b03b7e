#include "image_fixture.h"
#include <sys/stat.h>

#include <png.h>

#include <OpenEXR/openexr.h>

#include "../wrapped.h"
#include "image/formats.h"
#include "image/image_reply.h"
#include "image/rows.h"

static const whit_text recipe[] = {{"scene", "scenes/default.json"},
                                   {"options", "--aa 4 --depth 8"},
                                   {"note", "\xc3\xbc 5\xc2\xb0"}};
enum { RECIPE_COUNT = sizeof recipe / sizeof *recipe };

/* Puts the picture that is read again in place of *loaded. */
static void save_and_load(const char *name, const struct image *image, struct image *loaded)
{
    image_finish(loaded);
    char *path = in_folder(name);
    assert_int_equal(image_save(&warnings_log, image, NULL, 0, path, recipe, RECIPE_COUNT),
                     WHIT_OK);
    assert_int_equal(image_load(&warnings_log, NULL, path, NULL, loaded), WHIT_OK);
    assert_int_equal(messages.errors, 0);
}

TEST_IN(floats_keep_every_bit, folder_begin, folder_end)
{
    static const uint32_t sizes[][2] = {{1, 1}, {37, 1}, {1, 33}, {70, 49}};
    for (int i = 0; i < 4; ++i) {
        for (uint32_t channels = 1; channels <= 4; ++channels) {
            if (channels == 2)
                continue;
            own_image image = fixture_floats(sizes[i][0], sizes[i][1], channels), loaded = {0};
            image.pixels[0] = NAN;
            save_and_load("a.exr", &image, &loaded);
            assert_images_equal(&image, &loaded);
            if (channels != 4) {
                save_and_load("a.pfm", &image, &loaded);
                assert_images_equal(&image, &loaded);
            }
        }
    }
}

TEST_IN(integers_keep_every_bit, folder_begin, folder_end)
{
    for (uint32_t channels = 1; channels <= 4; ++channels) {
        own_image image = fixture_words(53, 41, channels), loaded = {0};
        save_and_load("ids.exr", &image, &loaded);
        assert_images_equal(&image, &loaded);
    }
}

TEST_IN(pfm_is_bottom_up_little_endian, folder_begin, folder_end)
{
    own_image image = fixture_flat(1, 2, 1, 1.0f), loaded = {0}, other = {0};
    image.pixels[1] = -2.0f;
    save_and_load("a.pfm", &image, &loaded);
    own_memory uint8_t *data = NULL;
    size_t size_bytes;
    char *path = in_folder("a.pfm");
    assert_int_equal(file_read(NULL, NULL, path, 0, &data, &size_bytes), WHIT_OK);
    assert_int_equal(size_bytes, 20);
    assert_memory_equal(data, "Pf\n1 2\n-1.0\n\0\0\0\xc0\0\0\x80\x3f", 20);
    fixture_put(path, "Pf 1 2 2.5 \xc0\0\0\0\x3f\x80\0\0", 19);
    assert_int_equal(image_load(&warnings_log, NULL, path, NULL, &other), WHIT_OK);
    assert_images_equal(&image, &other);
}

/* The nearest 8-bit sRGB code, by the formula in double. */
static int srgb_code(float linear)
{
    double v = linear < 0.0f ? 0.0 : linear > 1.0f ? 1.0 : (double)linear;
    v = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
    return (int)floor(v * 255.0 + 0.5);
}

static int code_of(float linear)
{
    return (int)lroundf(image_srgb_from_linear(linear) * 255.0f);
}

TEST_IN(png_rounds_to_nearest_srgb, folder_begin, folder_end)
{
    own_image image = fixture_floats(211, 97, 4), loaded = {0};
    for (uint32_t i = 0; i < 4000; ++i)
        image.pixels[i] = (float)i / 1e6f; /* where the codes lie close */
    save_and_load("a.png", &image, &loaded);
    assert_int_equal(loaded.channels, 4);
    for (size_t i = 0; i < (size_t)211 * 97 * 4; ++i) {
        if (i % 4 == 3) {
            float alpha = fminf(fmaxf(image.pixels[i], 0.0f), 1.0f);
            assert_true(fabsf(loaded.pixels[i] - alpha) <= 0.5f / 255.0f + 1e-6f);
        } else {
            assert_int_equal(code_of(loaded.pixels[i]), srgb_code(image.pixels[i]));
        }
    }
}

TEST_IN(png_survives_its_own_round_trip, folder_begin, folder_end)
{
    for (uint32_t channels = 1; channels <= 3; channels += 2) {
        own_image image = fixture_floats(64, 64, channels), first = {0}, second = {0};
        save_and_load("a.png", &image, &first);
        save_and_load("b.png", &first, &second);
        assert_int_equal(first.channels, channels);
        assert_images_equal(&first, &second);
    }
}

TEST_IN(nonfinite_is_magenta_and_counted, folder_begin, folder_end)
{
    for (uint32_t channels = 1; channels <= 4; ++channels) {
        if (channels == 2)
            continue;
        own_image image = fixture_floats(8, 8, channels), loaded = {0};
        image.pixels[5 * channels] = INFINITY;
        image.pixels[9 * channels + channels - 1] = NAN;
        messages.warnings = 0;
        save_and_load("a.png", &image, &loaded);
        assert_int_equal(messages.warnings, 1);
        assert_non_null(strstr(messages.last, " 2 of 64 "));
        static const float magenta[4] = {1.0f, 0.0f, 1.0f, 1.0f};
        assert_true(loaded.channels >= 3);
        size_t bytes = loaded.channels * sizeof(float);
        assert_memory_equal(loaded.pixels + 5 * loaded.channels, magenta, bytes);
        assert_memory_equal(loaded.pixels + 9 * loaded.channels, magenta, bytes);
        assert_memory_not_equal(loaded.pixels + 6 * loaded.channels, magenta, bytes);
        messages.warnings = 0;
        save_and_load("a.exr", &image, &loaded);
        assert_int_equal(messages.warnings, 1);
    }
}

TEST_IN(recipe_comes_back, folder_begin, folder_end)
{
    static const char *const names[] = {"a.png", "a.exr", "a.pfm"};
    own_image image = fixture_floats(9, 7, 3);
    for (int i = 0; i < 3; ++i) {
        char *path = in_folder(names[i]);
        own_memory whit_text *texts = NULL;
        uint32_t count, found = 0;
        assert_int_equal(image_save(&warnings_log, &image, NULL, 0, path, recipe, RECIPE_COUNT),
                         WHIT_OK);
        assert_int_equal(image_load_texts(&warnings_log, path, NULL, &texts, &count), WHIT_OK);
        for (uint32_t t = 0; t < count; ++t) {
            for (int r = 0; r < RECIPE_COUNT; ++r)
                found += strcmp(texts[t].key, recipe[r].key) == 0 &&
                         strcmp(texts[t].value, recipe[r].value) == 0;
        }
        assert_int_equal(count, i == 2 ? 0 : RECIPE_COUNT);
        assert_int_equal(found, count);
    }
    assert_int_equal(messages.errors, 0);
}

TEST_IN(refusals_leave_nothing_behind, folder_begin, folder_end)
{
    own_image floats = fixture_floats(4, 4, 3), words = fixture_words(4, 4, 2), none = {0};
    const whit_text other = {"compression", "value"}; /* a name of EXR's own */
    const struct {
        const char *name;
        const struct image *image;
        uint32_t texts;
        whit_result result;
        const char *says;
    } cases[] = {{"a.jpg", &floats, 0, WHIT_ERROR_USAGE, ""},
                 {"a.png", &words, 0, WHIT_ERROR_USAGE, ".exr"},
                 {"none/a.exr", &floats, 0, WHIT_ERROR_OUTPUT, ""},
                 {"a.png", &none, 0, WHIT_ERROR_USAGE, ""},
                 {"a.exr", &floats, 1, WHIT_ERROR_USAGE, "for something else"}};
    for (int i = 0; i < 5; ++i) {
        whit_result result =
            image_save(&warnings_log, cases[i].image, NULL, 0, in_folder(cases[i].name),
                       cases[i].texts ? &other : NULL, cases[i].texts);
        if (result != cases[i].result || messages.errors != i + 1 ||
            !strstr(messages.last, cases[i].says))
            fail_msg("case %d, %s: %d, %s", i, cases[i].name, (int)result, messages.last);
    }
    assert_int_equal(rmdir(folder), 0);
    assert_int_equal(mkdir(folder, 0700), 0);
    assert_true(image_format_known("x.PNG", false) && image_format_known("x.exr", true));
    assert_false(image_format_known("x.png", true) || image_format_known("exr", false));
}

/* What a key would lose in a file of one format is refused for all of them. */
TEST_IN(keys_that_a_file_would_change_are_refused, folder_begin, folder_end)
{
    static const char long_key[] =
        "keys of 80 bytes, where the keywords of a PNG have 79 of them at "
        "most: .........";
    const whit_text wrong[][2] = {
        {{"", "1"}},       {{" key", "1"}},   {{"key ", "1"}},     {{"a  key", "1"}},
        {{"a\nkey", "1"}}, {{long_key, "1"}}, {{"\xc2\x80", "1"}}, {{"key", "1"}, {"key", "2"}}};
    const char *const names[] = {"a.png", "a.exr", "a.pfm"};
    own_image image = fixture_floats(4, 4, 4);
    uint8_t *data = NULL;
    size_t size_bytes;
    assert_int_equal(strlen(long_key), 80);
    for (int i = 0; i < 8 * 3; ++i) {
        struct image_rows *rows = NULL;
        char *path = in_folder(names[i % 3]);
        uint32_t count = i / 3 == 7 ? 2 : 1;
        messages = (struct messages){0};
        assert_int_equal(image_save(&warnings_log, &image, NULL, 0, path, wrong[i / 3], count),
                         WHIT_ERROR_USAGE);
        assert_int_equal(image_rows_begin(&warnings_log, path, &image, wrong[i / 3], count, &rows),
                         WHIT_ERROR_USAGE);
        assert_int_equal(
            image_encode_png(&warnings_log, &image, wrong[i / 3], count, &data, &size_bytes),
            WHIT_ERROR_USAGE);
        assert_int_equal(messages.errors, 3);
        assert_non_null(strstr(messages.last_error, "keys have 1 to 79 printable characters"));
    }
    static const char *const reserved[] = {"name", "tiles", "version", "chunkCount"};
    for (int i = 0; i < 4; ++i) {
        const whit_text text = {reserved[i], "1"};
        assert_int_equal(image_save(&warnings_log, &image, NULL, 0, in_folder("a.exr"), &text, 1),
                         WHIT_ERROR_USAGE);
    }
    assert_int_equal(rmdir(folder), 0);
    assert_int_equal(mkdir(folder, 0700), 0);
    const whit_text long_text = {long_key + 1, "value"};
    own_memory whit_text *texts = NULL;
    uint32_t count;
    assert_int_equal(image_save(&warnings_log, &image, NULL, 0, in_folder("a.png"), &long_text, 1),
                     WHIT_OK);
    assert_int_equal(image_load_texts(&warnings_log, in_folder("a.png"), NULL, &texts, &count),
                     WHIT_OK);
    assert_true(count == 1 && strcmp(texts[0].key, long_text.key) == 0);
}

/* Writes a PNG with libpng, with a compressible text of `text_bytes`, unless that is 0. */
static void png_write_raw(const char *path, int colour_type, int bit_depth, int interlace,
                          size_t text_bytes)
{
    char *value = array_alloc_zeroed(text_bytes + 1, 1), key[] = "a";
    png_text text = {PNG_TEXT_COMPRESSION_zTXt, key, value, text_bytes, 0, NULL, NULL};
    memset(value, 'a', text_bytes);
    static const png_color palette[2] = {{0, 0, 0}, {255, 128, 0}};
    static const png_byte alpha[2] = {51, 255};
    FILE *stream = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_set_IHDR(png, info, 8, 8, bit_depth, colour_type, interlace, 0, 0);
    if (colour_type == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(png, info, palette, 2);
        png_set_tRNS(png, info, alpha, 2, NULL);
    }
    if (text_bytes)
        png_set_text(png, info, &text, 1);
    png_write_info(png, info);
    png_byte rows[8][64];
    png_bytep pointers[8];
    for (int y = 0; y < 8; ++y) {
        for (int i = 0; i < 64; ++i)
            rows[y][i] = (png_byte)(bit_depth == 1 ? 0xaa : y * 29 + i * 3);
        pointers[y] = rows[y];
    }
    png_write_image(png, pointers);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    free(value);
    fclose(stream);
}

static float linear_of(int code, int largest)
{
    return image_linear_from_srgb((float)code / (float)largest);
}

static struct image load_kind(int colour_type, int bit_depth, int interlace, uint32_t channels)
{
    struct image image;
    png_write_raw(in_folder("a.png"), colour_type, bit_depth, interlace, 0);
    assert_int_equal(image_load(&warnings_log, NULL, in_folder("a.png"), NULL, &image), WHIT_OK);
    assert_int_equal(image.channels, channels);
    return image;
}

TEST_IN(png_kinds_are_converted, folder_begin, folder_end)
{
    for (int interlace = 0; interlace <= 1; ++interlace) {
        struct image image = load_kind(PNG_COLOR_TYPE_PALETTE, 1, interlace, 4);
        const float expected[8] = {1.0f, linear_of(128, 255), 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.2f};
        assert_memory_equal(image.pixels + 8 * 4 * 3, expected, sizeof expected);
        image_finish(&image);
        image = load_kind(PNG_COLOR_TYPE_GRAY, 1, interlace, 1);
        assert_true(image.pixels[0] == 1.0f && image.pixels[1] == 0.0f);
        image_finish(&image);
        image = load_kind(PNG_COLOR_TYPE_GRAY_ALPHA, 8, interlace, 4);
        assert_true(image.pixels[4] == linear_of(6, 255) && image.pixels[5] == image.pixels[4] &&
                    image.pixels[6] == image.pixels[4] && image.pixels[7] == 9.0f / 255.0f);
        image_finish(&image);
        image = load_kind(PNG_COLOR_TYPE_RGB, 16, interlace, 3);
        int word = (29 + 2 * 3) << 8 | (29 + 3 * 3); /* row 1, bytes 2 and 3 */
        assert_true(image.pixels[8 * 3 + 1] == linear_of(word, 65535));
        image_finish(&image);
    }
    assert_int_equal(messages.errors, 0);
}

/* Writes an RGB picture directly with OpenEXRCore. */
static void exr_write_raw(const char *path, const struct image *image, bool tiled, bool half,
                          exr_compression_t compression)
{
    enum { TILE = 16, LEFT = -5, TOP = 7 };
    exr_context_t context;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int part;
    assert_int_equal(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &init), 0);
    assert_int_equal(
        exr_add_part(context, "p", tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part), 0);
    exr_attr_box2i_t window;
    window.min.x = LEFT;
    window.min.y = TOP;
    window.max.x = LEFT + (int)image->width - 1;
    window.max.y = TOP + (int)image->height - 1;
    exr_attr_v2f_t centre;
    centre.x = centre.y = 0.0f;
    assert_int_equal(exr_initialize_required_attr(context, part, &window, &window, 1.0f, &centre,
                                                  1.0f, EXR_LINEORDER_INCREASING_Y, compression),
                     0);
    if (tiled)
        assert_int_equal(exr_set_tile_descriptor(context, part, TILE, TILE, EXR_TILE_ONE_LEVEL,
                                                 EXR_TILE_ROUND_DOWN),
                         0);
    for (int c = 0; c < 3; ++c)
        assert_int_equal(exr_add_channel(context, part, (const char *[]){"B", "G", "R"}[c],
                                         half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                                         EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1),
                         0);
    assert_int_equal(exr_write_header(context), 0);
    int32_t rows = TILE;
    if (!tiled)
        assert_int_equal(exr_get_scanlines_per_chunk(context, part, &rows), 0);
    uint32_t step_x = tiled ? TILE : image->width;
    for (uint32_t y = 0; y < image->height; y += (uint32_t)rows) {
        for (uint32_t x = 0; x < image->width; x += step_x) {
            exr_chunk_info_t chunk;
            exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
            assert_int_equal(
                tiled ? exr_write_tile_chunk_info(context, part, (int)(x / TILE), (int)(y / TILE),
                                                  0, 0, &chunk)
                      : exr_write_scanline_chunk_info(context, part, TOP + (int)y, &chunk),
                0);
            assert_int_equal(exr_encoding_initialize(context, part, &chunk, &encode), 0);
            for (int c = 0; c < 3; ++c) {
                exr_coding_channel_info_t *channel = &encode.channels[c];
                channel->user_bytes_per_element = 4;
                channel->user_data_type = EXR_PIXEL_FLOAT;
                channel->user_pixel_stride = 12;
                channel->user_line_stride = (int32_t)image->width * 12;
                channel->encode_from_ptr =
                    (const uint8_t *)(image->pixels + (y * image->width + x) * 3 + 2 - (uint32_t)c);
            }
            assert_int_equal(exr_encoding_choose_default_routines(context, part, &encode), 0);
            assert_int_equal(exr_encoding_run(context, part, &encode), 0);
            exr_encoding_destroy(context, &encode);
        }
    }
    assert_int_equal(exr_finish(&context), 0);
}

/* Reads the four channels of layer `name` from a file of scanlines with OpenEXRCore. */
static void exr_read_layer(const char *path, const char *name, struct image *out)
{
    exr_context_t context;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int32_t rows;
    uint32_t found = 0;
    assert_int_equal(exr_start_read(&context, path, &init), 0);
    assert_int_equal(exr_get_scanlines_per_chunk(context, 0, &rows), 0);
    for (uint32_t y = 0; y < out->height; y += (uint32_t)rows) {
        exr_chunk_info_t chunk;
        exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
        assert_int_equal(exr_read_scanline_chunk_info(context, 0, (int)y, &chunk), 0);
        assert_int_equal(exr_decoding_initialize(context, 0, &chunk, &decode), 0);
        for (int i = 0; i < decode.channel_count; ++i) {
            exr_coding_channel_info_t *channel = &decode.channels[i];
            for (uint32_t c = 0; c < 4; ++c) {
                char full[300];
                snprintf(full, sizeof full, "%s.%c", name, "RGBA"[c]);
                if (strcmp(channel->channel_name, full) != 0)
                    continue;
                channel->decode_to_ptr = (uint8_t *)(out->pixels + y * out->width * 4 + c);
                channel->user_bytes_per_element = 4;
                channel->user_data_type = EXR_PIXEL_FLOAT;
                channel->user_pixel_stride = 16;
                channel->user_line_stride = (int32_t)out->width * 16;
                found++;
            }
        }
        assert_int_equal(exr_decoding_choose_default_routines(context, 0, &decode), 0);
        assert_int_equal(exr_decoding_run(context, 0, &decode), 0);
        exr_decoding_destroy(context, &decode);
    }
    assert_int_equal(found, 4 * ((out->height + (uint32_t)rows - 1) / (uint32_t)rows));
    assert_int_equal(exr_finish(&context), 0);
}

TEST_IN(exr_keeps_layers_beside_the_colour, folder_begin, folder_end)
{
    char *path = in_folder("layers.exr");
    own_image color = fixture_floats(45, 37, 4), other = fixture_floats(45, 37, 4);
    own_image third = fixture_floats(45, 37, 4), small = fixture_floats(4, 4, 4), loaded = {0};
    for (size_t i = 0; i < (size_t)45 * 37 * 4; ++i) {
        other.pixels[i] = (float)i - 7.25f;
        third.pixels[i] = -1e-30f * (float)i;
    }
    const char *const name = "a_name_that_is_longer_than_what_plain_files_take";
    const struct image_layer layers[] = {{"a", &other}, {name, &third}, {"b", &small}};
    assert_int_equal(image_save(&warnings_log, &color, layers, 2, path, recipe, RECIPE_COUNT),
                     WHIT_OK);
    assert_int_equal(image_load(&warnings_log, NULL, path, NULL, &loaded), WHIT_OK);
    assert_images_equal(&color, &loaded);
    exr_read_layer(path, "a", &loaded);
    assert_images_equal(&other, &loaded);
    exr_read_layer(path, name, &loaded);
    assert_images_equal(&third, &loaded);
    assert_int_equal(image_save(&warnings_log, &color, layers, 3, path, NULL, 0), WHIT_ERROR_USAGE);
    assert_int_equal(image_save(&warnings_log, &color, layers, WHIT_LAYERS_MAX + 1, path, NULL, 0),
                     WHIT_ERROR_USAGE);
    assert_int_equal(image_save(&warnings_log, &color, layers, 2, in_folder("a.png"), NULL, 0),
                     WHIT_ERROR_USAGE);
    const char *const wrong[] = {"a", "", "a.b"};
    for (int i = 0; i < 3; ++i) {
        const struct image_layer two[] = {{"a", &other}, {wrong[i], &third}};
        assert_int_equal(image_save(&warnings_log, &color, two, 2, path, NULL, 0),
                         WHIT_ERROR_USAGE);
        assert_non_null(strstr(messages.last_error, "names have 1 to 200 bytes and no dots"));
    }
}

TEST_IN(exr_kinds_are_read, folder_begin, folder_end)
{
    static const exr_compression_t compressions[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                                     EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                                     EXR_COMPRESSION_PIZ};
    char *path = in_folder("a.exr");
    own_image image = fixture_floats(45, 37, 3);
    for (size_t i = 0; i < (size_t)45 * 37 * 3; ++i)
        image.pixels[i] = roundf(image.pixels[i] * 1024.0f) / 1024.0f; /* a half holds these */
    for (int kind = 0; kind < 4; ++kind) {
        for (int c = 0; c < 5; ++c) {
            exr_write_raw(path, &image, kind & 1, kind & 2, compressions[c]);
            own_image loaded = {0};
            assert_int_equal(image_load(&warnings_log, NULL, path, NULL, &loaded), WHIT_OK);
            assert_images_equal(&image, &loaded);
        }
    }
    assert_int_equal(messages.errors, 0);
}

/* A pipe cannot seek: an EXR for it is kept in memory until its end. */
TEST_IN(pipes_get_the_bytes_of_files, folder_begin, folder_end)
{
    static const char *const names[] = {"a.png", "a.exr", "a.pfm"};
    own_image image = fixture_floats(30, 40, 3);
    for (int i = 0; i < 3; ++i) {
        own_memory uint8_t *data = NULL, *piped = NULL;
        size_t size_bytes;
        char *path = in_folder(names[i]);
        assert_int_equal(image_save(&warnings_log, &image, NULL, 0, path, NULL, 0), WHIT_OK);
        assert_int_equal(file_read(NULL, NULL, path, 0, &data, &size_bytes), WHIT_OK);
        piped = malloc(size_bytes + 1);
        assert_true(piped && unlink(path) == 0 && mkfifo(path, 0666) == 0);
        int pipe = open(path, O_RDWR); /* holds the 64 KiB that a pipe has room for */
        assert_true(pipe >= 0);
        assert_int_equal(image_save(&warnings_log, &image, NULL, 0, path, NULL, 0), WHIT_OK);
        assert_int_equal(fcntl(pipe, F_SETFL, O_NONBLOCK), 0);
        assert_int_equal(read(pipe, piped, size_bytes + 1), size_bytes);
        assert_memory_equal(piped, data, size_bytes);
        close(pipe);
    }
}

TEST_IN(hdr_rows_of_all_kinds, folder_begin, folder_end)
{
    char *path = in_folder("a.hdr");
    /* Row 0 flat with an old repeat mark, row 1 run-length coded: red runs, green plain. */
    static const char file[] = "#?RADIANCE\nEXPOSURE=1\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n"
                               "\x80\x40\x20\x81"
                               "\1\1\1\6"
                               "\0\0\0\0"
                               "\2\2\0\x08"
                               "\x88\x80"
                               "\x08\x01\x02\x03\x04\x05\x06\x07\x08"
                               "\x84\x10\x84\x20"
                               "\x88\x88";
    own_image image = {0};
    fixture_put(path, file, sizeof file - 1);
    assert_int_equal(image_load(&warnings_log, NULL, path, NULL, &image), WHIT_OK);
    assert_int_equal(image.width, 8);
    assert_int_equal(image.height, 2);
    assert_int_equal(image.channels, 3);
    for (int x = 0; x < 7; ++x) {
        const float expected[3] = {1.0f, 0.5f, 0.25f};
        assert_memory_equal(image.pixels + 3 * x, expected, sizeof expected);
    }
    assert_true(image.pixels[21] == 0.0f);
    for (int x = 0; x < 8; ++x) {
        const float expected[3] = {128.0f, (float)(x + 1), x < 4 ? 16.0f : 32.0f};
        assert_memory_equal(image.pixels + 24 + 3 * x, expected, sizeof expected);
    }
}

static uint64_t malloc_bytes;

WRAPPED(void *, malloc, size_t size_bytes)
{
    malloc_bytes += size_bytes;
    return __real_malloc(size_bytes);
}

/* A PNG whose text chunk, which expands a thousandfold, is repeated many times. */
static uint8_t *repeat_text(const char *path, size_t *size_bytes)
{
    enum { TIMES = 90, HEAD = 8, IHDR = 25, TAIL = 4 };
    own_memory uint8_t *file = NULL;
    size_t file_bytes;
    assert_int_equal(file_read(NULL, NULL, path, 0, &file, &file_bytes), WHIT_OK);
    uint8_t *text = file + HEAD + IHDR;
    assert_memory_equal(text + 4, "zTXt", 4);
    size_t text_bytes = HEAD + png_get_uint_32(text) + TAIL;
    uint8_t *many = array_alloc(file_bytes + TIMES * text_bytes, 1), *at = many;
    assert_non_null(many);
    memcpy(at, file, HEAD + IHDR);
    at += HEAD + IHDR;
    for (int i = 0; i < TIMES; ++i, at += text_bytes)
        memcpy(at, text, text_bytes);
    size_t rest = file_bytes - (size_t)(text - file);
    memcpy(at, text, rest);
    *size_bytes = (size_t)(at - many) + rest;
    return many;
}

TEST_IN(png_texts_take_what_they_may, folder_begin, folder_end)
{
    enum { TEXT_BYTES = (2 << 20) - 100, FREE_BYTES = 64 << 20 };
    char *path = in_folder("a.png");
    png_write_raw(path, PNG_COLOR_TYPE_GRAY, 8, PNG_INTERLACE_NONE, TEXT_BYTES);
    size_t size_bytes;
    own_memory uint8_t *file = repeat_text(path, &size_bytes);
    own_image image = {0};
    fixture_put(path, file, size_bytes);
    const struct image_source source = {&warnings_log, path, file, size_bytes};
    malloc_bytes = 0;
    assert_int_equal(image_decode(&source, &image), WHIT_OK); /* directly, not in a child */
    assert_in_range(malloc_bytes, TEXT_BYTES, FREE_BYTES + 10 * size_bytes + (1 << 20));
}

TEST(sizes_out_of_range)
{
    struct image image;
    assert_int_equal(image_init(&image, UINT32_MAX, UINT32_MAX, 4, false), WHIT_ERROR_MEMORY);
    assert_int_equal(image_init(&image, 0, 4, 4, false), WHIT_ERROR_USAGE);
    assert_int_equal(image_init(&image, 4, 4, 5, false), WHIT_ERROR_USAGE);
    image_finish(&image);
    image_finish(NULL);
}
