/* The ray tree of a pixel as rows of a table: branches with the most radiance come first, and
   shadow rays that ended alike are one row. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "whit/whit_probe.h"

struct family {
    const whit_probe_report *report;
    double *brought;                /* by ray: radiance of it and of all its branches */
    uint32_t *first_child, *next;   /* list of branches, most radiance first; WHIT_NONE: end */
    uint32_t *first_shadow, *after; /* list of shadow rays, in the order of the report */
    whit_probe_row *rows;
    uint32_t row_count;
};

static bool is_same_hit(const whit_probe_hit *a, const whit_probe_hit *b)
{
    return a->instance == b->instance;
}

/* Whether two shadow rays of one hit ended in the same way; they may go to other points of the
   light. */
static bool ended_alike(const whit_probe_ray *a, const whit_probe_ray *b)
{
    return a->light == b->light && a->end == b->end && a->material == b->material &&
           a->passed == b->passed && a->equal == b->equal && a->exact_known == b->exact_known &&
           a->exact_equal == b->exact_equal && is_same_hit(&a->device, &b->device) &&
           is_same_hit(&a->twin, &b->twin) && is_same_hit(&a->exact, &b->exact);
}

static whit_probe_row row_of(const struct family *f, uint32_t ray)
{
    whit_probe_row row = {.ray = ray, .count = 1};
    memcpy(row.added, f->report->rays[ray].added, sizeof row.added);
    return row;
}

static void fold(whit_probe_row *row, const whit_probe_ray *ray)
{
    ++row->count;
    for (int i = 0; i < 3; ++i)
        row->added[i] += (ray->added[i] - row->added[i]) / (float)row->count;
}

/* Adds rows for the shadow rays at a ray's hit; those that reach their light come first. */
static void add_shadows(struct family *f, uint32_t ray)
{
    const whit_probe_ray *rays = f->report->rays;
    uint32_t begin = f->row_count;
    for (uint32_t i = f->first_shadow[ray]; i != WHIT_NONE; i = f->after[i]) {
        uint32_t row = begin;
        while (row < f->row_count && !ended_alike(&rays[f->rows[row].ray], &rays[i]))
            ++row;
        if (row < f->row_count) {
            fold(&f->rows[row], &rays[i]);
            continue;
        }
        for (row = f->row_count++; row > begin && rays[f->rows[row - 1].ray].end > rays[i].end;
             --row)
            f->rows[row] = f->rows[row - 1];
        f->rows[row] = row_of(f, i);
    }
}

/* Inserts a branch into its parent's list, behind those with at least as much radiance. */
static void insert_child(struct family *f, uint32_t parent, uint32_t child)
{
    uint32_t *link = &f->first_child[parent];
    while (*link != WHIT_NONE && f->brought[*link] >= f->brought[child])
        link = &f->next[*link];
    f->next[child] = *link;
    *link = child;
}

/* Fills all lists and sums. Parents come before their branches in the report. */
static void link_rays(struct family *f)
{
    const whit_probe_ray *rays = f->report->rays;
    uint32_t count = f->report->ray_count;
    for (uint32_t i = 0; i < count; ++i) {
        f->first_child[i] = f->next[i] = f->first_shadow[i] = f->after[i] = WHIT_NONE;
        for (int k = 0; rays[i].kind != WHIT_RAY_SHADOW && k < 3; ++k)
            f->brought[i] += (double)rays[i].added[k];
    }
    for (uint32_t i = count; i-- > 0;) {
        uint32_t parent = rays[i].parent;
        if (parent != WHIT_NONE && rays[i].kind != WHIT_RAY_SHADOW)
            f->brought[parent] += f->brought[i];
        if (parent != WHIT_NONE && rays[i].kind == WHIT_RAY_SHADOW) {
            f->after[i] = f->first_shadow[parent];
            f->first_shadow[parent] = i;
        }
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (rays[i].parent != WHIT_NONE && rays[i].kind != WHIT_RAY_SHADOW)
            insert_child(f, rays[i].parent, i);
    }
}

/* Adds all rows depth first, without recursion: goes to a ray's first branch, or else to the next
   sibling of the nearest ancestor that has one. */
static void add_rows(struct family *f)
{
    const whit_probe_ray *rays = f->report->rays;
    uint32_t ray = f->report->ray_count > 0 ? 0 : WHIT_NONE;
    while (ray != WHIT_NONE) {
        f->rows[f->row_count++] = row_of(f, ray);
        add_shadows(f, ray);
        uint32_t to = f->first_child[ray];
        while (to == WHIT_NONE && ray != WHIT_NONE) {
            to = f->next[ray];
            ray = rays[ray].parent;
        }
        ray = to;
    }
}

whit_result whit_probe_rows(const whit_probe_report *report, whit_probe_row **rows, uint32_t *count)
{
    size_t n = report->ray_count;
    uint32_t *links = array_alloc(4 * n, sizeof *links);
    struct family f = {.report = report,
                       .brought = array_alloc_zeroed(n, sizeof *f.brought),
                       .rows = array_alloc(n, sizeof *f.rows)};
    whit_result result = WHIT_ERROR_MEMORY;
    *rows = NULL;
    *count = 0;
    if (links && f.brought && f.rows) {
        f.first_child = links;
        f.next = links + n;
        f.first_shadow = links + 2 * n;
        f.after = links + 3 * n;
        link_rays(&f);
        add_rows(&f);
        *rows = f.rows;
        *count = f.row_count;
        f.rows = NULL;
        result = WHIT_OK;
    }
    free(links);
    free(f.brought);
    free(f.rows);
    return result;
}
