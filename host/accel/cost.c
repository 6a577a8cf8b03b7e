#include "accel/cost.h"

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

void cost_merge(struct cost_sum *sum, const struct cost_sum *part)
{
    sum->rays += part->rays;
    sum->pairs += part->pairs;
    sum->leaves += part->leaves;
    sum->instances += part->instances;
    sum->triangles += part->triangles;
    sum->records += part->records;
    sum->stack_sum += part->stack_sum;
    sum->depth_sum += part->depth_sum;
    sum->stack = larger(sum->stack, part->stack);
    sum->depth = larger(sum->depth, part->depth);
    sum->most_pairs = larger(sum->most_pairs, part->most_pairs);
    sum->most_leaves = larger(sum->most_leaves, part->most_leaves);
    sum->most_instances = larger(sum->most_instances, part->most_instances);
    sum->most_triangles = larger(sum->most_triangles, part->most_triangles);
}

void cost_add(struct cost_sum *sum, const struct gpu_cost *cost)
{
    const struct cost_sum record = {
        .rays = cost->rays,
        .pairs = cost->pairs,
        .leaves = cost->leaves,
        .instances = cost->instances,
        .triangles = cost->triangles,
        .stack = cost->stack,
        .depth = cost->depth,
        .records = 1,
        .stack_sum = cost->stack,
        .depth_sum = cost->depth,
        .most_pairs = cost->pairs,
        .most_leaves = cost->leaves,
        .most_instances = cost->instances,
        .most_triangles = cost->triangles,
    };
    if (cost->rays > 0)
        cost_merge(sum, &record);
}
