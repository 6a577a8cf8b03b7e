/* `whit bench views`: compares small pictures of many cameras, drawn together, with one picture of
   as many pixels. */
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/path.h"
#include "base/vec.h"
#include "bench/table.h"
#include "whit/whit_program.h"

enum { VIEW_SIDE = 64, APART_EVERY = 8 };
enum side { TOGETHER, ONE, APART, SIDES };
static const double TURN = 0.5; /* angle in radians over which the cameras of the views are spread
                                   around the target */

struct views {
    struct bench *bench;
    const char *name;
    bool around; /* cameras are turned around the target of the scene's first camera; else each sees
                    a tile of that camera's picture */
    struct bench_scene loaded;
    whit_camera camera;
    uint32_t side;
    whit_renderer *renderers[SIDES]; /* for views together; for one picture; for views one after
                                        another */
    whit_camera *cameras;
    uint32_t count;
    struct sample_runs ms[SIDES];
    double rays[SIDES]; /* rays per pixel, of all kinds */
};

/* The scene's first camera as a pinhole. */
static whit_camera camera_of(const whit_camera_info *from)
{
    whit_camera camera = {.own = true,
                          .fov_y_degrees = from->fov_y_degrees > 0.0 ? from->fov_y_degrees : 40.0};
    for (int k = 0; k < 3; ++k) {
        camera.eye[k] = from->eye[k];
        camera.target[k] = from->target[k];
        camera.up[k] = from->up[k];
    }
    return camera;
}

/* The camera of view `index`: the scene's camera turned around its target. */
static whit_camera camera_around(const struct views *views, uint32_t index)
{
    whit_camera camera = views->camera;
    double angle = TURN * ((index + 0.5) / views->count - 0.5);
    double x = camera.eye[0] - camera.target[0], z = camera.eye[2] - camera.target[2];
    camera.eye[0] = camera.target[0] + x * cos(angle) + z * sin(angle);
    camera.eye[2] = camera.target[2] + z * cos(angle) - x * sin(angle);
    return camera;
}

/* The camera that sees tile `index` of the picture, and little else. */
static whit_camera camera_of_tile(const struct views *views, uint32_t index)
{
    whit_camera camera = views->camera;
    uint32_t side = views->side;
    double half = tan(camera.fov_y_degrees * PI / 360.0);
    double x = half * (2.0 * (index % side) + 1.0 - side) / side;
    double y = half * (side - 2.0 * (index / side) - 1.0) / side;
    double forward[3], right[3], up[3];
    for (int k = 0; k < 3; ++k)
        forward[k] = camera.target[k] - camera.eye[k];
    double3_unit(forward);
    double3_cross(forward, camera.up, right);
    double3_unit(right);
    double3_cross(right, forward, up);
    for (int k = 0; k < 3; ++k)
        camera.target[k] = camera.eye[k] + forward[k] + right[k] * x + up[k] * y;
    camera.fov_y_degrees = atan(half / side / sqrt(1.0 + x * x + y * y)) * 360.0 / PI;
    return camera;
}

/* The number of sides to run. APART draws only some views, and tiles are too different for some to
   stand for all. */
static uint32_t sides_of(bool around)
{
    return around ? SIDES : APART;
}

static whit_renderer_params params_of(const struct views *views, enum side side)
{
    whit_renderer_params params = whit_renderer_defaults();
    params.camera = views->camera;
    params.width = params.height = side == ONE ? VIEW_SIDE * views->side : VIEW_SIDE;
    params.many_pictures = side != ONE;
    params.cancel = &cli_cancel;
    return params;
}

static whit_result create_renderers(struct views *views)
{
    whit_camera_info info;
    whit_result result = WHIT_OK;
    whit_scene_get_camera(views->loaded.scene, 0, &info);
    views->camera = camera_of(&info);
    views->cameras = array_alloc(views->count, sizeof *views->cameras);
    if (!views->cameras)
        return WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; i < views->count; ++i)
        views->cameras[i] = views->around ? camera_around(views, i) : camera_of_tile(views, i);
    for (int side = 0; result == WHIT_OK && side < (int)sides_of(views->around); ++side) {
        const whit_renderer_params params = params_of(views, (enum side)side);
        result = whit_renderer_create(views->bench->device, views->loaded.accel, &params,
                                      &views->renderers[side]);
    }
    return result;
}

/* Draws one picture, or where `count` is not 0 the views of as many cameras, and reads the pixels
   to the host. */
static whit_result draw_picture(whit_renderer *renderer, const whit_camera *cameras, uint32_t count)
{
    whit_image *image = NULL;
    whit_result result = count ? whit_renderer_render_views(renderer, cameras, count)
                               : whit_renderer_render(renderer);
    if (result == WHIT_OK)
        result = whit_renderer_image(renderer, WHIT_AOV_COLOR, &image);
    whit_image_destroy(image);
    return result;
}

static whit_result draw_side(struct views *views, enum side side)
{
    whit_renderer *renderer = views->renderers[side];
    whit_renderer_params params = params_of(views, side);
    whit_result result = WHIT_OK;
    if (side != APART)
        return draw_picture(renderer, views->cameras, side == TOGETHER ? views->count : 0);
    for (uint32_t i = 0; result == WHIT_OK && i < views->count; i += APART_EVERY) {
        params.camera = views->cameras[i];
        result = whit_renderer_set_view(renderer, &params);
        if (result == WHIT_OK)
            result = draw_picture(renderer, NULL, 0);
    }
    return result;
}

/* The first run is a warm-up. */
static whit_result draw(void *user, uint32_t side, uint32_t run)
{
    struct views *views = user;
    whit_stats stats;
    double (*clock_ms)(void) = views->bench->is_cpu ? whit_clock_cpu_ms : whit_clock_ms;
    double start_ms = clock_ms();
    whit_result result = draw_side(views, (enum side)side);
    if (result != WHIT_OK)
        return result;
    double spent_ms = clock_ms() - start_ms;
    if (side == APART) {
        uint32_t drawn = (views->count + APART_EVERY - 1) / APART_EVERY;
        spent_ms *= (double)views->count / drawn;
    }
    if (run > 0)
        sample_add(&views->ms[side], spent_ms);
    whit_renderer_get_stats(views->renderers[side], &stats);
    views->rays[side] = (double)whit_stats_rays(&stats) / (double)stats.rays_primary;
    return bench_step(views->bench);
}

static void put_row(struct table *table, const struct views *views)
{
    const struct goal goal = {1.3, 1.1, false}, none = {0};
    struct figure figure =
        table_ratio(&views->ms[TOGETHER], &views->ms[ONE], views->around ? none : goal);
    json_t *row = document_object();
    snprintf(figure.name, sizeof figure.name, "%s%s", views->name, views->around ? ", around" : "");
    document_text(row, "scene", views->name);
    document_text(row, "cameras", views->around ? "around" : "tiles");
    document_count(row, "views", views->count);
    document_put(row, "views_ms", table_times(&views->ms[TOGETHER]));
    document_put(row, "one_ms", table_times(&views->ms[ONE]));
    document_put(row, "apart_ms", table_times(&views->ms[APART]));
    document_numbers(row, "rays_a_pixel", views->rays, APART);
    table_row(table);
    table_cell(table, "%s", figure.name);
    table_cell(table, "%u", views->count);
    table_ms(table, &views->ms[TOGETHER]);
    table_ms(table, &views->ms[ONE]);
    table_ms(table, &views->ms[APART]);
    table_cell(table, "%.2f, %.2f", views->rays[0], views->rays[1]);
    table_figure(table, &figure, row);
}

static whit_result run_scene(struct table *table, const char *name, bool around)
{
    char path[BENCH_PATH];
    struct views views = {.bench = table->bench, .name = path_name(name), .around = around};
    views.side = table->bench->ask.width / VIEW_SIDE / (around ? 2 : 1);
    views.count = views.side * views.side;
    whit_result result = bench_find(table->bench, name, path);
    if (result == WHIT_OK)
        result = bench_load_trees(path, &views.loaded);
    if (result == WHIT_OK)
        result = create_renderers(&views);
    if (result == WHIT_OK)
        result = sample_in_turns(sides_of(around), table->bench->ask.runs + 1, draw, &views);
    if (result == WHIT_OK)
        put_row(table, &views);
    for (int i = 0; i < SIDES; ++i)
        whit_renderer_destroy(views.renderers[i]);
    bench_unload(&views.loaded);
    free(views.cameras);
    return result;
}

whit_result bench_views(struct bench *bench)
{
    static const char *const heads[] = {"scene",     "views",        "views, ms", "one, ms",
                                        "apart, ms", "rays a pixel", NULL};
    static const char *const usual[] = {"room", "whitted", "34k"};
    const char *const *names = bench->ask.name_count ? bench->ask.names : usual;
    uint32_t count = bench->ask.name_count ? bench->ask.name_count : 3;
    struct table table;
    whit_result result = WHIT_OK;
    table_begin(&table, bench, "views", heads, true,
                count * (sides_of(false) + sides_of(true)) * (bench->ask.runs + 1));
    table_say(&table,
              "ms: %s a picture and its pixels on the host, in one process, kernels made. Views of "
              "%d x %d pixels; one sample, depth 8. Figure: times the time of one picture of as "
              "many pixels.",
              bench->is_cpu ? "processor time of" : "time by the clock of", VIEW_SIDE, VIEW_SIDE);
    table_say(&table, "The cameras see the tiles of that picture: the same rays. Around: each sees "
                      "all that the picture shows, from about its camera, by rays farther apart. "
                      "Apart: the views one after another, by "
                      "whit_renderer_set_view; every eighth is drawn, and all are reckoned.");
    for (uint32_t i = 0; result == WHIT_OK && i < 2 * count; ++i)
        result = run_scene(&table, names[i / 2], i % 2 != 0);
    return table_end(&table, "Views of many cameras", result);
}
