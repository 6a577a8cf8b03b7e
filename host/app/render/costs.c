/* The costs of a picture by kind of ray, for --stats. */
#include "app/render/costs.h"
#include "app/document.h"
#include "settings/values.h"

enum { FIGURES = 7 };
static const char *const figure_names[FIGURES] = {"inner_nodes", "boxes", "leaves", "triangles",
                                                  "instances",   "stack", "depth"};

/* Means per ray; for stack and depth, means per sample of a pixel. */
static void find_means(const whit_cost *cost, double out[FIGURES])
{
    double rays = cost->rays ? (double)cost->rays : 1.0;
    double records = cost->records ? (double)cost->records : 1.0;
    out[0] = (double)cost->inner_nodes / rays;
    out[1] = 2.0 * out[0];
    out[2] = (double)cost->leaves / rays;
    out[3] = (double)cost->triangles / rays;
    out[4] = (double)cost->instances / rays;
    out[5] = (double)cost->stack_sum / records;
    out[6] = (double)cost->depth_sum / records;
}

/* The largest in one sample of a pixel. */
static void find_max(const whit_cost *cost, uint64_t out[FIGURES])
{
    out[0] = cost->max_inner_nodes;
    out[1] = 2 * (uint64_t)cost->max_inner_nodes;
    out[2] = cost->max_leaves;
    out[3] = cost->max_triangles;
    out[4] = cost->max_instances;
    out[5] = cost->stack;
    out[6] = cost->depth;
}

static void print_kind(const char *name, const whit_cost *cost)
{
    double means[FIGURES];
    uint64_t max[FIGURES];
    find_means(cost, means);
    find_max(cost, max);
    printf("  %-10s %10llu", name, (unsigned long long)cost->rays);
    for (int i = 0; i < FIGURES; ++i)
        printf(" %9.2f", means[i]);
    printf("\n  %-10s %10s", "", "most");
    for (int i = 0; i < FIGURES; ++i)
        printf(" %9llu", (unsigned long long)max[i]);
    putchar('\n');
}

void costs_print(const whit_stats *stats)
{
    printf("costs of a ray: means, and most in one sample of a pixel\n  %-10s %10s", "", "rays");
    for (int i = 0; i < FIGURES; ++i)
        printf(" %9s", figure_names[i]);
    putchar('\n');
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind) {
        if (stats->costs[kind].rays)
            print_kind(value_word(values_rays, kind), &stats->costs[kind]);
    }
}

static json_t *kind_document(const whit_cost *cost)
{
    double means[FIGURES];
    uint64_t max[FIGURES];
    find_means(cost, means);
    find_max(cost, max);
    json_t *kind = document_object();
    document_count(kind, "rays", cost->rays);
    json_t *mean = document_child(kind, "mean"), *largest = document_child(kind, "max");
    for (int i = 0; i < FIGURES; ++i) {
        document_number(mean, figure_names[i], means[i]);
        document_count(largest, figure_names[i], max[i]);
    }
    return kind;
}

json_t *costs_document(const whit_stats *stats)
{
    json_t *costs = document_object();
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind)
        document_put(costs, value_word(values_rays, kind), kind_document(&stats->costs[kind]));
    return costs;
}
