#include "load/texture_ahead.h"

#include <stdatomic.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/threads.h"

/* Encoded pictures are kept up to this size together, and up to the scene's limit on memory. */
#define BYTES_MAX ((uint64_t)256 << 20)

struct entry {
    struct texture_source source;
    struct picture picture; /* without rgba: it is left to picture_read */
};

struct texture_ahead {
    struct key_table keys; /* index of the entry by each of its keys */
    struct entry **entries;
    uint32_t count, capacity;
    uint64_t bytes;
};

static struct entry *find(const struct scene *scene, const struct texture_key *key)
{
    uint32_t at;
    return scene->ahead && key_table_find(&scene->ahead->keys, key, sizeof *key, &at)
               ? scene->ahead->entries[at]
               : NULL;
}

static void destroy_entry(struct entry *entry)
{
    if (!entry)
        return;
    free(entry->source.owned);
    picture_finish(&entry->picture);
    free(entry);
}

/* Takes the entry, whatever becomes of it. Keys that do not fit into the table are not found. */
static void add(struct scene *scene, struct entry *entry)
{
    struct texture_ahead *ahead = scene->ahead;
    if (!ARRAY_PUSH(ahead->entries, ahead->count, ahead->capacity, entry)) {
        destroy_entry(entry);
        return;
    }
    ahead->bytes += entry->source.size_bytes;
    for (uint32_t i = 0; i < entry->source.key_count; ++i)
        (void)key_table_add(&ahead->keys, &entry->source.keys[i], sizeof entry->source.keys[i],
                            ahead->count - 1);
}

/* Reads a source that is neither a texture of the scene nor was named before. */
static bool read_new(const struct scene *scene, const char *name, const whit_load_params *params,
                     struct entry *entry)
{
    struct texture_source *source = &entry->source;
    char reason[FOREIGN_REASON_BYTES];
    uint32_t index;
    if (scene_find_texture(scene, name, &index))
        return false;
    if (!source->data) {
        texture_key_file(name, params, source);
        if (source->key_count == 0 || find(scene, source->keys) ||
            roots_reach(&scene->roots, name) != REACH_FILE)
            return false;
    }
    return texture_read(scene, name, params, source, reason) == WHIT_OK &&
           !find(scene, &source->keys[source->key_count - 1]);
}

void load_texture_soon(struct scene *scene, const char *path, const uint8_t *data,
                       size_t size_bytes, const whit_load_params *params)
{
    if (!scene->ahead)
        scene->ahead = array_alloc_zeroed(1, sizeof *scene->ahead);
    if (!scene->ahead || scene->ahead->bytes > BYTES_MAX || scene->ahead->bytes > scene_room(scene))
        return;
    char *name = data ? string_copy(path) : picture_find(&scene->roots, path);
    struct entry *entry = name ? array_alloc_zeroed(1, sizeof *entry) : NULL;
    if (entry) {
        entry->source = (struct texture_source){.data = data, .size_bytes = size_bytes};
        if (read_new(scene, name, params, entry))
            add(scene, entry);
        else
            destroy_entry(entry);
    }
    free(name);
}

struct decoding {
    struct entry **entries;
    const whit_log *log;
    struct foreign_params foreign;
    uint32_t threads;
    atomic_uint_least64_t pixels_left;
};

/* Each thread reserves an equal share of the pixels that are left, so that all pictures together
   stay below the limit at any time. */
static uint64_t reserve(struct decoding *decoding)
{
    uint64_t left = atomic_load(&decoding->pixels_left), share;
    do
        share = left / decoding->threads;
    while (!atomic_compare_exchange_weak(&decoding->pixels_left, &left, left - share));
    return share;
}

static void decode_entry(void *context, uint32_t index)
{
    struct decoding *decoding = context;
    struct entry *entry = decoding->entries[index];
    struct picture *picture = &entry->picture;
    char reason[FOREIGN_REASON_BYTES];
    uint64_t share = reserve(decoding);
    whit_result result = picture_read(decoding->log, &decoding->foreign, share, entry->source.data,
                                      entry->source.size_bytes, picture, reason);
    uint64_t pixels = result == WHIT_OK ? (uint64_t)picture->width * picture->height : 0;
    atomic_fetch_add(&decoding->pixels_left, share - pixels);
}

static int by_size(const void *a, const void *b)
{
    size_t x = (*(struct entry *const *)a)->source.size_bytes;
    size_t y = (*(struct entry *const *)b)->source.size_bytes;
    return (x < y) - (x > y);
}

void load_textures_ahead(struct scene *scene, const whit_load_params *params)
{
    uint32_t count = scene->ahead ? scene->ahead->count : 0;
    struct decoding decoding = {.log = &scene->log, .foreign = load_foreign(params)};
    uint32_t cores = threads_available();
    decoding.threads = cores < count ? cores : count;
    if (decoding.threads > 1)
        decoding.entries = array_copy(scene->ahead->entries, count, sizeof *decoding.entries);
    if (!decoding.entries)
        return;
    atomic_init(&decoding.pixels_left, scene_room(scene) / scene_texture_cost(1, 1));
    /* The largest first, as it takes longest. */
    qsort(decoding.entries, count, sizeof *decoding.entries, by_size);
    threads_for(decoding.threads, count, decode_entry, &decoding);
    free(decoding.entries);
}

void load_textures_end(struct scene *scene)
{
    struct texture_ahead *ahead = scene->ahead;
    scene->ahead = NULL;
    for (uint32_t i = 0; ahead && i < ahead->count; ++i)
        destroy_entry(ahead->entries[i]);
    if (!ahead)
        return;
    key_table_finish(&ahead->keys);
    free(ahead->entries);
    free(ahead);
}

void texture_take_source(struct scene *scene, struct texture_source *source)
{
    struct entry *entry = source->key_count > 0 ? find(scene, source->keys) : NULL;
    if (!entry || !entry->source.data)
        return;
    *source = entry->source;
    entry->source.owned = NULL;
    entry->source.data = NULL;
}

bool texture_take_picture(struct scene *scene, const struct texture_source *source,
                          uint64_t pixels_max, struct picture *out)
{
    struct entry *entry = find(scene, &source->keys[source->key_count - 1]);
    if (!entry || !entry->picture.rgba ||
        (uint64_t)entry->picture.width * entry->picture.height > pixels_max)
        return false;
    *out = entry->picture;
    entry->picture = (struct picture){0};
    return true;
}
