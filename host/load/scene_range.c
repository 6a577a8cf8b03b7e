/* Copies of all that one object added to the scene. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "load/scene_objects.h"
#include "load/scene_range.h"
#include "scene/afford.h"

static uint32_t moved_node(const struct scene_range *range, uint32_t node, uint32_t parent,
                           uint32_t first)
{
    if (node == range->parent)
        return parent;
    return node == SCENE_NONE ? node : node - range->first_node + first;
}

static bool copy_channel(struct reader *reader, struct scene_channel channel, uint32_t node)
{
    size_t values = channel.key_count * (channel.path == SCENE_PATH_ROTATION ? 4u : 3u) *
                    (channel.interpolation == SCENE_CUBIC ? (size_t)3 : 1);
    float *times = array_alloc(channel.key_count, sizeof *times);
    float *copies = array_alloc(values, sizeof *copies);
    if (!times || !copies) {
        free(times);
        free(copies);
        return reader_no_memory(reader);
    }
    memcpy(times, channel.times_s, channel.key_count * sizeof *times);
    memcpy(copies, channel.values, values * sizeof *copies);
    channel.node = node;
    channel.times_s = times;
    channel.values = copies;
    return scene_add_channel(reader->scene, channel) != SCENE_NONE || reader_no_memory(reader);
}

/* Length of a name, which is NULL where memory ran out for it. */
static uint64_t length_of(const char *name)
{
    return name ? strlen(name) : 0;
}

bool range_afford(struct reader *reader, const struct place *place, const struct scene_range *range,
                  uint64_t times)
{
    uint64_t instances = range->instance_end - range->first_instance;
    uint64_t bytes =
        scene_node_cost(1 + range->node_end - range->first_node) + scene_instance_cost(instances);
    for (uint32_t i = range->first_node; i < range->node_end; ++i)
        bytes += length_of(reader->scene->nodes[i].name);
    for (uint32_t i = range->first_instance; i < range->instance_end; ++i)
        bytes += length_of(reader->scene->instances[i].name);
    for (uint32_t i = range->first_channel; i < range->channel_end; ++i)
        bytes += 16 * sizeof(float) * (uint64_t)reader->scene->channels[i].key_count;
    for (uint32_t i = range->first_light; i < range->light_end; ++i)
        bytes += sizeof(struct scene_light) + length_of(reader->scene->lights[i].name) +
                 length_of(reader->scene->lights[i].origin.file);
    for (uint32_t i = range->first_camera; i < range->camera_end; ++i)
        bytes += sizeof(struct scene_camera) + length_of(reader->scene->cameras[i].name);
    return reader_afford(reader, place, bytes * times, "%llu copies of %llu instances",
                         (unsigned long long)times, (unsigned long long)instances);
}

static bool copy_lights_and_cameras(struct reader *reader, const struct scene_range *range,
                                    uint32_t parent, uint32_t first)
{
    struct scene *scene = reader->scene;
    for (uint32_t i = range->first_light; i < range->light_end; ++i) {
        struct scene_light light = scene->lights[i];
        light.name = scene_text(scene, light.name);
        light.origin.file = scene_text(scene, light.origin.file);
        light.node = moved_node(range, light.node, parent, first);
        if (scene_add_light(scene, light) == SCENE_NONE)
            return reader_no_memory(reader);
    }
    for (uint32_t i = range->first_camera; i < range->camera_end; ++i) {
        struct scene_camera camera = scene->cameras[i];
        camera.name = scene_text(scene, camera.name);
        camera.node = moved_node(range, camera.node, parent, first);
        if (scene_add_camera(scene, camera) == SCENE_NONE)
            return reader_no_memory(reader);
    }
    return true;
}

bool range_copy(struct reader *reader, const struct place *place, const struct scene_range *range,
                uint32_t parent)
{
    struct scene *scene = reader->scene;
    uint32_t first = scene->node_count;
    if (scene->instance_count + (uint64_t)(range->instance_end - range->first_instance) >
            INSTANCES_MAX ||
        first + (uint64_t)(range->node_end - range->first_node) > INSTANCES_MAX)
        return reader_fail(reader, place, "more than %u instances", INSTANCES_MAX);
    for (uint32_t i = range->first_node; i < range->node_end; ++i) {
        struct scene_node node = scene->nodes[i];
        node.name = string_copy(node.name);
        node.parent = moved_node(range, node.parent, parent, first);
        if (scene_add_node(scene, node) == SCENE_NONE)
            return reader_no_memory(reader);
    }
    for (uint32_t i = range->first_instance; i < range->instance_end; ++i) {
        struct scene_instance instance = scene->instances[i];
        instance.name = scene_text(scene, instance.name);
        instance.node = moved_node(range, instance.node, parent, first);
        if (scene_add_instance(scene, instance) == SCENE_NONE)
            return reader_no_memory(reader);
    }
    for (uint32_t i = range->first_channel; i < range->channel_end; ++i) {
        uint32_t node = moved_node(range, scene->channels[i].node, parent, first);
        if (!copy_channel(reader, scene->channels[i], node))
            return false;
    }
    return copy_lights_and_cameras(reader, range, parent, first);
}

struct scene_range range_begin(const struct scene *scene, uint32_t parent)
{
    return (struct scene_range){
        .parent = parent,
        .first_node = scene->node_count,
        .first_instance = scene->instance_count,
        .first_channel = scene->channel_count,
        .first_light = scene->light_count,
        .first_camera = scene->camera_count,
    };
}

void range_end(const struct scene *scene, struct scene_range *range)
{
    range->node_end = scene->node_count;
    range->instance_end = scene->instance_count;
    range->channel_end = scene->channel_count;
    range->light_end = scene->light_count;
    range->camera_end = scene->camera_count;
}
