#include "app/render/layers.h"

#include <stdlib.h>
#include <string.h>

#include "app/render/recipe.h"
#include "base/path.h"
#include "base/text.h"

whit_result layers_read(const whit_shader *shader, whit_renderer *renderer,
                        const whit_refine *refine, struct layers *layers)
{
    const whit_shader_info info = job_shader_info(shader);
    whit_result result = WHIT_OK;
    *layers = (struct layers){0};
    for (uint32_t i = 0; result == WHIT_OK && i < info.aov_count; ++i) {
        whit_image **image = &layers->images[i];
        result = renderer ? whit_renderer_image(renderer, (whit_aov)(WHIT_AOV_SHADER + i), image)
                          : whit_refine_aov(refine, i, image);
        layers->items[i] = (whit_image_layer){info.aovs[i], *image};
        layers->count = i + 1;
    }
    if (result != WHIT_OK)
        layers_finish(layers);
    return result;
}

void layers_finish(struct layers *layers)
{
    for (uint32_t i = 0; i < layers->count; ++i)
        whit_image_destroy(layers->images[i]);
    *layers = (struct layers){0};
}

void drawn_images_finish(struct drawn_images *images)
{
    whit_image_destroy(images->color);
    whit_image_destroy(images->ids);
    layers_finish(&images->layers);
    *images = (struct drawn_images){0};
}

bool layers_check(const struct job *job)
{
    char list[512] = "";
    const whit_shader_info info = job_shader_info(job->shader);
    const char *wanted = job->settings.aov;
    if (!wanted[0])
        return true;
    for (uint32_t i = 0; i < info.aov_count; ++i) {
        if (strcmp(info.aovs[i], wanted) == 0)
            return true;
        text_add(list, sizeof list, "%s%s", i ? ", " : ": there is ", info.aovs[i]);
    }
    return CLI_FAIL(false, "--aov %s: %s has no such `//@ aov`%s", wanted, job->settings.shader,
                    list);
}

static whit_result leave_alpha_out(const whit_image *image, whit_image **out)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    size_t count = (size_t)info.width * info.height;
    float *rgb = malloc(count * 3 * sizeof *rgb);
    if (!rgb)
        return WHIT_ERROR_MEMORY;
    for (size_t i = 0; i < count; ++i)
        memcpy(rgb + 3 * i, whit_image_floats(image) + 4 * i, 3 * sizeof *rgb);
    whit_result result = whit_image_create(info.width, info.height, 3, rgb, out);
    free(rgb);
    return result;
}

whit_result layers_save_image(const whit_image *image, const char *path,
                              const struct recipe *recipe, const whit_log *log)
{
    whit_image *opaque = NULL;
    whit_result result = path_is(path, "exr") ? WHIT_OK : leave_alpha_out(image, &opaque);
    if (result == WHIT_OK)
        result = whit_image_save(opaque ? opaque : image, path, recipe->texts, recipe->count, log);
    whit_image_destroy(opaque);
    return result;
}

whit_result layers_save(const struct layers *layers, const char *name, const char *path,
                        const struct recipe *recipe)
{
    const whit_image *image = NULL;
    for (uint32_t i = 0; i < layers->count; ++i)
        image = strcmp(layers->items[i].name, name) == 0 ? layers->images[i] : image;
    return layers_save_image(image, path, recipe, &cli_log);
}
