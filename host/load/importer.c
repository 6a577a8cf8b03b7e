#include "load/importer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"

/* A reply holds at most this many times the size of the files, plus a constant: a vertex of an OBJ
   face needs 4 characters at least and comes back as 48 bytes and its index. */
#define REPLY_PER_BYTE 64
#define REPLY_BASE     (UINT64_C(64) << 20)

uint32_t importer_array_words(enum import_array array)
{
    static const uint32_t words[IMPORT_ARRAY_COUNT] = {3, 3, 2, 2, 4, 4, 3};
    return words[array];
}

/* *spent: total size of all records' strings and arrays so far. It may not exceed the block's size,
   so that records of a small block cannot share one array many times. */
static bool check_string(const uint8_t *data, size_t size_bytes, uint64_t offset, uint32_t bytes,
                         uint64_t *spent, const char **out)
{
    *spent += (uint64_t)bytes + 1;
    if (offset > size_bytes || size_bytes - offset < (uint64_t)bytes + 1 || *spent > size_bytes)
        return false;
    if (data[offset + bytes] != 0 || memchr(data + offset, 0, bytes))
        return false;
    *out = (const char *)data + offset;
    return true;
}

static bool check_indices(const uint32_t *indices, uint32_t triangle_count, uint32_t vertex_count)
{
    uint32_t largest = 0;
    for (size_t i = 0; i < (size_t)triangle_count * 3; i++)
        largest = indices[i] > largest ? indices[i] : largest;
    return largest < vertex_count;
}

static bool check_array(const uint8_t *data, size_t size_bytes, const struct import_record *record,
                        enum import_array array, uint64_t *spent, const void **out)
{
    *out = NULL;
    uint64_t offset = record->arrays[array];
    if (offset == 0)
        return array != IMPORT_POSITIONS && array != IMPORT_INDICES;
    uint64_t count = array == IMPORT_INDICES ? record->triangle_count : record->vertex_count;
    uint64_t bytes = count * importer_array_words(array) * 4;
    *spent += bytes;
    if (offset % 4 || offset > size_bytes || size_bytes - offset < bytes || *spent > size_bytes)
        return false;
    *out = data + offset;
    return true;
}

static bool check_record(const uint8_t *data, size_t size_bytes, const struct import_record *record,
                         uint64_t *spent, struct import_part *part)
{
    const void *arrays[IMPORT_ARRAY_COUNT];
    for (int i = 0; i < IMPORT_ARRAY_COUNT; i++)
        if (!check_array(data, size_bytes, record, (enum import_array)i, spent, &arrays[i]))
            return false;
    *part = (struct import_part){
        .vertex_count = record->vertex_count,
        .triangle_count = record->triangle_count,
        .positions = arrays[IMPORT_POSITIONS],
        .normals = arrays[IMPORT_NORMALS],
        .uvs = {arrays[IMPORT_UV0], arrays[IMPORT_UV1]},
        .colors = arrays[IMPORT_COLORS],
        .tangents = arrays[IMPORT_TANGENTS],
        .indices = arrays[IMPORT_INDICES],
    };
    return record->vertex_count > 0 && record->triangle_count > 0 &&
           check_string(data, size_bytes, record->name, record->name_bytes, spent, &part->name) &&
           check_string(data, size_bytes, record->material, record->material_bytes, spent,
                        &part->material) &&
           check_indices(part->indices, part->triangle_count, part->vertex_count);
}

bool importer_parse(const uint8_t *data, size_t size_bytes, struct import_block *block,
                    char *reason, size_t reason_bytes)
{
    struct import_header header;
    uint32_t magic = 0;
    if (size_bytes >= sizeof magic)
        memcpy(&magic, data, sizeof magic);
    if (magic == IMPORT_ERROR_MAGIC) {
        foreign_text(data + sizeof magic, size_bytes - sizeof magic, reason, reason_bytes);
        return false;
    }
    snprintf(reason, reason_bytes, "the importer's reply is damaged");
    if (magic != IMPORT_MAGIC || size_bytes < sizeof header)
        return false;
    memcpy(&header, data, sizeof header);
    size_t room = size_bytes - sizeof header;
    if (header.size_bytes != size_bytes || header.part_count > room / sizeof(struct import_record))
        return false;
    block->counts = header.counts;
    if (header.part_count == 0 && room) {
        block->glb = data + sizeof header;
        block->glb_bytes = room;
        return true;
    }
    block->parts = array_alloc_zeroed(header.part_count, sizeof *block->parts);
    if (!block->parts) {
        snprintf(reason, reason_bytes, "out of memory");
        return false;
    }
    uint64_t spent = 0;
    for (uint32_t i = 0; i < header.part_count; i++) {
        struct import_record record;
        memcpy(&record, data + sizeof header + i * sizeof record, sizeof record);
        if (!check_record(data, size_bytes, &record, &spent, &block->parts[i]))
            return false;
    }
    block->part_count = header.part_count;
    return true;
}

/* Logs assimp's reason with the real path in place of the name under which assimp got the file. */
static void log_reason(const whit_log *log, const char *path, const char *handed_name,
                       const char *reason)
{
    const char *at = handed_name[0] ? strstr(reason, handed_name) : NULL;
    if (at)
        log_error(log, "%s: %.*s%s%s", path, (int)(at - reason), reason, path_name(path),
                  at + strlen(handed_name));
    else
        log_error(log, "%s: %s", path, reason);
}

whit_result importer_run(const whit_log *log, const char *path,
                         const struct import_request *request, const whit_load_params *params,
                         struct import_block *block)
{
    *block = (struct import_block){0};
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < request->file_count; i++)
        bytes += request->files[i].size_bytes;
    const struct foreign_params foreign = load_foreign(params);
    struct child_limits limits =
        foreign_limits(&foreign, "importer", bytes, bytes * REPLY_PER_BYTE + REPLY_BASE);
    struct import_request copy = *request;
    char reason[FOREIGN_REASON_BYTES];
    whit_result result =
        foreign_run(log, &limits, importer_assimp_run, &copy, &block->reply, reason);
    if (result != WHIT_OK) {
        log_error(log, "%s: %s", path, reason);
        importer_finish(block);
        return result;
    }
    if (!importer_parse(block->reply.data, block->reply.size_bytes, block, reason, sizeof reason)) {
        log_reason(log, path, request->files[0].name, reason);
        importer_finish(block);
        return WHIT_ERROR_INPUT;
    }
    return WHIT_OK;
}

void importer_finish(struct import_block *block)
{
    free(block->parts);
    child_reply_free(&block->reply);
    *block = (struct import_block){0};
}
