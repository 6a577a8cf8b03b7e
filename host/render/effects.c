/* The one list of effects and the specialization constants that they switch. */
#include <stddef.h>
#include <string.h>

#include "render/effects.h"
#include "scene/effects.h"

/* LIGHT_* bits of area lights: every kind but points, directional lights and spots. */
#define AREA_LIGHT_BITS (255u & ~(1u << LIGHT_POINT | 1u << LIGHT_DIRECTIONAL | 1u << LIGHT_SPOT))

#define SWITCH(effect, constant, bits)                                                             \
    {                                                                                              \
        SCENE_EFFECT_##effect, (uint32_t)offsetof(struct gpu_spec, constant) / 4u, bits            \
    }

/* The value of a constant is the sum of the bits of its effects that are on. */
static const struct effect_switch {
    enum scene_effect effect;
    uint32_t constant; /* id of the specialisation constant */
    uint32_t bits;
} switches[] = {
    SWITCH(SHADOWS, SPEC_SHADOWS, 1u),
    SWITCH(REFLECTION, SPEC_REFLECTION, 1u),
    SWITCH(REFRACTION, SPEC_REFRACTION, 1u),
    SWITCH(FRESNEL, SPEC_FRESNEL, FRESNEL_EXACT),
    SWITCH(ABSORPTION, SPEC_ABSORPTION, 1u),
    SWITCH(CUTOUTS, SPEC_CUTOUTS, 1u),
    SWITCH(TEXTURES, SPEC_TEXTURES, TEXTURES_ALL),
    SWITCH(NORMAL_MAPS, SPEC_NORMAL_MAPS, 1u),
    SWITCH(EMISSION, SPEC_EMISSION, 1u),
    SWITCH(HIGHLIGHTS, SPEC_HIGHLIGHTS, 1u),
    SWITCH(POINT_LIGHTS, SPEC_LIGHTS, 1u << LIGHT_POINT),
    SWITCH(DIRECTIONAL_LIGHTS, SPEC_LIGHTS, 1u << LIGHT_DIRECTIONAL),
    SWITCH(SPOT_LIGHTS, SPEC_LIGHTS, 1u << LIGHT_SPOT),
    SWITCH(AREA_LIGHTS, SPEC_LIGHTS, AREA_LIGHT_BITS),
    SWITCH(ENVIRONMENT_MAP, SPEC_ENVIRONMENT_MAP, 1u),
    SWITCH(SMOOTH_NORMALS, SPEC_SMOOTH_NORMALS, 1u),
    SWITCH(VERTEX_COLORS, SPEC_VERTEX_COLORS, 1u),
    SWITCH(METAL_ROUGH, SPEC_METAL_ROUGH, 1u),
    SWITCH(MEDIA, SPEC_MEDIA, MEDIA_TOUCH),
    SWITCH(SPHERES, SPEC_SPHERES, SPHERES_SOME),
    SWITCH(TINTED_SHADOWS, SPEC_FILTERS, 1u),
    SWITCH(CULLING, SPEC_CULLING, 1u),
    SWITCH(CATCHERS, SPEC_CATCHERS, 1u),
    SWITCH(TERMINATOR, SPEC_TERMINATOR, 1u),
};
enum { SWITCH_COUNT = sizeof switches / sizeof switches[0] };

/* Effects that do nothing without another one. Rows are sorted: an effect comes after what it
   needs. */
static const struct effect_need {
    enum scene_effect effect, needs;
} needs[] = {
    {SCENE_EFFECT_MEDIA, SCENE_EFFECT_REFRACTION},
    {SCENE_EFFECT_ABSORPTION, SCENE_EFFECT_MEDIA},
    {SCENE_EFFECT_TINTED_SHADOWS, SCENE_EFFECT_SHADOWS},
    {SCENE_EFFECT_TERMINATOR, SCENE_EFFECT_SHADOWS},
    {SCENE_EFFECT_TERMINATOR, SCENE_EFFECT_SMOOTH_NORMALS},
};
enum { NEED_COUNT = sizeof needs / sizeof needs[0] };

bool render_effect_can_add(enum scene_effect effect)
{
    for (int i = 0; i < SWITCH_COUNT; ++i) {
        if (switches[i].effect == effect)
            return true;
    }
    return false;
}

bool render_effect_can_remove(enum scene_effect effect)
{
    return effect == SCENE_EFFECT_LENS ||
           (effect != SCENE_EFFECT_SPHERES && render_effect_can_add(effect));
}

whit_result effects_check(const whit_log *log, const whit_renderer_params *params)
{
    for (uint32_t i = 0; i < 64; ++i) {
        enum scene_effect effect = (enum scene_effect)i;
        bool adds = params->effects_added >> i & 1, removes = params->effects_removed >> i & 1;
        const char *name = i < SCENE_EFFECT_COUNT ? scene_effect_name(effect) : "";
        if (adds && removes)
            return log_usage(log, "effects: `%s` is both added and left out", name);
        if ((adds && (!name[0] || !render_effect_can_add(effect))) ||
            (removes && (!name[0] || !render_effect_can_remove(effect))))
            return log_usage(log, "effects: number %u (`%s`) cannot be %s", i, name,
                             adds ? "added" : "left out");
    }
    return WHIT_OK;
}

void effects_choose(const whit_renderer_params *params, struct scene_effects *effects)
{
    uint64_t added = params->effects_added;
    for (int i = NEED_COUNT - 1; i >= 0; --i) {
        if (added >> needs[i].effect & 1)
            added |= UINT64_C(1) << needs[i].needs;
    }
    for (int i = 0; i < SWITCH_COUNT; ++i) {
        enum scene_effect effect = switches[i].effect;
        if (params->all_effects || (added >> effect & 1))
            effects->called[effect] = true;
    }
    for (int i = 0; i < SCENE_EFFECT_COUNT; ++i) {
        if (params->effects_removed >> i & 1)
            effects->called[i] = false;
    }
    if (params->shadows == WHIT_SHADOWS_NONE)
        effects->called[SCENE_EFFECT_SHADOWS] = false;
    if (params->shadows == WHIT_SHADOWS_OPAQUE)
        effects->called[SCENE_EFFECT_TINTED_SHADOWS] = false;
    for (int i = 0; i < NEED_COUNT; ++i) {
        if (!effects->called[needs[i].needs])
            effects->called[needs[i].effect] = false;
    }
}

void effects_switch(const struct scene_effects *effects, struct gpu_spec *spec)
{
    uint32_t values[GPU_SPEC_COUNT] = {0};
    bool switched[GPU_SPEC_COUNT] = {false};
    for (int i = 0; i < SWITCH_COUNT; ++i) {
        switched[switches[i].constant] = true;
        if (effects->called[switches[i].effect])
            values[switches[i].constant] |= switches[i].bits;
    }
    uint32_t *constants = (uint32_t *)spec;
    for (uint32_t i = 0; i < GPU_SPEC_COUNT; ++i) {
        if (switched[i])
            constants[i] = values[i];
    }
}

void effects_narrow_textures(const struct renderer *renderer, enum scene_materials which,
                             struct gpu_spec *spec)
{
    _Static_assert(TEXTURES_ALL == (1u << SCENE_SLOT_COUNT) - 1 &&
                       TEXTURES_SPECULAR_LEVEL == 1u << SCENE_SLOT_SPECULAR_LEVEL &&
                       TEXTURES_OPACITY == 1u << SCENE_SLOT_OPACITY,
                   "a bit for each slot");
    _Static_assert(SAMPLING_FILTERED == (uint32_t)SCENE_SAMPLING_FILTERED &&
                       SAMPLING_SRGB == (uint32_t)SCENE_SAMPLING_SRGB,
                   "the same bits");
    struct scene_effects own = {.called = {false}};
    uint64_t added = renderer->params.effects_added;
    if (renderer->params.all_effects || (added >> SCENE_EFFECT_TEXTURES & 1) ||
        (added >> SCENE_EFFECT_NORMAL_MAPS & 1))
        return;
    scene_effects_scan_materials(renderer->scene, which, &own);
    spec->SPEC_TEXTURES &= own.texture_slots;
    spec->SPEC_SAMPLING &= own.sampling;
}

void effects_narrow_to_class(const struct renderer *renderer, uint32_t material_class,
                             struct gpu_spec *spec)
{
    static const struct {
        enum scene_effect effect;
        uint32_t constant;
    } all[] = {
        {SCENE_EFFECT_REFLECTION, offsetof(struct gpu_spec, SPEC_REFLECTION)},
        {SCENE_EFFECT_REFRACTION, offsetof(struct gpu_spec, SPEC_REFRACTION)},
        {SCENE_EFFECT_MEDIA, offsetof(struct gpu_spec, SPEC_CROSSINGS)},
        {SCENE_EFFECT_FRESNEL, offsetof(struct gpu_spec, SPEC_FRESNEL)},
        {SCENE_EFFECT_NORMAL_MAPS, offsetof(struct gpu_spec, SPEC_NORMAL_MAPS)},
        {SCENE_EFFECT_EMISSION, offsetof(struct gpu_spec, SPEC_EMISSION)},
        {SCENE_EFFECT_HIGHLIGHTS, offsetof(struct gpu_spec, SPEC_HIGHLIGHTS)},
        {SCENE_EFFECT_METAL_ROUGH, offsetof(struct gpu_spec, SPEC_METAL_ROUGH)},
        {SCENE_EFFECT_CATCHERS, offsetof(struct gpu_spec, SPEC_CATCHERS)},
        {SCENE_EFFECT_CUTOUTS, offsetof(struct gpu_spec, SPEC_CUTOUTS)},
    };
    struct scene_effects own = {.called = {false}};
    bool glass = material_class == CLASS_GLASS;
    /* Kernels of glass then trace to the surface in contact, whose material may be of the other
       class. */
    bool walks = glass && spec->SPEC_MEDIA == MEDIA_TOUCH;
    enum scene_materials which = glass ? SCENE_MATERIALS_GLASS : SCENE_MATERIALS_OPAQUE;
    scene_effects_scan_materials(renderer->scene, which, &own);
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
        bool added = renderer->params.effects_added >> all[i].effect & 1;
        bool cuts = walks && all[i].effect == SCENE_EFFECT_CUTOUTS;
        if (!own.called[all[i].effect] && !added && !cuts)
            memset((char *)spec + all[i].constant, 0, sizeof(uint32_t));
    }
    if (!walks || !spec->SPEC_CUTOUTS)
        effects_narrow_textures(renderer, which, spec);
    /* Glass without refraction is lit like other surfaces: see material_drawn. */
    if (!own.lit && !(glass && !renderer->effects.called[SCENE_EFFECT_REFRACTION]))
        spec->SPEC_LIGHTS = 0;
    if (!walks && spec->SPEC_SPHERES)
        spec->SPEC_SPHERES = !own.on_spheres     ? SPHERES_NONE
                             : !own.on_triangles ? SPHERES_ONLY
                                                 : SPHERES_SOME;
}
