/* Checks that the cases of `whit hard` are as described and the same on every machine, and that the
   judge finds wrong hits. */
#include "accel_fixture.h"

#include "base/hash.h"
#include "hard/judge.h"
#include "hard/mesh.h"
#include "hard/rays.h"
#include "hard/topology.h"
#include "unit.h"

enum { RAYS = 512, THREADS = 2 };

/* Hash of the exact hits' ids of the first RAYS rays of every case. `whit hard` prints it, and hits
   on every device must have it. */
#define HASH UINT64_C(0x24a2309bfa7331e3)

struct shots {
    struct hard_scene hard;
    struct hard_ray rays[RAYS];
    struct rational_hit exact[RAYS];
    struct gpu_hit hits[RAYS];
};

static const struct gpu_hit miss = {.t = INFINITY, .primitive = HIT_NONE, .instance = HIT_NONE};
static const struct hard_case sphere = {"sphere", HARD_SPHERE, HARD_AIMED, 0, 1, false, false};

static struct shots *shots_make(const struct hard_case *hard, uint64_t seed)
{
    struct shots *shots = calloc(1, sizeof *shots);
    assert_non_null(shots);
    assert_int_equal(hard_scene_init(&silent, hard, &shots->hard), WHIT_OK);
    for (uint32_t i = 0; i < RAYS; ++i)
        shots->rays[i] = hard_ray_make(&shots->hard, shots->hard.rays, seed, i);
    assert_int_equal(hard_trace_exact(&shots->hard, shots->rays, RAYS, THREADS, shots->exact),
                     WHIT_OK);
    return shots;
}

static void shots_free(struct shots *shots)
{
    hard_scene_finish(&shots->hard);
    free(shots);
}

static whit_tally shots_judge(const struct shots *shots, uint32_t numerics)
{
    const struct hard_judgement judgement = {.hard = &shots->hard,
                                             .rays = shots->rays,
                                             .exact = shots->exact,
                                             .hits = shots->hits,
                                             .numerics = numerics,
                                             .count = RAYS};
    whit_tally tally;
    assert_int_equal(hard_judge(&judgement, THREADS, &tally), WHIT_OK);
    assert_int_equal(tally.rays, RAYS);
    return tally;
}

static whit_tally shots_trace(struct shots *shots, uint32_t numerics)
{
    assert_int_equal(
        hard_trace_twin(&shots->hard, numerics, shots->rays, RAYS, THREADS, shots->hits), WHIT_OK);
    return shots_judge(shots, numerics);
}

static uint32_t count_hits(const struct shots *shots)
{
    uint32_t hits = 0;
    for (uint32_t i = 0; i < RAYS; ++i)
        hits += shots->exact[i].primitive != HIT_NONE;
    return hits;
}

/* Checks that no triangle of a case was dropped: closed meshes are still closed. */
static void check_case(const struct hard_case *hard, const struct shots *shots)
{
    const struct hard_topology *t = &shots->hard.topology;
    bool closed =
        hard->mesh <= HARD_UNWELDED || hard->mesh == HARD_CUBE || hard->mesh == HARD_OCTAHEDRON;
    assert_int_equal(shots->hard.scene->note_count > 0 &&
                         strstr(shots->hard.scene->notes[0].text, "dropped") != NULL,
                     false);
    if (closed) {
        assert_int_equal(t->open_edges + t->crowded_edges + t->flipped_edges + t->duplicates, 0);
        assert_int_equal(2 * t->edges, 3 * t->triangles);
    }
    if (shots->hard.truth == HARD_MUST_HIT)
        assert_int_equal(count_hits(shots), RAYS);
    if (shots->hard.truth == HARD_MUST_MISS)
        assert_int_equal(count_hits(shots), 0);
    if (shots->hard.truth == HARD_ORACLE && hard->rays != HARD_LISTED)
        assert_in_range(count_hits(shots), RAYS / 3, RAYS);
}

TEST(cases_are_what_they_say)
{
    uint32_t count;
    uint64_t hash = HASH_START, leaks[3] = {0}, wrong[3] = {0};
    const struct hard_case *cases = hard_cases(&count);
    for (uint32_t i = 0; i < count; ++i) {
        struct shots *shots = shots_make(&cases[i], i + 1);
        hash = hard_hash(hash, shots->exact, RAYS);
        check_case(&cases[i], shots);
        for (uint32_t numerics = 0; numerics < 3; ++numerics) {
            whit_tally tally = shots_trace(shots, numerics);
            leaks[numerics] += cases[i].not_promised ? 0 : tally.leaks;
            wrong[numerics] += tally.wrong;
            assert_true(hard_promise_kept(numerics, !cases[i].not_promised, &tally));
        }
        shots_free(shots);
    }
    print_message(
        "%u cases of %u rays: leaks %llu watertight, %llu fast, %llu exact; wrong %llu, "
        "%llu, %llu; hash %016llx\n",
        count, (uint32_t)RAYS, (unsigned long long)leaks[NUMERICS_WATERTIGHT],
        (unsigned long long)leaks[NUMERICS_FAST], (unsigned long long)leaks[NUMERICS_EXACT],
        (unsigned long long)wrong[NUMERICS_WATERTIGHT], (unsigned long long)wrong[NUMERICS_FAST],
        (unsigned long long)wrong[NUMERICS_EXACT], (unsigned long long)hash);
    assert_int_equal(hash, HASH);
    assert_true(leaks[NUMERICS_FAST] > 0); /* the cases are hard */
    assert_true(wrong[NUMERICS_FAST] > 0);
}

/* The judge notices hits that are removed, moved or invented, and reports a broken promise. */
TEST(the_judge_sees)
{
    struct shots *shots = shots_make(&sphere, 1);
    for (uint32_t numerics = 0; numerics < 3; numerics += NUMERICS_EXACT) {
        whit_tally before = shots_trace(shots, numerics);
        assert_true(hard_promise_kept(numerics, true, &before));
        assert_int_equal(before.leaks, 0);
        struct gpu_hit kept = shots->hits[7];
        shots->hits[7] = miss;
        whit_tally after = shots_judge(shots, numerics);
        assert_int_equal(after.misses, 1);
        assert_int_equal(after.leaks, 1);
        assert_false(hard_promise_kept(numerics, true, &after));
        shots->hits[7] = kept;
        shots->hits[7].primitive =
            (kept.primitive + 1000) % (uint32_t)shots->hard.scene->triangle_total;
        after = shots_judge(shots, numerics);
        if (shots->exact[7].primitive == kept.primitive) {
            assert_int_equal(after.other_ids, before.other_ids + 1);
            assert_true(numerics != NUMERICS_EXACT || !hard_promise_kept(numerics, true, &after));
        }
        shots->hits[7] = kept;
    }
    assert_int_equal(hard_count_differing(shots->hits, shots->hits, RAYS), 0);
    struct gpu_hit other[RAYS];
    memcpy(other, shots->hits, sizeof other);
    other[3].u += 1e-7f;
    assert_int_equal(hard_count_differing(shots->hits, other, RAYS), 1);
    shots_free(shots);
}

/* A ray from the rounded middle of triangle `i`, almost parallel to the triangle and outwards.
   Since its origin is off the plane by rounding, it may hit that same triangle, but far away. */
static struct hard_ray ray_in_plane(const struct scene_mesh *mesh, uint32_t i)
{
    const float *v[3];
    struct hard_ray made = {.ray.t_max = INFINITY, .instance = HIT_NONE, .primitive = HIT_NONE};
    for (int c = 0; c < 3; ++c)
        v[c] = &mesh->positions[3 * (size_t)mesh->indices[3 * (size_t)i + (size_t)c]];
    for (int k = 0; k < 3; ++k) {
        made.ray.origin[k] = (v[0][k] + v[1][k] + v[2][k]) / 3.0f;
        made.ray.dir[k] = (v[0][k] - made.ray.origin[k]) + 3e-7f * made.ray.origin[k];
    }
    return made;
}

TEST(rays_in_a_plane_are_no_leaks)
{
    struct shots *shots = shots_make(&sphere, 1);
    const struct scene_mesh *mesh = &shots->hard.scene->meshes[0];
    uint32_t far = 0;
    shots->hard.truth = HARD_ORACLE; /* as for a scene that is not known to be closed */
    for (uint32_t i = 0; i < RAYS; ++i)
        shots->rays[i] = ray_in_plane(mesh, i % mesh->triangle_count);
    assert_int_equal(hard_trace_exact(&shots->hard, shots->rays, RAYS, THREADS, shots->exact),
                     WHIT_OK);
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct rational_hit *exact = &shots->exact[i];
        bool own = exact->primitive == i % mesh->triangle_count && exact->t > 1e-3f;
        far += own;
        *exact = own ? *exact : (struct rational_hit){INFINITY, HIT_NONE, HIT_NONE, 0};
        shots->hits[i] = miss;
    }
    whit_tally tally = shots_judge(shots, NUMERICS_WATERTIGHT);
    print_message("  %u rays go through the triangle that they start on; leaks %u\n", far,
                  (uint32_t)tally.leaks);
    assert_true(far > 10);
    assert_int_equal(tally.misses, far);
    assert_int_equal(tally.leaks, 0);
    shots_free(shots);
}

/* A ball sheared by 1e4. The line of a ray is off by more than the ball, in object space, where
   rays beside it in the world meet almost the same points: a miss is that of an outline. */
TEST(outlines_of_sheared_instances_are_no_leaks)
{
    const double at[3] = {0, 0, 0}, one[3] = {1, 1, 1};
    const struct affine shear = {.m = {1, 1e4, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    const struct affine turn = affine_from_trs(at, (double[]){0.3, -0.5, 0.2, 0.8}, one);
    const struct affine place = affine_multiply(&shear, &turn);
    struct scene_mesh mesh = mesh_sphere(1.0, 12, 8);
    struct shots *shots = calloc(1, sizeof *shots);
    struct scene *scene;
    assert_non_null(shots);
    assert_int_equal(hard_scene_of_mesh(&silent, "sheared", &mesh, &place, &scene), WHIT_OK);
    assert_int_equal(hard_scene_borrow(&silent, scene, 0.0, false, &shots->hard), WHIT_OK);
    for (uint32_t i = 0; i < RAYS; ++i)
        shots->rays[i] = hard_ray_make(&shots->hard, HARD_AROUND, 1, i);
    assert_int_equal(hard_trace_exact(&shots->hard, shots->rays, RAYS, THREADS, shots->exact),
                     WHIT_OK);
    whit_tally tally = shots_trace(shots, NUMERICS_WATERTIGHT);
    print_message("  %u misses, %u leaks\n", (uint32_t)tally.misses, (uint32_t)tally.leaks);
    assert_true(tally.misses > 0);
    assert_int_equal(tally.leaks, 0);
    shots_free(shots);
    scene_destroy(scene);
}

/* Rays that leave a convex body hit nothing; an invented hit counts as a self-hit. */
TEST(self_hits_are_seen)
{
    static const struct hard_case body = {
        "octahedron", HARD_OCTAHEDRON, HARD_LEAVING, 1e3, 1, false, false};
    struct shots *shots = shots_make(&body, 3);
    for (uint32_t i = 0; i < RAYS; ++i)
        shots->hits[i] = miss;
    assert_int_equal(shots_judge(shots, NUMERICS_EXACT).self_hits, 0);
    shots->hits[5] = (struct gpu_hit){.t = 1.0f, .primitive = 2, .instance = 0};
    whit_tally tally = shots_judge(shots, NUMERICS_EXACT);
    assert_int_equal(tally.self_hits, 1);
    assert_int_equal(tally.false_hits, 1);
    assert_false(hard_promise_kept(NUMERICS_EXACT, true, &tally));
    shots_free(shots);
}

/* A cube of 12 triangles with unshared vertices: complete, without the last triangle, with the
   first reversed, with the first in place of the last; and its first triangle alone, with its back.
 */
TEST(surfaces_are_described)
{
    static const struct {
        const char *name;
        uint64_t open, crowded, flipped, duplicates;
    } rows[] = {{"whole", 0, 0, 0, 0},
                {"one dropped", 3, 0, 0, 0},
                {"one flipped", 0, 0, 3, 0},
                {"one twice", 3, 0, 0, 1},
                {"one with its back", 3, 0, 0, 1}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        own_soup soup = soup_of_mesh("box", mesh_box(1, 2, 3));
        const float *v[3] = {soup_vertex(&soup, 0, 0), soup_vertex(&soup, 0, 1),
                             soup_vertex(&soup, 0, 2)};
        struct hard_topology t;
        uint32_t touched = 0;
        soup.count -= i == 1;
        if (i == 2)
            memcpy(soup.positions, (float[6]){v[1][0], v[1][1], v[1][2], v[0][0], v[0][1], v[0][2]},
                   6 * sizeof(float));
        if (i == 3)
            soup_set(&soup, soup.count - 1, v[0], v[1], v[2]);
        soup.count = i == 4 ? 2 : soup.count;
        if (i == 4)
            soup_set(&soup, 1, v[0], v[2], v[1]);
        own_scene *scene = scene_ready(soup_scene(&soup));
        assert_int_equal(hard_topology_init(scene, &t), WHIT_OK);
        for (uint32_t k = 0; k < t.triangles; ++k)
            touched += t.open[k];
        if (t.open_edges != rows[i].open || t.crowded_edges != rows[i].crowded ||
            t.flipped_edges != rows[i].flipped || t.duplicates != rows[i].duplicates ||
            (touched > 0) != (rows[i].open + rows[i].crowded > 0))
            fail_msg("%s", rows[i].name);
        hard_topology_finish(&t);
    }
}
