#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "base/text.h"
#include "render/probe.h"
#include "shader/program.h"

const char *whit_probe_end_name(whit_probe_end end)
{
    static const char *const names[WHIT_PROBE_ENDS] = {
        [WHIT_PROBE_MISSED] = "missed",
        [WHIT_PROBE_OPAQUE] = "hit, opaque",
        [WHIT_PROBE_DIVIDED] = "hit, goes on",
        [WHIT_PROBE_ABSORBED] = "absorbed",
        [WHIT_PROBE_DEPTH] = "bounces used up",
        [WHIT_PROBE_BAILOUT] = "bail-out",
        [WHIT_PROBE_REACHED] = "reached the light",
        [WHIT_PROBE_FILTERED] = "reached it weaker",
        [WHIT_PROBE_BLOCKED] = "blocked",
    };
    return (uint32_t)end < WHIT_PROBE_ENDS ? names[end] : "";
}

static whit_probe_end shadow_end(const float share[3])
{
    bool all = true, none = true;
    for (int i = 0; i < 3; ++i) {
        all &= share[i] >= 1.0f;
        none &= !(share[i] > 0.0f);
    }
    return all ? WHIT_PROBE_REACHED : none ? WHIT_PROBE_ABSORBED : WHIT_PROBE_FILTERED;
}

static whit_probe_end end_of(const struct gpu_probe_ray *traced, bool has_branches)
{
    switch (traced->end) {
    case PROBE_ABSORBED:
        return WHIT_PROBE_ABSORBED;
    case PROBE_HIT:
        return has_branches ? WHIT_PROBE_DIVIDED : WHIT_PROBE_OPAQUE;
    case PROBE_DEPTH:
        return WHIT_PROBE_DEPTH;
    case PROBE_BAILOUT:
        return WHIT_PROBE_BAILOUT;
    case PROBE_REACHED:
        return shadow_end(traced->added);
    case PROBE_BLOCKED:
        return WHIT_PROBE_BLOCKED;
    default:
        return WHIT_PROBE_MISSED;
    }
}

static whit_ray_kind kind_of(const struct probe_ray *ray)
{
    return (whit_ray_kind)(ray->traced.kind & PROBE_KIND_MASK);
}

static void copy(float to[3], const float from[3])
{
    memcpy(to, from, 3 * sizeof *to);
}

static whit_probe_hit hit_of(double t, uint32_t instance, uint32_t primitive)
{
    return (whit_probe_hit){.t = t, .instance = instance, .primitive = primitive};
}

static void set_answers(const struct probe_ray *from, whit_probe_ray *to)
{
    const struct gpu_probe_ray *traced = &from->traced;
    to->device = hit_of((double)traced->t, traced->instance, traced->primitive);
    to->twin = hit_of((double)from->twin.t, from->twin.instance, from->twin.primitive);
    to->exact = hit_of(INFINITY, WHIT_NONE, WHIT_NONE);
    to->equal = from->equal;
    to->exact_known = from->exact_known;
    to->exact_equal = to->exact_known && from->exact_equal;
    if (to->exact_known)
        to->exact = hit_of((double)from->exact_t, from->exact_instance, from->exact_primitive);
    to->passed = from->passed;
}

static whit_probe_ray ray_of(const struct scene *scene, const struct probe_report *report,
                             const struct probe_ray *from)
{
    const struct gpu_probe_ray *traced = &from->traced;
    bool shadow = kind_of(from) == WHIT_RAY_SHADOW;
    whit_probe_ray ray = {
        .kind = kind_of(from),
        .straight = (traced->kind & (PROBE_STRAIGHT | PROBE_THROUGH)) != 0,
        .end = end_of(traced, false),
        .parent = from->parent,
        .generation = from->generation,
        .ray.t_max = traced->t_max,
        .material = traced->material,
        .inside = (traced->kind & PROBE_INSIDE) != 0,
        .medium = traced->medium ? traced->medium - 1 : WHIT_NONE,
        .ior = traced->medium ? scene->materials[traced->medium - 1].ior : 1.0f,
        .light = shadow ? traced->light_sample / report->light_samples : WHIT_NONE,
        .light_sample = shadow ? traced->light_sample % report->light_samples : WHIT_NONE,
    };
    copy(ray.ray.origin, traced->origin);
    copy(ray.ray.dir, traced->dir);
    copy(ray.weight, traced->weight);
    copy(ray.added, traced->added);
    copy(ray.point, traced->point);
    copy(ray.normal, traced->normal);
    set_answers(from, &ray);
    return ray;
}

/* ---- Values of dbg(x) ---- */

static whit_probe_value value_of(const struct probe_value *from)
{
    const struct gpu_dbg *traced = &from->traced;
    whit_probe_value value = {.kind = (whit_value_kind)(traced->type / DBG_INT),
                              .size = traced->type % DBG_INT + 1,
                              .ray = from->ray,
                              .generation = traced->generation};
    for (uint32_t i = 0; i < value.size; ++i) {
        float real;
        int32_t whole;
        memcpy(&real, &traced->bits[i], sizeof real);
        memcpy(&whole, &traced->bits[i], sizeof whole);
        value.v[i] = value.kind == WHIT_VALUE_FLOAT ? (double)real
                     : value.kind == WHIT_VALUE_INT ? (double)whole
                                                    : (double)traced->bits[i];
    }
    return value;
}

static char *put_text(char **at, const char *text)
{
    char *to = *at;
    strcpy(to, text);
    *at += strlen(text) + 1;
    return to;
}

/* Copies the calls of dbg() with their texts into one block, since the shader may be destroyed
   before the report. NULL: no memory. */
static whit_probe_call *calls_from(const whit_shader *shader, const struct probe_report *from)
{
    const struct shader_dbg *dbg = &shader->dbg;
    size_t bytes = 0;
    for (uint32_t i = 0; i < dbg->count; ++i)
        bytes += strlen(dbg->sites[i].text) + strlen(shader->files[dbg->sites[i].file]) + 2;
    whit_probe_call *calls = calloc(1, dbg->count * sizeof *calls + bytes);
    char *at = calls ? (char *)(calls + dbg->count) : NULL;
    for (uint32_t i = 0; calls && i < dbg->count; ++i) {
        const struct shader_dbg_site *site = &dbg->sites[i];
        calls[i].text = put_text(&at, site->text);
        calls[i].file = put_text(&at, shader->files[site->file]);
        calls[i].line = site->line;
        calls[i].count = from->call_counts[i];
    }
    for (uint32_t i = 0; calls && i < from->value_count; ++i) {
        whit_probe_call *call = &calls[from->values[i].call];
        if (call->value_count < WHIT_PROBE_VALUES)
            call->values[call->value_count++] = value_of(&from->values[i]);
    }
    return calls;
}

void whit_probe_value_text(const whit_probe_value *value, int digits, char *text, size_t bytes)
{
    if (bytes == 0)
        return;
    text[0] = 0;
    for (uint32_t i = 0; i < value->size && i < 4; ++i) {
        text_add(text, bytes, i ? ", " : value->size > 1 ? "(" : "");
        if (value->kind == WHIT_VALUE_BOOL)
            text_add(text, bytes, value->v[i] != 0.0 ? "true" : "false");
        else
            text_add(text, bytes, "%.*g", value->kind == WHIT_VALUE_FLOAT ? digits : 10,
                     value->v[i]);
    }
    text_add(text, bytes, value->size > 1 ? ")" : "");
}

/* ---- Reports ---- */

static whit_result report_from(const whit_renderer *renderer, const struct probe_report *from,
                               whit_probe_report **out)
{
    whit_probe_report *report = calloc(1, sizeof *report);
    whit_probe_ray *rays = calloc(from->ray_count ? from->ray_count : 1, sizeof *rays);
    const whit_shader *shader = renderer->params.shader;
    uint32_t call_count = shader ? shader->dbg.count : 0;
    whit_probe_call *calls = call_count ? calls_from(shader, from) : NULL;
    if (!report || !rays || (call_count && !calls)) {
        free(report);
        free(rays);
        free(calls);
        return API_FAIL(&renderer->log, WHIT_ERROR_MEMORY, "out of memory");
    }
    for (uint32_t i = 0; i < from->ray_count; ++i) {
        rays[i] = ray_of(renderer->accel->scene, from, &from->rays[i]);
        if (rays[i].kind != WHIT_RAY_SHADOW && rays[i].parent != WHIT_NONE)
            rays[rays[i].parent].end = end_of(&from->rays[rays[i].parent].traced, true);
    }
    *report = (whit_probe_report){
        .x = from->x,
        .y = from->y,
        .samples = from->samples,
        .rays = rays,
        .ray_count = from->ray_count,
        .dropped = from->dropped,
        .differing = from->differing,
        .calls = calls,
        .call_count = call_count,
        .shaded = shader_has(renderer->params.shader, WHIT_HOOK_SHADE),
        .unshadowed = renderer->params.shadows == WHIT_SHADOWS_NONE ||
                      (renderer->params.effects_removed >> SCENE_EFFECT_SHADOWS & 1),
    };
    memcpy(report->color, from->color, sizeof report->color);
    whit_image pixel = {.image = {.width = 1, .height = 1, .channels = 4, .pixels = report->color}};
    whit_image_display_as(&pixel, &renderer->params);
    whit_image_display_bytes(&pixel, report->shown);
    *out = report;
    return WHIT_OK;
}

whit_result whit_probe(whit_renderer *renderer, uint32_t x, uint32_t y, uint32_t max_rays,
                       whit_probe_report **out)
{
    struct probe_report report;
    *out = NULL;
    whit_result result = api_need_device(renderer);
    if (result != WHIT_OK)
        return result;
    result = renderer_probe(renderer->renderer, x, y, max_rays, &report);
    if (result == WHIT_OK)
        result = report_from(renderer, &report, out);
    probe_report_finish(&report);
    return result;
}

void whit_probe_report_destroy(whit_probe_report *report)
{
    if (!report)
        return;
    free(report->rays);
    free(report->calls);
    free(report);
}
