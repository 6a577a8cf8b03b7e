/* Renders a scene to a picture and asks which triangles lie along a few rays, with libwhit alone:
       example SCENE PICTURE.png */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <whit/whit.h>

enum { RAY_COUNT = 5 };

static void on_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    fprintf(stderr, "example: %s%s\n", level == WHIT_LOG_ERROR ? "error: " : "", message);
}

/* From above the scene, straight down. */
static void make_rays(const whit_scene *scene, whit_ray rays[RAY_COUNT])
{
    whit_scene_info info;
    whit_scene_get_info(scene, &info);
    for (int i = 0; i < RAY_COUNT; ++i) {
        double along = (i + 0.5) / RAY_COUNT;
        rays[i] = (whit_ray){
            .origin = {(float)(info.lo[0] + along * (info.hi[0] - info.lo[0])),
                       (float)(2.0 * info.hi[1] - info.lo[1] + 1.0),
                       (float)(0.5 * (info.lo[2] + info.hi[2]))},
            .dir = {0.0f, -1.0f, 0.0f},
            .t_max = INFINITY,
        };
    }
}

/* The same rays on the device and on the CPU: their hits must be equal. */
static whit_result trace(whit_renderer *renderer, const whit_scene *scene)
{
    whit_ray rays[RAY_COUNT];
    whit_hit hits[RAY_COUNT], twins[RAY_COUNT];
    make_rays(scene, rays);
    whit_result result =
        whit_trace(renderer, WHIT_TRACE_DEVICE, rays, RAY_COUNT, false, hits, NULL);
    if (result == WHIT_OK)
        result = whit_trace(renderer, WHIT_TRACE_CPU_FLOAT, rays, RAY_COUNT, false, twins, NULL);
    for (int i = 0; i < RAY_COUNT && result == WHIT_OK; ++i) {
        if (hits[i].primitive != twins[i].primitive || hits[i].instance != twins[i].instance)
            return WHIT_ERROR_FAILED;
        if (hits[i].primitive == WHIT_NONE)
            printf("ray %d: nothing\n", i);
        else
            printf("ray %d: instance %u, primitive %u at t = %g\n", i, hits[i].instance,
                   hits[i].primitive, (double)hits[i].t);
    }
    return result;
}

static whit_result save(whit_renderer *renderer, const char *path, const whit_log *log)
{
    whit_image *image;
    whit_result result = whit_renderer_image(renderer, WHIT_AOV_COLOR, &image);
    if (result != WHIT_OK)
        return result;
    const whit_text text = {.key = "Software", .value = "whit example"};
    result = whit_image_save(image, path, &text, 1, log);
    whit_image_destroy(image);
    return result;
}

int main(int argc, char **argv)
{
    const whit_log log = {.fn = on_message, .level = WHIT_LOG_WARNING};
    whit_renderer_params params = whit_renderer_defaults();
    params.width = 160;
    params.height = 120;
    whit_scene *scene = NULL;
    whit_accel *accel = NULL;
    whit_device *device = NULL;
    whit_renderer *renderer = NULL;
    if (argc != 3) {
        fprintf(stderr, "usage: example SCENE PICTURE.png\n");
        return 2;
    }
    whit_result result = whit_scene_load(argv[1], NULL, &log, &scene);
    if (result == WHIT_OK)
        result = whit_accel_create(scene, NULL, &accel);
    if (result == WHIT_OK)
        result = whit_device_create(NULL, &log, &device);
    if (result == WHIT_OK)
        result = whit_renderer_create(device, accel, &params, &renderer);
    if (result == WHIT_OK)
        result = whit_renderer_render(renderer);
    if (result == WHIT_OK)
        result = save(renderer, argv[2], &log);
    if (result == WHIT_OK)
        result = trace(renderer, scene);
    whit_renderer_destroy(renderer);
    whit_device_destroy(device);
    whit_accel_destroy(accel);
    whit_scene_destroy(scene);
    printf("example: %s\n", whit_result_name(result));
    return result == WHIT_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
