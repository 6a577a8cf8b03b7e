/* The second half of W3 of the catalogue: closed meshes with integer vertices, and rays along the
   axes at multiples of a half and a quarter. Nothing is rounded: 64-bit integers tell which
   triangles a ray crosses, and its hits must be exactly these. Counted with a rule for ties,
   crossings are even from outside and odd from inside (github.com/jbikker/tinybvh, issue 168). */
#include "hard_fixture.h"
#include "unit.h"

enum { STEPS = 24, PARTS = 4 }; /* steps of the landscape; integer units per float unit */

/* ---- The meshes ---- */

struct heights {
    float top[STEPS + 1][STEPS + 1], bottom[STEPS + 1][STEPS + 1];
};

/* Two triangles of a square with corners in order, split along a random diagonal. */
static void set_square(struct soup *soup, uint32_t *at, float p[4][3])
{
    uint32_t turn = random_below(&random_state, 2);
    soup_set(soup, *at, p[turn], p[1 + turn], p[2 + turn]);
    soup_set(soup, *at + 1, p[turn], p[2 + turn], p[(3 + turn) % 4]);
    *at += 2;
}

static void set_floor(struct soup *soup, uint32_t *at, float heights[][STEPS + 1], bool up)
{
    for (int i = 0; i < STEPS; ++i)
        for (int j = 0; j < STEPS; ++j) {
            const int x[4] = {i, up ? i : i + 1, i + 1, up ? i + 1 : i};
            const int z[4] = {j, up ? j + 1 : j, j + 1, up ? j : j + 1};
            float p[4][3];
            for (int k = 0; k < 4; ++k) {
                p[k][0] = (float)x[k];
                p[k][1] = heights[x[k]][z[k]];
                p[k][2] = (float)z[k];
            }
            set_square(soup, at, p);
        }
}

/* The wall below a border of the landscape, which is to the left of the direction (dx, dz). */
static void set_wall(struct soup *soup, uint32_t *at, const struct heights *h, int x, int z, int dx,
                     int dz)
{
    for (int i = 0; i < STEPS; ++i, x += dx, z += dz) {
        float p[4][3] = {{(float)x, h->bottom[x][z], (float)z},
                         {(float)(x + dx), h->bottom[x + dx][z + dz], (float)(z + dz)},
                         {(float)(x + dx), h->top[x + dx][z + dz], (float)(z + dz)},
                         {(float)x, h->top[x][z], (float)z}};
        set_square(soup, at, p);
    }
}

/* A block whose top and bottom are landscapes with integer heights above and below 0. */
static struct soup soup_block(void)
{
    struct soup soup = soup_make("block", 4 * STEPS * STEPS + 8 * STEPS);
    static struct heights h;
    uint32_t at = 0;
    random_state = 3;
    for (int i = 0; i <= STEPS; ++i)
        for (int j = 0; j <= STEPS; ++j) {
            h.top[i][j] = (float)(1 + random_below(&random_state, 8));
            h.bottom[i][j] = -(float)(1 + random_below(&random_state, 4));
        }
    set_floor(&soup, &at, h.top, true);
    set_floor(&soup, &at, h.bottom, false);
    set_wall(&soup, &at, &h, 0, STEPS, 1, 0);
    set_wall(&soup, &at, &h, STEPS, STEPS, 0, -1);
    set_wall(&soup, &at, &h, STEPS, 0, -1, 0);
    set_wall(&soup, &at, &h, 0, 0, 0, 1);
    assert_int_equal(at, soup.count);
    soup_box(&soup);
    return soup;
}

/* A torus whose vertices are rounded to integers. */
static struct soup soup_quantised(void)
{
    struct soup soup = soup_of_mesh("ring", mesh_torus(1.0, 0.45, 40, 20));
    for (uint32_t i = 0; i < 9 * soup.count; ++i)
        soup.positions[i] = rintf(18.0f * soup.positions[i]);
    soup_box(&soup);
    return soup;
}

/* ---- By integers ---- */

/* A triangle projected along an axis, in units of 1 / PARTS. */
struct seen {
    int64_t p[3][2];
    int64_t area; /* twice the signed area */
};

static int64_t parts_of(float x)
{
    return (int64_t)lrintf(x * PARTS);
}

static struct seen *see_mesh(const struct soup *soup, uint32_t axis)
{
    struct seen *seen = calloc(soup->count, sizeof *seen);
    assert_non_null(seen);
    for (uint32_t i = 0; i < soup->count; ++i) {
        struct seen *s = &seen[i];
        for (uint32_t c = 0; c < 3; ++c)
            for (uint32_t k = 0; k < 2; ++k)
                s->p[c][k] = parts_of(soup_vertex(soup, i, c)[(axis + 1 + k) % 3]);
        s->area = (s->p[1][0] - s->p[0][0]) * (s->p[2][1] - s->p[0][1]) -
                  (s->p[1][1] - s->p[0][1]) * (s->p[2][0] - s->p[0][0]);
    }
    return seen;
}

/* Whether the closed triangle contains the point. *owned: whether it contains the point moved by an
   infinitesimal (e, e^2), which lies on no edge: the rule for ties. */
static bool has_point(const struct seen *s, const int64_t at[2], bool *owned)
{
    int64_t sign = s->area < 0 ? -1 : 1;
    *owned = true;
    for (int c = 0; c < 3; ++c) {
        const int64_t *a = s->p[c], *b = s->p[(c + 1) % 3];
        int64_t x = b[0] - a[0], y = b[1] - a[1];
        int64_t side = sign * (x * (at[1] - a[1]) - y * (at[0] - a[0]));
        if (side < 0 || s->area == 0)
            return false;
        int64_t moved = y != 0 ? -y : x;
        *owned &= side > 0 || sign * moved > 0;
    }
    return true;
}

/* ---- Rays ---- */

struct crossings {
    uint32_t rays, on_edges, exact, missed, invented, wrong_parity;
};

/* An axis-aligned ray: its place in the projection, and where it starts. */
struct line {
    uint32_t axis;
    int64_t at[2];
    bool inside; /* it starts at 0, between top and bottom of the block */
    bool up;
};

static struct gpu_ray ray_of_line(const struct line *line)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    ray.origin[line->axis] = line->inside ? 0.0f : line->up ? -1000.0f : 1000.0f;
    ray.dir[line->axis] = line->up ? 1.0f : -1.0f;
    for (uint32_t k = 0; k < 2; ++k) {
        ray.origin[(line->axis + 1 + k) % 3] = (float)line->at[k] / PARTS;
        ray.dir[(line->axis + 1 + k) % 3] = random_below(&random_state, 2) ? 0.0f : -0.0f;
    }
    return ray;
}

/* Marks the primitives of all hits along the ray. */
static void mark_hits(const struct level *level, const struct accel *accel,
                      const struct gpu_ray *ray, uint8_t *marks)
{
    struct traverse_params params = {.numerics = level->numerics};
    struct gpu_hit hit = trace_with(accel, params, ray, NULL);
    params.behind = &hit;
    for (; hit.primitive != HIT_NONE; hit = trace_with(accel, params, ray, NULL)) {
        assert_int_equal(marks[hit.primitive], 0); /* none twice */
        marks[hit.primitive] = 1;
    }
}

static void count_crossings(const struct soup *soup, const struct seen *seen,
                            const struct line *line, const uint8_t *marks, struct crossings *tally)
{
    uint32_t owners = 0;
    bool on_edge = false;
    for (uint32_t i = 0; i < soup->count; ++i) {
        bool owned, met = has_point(&seen[i], line->at, &owned);
        if (line->inside && met) /* from inside, only the top or the bottom is ahead */
            met = (soup_vertex(soup, i, 0)[1] > 0.0f) == line->up;
        tally->exact += met;
        tally->missed += met && !marks[i];
        tally->invented += !met && marks[i];
        owners += owned && marks[i];
        on_edge |= met && !owned;
    }
    ++tally->rays;
    tally->on_edges += on_edge;
    tally->wrong_parity += owners % 2 != line->inside;
}

/* Traces a grid of rays along an axis, `step` / PARTS apart, which extends beyond the mesh. */
static void cross_mesh(const struct level *level, const struct soup *soup,
                       const struct accel *accel, uint32_t axis, int64_t step, bool block,
                       struct crossings *tally)
{
    const struct bvh_box *box = &accel->meshes[0].box;
    own_memory struct seen *seen = see_mesh(soup, axis);
    own_memory uint8_t *marks = calloc(soup->count, 1);
    int64_t from[2], to[2];
    uint32_t turn = 0;
    assert_non_null(marks);
    for (uint32_t k = 0; k < 2; ++k) {
        from[k] = parts_of(box->lo[(axis + 1 + k) % 3]) - step;
        to[k] = parts_of(box->hi[(axis + 1 + k) % 3]) + step;
    }
    for (int64_t a = from[0]; a <= to[0]; a += step)
        for (int64_t b = from[1]; b <= to[1]; b += step, ++turn) {
            struct line line = {.axis = axis, .at = {a, b}, .up = turn % 2};
            line.inside = block && axis == 1 && turn % 4 < 2 && a > 0 && b > 0 &&
                          a < PARTS * STEPS && b < PARTS * STEPS;
            struct gpu_ray ray = ray_of_line(&line);
            memset(marks, 0, soup->count);
            mark_hits(level, accel, &ray, marks);
            count_crossings(soup, seen, &line, marks, tally);
        }
}

static void assert_crossings(struct soup made, int64_t step, bool block)
{
    own_world world = world_of_soup(made, (whit_accel_params){0});
    const struct soup *soup = &world.soup;
    assert_int_equal(world.scene->triangle_total,
                     soup->count); /* none without area: closed still */
    for (int l = 0; l < LEVELS; ++l)
        for (uint32_t axis = 0; axis < 3; ++axis) {
            struct crossings tally = {0};
            cross_mesh(&levels[l], soup, world.accel, axis, step, block, &tally);
            print_message("%-10s W3 %s along %c: %u of %u crossings missed, %u invented; "
                          "wrong parity of %u of %u rays, %u at edges\n",
                          levels[l].name, soup->name, "xyz"[axis], tally.missed, tally.exact,
                          tally.invented, tally.wrong_parity, tally.rays, tally.on_edges);
            assert_int_equal(tally.missed + tally.invented + tally.wrong_parity, 0);
            assert_true(tally.rays > 1000 && tally.exact > tally.rays / 2);
            assert_true(tally.on_edges > tally.rays / 10);
        }
}

TEST(landscapes_are_crossed_in_pairs)
{
    assert_crossings(soup_block(), 1, true);
}

TEST(quantised_meshes_are_crossed_in_pairs)
{
    assert_crossings(soup_quantised(), PARTS / 2, false);
}
