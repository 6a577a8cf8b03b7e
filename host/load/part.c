#include "load/part.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/same.h"
#include "base/vec.h"

void part_finish(struct part *part)
{
    for (int i = 0; i < PART_ARRAY_COUNT; i++)
        free(part->arrays[i]);
    free(part->name);
    free(part->material);
}

uint32_t part_words(enum part_array array)
{
    static const uint32_t words[PART_ARRAY_COUNT] = {3, 3, 2, 2, 4, 4, 3};
    return words[array];
}

size_t part_bytes(const struct part *part, enum part_array array)
{
    size_t count = array == PART_INDICES ? part->triangle_count : part->vertex_count;
    return count * part_words(array) * 4;
}

void *part_add(struct part *part, enum part_array array)
{
    part->arrays[array] = array_alloc(part_bytes(part, array), 1);
    return part->arrays[array];
}

/* --- normals ------------------------------------------------------------------------------- */

static void triangle_cross(const struct part *part, uint32_t triangle, double out[3])
{
    const float *positions = part->arrays[PART_POSITIONS];
    const uint32_t *index = (const uint32_t *)part->arrays[PART_INDICES] + (size_t)triangle * 3;
    double a[3], b[3];
    for (int i = 0; i < 3; i++) {
        double origin = positions[(size_t)index[0] * 3 + (size_t)i];
        a[i] = positions[(size_t)index[1] * 3 + (size_t)i] - origin;
        b[i] = positions[(size_t)index[2] * 3 + (size_t)i] - origin;
    }
    double3_cross(a, b, out);
    double length = double3_length(out);
    for (int i = 0; i < 3; i++)
        out[i] = length > 0 && isfinite(length) ? out[i] / length : 0;
}

static bool usable_normal(const float *n)
{
    double length = (double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2];
    return length > 1e-20 && isfinite(length);
}

/* Replaces zero normals, which assimp leaves where the file has none, by those of the faces. */
static bool repair_normals(struct part *part)
{
    float *normals = part->arrays[PART_NORMALS];
    uint32_t vertex_count = part->vertex_count, bad = 0;
    uint8_t *is_bad = normals ? array_alloc_zeroed(vertex_count, 1) : NULL;
    if (!is_bad)
        return !normals;
    for (uint32_t i = 0; i < vertex_count; i++) {
        if (usable_normal(normals + (size_t)i * 3))
            continue;
        memset(normals + (size_t)i * 3, 0, 3 * sizeof *normals);
        is_bad[i] = 1;
        bad++;
    }
    const uint32_t *indices = part->arrays[PART_INDICES];
    for (uint32_t i = 0; bad && i < part->triangle_count; i++) {
        double cross[3];
        triangle_cross(part, i, cross);
        for (int corner = 0; corner < 3; corner++) {
            uint32_t vertex = indices[(size_t)i * 3 + (size_t)corner];
            for (int k = 0; is_bad[vertex] && k < 3; k++)
                normals[(size_t)vertex * 3 + (size_t)k] += (float)cross[k];
        }
    }
    for (uint32_t i = 0; bad && i < vertex_count; i++)
        if (!usable_normal(normals + (size_t)i * 3))
            memcpy(normals + (size_t)i * 3, (float[3]){0, 1, 0}, 3 * sizeof *normals);
    free(is_bad);
    return true;
}

/* Gives each corner of each triangle a vertex of its own. */
static bool expand(struct part *part)
{
    const uint32_t *old = part->arrays[PART_INDICES];
    uint32_t corners = part->triangle_count * 3;
    if (part->triangle_count > UINT32_MAX / 3)
        return false;
    for (int array = 0; array < PART_INDICES; array++) {
        const uint32_t *from = part->arrays[array];
        size_t words = part_words((enum part_array)array);
        uint32_t *to = from ? array_alloc(corners, words * 4) : NULL;
        if (from && !to)
            return false;
        for (size_t i = 0; to && i < corners; i++)
            memcpy(to + i * words, from + old[i] * words, words * 4);
        free(part->arrays[array]);
        part->arrays[array] = to;
    }
    uint32_t *indices = part->arrays[PART_INDICES];
    for (uint32_t i = 0; i < corners; i++)
        indices[i] = i;
    part->vertex_count = corners;
    return true;
}

/* Adds flat normals to a part without normals, where other parts of the mesh have some. */
static bool add_flat_normals(struct part *part)
{
    if (!expand(part))
        return false;
    float *normals = part_add(part, PART_NORMALS);
    for (uint32_t i = 0; normals && i < part->triangle_count; i++) {
        double cross[3];
        triangle_cross(part, i, cross);
        for (size_t k = 0; k < 9; k++)
            normals[(size_t)i * 9 + k] = (float)cross[k % 3];
    }
    return normals;
}

/* --- welding ------------------------------------------------------------------------------- */

struct weld {
    uint32_t stride; /* words per record */
    uint32_t *records;
    uint32_t *table; /* index + 1 of a record; 0: free */
    size_t mask;
};

static size_t hash_words(const uint32_t *words, uint32_t count)
{
    uint64_t h = 0x9e3779b97f4a7c15u;
    for (uint32_t i = 0; i < count; i++) {
        h = (h ^ words[i]) * 0xff51afd7ed558ccdu;
        h ^= h >> 32;
    }
    return (size_t)h;
}

static bool weld_init(struct weld *weld, const struct part *part)
{
    uint32_t count = part->vertex_count;
    size_t slots = 16;
    *weld = (struct weld){0};
    for (int array = 0; array < PART_INDICES; array++)
        if (part->arrays[array])
            weld->stride += part_words((enum part_array)array);
    while (slots < (size_t)count * 2)
        slots *= 2;
    weld->mask = slots - 1;
    weld->records = array_alloc(count, weld->stride * sizeof *weld->records);
    weld->table = array_alloc_zeroed(slots, sizeof *weld->table);
    return weld->records && weld->table;
}

/* Copies vertices from the part's arrays into the records, or with `back` from there into the
   arrays. A record holds all attributes of one vertex. */
static void interleave(struct weld *weld, struct part *part, bool back)
{
    uint32_t at = 0;
    for (int array = 0; array < PART_INDICES; array++) {
        uint32_t words = part_words((enum part_array)array);
        uint32_t *plain = part->arrays[array];
        if (!plain)
            continue;
        for (size_t i = 0; i < part->vertex_count; i++) {
            uint32_t *record = weld->records + i * weld->stride + at;
            for (uint32_t k = 0; k < words; k++)
                *(back ? &plain[i * words + k] : &record[k]) =
                    back ? record[k] : plain[i * words + k];
        }
        at += words;
    }
}

static uint32_t weld_find(struct weld *weld, uint32_t vertex, uint32_t unique_count)
{
    const uint32_t *record = weld->records + (size_t)vertex * weld->stride;
    size_t slot = hash_words(record, weld->stride) & weld->mask;
    for (; weld->table[slot]; slot = (slot + 1) & weld->mask) {
        uint32_t other = weld->table[slot] - 1;
        if (!memcmp(weld->records + (size_t)other * weld->stride, record, weld->stride * 4))
            return other;
    }
    weld->table[slot] = unique_count + 1;
    memmove(weld->records + (size_t)unique_count * weld->stride, record, weld->stride * 4);
    return unique_count;
}

/* Merges vertices that are identical in all bits; vertices are ordered by their first use. */
static bool weld_part(struct part *part)
{
    struct weld weld;
    uint32_t *indices = part->arrays[PART_INDICES], unique_count = 0;
    uint32_t *moved = array_alloc(part->vertex_count, sizeof *moved);
    bool ok = weld_init(&weld, part) && moved;
    if (ok) {
        interleave(&weld, part, false);
        for (uint32_t i = 0; i < part->vertex_count; i++) {
            moved[i] = weld_find(&weld, i, unique_count);
            unique_count += moved[i] == unique_count;
        }
        for (size_t i = 0; i < (size_t)part->triangle_count * 3; i++)
            indices[i] = moved[indices[i]];
        part->vertex_count = unique_count;
        interleave(&weld, part, true);
    }
    free(weld.records);
    free(weld.table);
    free(moved);
    return ok;
}

/* --- smoothing groups ------------------------------------------------------------------------ */

/* Copies positions, normals and triangles of all parts into one, whose equal vertices are merged.
   False when memory runs out; *out is then to be released too. */
static bool join_parts(const struct part *parts, uint32_t count, struct part *out)
{
    for (uint32_t i = 0; i < count; i++) {
        out->vertex_count += parts[i].vertex_count;
        out->triangle_count += parts[i].triangle_count;
    }
    float *positions = part_add(out, PART_POSITIONS), *normals = part_add(out, PART_NORMALS);
    uint32_t *indices = part_add(out, PART_INDICES), first = 0;
    for (uint32_t i = 0; positions && normals && indices && i < count; i++) {
        const float *from = parts[i].arrays[PART_POSITIONS];
        const float *marks = parts[i].arrays[PART_NORMALS];
        const uint32_t *corners = parts[i].arrays[PART_INDICES];
        for (size_t k = 0; k < (size_t)parts[i].vertex_count * 3; k++) {
            *positions++ =
                from[k] + 0.0f; /* a negative zero becomes zero, since bits are compared */
            *normals++ = marks ? marks[k] : 0.0f;
        }
        for (size_t k = 0; k < (size_t)parts[i].triangle_count * 3; k++)
            *indices++ = corners[k] + first;
        first += parts[i].vertex_count;
    }
    return positions && normals && indices && weld_part(out);
}

static void add_corner(const struct part *part, uint32_t triangle, uint32_t corner, double *sums)
{
    const float *positions = part->arrays[PART_POSITIONS];
    const uint32_t *index = (const uint32_t *)part->arrays[PART_INDICES] + (size_t)triangle * 3;
    const float *at = positions + (size_t)index[corner] * 3;
    double normal[3], edges[2][3];
    triangle_cross(part, triangle, normal);
    for (uint32_t i = 0; i < 2; i++)
        for (size_t k = 0; k < 3; k++)
            edges[i][k] = (double)positions[(size_t)index[(corner + i + 1) % 3] * 3 + k] - at[k];
    double angle = same_atan2(double3_area(edges[0], edges[1]), double3_dot(edges[0], edges[1]));
    for (size_t k = 0; k < 3; k++)
        sums[(size_t)index[corner] * 3 + k] += angle * normal[k];
}

bool parts_smooth(struct part *parts, uint32_t count)
{
    struct part joined = {0};
    bool ok = join_parts(parts, count, &joined);
    double *sums = ok ? array_alloc_zeroed(joined.vertex_count, 3 * sizeof *sums) : NULL;
    const uint32_t *corners = joined.arrays[PART_INDICES];
    const float *marks = joined.arrays[PART_NORMALS];
    for (size_t i = 0; sums && i < (size_t)joined.triangle_count * 3; i++)
        add_corner(&joined, (uint32_t)(i / 3), (uint32_t)(i % 3), sums);
    for (uint32_t i = 0; sums && i < count; i++) {
        float *normals = parts[i].arrays[PART_NORMALS];
        const uint32_t *indices = parts[i].arrays[PART_INDICES];
        for (size_t k = 0; k < (size_t)parts[i].triangle_count * 3; k++, corners++) {
            double *sum = sums + (size_t)*corners * 3, length = double3_length(sum);
            for (size_t axis = 0; marks[(size_t)*corners * 3] > 0 && axis < 3; axis++)
                normals[(size_t)indices[k] * 3 + axis] =
                    length > 0 ? (float)(sum[axis] / length) : 0;
        }
    }
    ok = sums != NULL;
    free(sums);
    part_finish(&joined);
    return ok;
}

/* --- parts of a mesh ------------------------------------------------------------------------- */

bool parts_complete(struct part *parts, uint32_t count, bool corners)
{
    bool shaded = false;
    for (uint32_t i = 0; i < count; i++)
        shaded |= parts[i].arrays[PART_NORMALS] != NULL;
    for (uint32_t i = 0; i < count; i++) {
        bool flat = shaded && !parts[i].arrays[PART_NORMALS];
        if (flat ? !add_flat_normals(&parts[i]) : !repair_normals(&parts[i]))
            return false;
        if ((corners || flat) && !weld_part(&parts[i]))
            return false;
    }
    return true;
}
