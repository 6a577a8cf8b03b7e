/* OpenEXR files, with OpenEXRCore. They are read from memory, and written to memory unless the
   output can seek: the library writes its chunk table last, which a pipe does not allow. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include <OpenEXR/openexr.h>

#include "base/array.h"
#include "image/formats.h"

enum { REASON_BYTES = 256, CHANNELS_MAX = 4 };

/* State for the library's callbacks. */
struct memory_file {
    const uint8_t *read_data;
    FILE *stream;  /* output; NULL: written to `data` */
    uint8_t *data; /* written bytes */
    size_t size_bytes, capacity_bytes;
    char reason[REASON_BYTES]; /* the first error; later ones are its consequences */
    bool no_memory; /* an allocation failed; the library's own code for it also means bad data */
};

/* The file that this thread is working on, for the error callback. That cannot get it from the
   context: exr_get_user_data takes a lock that the library holds while it reports an error in
   writing. */
static _Thread_local struct memory_file *current;

static void *on_alloc(size_t size_bytes)
{
    void *block = malloc(size_bytes);
    if (!block && current)
        current->no_memory = true;
    return block;
}

static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    if (!current || current->reason[0])
        return;
    snprintf(current->reason, sizeof current->reason, "%s",
             message && message[0] ? message : exr_get_default_error_message(code));
    current->reason[strcspn(current->reason, "\r\n")] = 0;
}

static int64_t on_size(exr_const_context_t context, void *user)
{
    (void)context;
    const struct memory_file *file = user;
    return (int64_t)file->size_bytes;
}

static int64_t on_read(exr_const_context_t context, void *user, void *to, uint64_t size_bytes,
                       uint64_t offset, exr_stream_error_func_ptr_t error)
{
    (void)context, (void)error;
    const struct memory_file *file = user;
    if (offset >= file->size_bytes)
        return 0;
    if (size_bytes > file->size_bytes - offset)
        size_bytes = file->size_bytes - offset;
    memcpy(to, file->read_data + offset, size_bytes);
    return (int64_t)size_bytes;
}

static bool grow(struct memory_file *file, size_t needed_bytes)
{
    if (needed_bytes <= file->capacity_bytes)
        return true;
    size_t capacity_bytes = needed_bytes + needed_bytes / 2 + 65536;
    uint8_t *moved = realloc(file->data, capacity_bytes);
    if (!moved)
        return false;
    /* Zeroed, since the library skips parts and fills them later. */
    memset(moved + file->capacity_bytes, 0, capacity_bytes - file->capacity_bytes);
    file->data = moved;
    file->capacity_bytes = capacity_bytes;
    return true;
}

static int64_t on_write(exr_const_context_t context, void *user, const void *from,
                        uint64_t size_bytes, uint64_t offset, exr_stream_error_func_ptr_t error)
{
    struct memory_file *file = user;
    if (file->stream) {
        if (fseeko(file->stream, (off_t)offset, SEEK_SET) == 0 &&
            fwrite(from, 1, size_bytes, file->stream) == size_bytes)
            return (int64_t)size_bytes;
        snprintf(file->reason, sizeof file->reason, "cannot write: %s", strerror(errno));
        error(context, EXR_ERR_WRITE_IO, "%s", file->reason);
        return -1;
    }
    if (offset > SIZE_MAX / 4 || size_bytes > SIZE_MAX / 4 || !grow(file, offset + size_bytes)) {
        file->no_memory = true;
        error(context, EXR_ERR_OUT_OF_MEMORY, "out of memory");
        return -1;
    }
    memcpy(file->data + offset, from, size_bytes);
    if (offset + size_bytes > file->size_bytes)
        file->size_bytes = offset + size_bytes;
    return (int64_t)size_bytes;
}

/* The library's callbacks for `file`, which is `current` until finish(). */
static exr_context_initializer_t callbacks(struct memory_file *file)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    current = file;
    init.error_handler_fn = on_error;
    init.alloc_fn = on_alloc;
    init.free_fn = free;
    init.user_data = file;
    init.max_image_width = init.max_image_height = IMAGE_SIDE_MAX;
    init.max_tile_width = init.max_tile_height = IMAGE_SIDE_MAX;
    init.zip_level = 4;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return init;
}

static exr_result_t finish(exr_context_t *context)
{
    exr_result_t code = exr_finish(context);
    current = NULL;
    return code;
}

static whit_result report(const whit_log *log, const char *path, const struct memory_file *file,
                          exr_result_t code, whit_result result)
{
    log_error(log, "%s: %s%s", path, file->stream && ferror(file->stream) ? "" : "EXR: ",
              file->no_memory   ? "out of memory"
              : file->reason[0] ? file->reason
                                : exr_get_default_error_message(code));
    return file->no_memory ? WHIT_ERROR_MEMORY : result;
}

/* Names of the file's channels, in the order of the image's. */
static const char *const *channel_names(const struct image *image)
{
    static const char *const grey[] = {"Y"}, *const id[] = {"id"};
    static const char *const identity[] = {"instance", "primitive", "word2", "word3"};
    static const char *const colour[] = {"R", "G", "B", "A"};
    if (image->words)
        return image->channels == 1 ? id : identity;
    return image->channels == 1 ? grey : colour;
}

/* The image and channel index from which a channel of the file is written. */
struct channel_source {
    const struct image *image;
    uint32_t at;
};

static struct channel_source find_source(const struct image_target *target,
                                         const struct image *image, const char *name)
{
    for (uint32_t i = 0; i < target->layer_count; ++i) {
        const struct image_layer *layer = &target->layers[i];
        size_t length = strlen(layer->name);
        if (strncmp(name, layer->name, length) == 0 && name[length] == '.')
            return (struct channel_source){layer->image,
                                           (uint32_t)strcspn("RGBA", name + length + 1)};
    }
    const char *const *names = channel_names(image);
    uint32_t at = 0;
    while (at + 1 < image->channels && strcmp(names[at], name) != 0)
        at++;
    return (struct channel_source){image, at};
}

static exr_result_t add_layer(exr_context_t context, int part, const char *name)
{
    exr_result_t code = EXR_ERR_SUCCESS;
    for (const char *c = "RGBA"; *c && code == EXR_ERR_SUCCESS; ++c) {
        char channel[256];
        snprintf(channel, sizeof channel, "%.200s.%c", name, *c);
        if (strlen(channel) > 31)
            code = exr_set_longname_support(context, 1);
        if (code == EXR_ERR_SUCCESS)
            code = exr_add_channel(context, part, channel, EXR_PIXEL_FLOAT,
                                   EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    }
    return code;
}

static exr_result_t write_header(exr_context_t context, const struct image_target *target,
                                 const struct image *image)
{
    int part;
    exr_result_t code = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(context, part, (int32_t)image->width,
                                                   (int32_t)image->height, EXR_COMPRESSION_ZIP);
    const char *const *names = channel_names(image);
    for (uint32_t i = 0; i < image->channels && code == EXR_ERR_SUCCESS; ++i)
        code = exr_add_channel(context, part, names[i],
                               image->words ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT,
                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (uint32_t i = 0; i < target->layer_count && code == EXR_ERR_SUCCESS; ++i)
        code = add_layer(context, part, target->layers[i].name);
    for (uint32_t i = 0; i < target->text_count && code == EXR_ERR_SUCCESS; ++i) {
        if (strlen(target->texts[i].key) > 31)
            code = exr_set_longname_support(context, 1);
        if (code == EXR_ERR_SUCCESS)
            code = exr_attr_set_string(context, part, target->texts[i].key, target->texts[i].value);
    }
    return code == EXR_ERR_SUCCESS ? exr_write_header(context) : code;
}

static const uint8_t *image_bytes(const struct image *image)
{
    return image->words ? (const uint8_t *)image->words : (const uint8_t *)image->pixels;
}

static void set_sources(exr_encode_pipeline_t *encode, const struct image_target *target,
                        const struct image *image, uint32_t y)
{
    for (int16_t i = 0; i < encode->channel_count; ++i) {
        exr_coding_channel_info_t *channel = &encode->channels[i];
        struct channel_source source = find_source(target, image, channel->channel_name);
        size_t row_bytes = (size_t)source.image->width * source.image->channels * 4;
        channel->encode_from_ptr =
            image_bytes(source.image) + y * row_bytes + (size_t)source.at * 4;
        channel->user_pixel_stride = (int32_t)source.image->channels * 4;
        channel->user_line_stride = (int32_t)row_bytes;
    }
}

/* A file that is being written. */
struct exr_writer {
    const struct image_target *target;
    struct memory_file file;
    exr_context_t context;
    exr_encode_pipeline_t encode;
    exr_result_t code;
    uint32_t y; /* rows written so far */
};

static exr_result_t write_chunk(struct exr_writer *writer, const struct image *rows, uint32_t row)
{
    exr_context_t context = writer->context;
    bool first = writer->y + row == 0;
    exr_chunk_info_t chunk;
    exr_result_t code = exr_write_scanline_chunk_info(context, 0, (int)(writer->y + row), &chunk);
    if (code == EXR_ERR_SUCCESS)
        code = first ? exr_encoding_initialize(context, 0, &chunk, &writer->encode)
                     : exr_encoding_update(context, 0, &chunk, &writer->encode);
    if (code != EXR_ERR_SUCCESS)
        return code;
    set_sources(&writer->encode, writer->target, rows, row);
    if (first)
        code = exr_encoding_choose_default_routines(context, 0, &writer->encode);
    return code == EXR_ERR_SUCCESS ? exr_encoding_run(context, 0, &writer->encode) : code;
}

void exr_rows_add(struct exr_writer *writer, const struct image *rows)
{
    int32_t chunk_rows = 1;
    current = &writer->file;
    if (writer->code == EXR_ERR_SUCCESS)
        writer->code = exr_get_scanlines_per_chunk(writer->context, 0, &chunk_rows);
    for (uint32_t y = 0; y < rows->height && writer->code == EXR_ERR_SUCCESS;
         y += (uint32_t)chunk_rows)
        writer->code = write_chunk(writer, rows, y);
    writer->y += rows->height;
}

struct exr_writer *exr_rows_begin(const struct image_target *target, const struct image *shape)
{
    struct exr_writer *writer = calloc(1, sizeof *writer);
    if (!writer) {
        log_error(target->log, "%s: out of memory", target->path);
        return NULL;
    }
    writer->target = target;
    writer->encode = (exr_encode_pipeline_t)EXR_ENCODE_PIPELINE_INITIALIZER;
    writer->file.stream = fseeko(target->stream, 0, SEEK_CUR) == 0 ? target->stream : NULL;
    exr_context_initializer_t init = callbacks(&writer->file);
    init.write_fn = on_write;
    writer->code = exr_start_write(&writer->context, target->path, EXR_WRITE_FILE_DIRECTLY, &init);
    if (writer->code == EXR_ERR_SUCCESS)
        writer->code = write_header(writer->context, target, shape);
    return writer;
}

whit_result exr_rows_end(struct exr_writer *writer)
{
    const struct image_target *target = writer->target;
    struct memory_file *file = &writer->file;
    whit_result result = WHIT_OK;
    current = file;
    exr_encoding_destroy(writer->context, &writer->encode);
    exr_result_t end_code = finish(&writer->context); /* writes the chunk table */
    exr_result_t code = writer->code == EXR_ERR_SUCCESS ? end_code : writer->code;
    if (code != EXR_ERR_SUCCESS)
        result = report(target->log, target->path, file, code, WHIT_ERROR_OUTPUT);
    else if (!file->stream)
        fwrite(file->data, 1, file->size_bytes, target->stream);
    free(file->data);
    free(writer);
    return result;
}

/* The channels that are read from a file, in the order of the image's. */
struct selection {
    const char *names[CHANNELS_MAX];
    uint32_t count;
    bool integers;
};

static const exr_attr_chlist_entry_t *find_channel(const exr_attr_chlist_t *list, const char *name)
{
    for (int i = 0; i < list->num_channels; ++i) {
        if (strcmp(list->entries[i].name.str, name) == 0)
            return &list->entries[i];
    }
    return NULL;
}

static bool select_named(const exr_attr_chlist_t *list, const char *const *names, uint32_t count,
                         struct selection *selection)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (!find_channel(list, names[i]))
            return false;
        selection->names[i] = names[i];
    }
    selection->count = count;
    return true;
}

static bool all_integers(const exr_attr_chlist_t *list)
{
    for (int i = 0; i < list->num_channels; ++i) {
        if (list->entries[i].pixel_type != EXR_PIXEL_UINT)
            return false;
    }
    return true;
}

/* Chooses RGBA, RGB or Y; else all channels if they are integers; else the file's only channel. */
static bool select_channels(const exr_attr_chlist_t *list, struct selection *selection)
{
    static const char *const colour[] = {"R", "G", "B", "A"}, *const grey[] = {"Y"};
    *selection = (struct selection){0};
    if (list->num_channels < 1)
        return false;
    if (all_integers(list) && list->num_channels <= CHANNELS_MAX) {
        selection->integers = true;
        selection->count = (uint32_t)list->num_channels;
        for (uint32_t i = 0; i < selection->count; ++i)
            selection->names[i] = list->entries[i].name.str;
        return true;
    }
    if (select_named(list, colour, 4, selection) || select_named(list, colour, 3, selection))
        return true;
    bool chroma = find_channel(list, "RY") || find_channel(list, "BY");
    if (!chroma && select_named(list, grey, 1, selection))
        return true;
    selection->names[0] = list->entries[0].name.str;
    selection->count = 1;
    return list->num_channels == 1;
}

static const char *why_not_readable(exr_context_t context, const exr_attr_chlist_t *list,
                                    struct selection *selection)
{
    exr_storage_t storage;
    if (exr_get_storage(context, 0, &storage) != EXR_ERR_SUCCESS ||
        (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED))
        return "deep pictures are not supported";
    if (!select_channels(list, selection))
        return "it has no channels R, G, B or Y";
    for (int i = 0; i < list->num_channels; ++i) {
        if (list->entries[i].x_sampling != 1 || list->entries[i].y_sampling != 1)
            return "subsampled channels are not supported";
    }
    return NULL;
}

/* Checks that a chunk lies within the image. `x`, `y`: of its first pixel. */
static exr_result_t check_chunk(const exr_chunk_info_t *chunk, const struct image *image,
                                uint32_t x, uint32_t y)
{
    bool inside = chunk->width > 0 && chunk->height > 0 && x < image->width && y < image->height &&
                  (uint32_t)chunk->width <= image->width - x &&
                  (uint32_t)chunk->height <= image->height - y;
    return inside ? EXR_ERR_SUCCESS : EXR_ERR_CORRUPT_CHUNK;
}

static void set_destinations(exr_decode_pipeline_t *decode, const struct selection *selection,
                             const struct image *image, uint32_t x, uint32_t y)
{
    size_t row_bytes = (size_t)image->width * image->channels * 4;
    uint8_t *pixels = image->words ? (uint8_t *)image->words : (uint8_t *)image->pixels;
    for (int16_t i = 0; i < decode->channel_count; ++i) {
        exr_coding_channel_info_t *channel = &decode->channels[i];
        channel->decode_to_ptr = NULL;
        for (uint32_t c = 0; c < selection->count; ++c) {
            if (strcmp(selection->names[c], channel->channel_name) != 0)
                continue;
            channel->decode_to_ptr = pixels + y * row_bytes + ((size_t)x * image->channels + c) * 4;
            channel->user_bytes_per_element = 4;
            channel->user_data_type = selection->integers ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
            channel->user_pixel_stride = (int32_t)image->channels * 4;
            channel->user_line_stride = (int32_t)row_bytes;
        }
    }
}

struct decoder {
    exr_context_t context;
    const struct selection *selection;
    const struct image *image;
    exr_decode_pipeline_t pipeline;
    bool started;
};

static exr_result_t decode_chunk(struct decoder *decoder, const exr_chunk_info_t *chunk, uint32_t x,
                                 uint32_t y)
{
    exr_result_t code = check_chunk(chunk, decoder->image, x, y);
    if (code != EXR_ERR_SUCCESS)
        return code;
    exr_decode_pipeline_t *pipeline = &decoder->pipeline;
    code = decoder->started ? exr_decoding_update(decoder->context, 0, chunk, pipeline)
                            : exr_decoding_initialize(decoder->context, 0, chunk, pipeline);
    if (code != EXR_ERR_SUCCESS)
        return code;
    set_destinations(pipeline, decoder->selection, decoder->image, x, y);
    if (!decoder->started)
        code = exr_decoding_choose_default_routines(decoder->context, 0, pipeline);
    decoder->started = true;
    return code == EXR_ERR_SUCCESS ? exr_decoding_run(decoder->context, 0, pipeline) : code;
}

/* Decodes chunk by chunk: tiles, or as many rows as the compression puts together. */
static exr_result_t decode_pixels(exr_context_t context, const struct selection *selection,
                                  const struct image *image, int32_t top)
{
    exr_storage_t storage;
    int32_t width = (int32_t)image->width, height = 0;
    struct decoder decoder = {.context = context, .selection = selection, .image = image};
    exr_result_t code = exr_get_storage(context, 0, &storage);
    bool tiled = code == EXR_ERR_SUCCESS && storage == EXR_STORAGE_TILED;
    if (code == EXR_ERR_SUCCESS)
        code = tiled ? exr_get_tile_sizes(context, 0, 0, 0, &width, &height)
                     : exr_get_scanlines_per_chunk(context, 0, &height);
    if (code == EXR_ERR_SUCCESS && (width < 1 || height < 1))
        code = EXR_ERR_CORRUPT_CHUNK;
    uint32_t step_x = (uint32_t)width, step_y = (uint32_t)height;
    for (uint32_t y = 0; y < image->height && code == EXR_ERR_SUCCESS; y += step_y) {
        for (uint32_t x = 0; x < image->width && code == EXR_ERR_SUCCESS; x += step_x) {
            exr_chunk_info_t chunk;
            code = tiled ? exr_read_tile_chunk_info(context, 0, (int)(x / step_x),
                                                    (int)(y / step_y), 0, 0, &chunk)
                         : exr_read_scanline_chunk_info(context, 0, top + (int)y, &chunk);
            if (code == EXR_ERR_SUCCESS)
                code = decode_chunk(&decoder, &chunk, x, y);
        }
    }
    exr_decoding_destroy(context, &decoder.pipeline);
    return code;
}

static exr_result_t open_memory(const struct image_source *source, struct memory_file *file,
                                exr_context_t *context)
{
    *file = (struct memory_file){.read_data = source->data, .size_bytes = source->size_bytes};
    exr_context_initializer_t init = callbacks(file);
    init.read_fn = on_read;
    init.size_fn = on_size;
    *context = NULL;
    return exr_start_read(context, source->path, &init);
}

whit_result exr_load(const struct image_source *source, struct image *image)
{
    struct memory_file file;
    exr_context_t context;
    const exr_attr_chlist_t *list = NULL;
    exr_attr_box2i_t window = {0};
    struct selection selection;
    whit_result result = WHIT_OK;
    exr_result_t code = open_memory(source, &file, &context);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_channels(context, 0, &list);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_data_window(context, 0, &window);
    if (code != EXR_ERR_SUCCESS)
        goto fail;
    const char *reason = why_not_readable(context, list, &selection);
    if (reason) {
        log_error(source->log, "%s: EXR: %s", source->path, reason);
        result = WHIT_ERROR_INPUT;
        goto done;
    }
    int64_t width = (int64_t)window.max.x - window.min.x + 1;
    int64_t height = (int64_t)window.max.y - window.min.y + 1;
    result =
        image_init_loaded(source, image, width < 0 ? 0 : (uint64_t)width,
                          height < 0 ? 0 : (uint64_t)height, selection.count, selection.integers);
    if (result != WHIT_OK)
        goto done;
    code = decode_pixels(context, &selection, image, window.min.y);
fail:
    if (code != EXR_ERR_SUCCESS)
        result = report(source->log, source->path, &file, code, WHIT_ERROR_INPUT);
done:
    finish(&context);
    return result;
}

static bool is_recipe(const exr_attribute_t *attribute)
{
    return attribute->type == EXR_ATTR_STRING && attribute->string && attribute->string->str &&
           strcmp(attribute->name, "name") != 0 && strcmp(attribute->name, "type") != 0;
}

whit_result exr_load_texts(const struct image_source *source, struct text_list *list)
{
    struct memory_file file;
    exr_context_t context;
    int32_t count = 0;
    exr_result_t code = open_memory(source, &file, &context);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_attribute_count(context, 0, &count);
    for (int32_t i = 0; i < count && code == EXR_ERR_SUCCESS; ++i) {
        const exr_attribute_t *attribute;
        code = exr_get_attribute_by_index(context, 0, EXR_ATTR_LIST_FILE_ORDER, i, &attribute);
        if (code == EXR_ERR_SUCCESS && is_recipe(attribute) &&
            !text_list_add(list, attribute->name, attribute->string->str))
            code = EXR_ERR_OUT_OF_MEMORY;
    }
    whit_result result = WHIT_OK;
    if (code != EXR_ERR_SUCCESS)
        result = report(source->log, source->path, &file, code, WHIT_ERROR_INPUT);
    finish(&context);
    return result;
}
