#include <math.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>
#include <zlib.h>

#include "base/array.h"
#include "image/display.h"
#include "image/formats.h"

/* libpng leaves its functions by longjmp. Whatever must survive that lives in here, outside the
   frame that calls setjmp. */
struct job {
    const whit_log *log;
    const char *path;
    const struct image_source *source;
    size_t read_bytes, taken_bytes;
    FILE *stream;
    png_structp png;
    png_infop info;
    uint8_t *bytes;  /* the picture or some rows of it */
    png_bytepp rows; /* into `bytes` */
    png_textp texts;
    whit_result result;
};

/* A file that is being written. */
struct png_writer {
    struct job job;
    struct display_encoder encoder;
    uint32_t channels;
};

static void on_error(png_structp png, png_const_charp message)
{
    struct job *job = png_get_error_ptr(png);
    bool memory = strstr(message, "memory") != NULL;
    job->result = memory ? WHIT_ERROR_MEMORY : job->source ? WHIT_ERROR_INPUT : WHIT_ERROR_OUTPUT;
    log_error(job->log, "%s: PNG: %s", job->path, message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    struct job *job = png_get_error_ptr(png);
    log_debug(job->log, "%s: PNG: %s", job->path, message);
}

static void *allocate(struct job *job, size_t count, size_t element_bytes)
{
    void *memory = array_alloc(count, element_bytes);
    if (!memory)
        png_error(job->png, "out of memory");
    return memory;
}

static void write_data(png_structp png, png_bytep data, size_t size_bytes)
{
    struct job *job = png_get_io_ptr(png);
    fwrite(data, 1, size_bytes, job->stream); /* errors are found at the commit */
}

static void flush_data(png_structp png)
{
    (void)png;
}

static void read_data(png_structp png, png_bytep data, size_t size_bytes)
{
    struct job *job = png_get_io_ptr(png);
    if (size_bytes > job->source->size_bytes - job->read_bytes)
        png_error(png, "the file is cut short");
    memcpy(data, job->source->data + job->read_bytes, size_bytes);
    job->read_bytes += size_bytes;
}

/* libpng's allocator for reading, with a limit: compressed texts can grow a thousandfold, and there
   may be many. */
static png_voidp take_memory(png_structp png, png_alloc_size_t size_bytes)
{
    enum { BYTES_FREE = 64 << 20, BYTES_PER_BYTE = 8 };
    struct job *job = png_get_mem_ptr(png);
    size_t left = BYTES_FREE + BYTES_PER_BYTE * job->source->size_bytes - job->taken_bytes;
    if (size_bytes > left)
        return NULL;
    job->taken_bytes += size_bytes;
    return malloc(size_bytes);
}

static void give_memory(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

static void finish(struct job *job)
{
    if (job->source)
        png_destroy_read_struct(&job->png, &job->info, NULL);
    else
        png_destroy_write_struct(&job->png, &job->info);
    free(job->bytes);
    free(job->rows);
    free(job->texts);
}

/* A grey picture with non-finite pixels is written as RGB, since those are magenta. */
uint32_t png_channels(const struct image *image)
{
    size_t pixel_count = (size_t)image->width * image->height;
    for (size_t i = 0; image->channels == 1 && i < pixel_count; ++i) {
        if (!isfinite(image->pixels[i]))
            return 3;
    }
    return image->channels;
}

static bool is_ascii(const char *text)
{
    for (; *text; ++text) {
        if ((unsigned char)*text > 126)
            return false;
    }
    return true;
}

static void set_texts(struct job *job, const struct image_target *target)
{
    if (target->text_count == 0)
        return;
    job->texts = allocate(job, target->text_count, sizeof *job->texts);
    memset(job->texts, 0, target->text_count * sizeof *job->texts);
    for (uint32_t i = 0; i < target->text_count; ++i) {
        const whit_text *text = &target->texts[i];
        bool ascii = is_ascii(text->value);
        job->texts[i].compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        job->texts[i].key = (char *)(uintptr_t)text->key; /* copied by libpng */
        job->texts[i].text = (char *)(uintptr_t)text->value;
        if (ascii)
            job->texts[i].text_length = strlen(text->value);
        else
            job->texts[i].itxt_length = strlen(text->value);
    }
    png_set_text(job->png, job->info, job->texts, (int)target->text_count);
}

/* Rows are converted for the file together, as many as take ROWS_BYTES, or one. */
enum { ROWS_BYTES = 1 << 20 };

static uint32_t rows_at_once(const struct png_writer *writer, uint32_t width)
{
    size_t row_bytes = (size_t)width * writer->channels;
    return row_bytes < ROWS_BYTES ? (uint32_t)(ROWS_BYTES / row_bytes) : 1;
}

static void write_rows(struct png_writer *writer, const struct image *rows)
{
    struct job *job = &writer->job;
    uint32_t many = rows_at_once(writer, rows->width);
    for (uint32_t y = 0; y < rows->height; y += many) {
        uint32_t count = rows->height - y < many ? rows->height - y : many;
        display_encode(&writer->encoder, rows, y, count, job->bytes, writer->channels);
        for (uint32_t i = 0; i < count; ++i)
            png_write_row(job->png, job->bytes + (size_t)i * rows->width * writer->channels);
    }
}

static void write_head(struct png_writer *writer, const struct image_target *target,
                       const struct image *shape)
{
    static const int colour_types[5] = {0, PNG_COLOR_TYPE_GRAY, 0, PNG_COLOR_TYPE_RGB,
                                        PNG_COLOR_TYPE_RGB_ALPHA};
    struct job *job = &writer->job;
    png_set_write_fn(job->png, job, write_data, flush_data);
    png_set_user_limits(job->png, IMAGE_SIDE_MAX, IMAGE_SIDE_MAX);
    png_set_IHDR(job->png, job->info, shape->width, shape->height, 8,
                 colour_types[writer->channels], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(job->png, job->info, PNG_sRGB_INTENT_PERCEPTUAL);
    set_texts(job, target);
    /* One filter, and deflate with runs of one byte as its only matches (Z_RLE). For rendered
       pictures files are 1 to 22 % smaller than with level 2 and all matches, in 0.85 to 0.95 of
       its time. */
    png_set_filter(job->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(job->png, 1);
    png_set_compression_strategy(job->png, Z_RLE);
    png_write_info(job->png, job->info);
    job->bytes =
        allocate(job, rows_at_once(writer, shape->width), (size_t)shape->width * writer->channels);
}

/* A function of its own for setjmp, after which local variables of its frame may be undefined. */
static void try_head(struct png_writer *writer, const struct image_target *target,
                     const struct image *shape)
{
    if (setjmp(png_jmpbuf(writer->job.png)) == 0)
        write_head(writer, target, shape);
}

struct png_writer *png_rows_begin(const struct image_target *target, const struct image *shape,
                                  uint32_t channels)
{
    struct png_writer *writer = calloc(1, sizeof *writer);
    if (!writer)
        goto no_memory;
    struct job *job = &writer->job;
    *job = (struct job){.log = target->log, .path = target->path, .stream = target->stream};
    writer->channels = channels;
    display_encoder_init(&writer->encoder);
    job->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, job, on_error, on_warning);
    job->info = job->png ? png_create_info_struct(job->png) : NULL;
    if (!job->info)
        goto no_memory;
    try_head(writer, target, shape);
    return writer;
no_memory:
    log_error(target->log, "%s: no memory to write a PNG", target->path);
    if (writer)
        finish(&writer->job);
    free(writer);
    return NULL;
}

void png_rows_add(struct png_writer *writer, const struct image *rows)
{
    if (writer->job.result == WHIT_OK && setjmp(png_jmpbuf(writer->job.png)) == 0)
        write_rows(writer, rows);
}

whit_result png_rows_end(struct png_writer *writer, bool whole)
{
    if (whole && writer->job.result == WHIT_OK && setjmp(png_jmpbuf(writer->job.png)) == 0)
        png_write_end(writer->job.png, NULL);
    whit_result result = writer->job.result;
    finish(&writer->job);
    free(writer);
    return result;
}

whit_result png_write(const struct image_target *target, const struct image *image)
{
    struct png_writer *writer = png_rows_begin(target, image, png_channels(image));
    if (!writer)
        return WHIT_ERROR_MEMORY;
    png_rows_add(writer, image);
    return png_rows_end(writer, true);
}

static bool begin_read(struct job *job, const struct image_source *source)
{
    *job = (struct job){.log = source->log, .path = source->path, .source = source};
    job->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, job, on_error, on_warning, job,
                                        take_memory, give_memory);
    job->info = job->png ? png_create_info_struct(job->png) : NULL;
    if (job->info)
        return true;
    log_error(source->log, "%s: no memory to read a PNG", source->path);
    job->result = WHIT_ERROR_MEMORY;
    return false;
}

/* Checks that chunks end within the file. Except for pixels, which it reads piece by piece, libpng
   allocates a whole chunk before it notices that the file is truncated. */
static void check_chunks(struct job *job)
{
    enum { MAGIC = 8, HEAD = 8, TAIL = 4 };
    const struct image_source *source = job->source;
    for (size_t at = MAGIC; at < source->size_bytes && source->size_bytes - at >= HEAD;) {
        const uint8_t *head = source->data + at;
        size_t left = source->size_bytes - at - HEAD, bytes = png_get_uint_32(head);
        bool fits = left >= TAIL && bytes <= left - TAIL;
        if (!fits && memcmp(head + 4, "IDAT", 4) != 0)
            png_error(job->png, "the file is cut short");
        if (!fits || memcmp(head + 4, "IEND", 4) == 0)
            return;
        at += HEAD + bytes + TAIL;
    }
}

static void read_info(struct job *job)
{
    enum { CHUNK_BYTES_MAX = 2 << 20, CHUNK_COUNT_MAX = 100 };
    check_chunks(job);
    png_set_read_fn(job->png, job, read_data);
    png_set_user_limits(job->png, IMAGE_SIDE_MAX, IMAGE_SIDE_MAX);
    png_set_chunk_malloc_max(job->png, CHUNK_BYTES_MAX);
    png_set_chunk_cache_max(job->png, CHUNK_COUNT_MAX);
    png_read_info(job->png, job->info);
}

/* Makes libpng convert to 8 or 16 bits per channel, and to grey, RGB or RGBA. */
static void set_transforms(struct job *job)
{
    png_set_expand(job->png);
    if (png_get_color_type(job->png, job->info) == PNG_COLOR_TYPE_GRAY_ALPHA ||
        (png_get_color_type(job->png, job->info) == PNG_COLOR_TYPE_GRAY &&
         png_get_valid(job->png, job->info, PNG_INFO_tRNS)))
        png_set_gray_to_rgb(job->png);
    png_set_interlace_handling(job->png);
    png_read_update_info(job->png, job->info);
}

static void read_pixels(struct job *job)
{
    size_t row_bytes = png_get_rowbytes(job->png, job->info);
    uint32_t height = png_get_image_height(job->png, job->info);
    job->bytes = allocate(job, height, row_bytes);
    job->rows = allocate(job, height, sizeof *job->rows);
    for (uint32_t y = 0; y < height; ++y)
        job->rows[y] = job->bytes + y * row_bytes;
    png_read_image(job->png, job->rows);
    png_read_end(job->png, NULL);
}

static void decode_8(const uint8_t *from, struct image *image)
{
    float linear[256];
    for (int i = 0; i < 256; ++i)
        linear[i] = image_linear_from_srgb((float)i / 255.0f);
    size_t count = (size_t)image->width * image->height * image->channels;
    for (size_t i = 0; i < count; ++i)
        image->pixels[i] =
            image->channels == 4 && i % 4 == 3 ? (float)from[i] / 255.0f : linear[from[i]];
}

static void decode_16(const uint8_t *from, struct image *image)
{
    size_t count = (size_t)image->width * image->height * image->channels;
    for (size_t i = 0; i < count; ++i) {
        float value = (float)((uint32_t)from[2 * i] << 8 | from[2 * i + 1]) / 65535.0f;
        bool alpha = image->channels == 4 && i % 4 == 3;
        image->pixels[i] = alpha ? value : image_linear_from_srgb(value);
    }
}

/* Refuses a header that states more pixels than the file's bytes can hold: deflate expands a byte
   to at most 1032. */
static void check_amount(struct job *job)
{
    enum { DEFLATE_MAX = 1032 };
    uint64_t depth = png_get_bit_depth(job->png, job->info);
    uint64_t bits = (uint64_t)png_get_image_width(job->png, job->info) * depth *
                    png_get_channels(job->png, job->info);
    uint64_t bytes = (bits + 7) / 8 * png_get_image_height(job->png, job->info);
    if (bytes / DEFLATE_MAX > job->source->size_bytes)
        png_error(job->png, "the file is cut short");
}

static void read_picture(struct job *job, struct image *image)
{
    read_info(job);
    check_amount(job);
    set_transforms(job);
    job->result = image_init_loaded(job->source, image, png_get_image_width(job->png, job->info),
                                    png_get_image_height(job->png, job->info),
                                    png_get_channels(job->png, job->info), false);
    if (job->result != WHIT_OK)
        return;
    read_pixels(job);
    if (png_get_bit_depth(job->png, job->info) == 16)
        decode_16(job->bytes, image);
    else
        decode_8(job->bytes, image);
}

static void read_texts(struct job *job, struct text_list *list)
{
    read_info(job);
    png_textp texts;
    int count = 0;
    png_get_text(job->png, job->info, &texts, &count);
    for (int i = 0; i < count; ++i) {
        if (!text_list_add(list, texts[i].key, texts[i].text ? texts[i].text : ""))
            png_error(job->png, "out of memory");
    }
}

/* Reads the picture, or its texts where `image` is NULL. */
static whit_result load(const struct image_source *source, struct image *image,
                        struct text_list *list)
{
    struct job *job = calloc(1, sizeof *job);
    if (!job)
        return log_failure(source->log, WHIT_ERROR_MEMORY, "%s: no memory to read a PNG",
                           source->path);
    if (begin_read(job, source) && setjmp(png_jmpbuf(job->png)) == 0) {
        if (image)
            read_picture(job, image);
        else
            read_texts(job, list);
    }
    whit_result result = job->result;
    finish(job);
    free(job);
    return result;
}

whit_result png_load(const struct image_source *source, struct image *image)
{
    return load(source, image, NULL);
}

whit_result png_load_texts(const struct image_source *source, struct text_list *list)
{
    return load(source, NULL, list);
}
