/* Pairs of floats beside exact arithmetic: what they are sure of is so, and they are nearly always
   sure. */
#include "hard_fixture.h"

#include "twin/ff_triangle.h"

typedef void (*make_fn)(struct vec3 v[3], struct gpu_ray *ray);

static struct vec3 random_grid_point(int max)
{
    int span = 2 * max + 1;
    struct vec3 p;
    p.x = (float)((int)(random_float(&random_state) * (float)span) - max);
    p.y = (float)((int)(random_float(&random_state) * (float)span) - max);
    p.z = (float)((int)(random_float(&random_state) * (float)span) - max);
    return p;
}

static void random_triangle(float size, struct vec3 around, struct vec3 v[3])
{
    for (int i = 0; i < 3; ++i)
        v[i] = vec3_add(around, random_point(size));
}

static struct vec3 point_of(const struct vec3 v[3], float a, float b)
{
    struct vec3 p = vec3_add(vec3_scale(v[0], a), vec3_scale(v[1], b));
    return vec3_add(p, vec3_scale(v[2], 1.0f - a - b));
}

static void make_ordinary(struct vec3 v[3], struct gpu_ray *ray)
{
    random_triangle(1.0f, random_point(3.0f), v);
    float a = random_float(&random_state), b = random_float(&random_state);
    *ray = ray_through(random_point(10.0f), point_of(v, 1.5f * a - 0.25f, 1.5f * b - 0.25f));
}

static void make_far(struct vec3 v[3], struct gpu_ray *ray)
{
    random_triangle(0.05f, vec3_make(0.0f, 0.0f, 0.0f), v);
    float b = random_float(&random_state), a = random_float(&random_state);
    *ray = ray_from_cube(1e7f, point_of(v, a, b));
}

static void make_tiny(struct vec3 v[3], struct gpu_ray *ray)
{
    random_triangle(1e-8f, random_point(1e-6f), v);
    *ray = ray_from_cube(1e-6f, point_of(v, 0.5f * random_float(&random_state), 0.5f));
}

static void make_huge(struct vec3 v[3], struct gpu_ray *ray)
{
    random_triangle(1e6f, random_point(1e7f), v);
    *ray = ray_from_cube(1e11f, point_of(v, 0.3f, random_float(&random_state)));
}

/* Through the middle of an edge exactly, where the edge function is 0 and its terms are of 68 bits.
 */
static void make_on_edge(struct vec3 v[3], struct gpu_ray *ray)
{
    struct vec3 middle = random_grid_point(1 << 21), half = random_grid_point(1 << 20);
    v[0] = vec3_sub(middle, half);
    v[1] = vec3_add(middle, half);
    v[2] = random_grid_point(1 << 21);
    struct vec3 origin = random_grid_point(1 << 22);
    *ray = ray_through(origin, middle);
}

/* At a t exactly in the middle between two floats. */
static void make_between(struct vec3 v[3], struct gpu_ray *ray)
{
    const float t = 16777216.0f; /* 2^24, and 1 more below */
    struct vec3 origin = vec3_scale(random_grid_point(50), 2.0f), dir, p;
    origin = vec3_add(origin, vec3_make(1.0f, 1.0f, 1.0f));
    dir.x = random_float(&random_state) < 0.5f ? -1.0f : 1.0f;
    dir.y = random_float(&random_state) < 0.5f ? -1.0f : 1.0f;
    dir.z = random_float(&random_state) < 0.5f ? -1.0f : 1.0f;
    p.x = dir.x * t + (origin.x + dir.x);
    p.y = dir.y * t + (origin.y + dir.y);
    p.z = dir.z * t + (origin.z + dir.z);
    struct vec3 a = vec3_scale(random_grid_point(5000), 2.0f);
    struct vec3 b = vec3_scale(random_grid_point(5000), 2.0f);
    v[0] = vec3_add(p, a);
    v[1] = vec3_add(p, b);
    v[2] = vec3_sub(p, vec3_add(a, b));
    *ray = (struct gpu_ray){.t_max = FLT_MAX};
    vec3_store(ray->origin, origin);
    vec3_store(ray->dir, dir);
}

static void make_without_area(struct vec3 v[3], struct gpu_ray *ray)
{
    random_triangle(1.0f, random_point(3.0f), v);
    int i = (int)(random_float(&random_state) * 3.0f) % 3;
    v[i] = v[(i + 1) % 3];
    *ray = ray_through(random_point(10.0f), v[i]);
}

struct tally {
    uint32_t rays, sure, met, wrong, keys_known, wrong_keys;
};

static void compare(struct rational *rational, const struct vec3 v[3], const struct gpu_ray *ray,
                    struct tally *tally)
{
    struct vec3 origin = vec3_load(ray->origin), dir = vec3_load(ray->dir);
    struct exact_candidate m;
    bool key_known;
    float key = NAN;
    bool met = rational_meet(rational, origin, dir, v, &key, NULL);
    bool sure = ff_meet(origin, dir, v[0], v[1], v[2], &m, &key_known);
    ++tally->rays;
    tally->met += met;
    tally->sure += sure;
    tally->wrong += sure && (m.met != met || (met && m.key != key));
    tally->keys_known += met && key_known;
    tally->wrong_keys += met && key_known && m.key != key;
}

static void what_is_sure_is_so(void **state)
{
    (void)state;
    enum { RAYS = 100000 };
    static const struct {
        const char *name;
        make_fn make;
        double sure_min, sure_max; /* share of rays */
    } kinds[] = {
        {"ordinary", make_ordinary, 0.999, 1.0},
        {"from far away", make_far, 0.99, 1.0},
        {"tiny", make_tiny, 0.99, 1.0},
        {"huge", make_huge, 0.99, 1.0},
        {"exactly on an edge", make_on_edge, 0.0, 0.01},
        {"t between two floats", make_between, 0.0, 0.01},
        {"without area", make_without_area, 1.0, 1.0},
    };
    struct rational *rational = rational_create(NULL);
    assert_non_null(rational);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        struct tally tally = {0};
        random_state = 38 + (uint32_t)k;
        for (int r = 0; r < RAYS; ++r) {
            struct vec3 v[3];
            struct gpu_ray ray;
            kinds[k].make(v, &ray);
            compare(rational, v, &ray, &tally);
        }
        double share = (double)tally.sure / RAYS;
        print_message("%-20s %u of %u sure, of which %u wrong; %u met, %u keys known, of which "
                      "%u wrong\n",
                      kinds[k].name, tally.sure, tally.rays, tally.wrong, tally.met,
                      tally.keys_known, tally.wrong_keys);
        assert_int_equal(tally.wrong + tally.wrong_keys, 0);
        assert_true(share >= kinds[k].sure_min && share <= kinds[k].sure_max);
    }
    rational_destroy(rational);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_sure_is_so)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
