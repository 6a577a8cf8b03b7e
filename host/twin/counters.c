#include "twin/counters.h"

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

void cost_merge(whit_cost *sum, const whit_cost *part)
{
    sum->rays += part->rays;
    sum->inner_nodes += part->inner_nodes;
    sum->leaves += part->leaves;
    sum->instances += part->instances;
    sum->triangles += part->triangles;
    sum->records += part->records;
    sum->stack_sum += part->stack_sum;
    sum->depth_sum += part->depth_sum;
    sum->stack = larger(sum->stack, part->stack);
    sum->depth = larger(sum->depth, part->depth);
    sum->max_inner_nodes = larger(sum->max_inner_nodes, part->max_inner_nodes);
    sum->max_leaves = larger(sum->max_leaves, part->max_leaves);
    sum->max_instances = larger(sum->max_instances, part->max_instances);
    sum->max_triangles = larger(sum->max_triangles, part->max_triangles);
}

void cost_add(whit_cost *sum, const struct gpu_cost *cost)
{
    const whit_cost record = {
        .rays = cost->rays,
        .inner_nodes = cost->inner_nodes,
        .leaves = cost->leaves,
        .instances = cost->instances,
        .triangles = cost->triangles,
        .stack = cost->stack,
        .depth = cost->depth,
        .records = 1,
        .stack_sum = cost->stack,
        .depth_sum = cost->depth,
        .max_inner_nodes = cost->inner_nodes,
        .max_leaves = cost->leaves,
        .max_instances = cost->instances,
        .max_triangles = cost->triangles,
    };
    if (cost->rays > 0)
        cost_merge(sum, &record);
}
