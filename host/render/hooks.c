/* A user's functions in place of whit's own: what they change about how a picture is made. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/text.h"
#include "device/buffer.h"
#include "render/hooks.h"
#include "render/pixels.h"
#include "render/stage_set.h"
#include "scene/effects.h"
#include "shader/sliders.h"

_Static_assert(DBG_CALLS == SHADER_DBG_MAX, "room for all of them");
_Static_assert(SLIDERS_MAX == SHADER_SLIDERS_MAX, "the same values");
_Static_assert(HIT_SHAPE == WHIT_INSTANCE_SHAPE, "the same instance");
_Static_assert(HOOK_CAMERA == 1u << WHIT_HOOK_CAMERA && HOOK_SHADE == 1u << WHIT_HOOK_SHADE &&
                   HOOK_POST == 1u << WHIT_HOOK_POST && HOOK_AOV == 1u << WHIT_HOOK_AOV &&
                   HOOK_INTERSECT == 1u << WHIT_HOOK_INTERSECT,
               "the same bits");

#define EFFECT(name) (UINT64_C(1) << SCENE_EFFECT_##name)

/* Effects that kernels of the user's functions get only if these call or read what `reaches`
   names. */
static const struct {
    uint32_t reaches;
    uint64_t effects;
} asked[] = {
    {SHADER_REACHES_LIGHTS, EFFECT(POINT_LIGHTS) | EFFECT(DIRECTIONAL_LIGHTS) |
                                EFFECT(SPOT_LIGHTS) | EFFECT(AREA_LIGHTS) | EFFECT(TERMINATOR)},
    {SHADER_REACHES_SHADOWS, EFFECT(SHADOWS)},
    {SHADER_REACHES_TEXTURES, EFFECT(TEXTURES)},
    {SHADER_REACHES_VERTEX_COLORS, EFFECT(VERTEX_COLORS)},
    {SHADER_REACHES_METAL_ROUGH, EFFECT(METAL_ROUGH)},
    {SHADER_REACHES_EMISSION, EFFECT(EMISSION)},
    {SHADER_REACHES_HIGHLIGHTS, EFFECT(HIGHLIGHTS)},
    {SHADER_REACHES_NORMALS, EFFECT(SMOOTH_NORMALS) | EFFECT(NORMAL_MAPS)},
};

/* The effects of these bits change no ray that whit itself sends on from a surface. */
#define BY_FUNCTIONS_ALONE                                                                         \
    (SHADER_REACHES_LIGHTS | SHADER_REACHES_SHADOWS | SHADER_REACHES_EMISSION |                    \
     SHADER_REACHES_HIGHLIGHTS)

/* Whether surfaces send rays on or let rays pass, by what they look like. */
static bool has_rays(const struct renderer *renderer)
{
    static const enum scene_effect rays[] = {SCENE_EFFECT_REFLECTION, SCENE_EFFECT_REFRACTION,
                                             SCENE_EFFECT_CUTOUTS};
    const whit_renderer_params *params = &renderer->params;
    bool has = false;
    for (size_t i = 0; i < sizeof rays / sizeof *rays; ++i) {
        bool removed = params->effects_removed >> rays[i] & 1;
        has = has || (renderer->effects.called[rays[i]] && !removed) ||
              (params->effects_added >> rays[i] & 1);
    }
    return has;
}

/* SHADER_REACHES_* bits that decide which effects kernels are compiled with. With a user's shade(),
   lights and shadows are needed by shadow catchers alone, apart from the user's functions; the rest
   is needed by rays alone. */
static uint32_t deciding(const struct renderer *renderer)
{
    const whit_renderer_params *params = &renderer->params;
    if (!shader_has(params->shader, WHIT_HOOK_SHADE) || params->all_effects ||
        renderer->effects.called[SCENE_EFFECT_CATCHERS])
        return 0;
    return (params->keep_unread ? SHADER_REACHES_LIGHTS | SHADER_REACHES_SHADOWS
                                : SHADER_REACHES_ALL) &
           (has_rays(renderer) ? BY_FUNCTIONS_ALONE : SHADER_REACHES_ALL);
}

static uint64_t effects_not_asked_for(const struct renderer *renderer)
{
    uint64_t effects = 0;
    uint32_t unasked = renderer->reaches_decide & ~shader_reaches(renderer->params.shader);
    for (size_t i = 0; i < sizeof asked / sizeof *asked; ++i)
        effects |= unasked & asked[i].reaches ? asked[i].effects : 0;
    return effects & ~renderer->params.effects_added;
}

void hooks_take(struct renderer *renderer)
{
    whit_renderer_params *params = &renderer->params;
    if (!params->shader)
        return;
    params->compile_async = false; /* the general kernel has none of the user's functions */
    if (shader_has(params->shader, WHIT_HOOK_SCATTER))
        params->effects_added |= EFFECT(REFLECTION) & ~params->effects_removed;
    renderer->reaches_decide = deciding(renderer);
    renderer->effects_unasked = effects_not_asked_for(renderer) & ~params->effects_removed;
    params->effects_removed |= renderer->effects_unasked;
}

uint32_t hooks_dbg_count(const struct target *target)
{
    const whit_shader *shader = target->renderer->params.shader;
    return shader && target->probed ? shader->dbg.count : 0;
}

const struct shader_code *hooks_code(const struct target *target, const char *kernel)
{
    return shader_code_of(target->renderer->params.shader, kernel, hooks_dbg_count(target) > 0);
}

uint32_t hooks_aov_count(const struct target *target)
{
    const whit_shader *shader = target->renderer->params.shader;
    return shader && (!target->probed || shader->dbg.count) ? shader->aov_count : 0;
}

whit_result hooks_check_step_aov(const struct renderer *renderer, uint32_t step_aov)
{
    uint32_t count = hooks_aov_count(&renderer->picture);
    if (step_aov <= count)
        return WHIT_OK;
    return log_usage(&renderer->log, "steps of the aov number %u: the shader has %u", step_aov,
                     count);
}

whit_result hooks_read_sliders(struct renderer *renderer, const char *sliders)
{
    char why[512];
    float values[SLIDERS_MAX]; /* those of the renderer stay after an error */
    if (!renderer->params.shader && (!sliders || !sliders[0] || renderer->params.skip_sliders))
        return WHIT_OK;
    if (!renderer->params.shader)
        return log_usage(&renderer->log, "sliders are set, and there is no shader that has any");
    if (shader_sliders_read(renderer->params.shader, sliders, renderer->params.skip_sliders, values,
                            why, sizeof why)) {
        memcpy(renderer->sliders, values, sizeof values);
        return WHIT_OK;
    }
    return log_usage(&renderer->log, "%s", why);
}

/* Buffers are made for the number of aovs. */
static bool same_aovs(const whit_shader *a, const whit_shader *b)
{
    bool same = a->aov_count == b->aov_count;
    for (uint32_t i = 0; same && i < a->aov_count; ++i)
        same = strcmp(a->aov_names[i], b->aov_names[i]) == 0;
    return same;
}

bool renderer_takes_shader(const struct renderer *renderer, const whit_shader *shader)
{
    const whit_shader *own = renderer->params.shader;
    return own && shader && own->hooks == shader->hooks && same_aovs(own, shader) &&
           !((shader_reaches(own) ^ shader_reaches(shader)) & renderer->reaches_decide);
}

whit_result renderer_set_shader(struct renderer *renderer, const whit_renderer_params *params)
{
    const whit_shader *before = renderer->params.shader;
    uint32_t aovs = hooks_aov_count(&renderer->probe);
    const struct gpu_frame frame = renderer->frame;
    float sliders[SLIDERS_MAX];
    memcpy(sliders, renderer->sliders, sizeof sliders);
    renderer->params.shader = renderer->portable.shader = params->shader;
    whit_result result = hooks_find_material(renderer);
    if (result == WHIT_OK)
        result = renderer_set_view(renderer, params);
    if (result == WHIT_OK) {
        result = stages_replace(&renderer->picture, before);
        renderer->between_views = result != WHIT_OK; /* the device has the new shader's sliders */
    }
    if (result != WHIT_OK) {
        renderer->params.shader = renderer->portable.shader = before;
        renderer->frame.shape_material = frame.shape_material;
        renderer->frame.shape_error = frame.shape_error;
        memcpy(renderer->sliders, sliders, sizeof sliders);
        return result;
    }
    stage_set_finish(&renderer->probe.stages.set);
    if (hooks_aov_count(&renderer->probe) != aovs)
        target_drop_pixels(&renderer->probe);
    hooks_warn_material(renderer);
    return WHIT_OK;
}

void hooks_warn_material(const struct renderer *renderer)
{
    const struct scene *scene = renderer->scene;
    const whit_shader *shader = renderer->params.shader;
    if (!shader_has(shader, WHIT_HOOK_INTERSECT) ||
        scene_find_worn(scene, shader->box.material) != SCENE_NONE)
        return;
    const struct shader_box *box = &shader->box;
    const char **names = array_alloc_zeroed(scene->material_count, sizeof *names);
    const char *nearest = NULL;
    uint32_t count = 0;
    for (uint32_t i = 0; names && i < scene->material_count; ++i) {
        const char *name = scene->materials[i].name;
        if (name && name[0] && scene_find_worn(scene, name) != SCENE_NONE)
            names[count++] = name;
    }
    nearest = count > 0 ? text_nearest(box->material, names, count) : NULL;
    log_warning(&renderer->log, "%s:%u: nothing in the scene wears a material `%s`%s%s%s",
                shader->text.files[box->file].name, box->line, box->material,
                nearest ? "; did you mean `" : "", nearest ? nearest : "", nearest ? "`?" : "");
    free(names);
}

whit_result hooks_find_material(struct renderer *renderer)
{
    const whit_shader *shader = renderer->params.shader;
    if (!shader_has(shader, WHIT_HOOK_INTERSECT))
        return WHIT_OK;
    const struct shader_box *box = &shader->box;
    uint32_t index = scene_find_worn(renderer->scene, box->material);
    if (index == SCENE_NONE)
        index = scene_find_worn(renderer->scene, "");
    if (index == SCENE_NONE)
        return log_failure(&renderer->log, WHIT_ERROR_INPUT,
                           "%s:%u: the scene has no material for the shape",
                           shader->text.files[box->file].name, box->line);
    const float *passes = renderer->scene->materials[index].transmission;
    bool glass = passes[0] > 0.0f || passes[1] > 0.0f || passes[2] > 0.0f;
    renderer->frame.shape_material = index | (glass ? SHAPE_IS_GLASS : 0);
    renderer->frame.shape_error = box->error;
    return WHIT_OK;
}

whit_result hooks_clear_status(const struct target *target)
{
    const uint32_t none[2] = {0, 0};
    return buffer_write(target->buffers.status, STATUS_LOOP_AT, none, sizeof none);
}

/* Reads a word of the status buffer at byte `at`; 0 where it cannot be read. */
static uint32_t read_status(const struct target *target, uint64_t at)
{
    uint32_t number = 0;
    bool fine = buffer_read(target->buffers.status, at, &number, sizeof number) == WHIT_OK;
    return fine ? number : 0;
}

void hooks_describe_file(const struct target *target, char *text, size_t text_bytes)
{
    const whit_shader *shader = target->renderer->params.shader;
    if (shader && shader->text.file_count > 0)
        text_add(text, text_bytes, "; %s has functions of this picture",
                 shader->text.files[0].name);
}

void hooks_describe_loops(const struct target *target, char *text, size_t text_bytes)
{
    enum { NAMED = 4 };
    const whit_shader *shader = target->renderer->params.shader;
    uint32_t line = 0, count = 0;
    const char *file = "";
    for (uint32_t kernel = 0; shader && count == 0 && kernel < HOOK_KERNEL_TEST; ++kernel) {
        for (; shader_find_loop(shader, kernel << 16 | (count + 1), &file, &line); ++count) {
            if (count < NAMED)
                text_add(text, text_bytes, "%s%s:%u", count ? ", " : ": ", file, line);
        }
    }
    if (count > NAMED)
        text_add(text, text_bytes, " and %u more", count - NAMED);
    if (count == 0)
        hooks_describe_file(target, text, text_bytes);
}

void hooks_describe_fuel(const struct target *target, char *text, size_t text_bytes)
{
    uint32_t line = 0;
    const char *file = "";
    const whit_shader *shader = target->renderer->params.shader;
    if (!shader || !shader_find_loop(shader, read_status(target, STATUS_LOOP_AT), &file, &line))
        return;
    if (shader->fuel < SHADER_FUEL_MAX)
        text_add(text, text_bytes, ": %s:%u: `//@ fuel N` gives it more than %u, up to %d", file,
                 line, shader->fuel, SHADER_FUEL_MAX);
    else
        text_add(text, text_bytes, ": %s:%u: it has the most fuel, %d; --trust sets no limit", file,
                 line, SHADER_FUEL_MAX);
}

void hooks_describe_shape(const struct target *target, char *text, size_t text_bytes)
{
    static const char *const reasons[] = {
        [SHAPE_NOT_A_NUMBER] = "gives what is no number",
        [SHAPE_BY_REACH] = "meets something else with a larger `far`",
        [SHAPE_OUTSIDE] = "meets its shape outside of the box of `//@ box`",
    };
    uint32_t file, line;
    const struct renderer *renderer = target->renderer;
    const whit_shader *shader = renderer->params.shader;
    uint32_t word = read_status(target, STATUS_SHAPE_AT), reason = word >> SHAPE_REASON_SHIFT;
    uint32_t pixel = SHAPE_PIXEL_MASK - (word & SHAPE_PIXEL_MASK), width = renderer->params.width;
    if (shader && reason && shader_text_defines(&shader->text, "intersect", &file, &line))
        text_add(text, text_bytes, ": %s:%u: intersect() %s, in pixel %u, %u of %u x %u",
                 shader->text.files[file].name, line, reasons[reason], pixel % width, pixel / width,
                 width, renderer->params.height);
}
