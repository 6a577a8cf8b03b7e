/* The transform of an object in a scene file: a matrix, or translation, rotation and scale. */
#include "load/scene_animation.h"
#include "load/scene_objects.h"

static bool read_matrix(struct reader *reader, const struct place *place, const json_t *object,
                        struct scene_node *node)
{
    static const char *const others[] = {"translation", "rotation", "quaternion", "scale",
                                         "animation"};
    struct place here = {place, "matrix", 0};
    if (!json_object_get(object, "matrix"))
        return true;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        if (json_object_get(object, others[i]))
            return reader_fail(reader, &here, "`matrix` and `%s` exclude each other", others[i]);
    }
    node->has_matrix = true;
    return reader_numbers(reader, place, object, "matrix", 12, node->matrix.m);
}

static bool read_scale(struct reader *reader, const struct place *place, const json_t *object,
                       double out[3])
{
    struct place here = {place, "scale", 0};
    if (!reader_extent(reader, place, object, "scale", -1e15, 1e15, 3, out))
        return false;
    if (out[0] == 0.0 || out[1] == 0.0 || out[2] == 0.0)
        return reader_fail(reader, &here, "a scale of 0 leaves nothing");
    return true;
}

bool reader_transform(struct reader *reader, const struct place *place, const json_t *object,
                      struct scene_node *node)
{
    double degrees[3] = {0, 0, 0};
    struct place at_turn = {place, "quaternion", 0};
    if (!read_matrix(reader, place, object, node) ||
        !reader_numbers(reader, place, object, "translation", 3, node->translation) ||
        !reader_numbers(reader, place, object, "rotation", 3, degrees) ||
        !read_scale(reader, place, object, node->scale))
        return false;
    reader_quaternion(degrees, node->rotation);
    if (!json_object_get(object, "quaternion"))
        return true;
    if (json_object_get(object, "rotation"))
        return reader_fail(reader, &at_turn, "`quaternion` and `rotation` exclude each other");
    if (!reader_numbers(reader, place, object, "quaternion", 4, node->rotation))
        return false;
    double length = 0.0;
    for (int i = 0; i < 4; ++i)
        length += node->rotation[i] * node->rotation[i];
    return length > 0.0 || reader_fail(reader, &at_turn, "all zero is no rotation");
}
