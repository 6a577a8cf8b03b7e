/* Hard tests of boxes: a box that a ray enters by exact arithmetic must be entered. */
#include "hard_fixture.h"
#include "unit.h"

#include <gmp.h>

/* ---- By exact arithmetic ---- */

/* The product (a - b) * c of three floats. */
struct product {
    double a, b, c;
};

static void set_product(mpq_t out, const struct product *p)
{
    mpq_t part;
    mpq_init(part);
    mpq_set_d(out, p->a);
    mpq_set_d(part, p->b);
    mpq_sub(out, out, part);
    mpq_set_d(part, p->c);
    mpq_mul(out, out, part);
    mpq_clear(part);
}

/* Whether left <= right. Decided in double if the difference exceeds the rounding errors (two per
   product, one of the difference), else exactly. */
static bool not_above(struct product left, struct product right)
{
    double l = (left.a - left.b) * left.c, r = (right.a - right.b) * right.c;
    if (fabs(l - r) > 0x1p-50 * (fabs(l) + fabs(r)))
        return l < r;
    mpq_t exact[2];
    mpq_inits(exact[0], exact[1], NULL);
    set_product(exact[0], &left);
    set_product(exact[1], &right);
    bool result = mpq_cmp(exact[0], exact[1]) <= 0;
    mpq_clears(exact[0], exact[1], NULL);
    return result;
}

/* Whether the ray is in the closed box somewhere in [t_min, t_max], which are finite. Distances to
   planes, (plane - origin) / dir, are compared by cross multiplication. */
static bool enters_exactly(const struct gpu_ray *ray, const float lo[3], const float hi[3],
                           float t_min, float t_max)
{
    struct product near[3], far[3];
    int count = 0;
    for (int k = 0; k < 3; ++k) {
        double o = (double)ray->origin[k], d = (double)ray->dir[k];
        if (d == 0.0 && !((double)lo[k] <= o && o <= (double)hi[k]))
            return false;
        if (d == 0.0)
            continue;
        double sign = d < 0.0 ? -1.0 : 1.0;
        double first = (double)(d < 0.0 ? hi[k] : lo[k]), last = (double)(d < 0.0 ? lo[k] : hi[k]);
        near[count] = (struct product){sign * first, sign * o, fabs(d)};
        far[count++] = (struct product){sign * last, sign * o, fabs(d)};
    }
    bool entered = t_min <= t_max;
    for (int i = 0; i < count && entered; ++i) {
        const struct product from = {(double)t_min, 0.0, far[i].c};
        const struct product to = {(double)t_max, 0.0, near[i].c};
        entered = not_above((struct product){near[i].a, near[i].b, 1.0}, to) &&
                  not_above(from, (struct product){far[i].a, far[i].b, 1.0});
        for (int j = 0; j < count && entered; ++j)
            entered = not_above((struct product){near[i].a, near[i].b, far[j].c},
                                (struct product){far[j].a, far[j].b, near[i].c});
    }
    return entered;
}

/* ---- Rays at boxes ---- */

struct crossing {
    bool entered;
    float near, far;
};

static struct crossing cross_box(const struct level *level, const struct gpu_ray *ray,
                                 const float lo[3], const float hi[3])
{
    struct ray_setup setup = make_ray_setup(vec3_load(ray->origin), vec3_load(ray->dir));
    float t_max = fminf(ray->t_max, FLT_MAX);
    struct crossing out;
    out.entered = level_enters(level, &setup, lo, hi, ray->t_min, t_max, &out.near, &out.far);
    return out;
}

/* Whether two crossings differ; the ends of `a` are multiplied by `scale` first. */
static bool crossings_differ(const struct crossing *a, const struct crossing *b, float scale)
{
    return a->entered != b->entered ||
           (a->entered && (a->near * scale != b->near || a->far * scale != b->far));
}

struct tally {
    uint32_t rays, entered, missed, false_hits;
};

static void compare_box(const struct level *level, const struct gpu_ray *ray, const float lo[3],
                        const float hi[3], struct tally *tally)
{
    bool entered = cross_box(level, ray, lo, hi).entered;
    bool exact = enters_exactly(ray, lo, hi, ray->t_min, fminf(ray->t_max, FLT_MAX));
    ++tally->rays;
    tally->entered += exact;
    tally->missed += exact && !entered;
    tally->false_hits += !exact && entered;
}

static void tell(const struct level *level, const char *name, const struct tally *tally)
{
    print_message("%-10s %-34s %u of %u entered boxes missed; %u of %u entered in vain\n",
                  level->name, name, tally->missed, tally->entered, tally->false_hits,
                  (tally->rays - tally->entered));
}

struct box_kind {
    const char *name;
    float offset, size;
    int flat;     /* axes on which lo == hi */
    int parallel; /* axes on which dir is 0 and the ray lies in a face */
    float speed;  /* |dir|, about; 0: any */
    bool wild;    /* rays are not aimed at the box */
};

static const struct box_kind box_kinds[] = {
    {"B1 not aimed", 0, 1, 0, 0, 0, true},
    {"B1 offset 0", 0, 1, 0, 0, 0, false},
    {"B1 offset 1e3", 1e3f, 1, 0, 0, 0, false},
    {"B1 offset 1e5", 1e5f, 1, 0, 0, 0, false},
    {"B2 along one face", 0, 1, 0, 1, 0, false},
    {"B2 along one face, offset 1e5", 1e5f, 1, 0, 1, 0, false},
    {"B3 along two faces", 1e3f, 1, 0, 2, 0, false},
    {"B5 flat on one axis", 0, 1, 1, 0, 0, false},
    {"B5 flat on one axis, offset 1e5", 1e5f, 1, 1, 0, 0, false},
    {"B5 flat on two axes", 1e3f, 1, 2, 0, 0, false},
    {"B5 a point", 1e3f, 1, 3, 0, 0, false},
    {"B6 direction of 1e-20", 0, 1, 0, 0, 1e-20f, false},
    {"B6 direction of 1e-37", 0, 1, 0, 0, 1e-37f, false},
    {"B6 direction of 1e18", 1e3f, 1, 0, 0, 1e18f, false},
    {"B6 box of 1e-12", 0, 1e-12f, 0, 0, 0, false},
    {"B6 box of 1e12", 0, 1e12f, 0, 0, 0, false},
};

/* A ray at a corner, or at a point of an edge or a face; every fourth starts inside or on the
   surface. */
static struct gpu_ray ray_at_box(const struct box_kind *kind, const float lo[3], const float hi[3])
{
    struct gpu_ray ray = {.t_max = INFINITY};
    uint32_t loose = random_below(&random_state, 3), axis = random_below(&random_state, 3);
    bool inside = random_below(&random_state, 4) == 0;
    float scale = kind->speed > 0.0f ? kind->speed / kind->size : 1.0f;
    for (uint32_t k = 0; k < 3; ++k) {
        float between = lo[k] + (hi[k] - lo[k]) * random_float(&random_state);
        float target = (k + axis) % 3 < loose ? between : either(lo[k], hi[k]);
        if (kind->wild)
            target = kind->offset + random_within(3.0f * kind->size);
        bool still = (k + axis) % 3 < (uint32_t)kind->parallel;
        ray.origin[k] =
            inside ? either(between, lo[k]) : between + random_within(3.0f * kind->size);
        if (still) {
            ray.origin[k] = either(lo[k], hi[k]);
            ray.dir[k] = either(0.0f, -0.0f);
        } else {
            ray.dir[k] = scale * (target - ray.origin[k]);
        }
    }
    return ray;
}

static void make_box(const struct box_kind *kind, float lo[3], float hi[3])
{
    uint32_t axis = random_below(&random_state, 3);
    for (uint32_t k = 0; k < 3; ++k) {
        float middle = kind->offset + random_within(kind->size),
              half = kind->size * random_float(&random_state);
        lo[k] = middle - half;
        hi[k] = (k + axis) % 3 < (uint32_t)kind->flat ? lo[k] : middle + half;
    }
}

static bool moves(const struct gpu_ray *ray)
{
    return ray->dir[0] != 0.0f || ray->dir[1] != 0.0f || ray->dir[2] != 0.0f;
}

/* Whether a component of dir is denormal. Its reciprocal may be infinite; except at `exact`, tests
   of boxes then take it as 0, and hits are lost. */
static bool has_denormal(const struct gpu_ray *ray)
{
    bool found = false;
    for (int k = 0; k < 3; ++k)
        found |= ray->dir[k] != 0.0f && fabsf(ray->dir[k]) < FLT_MIN;
    return found;
}

static void aim_at_boxes(const struct level *level, const struct box_kind *kind, uint32_t rays,
                         struct tally *tally, struct tally *denormal)
{
    for (uint32_t r = 0; r < rays; ++r) {
        float lo[3], hi[3];
        make_box(kind, lo, hi);
        struct gpu_ray ray = ray_at_box(kind, lo, hi);
        if (moves(&ray))
            compare_box(level, &ray, lo, hi, has_denormal(&ray) ? denormal : tally);
    }
}

/* B1, B2, B3, B5, B6 */
TEST(entered_boxes_are_entered)
{
    enum { KINDS = sizeof box_kinds / sizeof *box_kinds };
    const uint32_t rays = cases_of(70000);
    for (int l = 0; l < LEVELS; ++l) {
        struct tally all = {0}, denormal = {0};
        for (size_t i = 0; i < KINDS; ++i) {
            struct tally tally = {0};
            random_state = 11 + i;
            aim_at_boxes(&levels[l], &box_kinds[i], rays, &tally, &denormal);
            tell(&levels[l], box_kinds[i].name, &tally);
            assert_true(tally.entered > rays / 50);
            all.rays += tally.rays;
            all.entered += tally.entered;
            all.missed += tally.missed;
            all.false_hits += tally.false_hits;
        }
        tell(&levels[l], "all", &all);
        tell(&levels[l], "B6 denormals, promised at `exact`", &denormal);
        assert_true(denormal.entered > 100);
        assert_true(!levels[l].watertight || all.missed == 0);
        assert_true(!levels[l].exact || denormal.missed == 0);
    }
}

/* B4: 26 directions, in which every zero is tried with both signs. */
TEST(signs_of_zeros_do_not_matter)
{
    const float lo[3] = {-1, -2, 0}, hi[3] = {1, 0, 3};
    const float starts[4][3] = {{0, -1, 1}, {-1, 0, 3}, {5, -1, 1}, {1, -2, 0}};
    uint32_t compared = 0, differ = 0;
    for (int l = 0; l < LEVELS; ++l)
        for (uint32_t i = 0; i < 27 * 8 * 4; ++i) {
            struct gpu_ray ray = {.t_max = INFINITY}, other;
            uint32_t code = i / 32;
            memcpy(ray.origin, starts[i / 8 % 4], sizeof ray.origin);
            for (uint32_t k = 0; k < 3; ++k, code /= 3)
                ray.dir[k] = (float)(code % 3) - 1.0f;
            if (!moves(&ray))
                continue;
            other = ray;
            for (uint32_t k = 0; k < 3; ++k)
                other.dir[k] = ray.dir[k] == 0.0f && (i >> k & 1) ? -0.0f : ray.dir[k];
            struct crossing a = cross_box(&levels[l], &ray, lo, hi),
                            b = cross_box(&levels[l], &other, lo, hi);
            ++compared;
            differ += crossings_differ(&a, &b, 1.0f);
        }
    print_message("B4 %u of %u differ by the sign of a zero\n", differ, compared);
    assert_int_equal(differ, 0);
}

/* B4 in a tree, in every traversal order, with rays in the planes of boxes among others. */
TEST(signs_of_zeros_do_not_matter_in_trees)
{
    enum { RAYS = 6000 };
    own_world world = world_of_soup(soup_rooms(200), (whit_accel_params){.leaf_limit = 1});
    const struct accel *accel = world.accel;
    for (int l = 0; l < LEVELS; ++l) {
        uint32_t differ = 0, hits = 0;
        random_state = 4;
        for (uint32_t i = 0; i < RAYS; ++i) {
            struct gpu_ray ray = soup_ray(&world.soup, &accel->meshes[0].box, 2 * i + 1);
            for (uint32_t k = 0; k < 3; ++k) /* one zero or two */
                ray.dir[k] = k == i % 3 || (k + i) % 4 == 0 ? ray.dir[k] : 0.0f;
            ray.dir[i % 3] = ray.dir[i % 3] == 0.0f ? 1.0f : ray.dir[i % 3];
            struct gpu_hit plain = level_trace(&levels[l], accel, ORDER_BASIC, false, &ray);
            hits += plain.primitive != HIT_NONE;
            for (uint32_t way = 0; way < 24; ++way) {
                struct gpu_ray turned = ray;
                for (uint32_t k = 0; k < 3; ++k)
                    turned.dir[k] = ray.dir[k] == 0.0f && way >> k & 1 ? -0.0f : ray.dir[k];
                struct gpu_hit hit = level_trace(&levels[l], accel, way / 8, false, &turned);
                differ += !hits_equal(&hit, &plain);
            }
        }
        print_message(
            "%-10s B4 %u of %u rays in a tree differ by the sign of a zero, %u of %u hit\n",
            levels[l].name, differ, 24 * RAYS, hits, (uint32_t)RAYS);
        assert_int_equal(differ, 0);
        assert_true(hits > RAYS / 4);
    }
}

/* B6: a direction scaled by a power of two has t scaled by its inverse, exactly. */
TEST(lengths_of_directions_scale_t)
{
    enum { RAYS = 20000 };
    uint32_t differ = 0, entered = 0;
    random_state = 6;
    for (int l = 0; l < LEVELS; ++l)
        for (int r = 0; r < RAYS; ++r) {
            float lo[3], hi[3];
            make_box(&box_kinds[2], lo, hi);
            struct gpu_ray ray = ray_at_box(&box_kinds[2], lo, hi), longer = ray;
            float scale = ldexpf(1.0f, (int)random_below(&random_state, 120) - 60);
            vec3_store(longer.dir, vec3_scale(vec3_load(ray.dir), scale));
            struct crossing a = cross_box(&levels[l], &ray, lo, hi),
                            b = cross_box(&levels[l], &longer, lo, hi);
            entered += a.entered;
            differ += crossings_differ(&a, &b, 1.0f / scale);
        }
    print_message("B6 %u of %u differ by more than a power of two, %u entered\n", differ,
                  LEVELS * RAYS, entered);
    assert_true(entered > RAYS);
    assert_int_equal(differ, 0);
}

/* Computes in double where the line enters and leaves the box; whether it does so at t >= 0. */
static bool find_ends(const struct gpu_ray *ray, const float lo[3], const float hi[3],
                      double *enter, double *leave)
{
    *enter = -INFINITY;
    *leave = INFINITY;
    for (int k = 0; k < 3; ++k) {
        if (ray->dir[k] == 0.0f)
            continue;
        double a = ((double)lo[k] - (double)ray->origin[k]) / (double)ray->dir[k];
        double b = ((double)hi[k] - (double)ray->origin[k]) / (double)ray->dir[k];
        *enter = fmax(*enter, fmin(a, b));
        *leave = fmin(*leave, fmax(a, b));
    }
    return *enter <= *leave && *leave >= 0.0 && *leave < (double)FLT_MAX;
}

/* B8 with any numbers: the ray's interval ends where it enters the box, rounded up to a float, or
   begins where it leaves the box, rounded down, or is only 0 for rays that start in the box. All of
   these must enter. At `watertight` the near end may be off by three roundings, so the interval
   ends four roundings later. */
TEST(intervals_are_closed)
{
    enum { RAYS = 100000 };
    for (int l = 0; l < LEVELS; ++l) {
        struct tally at_end = {0}, near_end = {0}, at_begin = {0}, at_start = {0};
        random_state = 8;
        for (int r = 0; r < RAYS; ++r) {
            float lo[3], hi[3];
            make_box(&box_kinds[1 + r % 3], lo, hi);
            struct gpu_ray ray = ray_at_box(&box_kinds[1 + r % 3], lo, hi);
            double enter, leave;
            if (!find_ends(&ray, lo, hi, &enter, &leave))
                continue;
            if (enter <= 0.0) {
                ray.t_max = 0.0f;
                compare_box(&levels[l], &ray, lo, hi, &at_start);
            } else {
                ray.t_max = nextafterf((float)enter, INFINITY);
                compare_box(&levels[l], &ray, lo, hi, &at_end);
                ray.t_max = nextafterf(ray.t_max * (1.0f + 2.0f * FLT_EPSILON), INFINITY);
                compare_box(&levels[l], &ray, lo, hi, &near_end);
            }
            ray.t_max = INFINITY;
            ray.t_min = fmaxf(nextafterf((float)leave, -INFINITY), 0.0f);
            compare_box(&levels[l], &ray, lo, hi, &at_begin);
        }
        tell(&levels[l], "B8 t_max at the entry", &at_end);
        tell(&levels[l], "B8 t_max 4 roundings behind it", &near_end);
        tell(&levels[l], "B8 t_min at the exit", &at_begin);
        tell(&levels[l], "B8 from inside or a face, t_max 0", &at_start);
        assert_true(at_end.entered > RAYS / 4 && at_start.entered > RAYS / 10);
        assert_true(!levels[l].watertight ||
                    near_end.missed + at_begin.missed + at_start.missed == 0);
        assert_true(!levels[l].exact || at_end.missed == 0);
    }
}

/* A box of integers and a ray whose distances to its planes are floats. */
static struct gpu_ray integer_ray_at_box(float lo[3], float hi[3])
{
    struct gpu_ray ray = {.t_max = INFINITY};
    for (int k = 0; k < 3; ++k) {
        lo[k] = (float)random_below(&random_state, 65) - 32.0f;
        hi[k] = lo[k] + (float)random_below(&random_state, 17);
        ray.origin[k] = (float)random_below(&random_state, 129) - 64.0f;
        int power = (int)random_below(&random_state, 3);
        ray.dir[k] = either(0.0f, ldexpf(either(-1.0f, 1.0f), power));
        if (ray.dir[k] == 0.0f ||
            random_below(&random_state, 4) == 0) /* in the box, or on a face */
            ray.origin[k] =
                lo[k] + (float)random_below(&random_state, 1 + (uint32_t)(hi[k] - lo[k]));
    }
    return ray;
}

/* B8 without rounding: t_max at the entry and t_min at the exit both count as inside. t_max one
   float before the entry, or t_min one float behind the exit, is outside. */
TEST(ends_that_are_floats_count)
{
    enum { RAYS = 200000 };
    for (int l = 0; l < LEVELS; ++l) {
        struct tally at_end = {0}, before = {0}, at_begin = {0}, point = {0};
        random_state = 88;
        for (int r = 0; r < RAYS; ++r) {
            float lo[3], hi[3];
            double first, last;
            struct gpu_ray ray = integer_ray_at_box(lo, hi);
            if (!find_ends(&ray, lo, hi, &first, &last))
                continue;
            float enter = fmaxf((float)first, 0.0f), leave = (float)last;
            ray.t_max = enter;
            compare_box(&levels[l], &ray, lo, hi, &at_end);
            ray.t_min = enter;
            compare_box(&levels[l], &ray, lo, hi, &point);
            ray.t_min = 0.0f;
            ray.t_max = nextafterf(enter, -INFINITY);
            if (enter > 0.0f)
                compare_box(&levels[l], &ray, lo, hi, &before);
            ray.t_min = leave;
            ray.t_max = INFINITY;
            compare_box(&levels[l], &ray, lo, hi, &at_begin);
        }
        tell(&levels[l], "B8 t_max at the entry, a float", &at_end);
        tell(&levels[l], "B8 t_min and t_max at the entry", &point);
        tell(&levels[l], "B8 t_min at the exit, a float", &at_begin);
        tell(&levels[l], "B8 t_max one float before", &before);
        assert_true(at_end.entered > RAYS / 10 && before.rays > RAYS / 20);
        assert_int_equal(at_end.entered, at_end.rays);
        assert_int_equal(at_begin.entered, at_begin.rays);
        assert_int_equal(at_end.missed + at_begin.missed + point.missed + before.entered, 0);
        assert_true(levels[l].exact || before.false_hits == 0);
    }
}

/* Rays from anywhere, and from points on walls, at axis-aligned walls, whose boxes are flat. */
static struct gpu_ray ray_at_wall(const struct soup *soup, const struct bvh_box *bounds, uint32_t i)
{
    struct gpu_ray ray = soup_ray(soup, bounds, i);
    if (i % 4 == 0) { /* walls are every eighth pair of triangles */
        uint32_t wall = random_below(&random_state, soup->count / 8) * 8;
        const float *a = soup_vertex(soup, wall, 0), *b = soup_vertex(soup, wall, 1),
                    *c = soup_vertex(soup, wall, 2);
        for (int k = 0; k < 3; ++k)
            ray.origin[k] = 0.25f * a[k] + 0.25f * b[k] + 0.5f * c[k];
    }
    return ray;
}

struct ends {
    uint32_t hits, lost, early, starts;
};

/* `first` is the hit of the unbounded ray. It must stay the hit with t_max at its t, and at `exact`
   also with t_min there; with t_max one float before, nothing may be hit. */
static void try_ends(const struct level *level, const struct accel *accel, uint32_t order,
                     const struct gpu_ray *ray, const struct gpu_hit *first, struct ends *ends)
{
    struct gpu_ray cut = *ray;
    ++ends->hits;
    ends->starts += first->t == 0.0f;
    cut.t_max = first->t;
    struct gpu_hit again = level_trace(level, accel, order, false, &cut);
    ends->lost += !hits_equal(&again, first);
    ends->lost += level_trace(level, accel, order, true, &cut).primitive == HIT_NONE;
    cut.t_min = level->exact ? first->t : 0.0f;
    ends->lost += level_trace(level, accel, order, false, &cut).primitive != first->primitive;
    cut.t_max = nextafterf(first->t, -INFINITY);
    cut.t_min = 0.0f;
    ends->early += level_trace(level, accel, order, true, &cut).primitive != HIT_NONE;
}

/* B8 in a tree: axis-aligned walls have flat boxes, which rays from outside, from inside and
   from the wall itself enter at the t of the hit. At `exact` hits equal those of fractions, also
   at t 0. */
TEST(hits_at_the_entry_of_their_box_count)
{
    enum { RAYS = 12000 };
    own_world world = world_of_soup(soup_rooms(200), (whit_accel_params){.leaf_limit = 1});
    const struct accel *accel = world.accel;
    own_rational *rational = rational_create(accel);
    for (int l = 0; l < LEVELS; ++l) {
        struct ends ends = {0};
        random_state = 80;
        for (uint32_t i = 0; i < RAYS; ++i) {
            struct gpu_ray ray = ray_at_wall(&world.soup, &accel->meshes[0].box, i);
            struct gpu_hit first = level_trace(&levels[l], accel, i % 3, false, &ray);
            struct rational_hit exact;
            rational_trace(rational, &ray, NULL, &exact);
            if (levels[l].exact) {
                assert_int_equal(first.primitive, exact.primitive);
                assert_true(first.t == exact.t);
            }
            if (first.primitive != HIT_NONE)
                try_ends(&levels[l], accel, i % 3, &ray, &first, &ends);
        }
        print_message("%-10s B8 in a tree: %u lost, %u early, of %u hits; %u at the start\n",
                      levels[l].name, ends.lost, ends.early, ends.hits, ends.starts);
        assert_int_equal(ends.lost + ends.early, 0);
        assert_true(ends.hits > RAYS / 2);
        assert_true(ends.starts > RAYS / 8); /* not all at `watertight`: not promised */
    }
}

/* Makes a valid ray invalid in the way `what`. */
enum { SENSELESS = 14 };
static struct gpu_ray spoiled(struct gpu_ray ray, uint32_t what, uint32_t axis)
{
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    static const float intervals[][2] = {{1, 0.5f},       {0, -1},         {2, -INFINITY},
                                         {0, -0x1p-149f}, {NAN, INFINITY}, {INFINITY, INFINITY},
                                         {NAN, NAN},      {FLT_MAX, 0}};
    if (what < 3)
        ray.origin[axis] = bad[what];
    else if (what < 6)
        ray.dir[axis] = bad[what - 3];
    else {
        ray.t_min = intervals[what - 6][0];
        ray.t_max = intervals[what - 6][1];
    }
    return ray;
}

/* B9 and B10: invalid rays hit nothing and visit at most one pair of nodes, in any order, where
   valid rays visit many. */
TEST(senseless_rays_cost_nothing)
{
    own_world world = world_of_soup(soup_sphere(40, 20), (whit_accel_params){0});
    const struct accel *accel = world.accel;
    for (int l = 0; l < LEVELS; ++l) {
        uint32_t rays = 0, hits = 0, max = 0, min = UINT32_MAX;
        random_state = 9;
        for (uint32_t i = 0; i < 300 * SENSELESS; ++i) {
            struct gpu_ray good = ray_from_cube(0.5f, random_point(2.0f));
            struct gpu_ray ray = spoiled(good, i % SENSELESS, i / SENSELESS % 3);
            struct gpu_cost cost = {0}, good_cost = {0};
            struct traverse_params params = {
                .order = i % 3, .numerics = levels[l].numerics, .any = i % 2};
            ++rays;
            hits += trace_with(accel, params, &ray, &cost).primitive != HIT_NONE;
            max = cost.inner_nodes > max ? cost.inner_nodes : max;
            params.any = false;
            assert_int_not_equal(trace_with(accel, params, &good, &good_cost).primitive, HIT_NONE);
            min = good_cost.inner_nodes < min ? good_cost.inner_nodes : min;
        }
        print_message(
            "%-10s B9, B10 %u hits of %u senseless rays, %u pairs at most; %u and more of "
            "others\n",
            levels[l].name, hits, rays, max, min);
        assert_int_equal(hits, 0);
        assert_true(max <= 1 && min > 1);
    }
}
