/* Parts of scenes, scenes mixed from the parts of two others, and faults. */
#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "base/array.h"
#include "scene/change.h"
#include "scene/fault.h"

const char *whit_part_kind_name(whit_part_kind kind)
{
    return scene_part_kind_name(kind);
}

const char *whit_fault_kind_name(whit_fault_kind kind)
{
    static const char *const names[WHIT_FAULT_KINDS] = {
        [WHIT_FAULT_VERTEX] = "vertex",       [WHIT_FAULT_IOR] = "ior",
        [WHIT_FAULT_LIGHT] = "light",         [WHIT_FAULT_TEXELS] = "texel row",
        [WHIT_FAULT_MATERIALS] = "materials", [WHIT_FAULT_ORDER] = "order",
    };
    return kind < WHIT_FAULT_KINDS ? names[kind] : "";
}

static whit_result no_memory(const whit_scene *handle, whit_result result)
{
    if (result == WHIT_ERROR_MEMORY)
        log_error(&handle->log, "%s: out of memory for the parts of the scene",
                  handle->scene->name);
    return result;
}

/* Lists the parts of a scene. Release with scene_parts_finish(side->parts), after a failure too. */
static whit_result begin_side(const whit_scene *handle, struct scene_parts *parts,
                              struct scene_side *side)
{
    *parts = (struct scene_parts){0};
    *side = (struct scene_side){handle->scene, parts};
    if (handle->scene->pictures_dropped)
        return API_FAIL(&handle->log, WHIT_ERROR_USAGE,
                        "%s: its pictures were dropped, and are parts of it", handle->scene->name);
    return no_memory(handle, scene_parts_init(handle->scene, parts));
}

whit_result whit_scene_parts(const whit_scene *handle, whit_part **out, uint32_t *count)
{
    struct scene_parts parts;
    struct scene_side side;
    size_t bytes = 0;
    *out = NULL;
    *count = 0;
    whit_result result = begin_side(handle, &parts, &side);
    for (uint32_t i = 0; i < parts.count; ++i)
        bytes += sizeof **out + strlen(parts.items[i].name) + 1;
    whit_part *list = result == WHIT_OK ? malloc(bytes) : NULL;
    if (result == WHIT_OK && !list)
        result = no_memory(handle, WHIT_ERROR_MEMORY);
    char *names = (char *)(list + (list ? parts.count : 0));
    for (uint32_t i = 0; list && i < parts.count; ++i) {
        const struct scene_part *part = &parts.items[i];
        list[i] = (whit_part){part->kind, strcpy(names, part->name), part->hash};
        names += strlen(names) + 1;
    }
    *out = list;
    *count = list ? parts.count : 0;
    scene_parts_finish(&parts);
    return result;
}

whit_result whit_scene_part_change(const whit_scene *before, const whit_scene *after,
                                   whit_part_kind kind, const char *name, char *text, size_t bytes)
{
    struct scene_parts was = {0}, is = {0};
    struct scene_side side_before, side_after;
    whit_result result = begin_side(before, &was, &side_before);
    if (result == WHIT_OK)
        result = begin_side(after, &is, &side_after);
    if (result == WHIT_OK)
        scene_change_write(&side_before, &side_after, kind, name, text, bytes);
    scene_parts_finish(&was);
    scene_parts_finish(&is);
    return result;
}

whit_result whit_scene_mix(const whit_scene *before, const whit_scene *after, const bool *back,
                           whit_scene **out)
{
    struct scene_parts was = {0}, is = {0};
    struct scene_side side_before, side_after;
    struct scene *made = NULL;
    whit_result result = begin_side(before, &was, &side_before);
    if (result == WHIT_OK)
        result = begin_side(after, &is, &side_after);
    if (result == WHIT_OK)
        result = no_memory(after, scene_mix(&after->log, &side_before, &side_after, back, &made));
    scene_parts_finish(&was);
    scene_parts_finish(&is);
    return api_hand_out_scene(&after->log, made, result, out);
}

whit_result whit_scene_fault(const whit_scene *scene, const whit_fault *faults, uint32_t count,
                             whit_scene **out)
{
    struct scene_parts parts = {0};
    struct scene_side side;
    struct scene *made = NULL;
    whit_result result = begin_side(scene, &parts, &side);
    if (result == WHIT_OK)
        result = no_memory(scene, scene_fault(&scene->log, &side, faults, count, &made));
    scene_parts_finish(&parts);
    return api_hand_out_scene(&scene->log, made, result, out);
}
