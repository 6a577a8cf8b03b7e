/* The general kernel draws while a thread compiles the specialised one: pictures are the same bytes
   whichever kernel draws them, and whatever is called in between. The linker puts the functions
   below in place of thread_start and thread_join, so that the test says when the thread begins. */
#include <semaphore.h>

#include "../wrapped.h"
#include "base/threads.h"
#include "device/pipeline.h"
#include "picture_fixture.h"
#include "render/variants.h"
#include "render_scenes.h"
#include "unit.h"

/* The thread that compiles, of which there is never more than one: what it runs, and the signals
   that let it begin and that say that it has ended. */
static struct {
    void (*fn)(void *context);
    void *context;
    sem_t begin, ended;
} compiling;

static void compile_when_told(void *context)
{
    (void)context;
    assert_int_equal(sem_wait(&compiling.begin), 0);
    compiling.fn(compiling.context);
    assert_int_equal(sem_post(&compiling.ended), 0);
}

WRAPPED(struct thread *, thread_start, void (*fn)(void *context), void *context)
{
    compiling.fn = fn;
    compiling.context = context;
    assert_int_equal(sem_init(&compiling.begin, 0, 0), 0);
    assert_int_equal(sem_init(&compiling.ended, 0, 0), 0);
    return __real_thread_start(compile_when_told, NULL);
}

static void let_thread_begin(void)
{
    assert_int_equal(sem_post(&compiling.begin), 0);
}

static void await_thread(void)
{
    assert_int_equal(sem_wait(&compiling.ended), 0);
}

/* Tells the compiling thread to begin before it joins it, so that callers need not do so. */
WRAPPED(void, thread_join, struct thread *thread)
{
    let_thread_begin();
    __real_thread_join(thread);
}

static bool refused; /* as when memory runs out */

WRAPPED(whit_result, pipeline_create, struct device *device, const struct pipeline_params *params,
        struct pipeline **out)
{
    return refused ? WHIT_ERROR_MEMORY : __real_pipeline_create(device, params, out);
}

WRAPPED(whit_result, binding_set_create, struct pipeline *pipeline, struct buffer *const *buffers,
        uint32_t count, struct binding_set **out)
{
    return refused ? WHIT_ERROR_MEMORY : __real_binding_set_create(pipeline, buffers, count, out);
}

static whit_stats stats_of(const struct renderer *renderer)
{
    whit_stats stats;
    renderer_get_stats(renderer, &stats);
    return stats;
}

/* Draws while the thread has not begun: the picture is the general kernel's. */
static struct image render_general(struct fixture *f)
{
    struct image image = render(f);
    assert_true(stats_of(f->renderer).general);
    return image;
}

/* Lets the thread run to its end and draws then: the picture is the specialised kernel's. */
static struct image render_specialised(struct fixture *f)
{
    let_thread_begin();
    await_thread();
    struct image image = render(f);
    assert_false(stats_of(f->renderer).general);
    return image;
}

/* Without normals and colours, which makes the rows of its triangles shorter. It has two materials,
   so that a kernel that reads the wrong row for a triangle draws another picture. */
static struct scene *flat_scene(void)
{
    struct scene *scene = terrain_scene();
    uint32_t index = scene_put_material(scene, matte(0.1f, 0.2f, 0.3f));
    for (uint32_t t = 0; t < scene->meshes[0].triangle_count; ++t) {
        if (t % 5 < 2)
            scene->meshes[0].materials[t] = index;
    }
    free(scene->meshes[0].normals);
    scene->meshes[0].normals = NULL;
    return scene;
}

/* Effects left out so that the general kernel compiles faster. It still has some that the scenes do
   not call for: textures and cut-outs. */
static const uint64_t removed =
    UINT64_C(1) << SCENE_EFFECT_NORMAL_MAPS | UINT64_C(1) << SCENE_EFFECT_EMISSION |
    UINT64_C(1) << SCENE_EFFECT_SPOT_LIGHTS | UINT64_C(1) << SCENE_EFFECT_AREA_LIGHTS |
    UINT64_C(1) << SCENE_EFFECT_ENVIRONMENT_MAP | UINT64_C(1) << SCENE_EFFECT_METAL_ROUGH |
    UINT64_C(1) << SCENE_EFFECT_CULLING | UINT64_C(1) << SCENE_EFFECT_CATCHERS |
    UINT64_C(1) << SCENE_EFFECT_TINTED_SHADOWS;

static whit_renderer_params beside_params(whit_camera camera)
{
    return (whit_renderer_params){.width = 50,
                                  .height = 30,
                                  .depth = 4,
                                  .camera = camera,
                                  .effects_removed = removed,
                                  .compile_async = true};
}

TEST(both_kernels_draw_the_same)
{
    static struct scene *(*const make[])(void) = {glass_scene, flat_scene, ring_scene};
    static const whit_camera cameras[] = {GLASS_CAMERA, CAMERA_AT(0, 6, 9, 0, 0, 0, 0, 1, 0, 40),
                                          CAMERA_AT(0, 6, 14, 0, 0, 0, 0, 1, 0, 40)};
    for (int i = 0; i < 3; ++i) {
        /* Set, since else they would depend on whether the kernels are for many pictures. */
        whit_renderer_params params = beside_params(cameras[i]);
        params.packets = WHIT_PACKETS_OFF;
        params.classes = WHIT_CLASSES_MANY;
        params.effects_removed = i == 0 ? 0 : removed;
        own_fixture f = fixture_open(make[i](), NULL, &params);
        whit_stats begun = stats_of(f.renderer);
        assert_true(begun.general);
        own_image first = render_general(&f), second = render_specialised(&f);
        whit_stats done = stats_of(f.renderer);
        assert_null(f.renderer->async.job);
        assert_true(done.kernel_instructions < begun.kernel_instructions);
        params.compile_async = false;
        fixture_renew(&f, &params);
        assert_false(stats_of(f.renderer).general);
        own_image at_once = render(&f);
        assert_int_equal(stats_of(f.renderer).kernel_instructions, done.kernel_instructions);
        assert_same_image("general", &first, &at_once);
        assert_same_image("specialised", &second, &at_once);
    }
}

/* Stages that are timed from the second picture on need kernels that the thread did not make. */
TEST(stages_may_be_timed_once_the_kernels_are_there)
{
    whit_renderer_params params =
        beside_params((whit_camera)CAMERA_AT(0, 6, 14, 0, 0, 0, 0, 1, 0, 40));
    params.packets = WHIT_PACKETS_OFF;
    params.classes = WHIT_CLASSES_MANY;
    params.tile_size = 16;
    struct scene *scene = ring_scene();
    scene_put_lamp(scene, 0, 6, 3, 0.6f);
    own_fixture f = fixture_open(scene, NULL, &params);
    own_image first = render_general(&f);
    params.time_stages = true;
    assert_int_equal(renderer_set_view(f.renderer, &params), WHIT_OK);
    own_image second = render_specialised(&f);
    assert_non_null(f.renderer->picture.stages.set.passes[STAGE_SHADE_DIRECT].pipeline);
    assert_same_image("timed", &first, &second);
}

/* An effect that is removed by name is missing in the general kernel too. */
TEST(removed_effects_stay_removed)
{
    whit_renderer_params params = beside_params(glass_camera);
    params.shadows = WHIT_SHADOWS_NONE;
    params.effects_removed |= UINT64_C(1) << SCENE_EFFECT_REFLECTION;
    own_fixture f = fixture_open(glass_scene(), NULL, &params);
    own_image first = render_general(&f), second = render_specialised(&f);
    assert_same_image("specialised", &first, &second);
    assert_int_equal(stats_of(f.renderer).rays_shadow, 0);
    assert_int_equal(stats_of(f.renderer).rays_reflected, 0);
}

/* A renderer that is asked for a kernel with all effects starts no thread. */
TEST(all_effects_need_no_thread)
{
    whit_renderer_params params = beside_params((whit_camera){.name = NULL});
    own_fixture f = fixture_open(terrain_scene(), NULL, &params);
    params.all_effects = true;
    fixture_renew(&f, &params);
    own_image image = render(&f);
    assert_null(f.renderer->async.job);
}

/* Other scenes, other times, destroyed passes and cancelled pictures come while the thread is at
   work, or when it has just finished its pipeline. */
TEST(anything_may_come_in_between)
{
    bool cancel = false;
    whit_renderer_params params =
        beside_params((whit_camera)CAMERA_AT(0, 6, 9, 0, 0, 0, 0, 1, 0, 40));
    params.cancel = &cancel;
    own_fixture f = fixture_open(terrain_scene(), NULL, &params);
    /* The renderer is destroyed without a picture: before the thread begins, while it is at work,
       and when it has ended. */
    for (int i = 0; i < 3; ++i) {
        if (i >= 1)
            let_thread_begin();
        if (i == 2)
            await_thread();
        fixture_renew(&f, &params);
    }
    cancel = true;
    assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_CANCELLED);
    cancel = false;
    own_image before = render_general(&f);
    passes_finish(f.renderer); /* as when a buffer grows */
    own_image again = render_general(&f);
    assert_same_image("again", &before, &again);
    assert_int_equal(renderer_set_time(f.renderer, 1.0), WHIT_OK);
    own_image moved = render_specialised(&f);
    assert_same_image("again", &before, &moved);
    /* Constants that no longer fit: what the thread makes with them is not taken. */
    fixture_renew(&f, &params);
    f.renderer->effects.called[SCENE_EFFECT_SHADOWS] = false;
    passes_finish(f.renderer);
    own_image general = render_general(&f);
    assert_true(stats_of(f.renderer).rays_shadow > 0);
    own_image special = render_specialised(&f);
    assert_int_equal(stats_of(f.renderer).rays_shadow, 0);
}

/* First the kernels of the thread cannot be bound, then neither general nor other kernels made. */
TEST(kernels_are_made_again_after_errors)
{
    whit_renderer_params params = beside_params(glass_camera);
    own_fixture f = fixture_open(glass_scene(), NULL, &params);
    own_image before = render_general(&f);
    let_thread_begin();
    await_thread();
    refused = true;
    for (int i = 0; i < 2; ++i)
        assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_MEMORY);
    let_thread_begin();
    await_thread();
    refused = false;
    own_image again = render_general(&f);
    assert_same_image("again", &before, &again);
}
