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

/* The bytes of a reply that were not read yet. */
struct rest {
    uint8_t *at;
    size_t bytes;
};

/* The next bytes; NULL: there are not as many. */
static void *take(struct rest *rest, size_t bytes)
{
    size_t padded = (bytes + 3) & ~(size_t)3;
    if (padded > rest->bytes)
        return NULL;
    void *taken = rest->at;
    rest->at += padded;
    rest->bytes -= padded;
    return taken;
}

static char *take_string(struct rest *rest, uint32_t bytes)
{
    char *text = take(rest, (size_t)bytes + 1);
    return text && memchr(text, 0, (size_t)bytes + 1) == text + bytes ? text : NULL;
}

static bool check_indices(const struct part *part)
{
    const uint32_t *indices = part->arrays[PART_INDICES];
    uint32_t largest = 0;
    for (size_t i = 0; i < (size_t)part->triangle_count * 3; i++)
        largest = indices[i] > largest ? indices[i] : largest;
    return largest < part->vertex_count;
}

static bool take_part(struct rest *rest, struct part *part)
{
    const uint32_t needed = 1u << PART_POSITIONS | 1u << PART_INDICES;
    const struct import_record *record = take(rest, sizeof *record);
    if (!record || (record->arrays & needed) != needed || record->arrays >> PART_ARRAY_COUNT)
        return false;
    part->vertex_count = record->vertex_count;
    part->triangle_count = record->triangle_count;
    part->name = take_string(rest, record->name_bytes);
    part->material = part->name ? take_string(rest, record->material_bytes) : NULL;
    bool there = part->material && part->vertex_count && part->triangle_count;
    for (int i = 0; there && i < PART_ARRAY_COUNT; i++) {
        if (record->arrays >> i & 1)
            part->arrays[i] = take(rest, part_bytes(part, (enum part_array)i));
        there = part->arrays[i] || !(record->arrays >> i & 1);
    }
    return there && check_indices(part);
}

whit_result importer_parse(uint8_t *data, size_t size_bytes, struct import_block *block)
{
    struct rest rest = {data, size_bytes};
    const struct import_header *header = take(&rest, sizeof *header);
    if (!header || header->part_count > rest.bytes / sizeof(struct import_record))
        return WHIT_ERROR_INPUT;
    block->counts = header->counts;
    if (header->part_count == 0 && rest.bytes) {
        block->glb = rest.at;
        block->glb_bytes = rest.bytes;
        return WHIT_OK;
    }
    block->parts = array_alloc_zeroed(header->part_count, sizeof *block->parts);
    if (!block->parts)
        return WHIT_ERROR_MEMORY;
    block->part_count = header->part_count;
    for (uint32_t i = 0; i < block->part_count; i++)
        if (!take_part(&rest, &block->parts[i]))
            return WHIT_ERROR_INPUT;
    return rest.bytes ? WHIT_ERROR_INPUT : WHIT_OK;
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
    struct foreign_answer answer;
    whit_result result =
        foreign_ask(log, &limits, importer_assimp_run, &copy, &block->reply, &answer);
    if (result != WHIT_OK) {
        log_reason(log, path, request->files[0].name, answer.reason);
        if (answer.result == WHIT_ERROR_MEMORY) /* no answer of importer_assimp_run */
            result = WHIT_ERROR_INPUT;
    } else {
        result = importer_parse(block->reply.data, block->reply.size_bytes - sizeof answer, block);
        if (result != WHIT_OK)
            log_error(log, "%s: %s", path,
                      result == WHIT_ERROR_MEMORY ? "out of memory"
                                                  : "the importer's reply is damaged");
    }
    if (result != WHIT_OK)
        importer_finish(block);
    return result;
}

void importer_finish(struct import_block *block)
{
    free(block->parts);
    child_reply_free(&block->reply);
    *block = (struct import_block){0};
}
