/* What the library says of trees and of hits in them, whatever the trees; no device is needed. */
#include <math.h>

#include "folder_fixture.h"
#include "whit.h"

static whit_scene *scene;

static void load(const char *text)
{
    assert_int_equal(whit_scene_load(put_text("a.json", text), NULL, &warnings_log, &scene),
                     WHIT_OK);
}

static whit_accel *accel_of(const whit_accel_params *params)
{
    whit_accel *accel = NULL;
    assert_int_equal(whit_accel_create(scene, params, &accel), WHIT_OK);
    return accel;
}

/* ---- Normals of hits ---- */

struct corners {
    uint32_t instance, primitive;
    float at[9];
};

static bool find_corners(void *user, const whit_triangle *triangle)
{
    struct corners *corners = user;
    if (triangle->instance == corners->instance && triangle->primitive == corners->primitive)
        memcpy(corners->at, triangle->vertices, sizeof corners->at);
    return true;
}

/* The unit normal of the hit's triangle by its vertices in world space. */
static void world_normal(const whit_hit *hit, double n[3])
{
    struct corners corners = {hit->instance, hit->primitive, {0}};
    double e[2][3];
    assert_int_equal(whit_scene_triangles(scene, 0.0, find_corners, &corners), WHIT_OK);
    for (int i = 0; i < 6; ++i)
        e[i / 3][i % 3] = (double)corners.at[3 + i] - (double)corners.at[i % 3];
    for (int i = 0; i < 3; ++i)
        n[i] = e[0][(i + 1) % 3] * e[1][(i + 2) % 3] - e[0][(i + 2) % 3] * e[1][(i + 1) % 3];
    double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; ++i)
        n[i] /= size;
}

/* The cosine between the hit's ng and its triangle's normal. */
static double cosine(const whit_hit *hit)
{
    double n[3], dot = 0.0, size = 0.0;
    world_normal(hit, n);
    for (int i = 0; i < 3; ++i) {
        dot += (double)hit->ng[i] * n[i];
        size += (double)hit->ng[i] * (double)hit->ng[i];
    }
    return dot / sqrt(size);
}

TEST_IN(normals_of_hits_have_the_side_of_their_object, folder_begin, folder_end)
{
    const double sides[] = {1.0, -1.0, 1.0};
    load("{\"materials\": {\"m\": {}}, \"objects\": ["
         "{\"shape\": \"box\", \"material\": \"m\", \"scale\": [3, 3, 3], \"translation\": [-9, 0, "
         "0]},"
         "{\"shape\": \"box\", \"material\": \"m\", \"scale\": [-3, 2, 1]},"
         "{\"shape\": \"box\", \"material\": \"m\", \"scale\": [-3, -2, 1], \"translation\": [9, "
         "0, 0]}]}");
    for (int trees = WHIT_INSTANCES_AUTO; trees <= WHIT_INSTANCES_OFF; ++trees) {
        whit_accel *accel = accel_of(&(whit_accel_params){.instances = (whit_instances)trees});
        whit_renderer *renderer = NULL;
        assert_int_equal(whit_renderer_create(NULL, accel, NULL, &renderer), WHIT_OK);
        for (int i = 0; i < 3; ++i) {
            const whit_ray ray = {{9.0f * (float)i - 8.9f, 0.2f, 9}, 0, {0, 0, -1}, INFINITY};
            whit_hit hit;
            assert_int_equal(whit_trace(renderer, WHIT_TRACE_CPU_FLOAT, &ray, 1, false, &hit, NULL),
                             WHIT_OK);
            assert_int_equal(hit.instance, i);
            assert_true(fabs(cosine(&hit) - sides[i]) < 1e-6 && hit.ng[2] > 0.0f);
        }
        whit_renderer_destroy(renderer);
        whit_accel_destroy(accel);
    }
    whit_scene_destroy(scene);
}

/* ---- Trees ---- */

TEST(params_of_trees_are_refused_once)
{
    const whit_accel_params bad[] = {{.build = (whit_build)9},
                                     {.bins = 257},
                                     {.leaf_limit = 16},
                                     {.spatial_alpha = -1.0f},
                                     {.spatial_budget = NAN}};
    whit_accel *accel = NULL;
    messages = (struct messages){0};
    assert_int_equal(whit_scene_load(WHIT_SCENES_DIR "/balls.json", NULL, &warnings_log, &scene),
                     WHIT_OK);
    for (int i = 0; i < 5; ++i) {
        assert_int_equal(whit_accel_create(scene, &bad[i], &accel), WHIT_ERROR_USAGE);
        assert_int_equal(messages.errors, i + 1);
    }
    assert_non_null(strstr(messages.text, "spatial_alpha -1 and spatial_budget 0: the first"));
    whit_scene_destroy(scene);
}

TEST(boxes_are_those_of_the_time_of_the_trees)
{
    whit_box *boxes = NULL;
    uint64_t total;
    messages = (struct messages){0};
    assert_int_equal(whit_scene_load(WHIT_SCENES_DIR "/spin.json", NULL, &warnings_log, &scene),
                     WHIT_OK);
    whit_accel *accel = accel_of(NULL);
    assert_int_equal(whit_accel_boxes(accel, 0.0, true, 0, 1, &boxes, &total), WHIT_OK);
    whit_memory_destroy(boxes);
    assert_int_equal(whit_accel_boxes(accel, 1.5, true, 0, 1, &boxes, &total), WHIT_ERROR_USAGE);
    assert_null(boxes);
    assert_string_equal(messages.last_error, "boxes at 1.5 s: the trees are posed at 0 s");
    whit_accel_destroy(accel);
    whit_scene_destroy(scene);
}
