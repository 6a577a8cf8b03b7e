/* The least distance of a second surface from the one that a ray leaves (S2 of the catalogue of
   hard cases). Rays start as secondary rays do, moved off the surface by the error bound of their
   origin, and must still hit the sheet in front of them. */
#include "hard_fixture.h"

#include "hard/judge.h"
#include "hard/mesh.h"
#include "hard/rays.h"
#include "unit.h"

/* Widths in ulps of the largest coordinate; r = 2^-24 of it is at most 1 ulp. The error of a point
   is at most gamma(7) = 7 r of its coordinates on each axis, and the point is moved by as much
   along the normal, whose components add up to at most 1.74: 2 x 12.2. It is then moved by one
   float on each axis: 1.74. Corners of the other sheet are rounded by half a float: 0.87. An
   instance adds 16 r (the 2^-20 of hard_rays.c): 27.8, and the roundings of the ray in object space
   add 4 r for each of its terms: 14. */
enum { SAFE_ULPS = 28, SAFE_ULPS_PLACED = 70, RAYS = 300 };

static const uint32_t widths[] = {1, 2, 3, 4, 6, 8, 10, 12, 14, 16, 18, 20, 24, 28, 40, 56, 70, 96};

struct gap {
    const char *name;
    float offset, size;
    bool placed; /* the mesh is at the origin, and an instance moves it */
    bool corner; /* the large sheet touches an edge of the small one, at an angle of SLOPE */
};

#define SLOPE 0.017455065f /* tan 1 degree */

struct sheets {
    struct vec3 normal, edge, away; /* edge: a point of the touched edge; away: direction from it */
    float ulp;                      /* of the largest coordinate in the world */
    struct scene *scene;
    struct hard_scene hard;
};

/* Makes two sheets in random orientation. Triangles 0 and 1 are a square, 2 and 3 a parallel one
   three times as large, `ulps` in front of it, or touching its edge at an angle. */
static struct sheets make_sheets(const struct gap *gap, uint32_t ulps)
{
    struct vec3 u = vec3_normalize(random_point(1.0f)), v = vec3_normalize(random_point(1.0f));
    struct sheets out = {.normal = vec3_normalize(vec3_cross(u, v))};
    v = vec3_cross(out.normal, u);
    float far = gap->offset + 2.0f * gap->size;
    out.ulp = nextafterf(far, INFINITY) - far;
    float at = gap->placed ? 0.0f : gap->offset;
    struct vec3 middle = vec3_add(vec3_make(at, -at, at), random_point(0.5f * gap->size));
    struct soup soup = soup_make("sheets", 4);
    out.edge = vec3_sub(middle, vec3_scale(v, 0.5f * gap->size));
    out.away = v;
    for (uint32_t i = 0; i < 2; ++i) {
        float size = gap->size * (i ? 1.5f : 0.5f), before = i ? (float)ulps * out.ulp : 0.0f;
        bool leans = i && gap->corner;
        struct vec3 from = vec3_add(middle, vec3_scale(out.normal, before));
        from = leans ? out.edge : vec3_sub(from, vec3_scale(v, size));
        struct vec3 way = leans ? vec3_add(v, vec3_scale(out.normal, SLOPE)) : v;
        float corner[3], along[3], up[3];
        vec3_store(corner, vec3_sub(from, vec3_scale(u, size)));
        vec3_store(along, vec3_scale(u, 2.0f * size));
        vec3_store(up, vec3_scale(way, 2.0f * size));
        soup_quad(&soup, 2 * i, corner, along, up);
    }
    struct scene_mesh mesh = mesh_triangles(soup.positions, 4);
    soup_finish(&soup);
    const double to[3] = {(double)gap->offset, -(double)gap->offset, (double)gap->offset};
    const double unturned[4] = {0, 0, 0, 1}, one[3] = {1, 1, 1};
    const struct affine place = affine_from_trs(to, unturned, one);
    if (gap->placed)
        out.edge = vec3_add(out.edge, vec3_make((float)to[0], (float)to[1], (float)to[2]));
    assert_int_equal(
        hard_scene_of_mesh(&silent, gap->name, &mesh, gap->placed ? &place : NULL, &out.scene),
        WHIT_OK);
    assert_int_equal(hard_scene_borrow(&silent, out.scene, 0.0, false, &out.hard), WHIT_OK);
    return out;
}

static void free_sheets(struct sheets *sheets)
{
    hard_scene_finish(&sheets->hard);
    scene_destroy(sheets->scene);
}

struct leaks {
    uint32_t rays, leaks;
    uint32_t differ[LEVELS]; /* rays for which a level disagrees with exact arithmetic */
};

/* Counts rays from the small sheet towards the large one that miss it by exact arithmetic, and rays
   for which a level disagrees. Rays do not start in the corner where the gap between the sheets is
   less than `min` wide. */
static void count_leaks(const struct sheets *sheets, float min, struct leaks *leaks)
{
    own_rational *rational = rational_create(sheets->hard.accel);
    assert_non_null(rational);
    for (uint64_t i = 0; i < 8; ++i) {
        struct hard_ray shot =
            hard_ray_make(&sheets->hard, HARD_LEAVING, random_bits(&random_state), i);
        struct vec3 dir = vec3_add(sheets->normal, random_point(0.25f));
        if (shot.primitive > 1 || vec3_dot(vec3_load(shot.ray.dir), sheets->normal) <= 0.0f)
            continue; /* starts on the other sheet, or goes the other way */
        float width =
            SLOPE * vec3_dot(vec3_sub(vec3_load(shot.ray.origin), sheets->edge), sheets->away);
        if (width < min)
            continue; /* starts in the corner */
        vec3_store(shot.ray.dir, dir);
        const struct rational_hit own = {.primitive = shot.primitive, .instance = shot.instance};
        const struct rational_query query = {.own = &own};
        struct rational_hit exact;
        rational_trace(rational, &shot.ray, &query, &exact);
        ++leaks->rays;
        leaks->leaks += exact.primitive != 2 && exact.primitive != 3;
        for (int l = 0; l < LEVELS; ++l) {
            struct gpu_hit hit;
            assert_int_equal(hard_trace_twin(&sheets->hard, levels[l].numerics, &shot, 1, 1, &hit),
                             WHIT_OK);
            leaks->differ[l] += (hit.primitive == HIT_NONE) != (exact.primitive == HIT_NONE);
        }
    }
}

static struct leaks leaks_of_gap(const struct gap *gap, uint32_t ulps)
{
    struct leaks leaks = {0};
    while (leaks.rays < RAYS) {
        struct sheets sheets = make_sheets(gap, ulps);
        count_leaks(&sheets, gap->corner ? (float)ulps * sheets.ulp : -INFINITY, &leaks);
        free_sheets(&sheets);
    }
    return leaks;
}

/* S2 */
TEST(narrow_gaps_keep_their_light)
{
    static const struct gap gaps[] = {
        {"S2 at the origin", 0.0f, 1.0f, false, false},
        {"S2 at 1e3", 1e3f, 1.0f, false, false},
        {"S2 at 1e6, 1e3 in size", 1e6f, 1e3f, false, false},
        {"S2 at 1e3, 1e-1 in size", 1e3f, 0.1f, false, false},
        {"S2 instance at 1e3", 1e3f, 1.0f, true, false},
    };
    enum { WIDTHS = sizeof widths / sizeof *widths, EXACT = 1 };
    for (size_t i = 0; i < sizeof gaps / sizeof *gaps; ++i) {
        uint32_t safe = gaps[i].placed ? SAFE_ULPS_PLACED : SAFE_ULPS, narrowest = 0, rays = 0;
        uint32_t first_leaks = 0, differ = 0;
        random_state = 2;
        for (int w = 0; w < WIDTHS; ++w) {
            struct leaks leaks = leaks_of_gap(&gaps[i], widths[w]);
            first_leaks = w == 0 ? leaks.leaks : first_leaks;
            narrowest = leaks.leaks > 0 ? 0 : narrowest ? narrowest : widths[w];
            rays += leaks.rays;
            differ += leaks.differ[0];
            assert_int_equal(leaks.differ[EXACT], 0);
            assert_true(widths[w] < safe || leaks.leaks + leaks.differ[0] == 0);
        }
        print_message(
            "%-26s no leak from %u ulp on, of %u rays a gap; at 1 ulp %u leak; watertight "
            "says otherwise for %u of %u\n",
            gaps[i].name, narrowest, (uint32_t)RAYS, first_leaks, differ, rays);
        assert_true(first_leaks > 0); /* else nothing was near enough */
    }
}

TEST(corners_of_a_degree_keep_their_light)
{
    static const struct gap corners[] = {
        {"S3 at the origin", 0.0f, 1.0f, false, true},
        {"S3 at 1e3, 10 in size", 1e3f, 10.0f, false, true},
        {"S3 instance at 1e3, 10 in size", 1e3f, 10.0f, true, true},
    };
    for (size_t i = 0; i < sizeof corners / sizeof *corners; ++i) {
        struct leaks leaks[2];
        random_state = 3;
        leaks[0] = leaks_of_gap(&corners[i], 0);
        leaks[1] = leaks_of_gap(&corners[i], corners[i].placed ? SAFE_ULPS_PLACED : SAFE_ULPS);
        print_message("%-32s %u of %u leak, %u of %u where it is wider than roundings\n",
                      corners[i].name, leaks[0].leaks, leaks[0].rays, leaks[1].leaks,
                      leaks[1].rays);
        assert_int_equal(leaks[1].leaks + leaks[1].differ[0] + leaks[1].differ[1], 0);
    }
}
