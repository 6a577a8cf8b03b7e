/* What the library says of trees; no device is needed. */
#include <math.h>

#include "folder_fixture.h"
#include "whit.h"

static whit_scene *scene;

static whit_accel *accel_of(const whit_accel_params *params)
{
    whit_accel *accel = NULL;
    assert_int_equal(whit_accel_create(scene, params, &accel), WHIT_OK);
    return accel;
}

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
