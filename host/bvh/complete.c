/* Computes the axis bits and the SAH cost of a finished tree, whichever builder made it. */
#include <math.h>

#include "base/threads.h"
#include "bvh/complete.h"

void bvh_set_axis(struct gpu_bvh_node *first)
{
    const struct gpu_bvh_node *second = first + 1;
    uint32_t axis = 0;
    double gap = 0.0;
    for (uint32_t a = 0; a < 3; ++a) {
        double along = ((double)second->lo[a] + (double)second->hi[a]) -
                       ((double)first->lo[a] + (double)first->hi[a]);
        if (fabs(along) > fabs(gap)) {
            gap = along;
            axis = a;
        }
    }
    first->count = bvh_count(first) | axis << BVH_AXIS_SHIFT | (gap < 0.0 ? BVH_SECOND_LOW : 0);
}

struct tally {
    double area_inner, area_leaves; /* half areas; of leaves: times primitives */
};

static void node_tally(const struct gpu_bvh_node *node, struct tally *tally)
{
    uint32_t count = bvh_count(node);
    if (count == 0)
        tally->area_inner += bvh_half_area(node);
    else
        tally->area_leaves += bvh_half_area(node) * count;
}

/* Each chunk of nodes has its own sums. They are added in the order of the chunks, whichever
   threads made them, so that the total has the same bits for any number of threads. */
enum { CHUNK_NODES = 16384, CHUNKS_MAX = 512 };

struct chunks {
    struct bvh *bvh;
    uint32_t nodes; /* of a chunk; even */
    struct tally tallies[CHUNKS_MAX];
};

static void chunk_complete(void *user, uint32_t index)
{
    struct chunks *chunks = user;
    struct bvh *bvh = chunks->bvh;
    struct tally tally = {0};
    uint32_t begin = index * chunks->nodes;
    uint32_t end =
        bvh->node_count - begin > chunks->nodes ? begin + chunks->nodes : bvh->node_count;
    for (uint32_t i = begin; i < end; ++i) {
        if (i == 1)
            continue;
        node_tally(&bvh->nodes[i], &tally);
        if (i >= 2 && i % 2 == 0)
            bvh_set_axis(&bvh->nodes[i]);
    }
    chunks->tallies[index] = tally;
}

static struct tally nodes_complete(struct bvh *bvh, uint32_t thread_count)
{
    struct tally sum = {0};
    struct chunks chunks = {.bvh = bvh, .nodes = CHUNK_NODES};
    while ((uint64_t)chunks.nodes * CHUNKS_MAX < bvh->node_count)
        chunks.nodes *= 2;
    uint32_t count = (bvh->node_count + chunks.nodes - 1) / chunks.nodes;
    threads_for(thread_count, count, chunk_complete, &chunks);
    for (uint32_t i = 0; i < count; ++i) {
        sum.area_inner += chunks.tallies[i].area_inner;
        sum.area_leaves += chunks.tallies[i].area_leaves;
    }
    return sum;
}

void bvh_complete(struct bvh *bvh, uint32_t thread_count)
{
    struct tally tally = nodes_complete(bvh, thread_count);
    double root = bvh->node_count > 0 ? bvh_half_area(&bvh->nodes[0]) : 0.0;
    bvh->sah_cost = root > 0.0 ? (tally.area_inner + tally.area_leaves) / root : 0.0;
}
