/* A validator that refuses every way of breaking a tree. */
#include "accel_build_fixture.h"

#include <stdalign.h>

/* ---- Broken trees ---- */

static uint32_t find_node(const struct bvh *bvh, bool leaf)
{
    for (uint32_t i = 2; i < bvh->node_count; ++i) {
        if ((bvh_count(&bvh->nodes[i]) > 0) == leaf)
            return i;
    }
    fail();
    return 0;
}

static void shrink_parent(struct bvh *b)
{
    struct gpu_bvh_node *n = &b->nodes[find_node(b, false)];
    n->hi[1] = nextafterf(n->hi[1], -INFINITY);
}
static void shrink_leaf(struct bvh *b)
{
    struct gpu_bvh_node *n = &b->nodes[find_node(b, true)];
    n->lo[2] = nextafterf(n->lo[2], INFINITY);
}
static void repeat_primitive(struct bvh *b)
{
    b->order[0] = b->order[1];
}
static void exceed_primitives(struct bvh *b)
{
    b->order[3] = b->primitive_count;
}
static void make_cycle(struct bvh *b)
{
    b->nodes[b->nodes[0].first] = b->nodes[0];
}
/* A cycle that never meets a leaf. */
static void make_cycle_of_inner(struct bvh *b)
{
    b->nodes[b->nodes[0].first] = b->nodes[b->nodes[0].first + 1] = b->nodes[0];
}
static void share_children(struct bvh *b)
{
    b->nodes[find_node(b, false)].first = b->nodes[0].first;
}
static void exceed_nodes(struct bvh *b)
{
    b->nodes[find_node(b, false)].first = b->node_count;
}
static void turn_axis(struct bvh *b)
{
    uint32_t *count = &b->nodes[2].count;
    uint32_t axis = *count >> BVH_AXIS_SHIFT & BVH_AXIS_MASK;
    *count ^= (axis ^ (axis + 1) % 3) << BVH_AXIS_SHIFT;
}
static void overlap_leaves(struct bvh *b)
{
    struct gpu_bvh_node *n = &b->nodes[find_node(b, true)];
    n->first = n->first > 0 ? n->first - 1 : n->first + 1;
}
static void lose_record(struct bvh *b)
{
    uint32_t i = 0;
    while (bvh_count(&b->nodes[i]) <= 1)
        ++i;
    --b->nodes[i].count;
}
static void lose_pair(struct bvh *b)
{
    b->node_count -= 2;
}
/* Two leaves under one node become one leaf. */
static void pass_by_pair(struct bvh *b)
{
    for (uint32_t i = 2; i < b->node_count; ++i) {
        struct gpu_bvh_node *n = &b->nodes[i];
        const struct gpu_bvh_node *pair = &b->nodes[n->first];
        if (bvh_count(n) == 0 && bvh_count(&pair[0]) > 0 && bvh_count(&pair[1]) > 0 &&
            bvh_count(&pair[0]) + bvh_count(&pair[1]) <= 4) {
            n->count += bvh_count(&pair[0]) + bvh_count(&pair[1]);
            n->first = pair[0].first;
            return;
        }
    }
    fail();
}
static void add_half_pair(struct bvh *b)
{
    ++b->node_count;
}
static void set_nan(struct bvh *b)
{
    b->nodes[0].lo[0] = NAN;
}
static void set_infinity(struct bvh *b)
{
    b->nodes[0].hi[0] = INFINITY;
}
static void state_depth(struct bvh *b)
{
    ++b->depth;
}
static void state_leaf_count(struct bvh *b)
{
    --b->leaf_count;
}
static void state_largest(struct bvh *b)
{
    ++b->leaf_largest;
}
static void have_no_nodes(struct bvh *b)
{
    b->node_count = 0;
}

/* Each way must be refused for its own reason. */
static const struct {
    const char *name;
    void (*apply)(struct bvh *bvh);
    const char *reason; /* NULL: none */
} breakages[] = {
    {"nothing", NULL, NULL},
    {"another inner node's children", share_children, "two parents"},
    {"parent shrunk", shrink_parent, "a child is not inside"},
    {"leaf shrunk", shrink_leaf, "does not contain its primitive"},
    {"primitive twice", repeat_primitive, "twice"},
    {"primitive out of range", exceed_primitives, "names a primitive out of range"},
    {"cycle", make_cycle, "two parents"},
    {"cycle of inner nodes", make_cycle_of_inner, "two parents"},
    {"children behind the end", exceed_nodes, "children out of range"},
    {"another axis", turn_axis, "the axis is not"},
    {"leaves overlap", overlap_leaves, "share a record"},
    {"record lost", lose_record, "primitives are missing"},
    {"pair beyond the end", lose_pair, "children out of range"},
    {"pair not reached", pass_by_pair, "not reached"},
    {"half a pair", add_half_pair, "aligned pairs"},
    {"NaN", set_nan, "not finite"},
    {"infinity", set_infinity, "not finite"},
    {"depth", state_depth, "stated depth"},
    {"number of leaves", state_leaf_count, "stated number of leaves"},
    {"largest leaf", state_largest, "stated largest leaf"},
    {"no nodes", have_no_nodes, "no nodes for primitives"},
};

/* The same, of one word of a node: (word & keep) ^ change. */
enum { ROOT, SECOND_CHILD = 3, INNER = 1000, LEAF };
static const struct {
    const char *name;
    uint32_t node; /* its number, or the first of its kind */
    bool count;    /* the word `count`; else `first` */
    uint32_t keep, change;
    const char *reason;
} changes[] = {
    {"children far behind the end", INNER, false, 0, 0xfffffffeu, "children out of range"},
    {"children at the root", INNER, false, 0, 0, "children out of range"},
    {"children at an odd node", ROOT, false, ~0u, 1, "do not start at an even"},
    {"leaf behind the end", LEAF, false, 0, 500, "reaches out of range"},
    {"leaf far behind the end", LEAF, false, 0, 0xfffffffeu, "reaches out of range"},
    {"all bits of a count", LEAF, true, 0, 0xfffffff0u, "stray bits"},
    {"high bit of a count", 2, true, ~128u, 128, "stray bits"},
    {"axis of the root", ROOT, true, ~(1u << BVH_AXIS_SHIFT), 1u << BVH_AXIS_SHIFT, "stray bits"},
    {"sign at the second child", SECOND_CHILD, true, ~BVH_SECOND_LOW, BVH_SECOND_LOW, "stray bits"},
    {"a fourth axis", 2, true, ~(BVH_AXIS_MASK << BVH_AXIS_SHIFT), BVH_AXIS_MASK << BVH_AXIS_SHIFT,
     "the axis is not"},
    {"sign of the axis", 2, true, ~0u, BVH_SECOND_LOW, "the axis is not"},
    {"leaf over the limit", LEAF, true, 0, 5, "over the limit"},
};

static void assert_said(const struct bvh *bvh, const struct bvh_box *boxes, const char *name,
                        const char *reason)
{
    last_error[0] = 0;
    whit_result result = bvh_validate(&silent, bvh, boxes, 4);
    if (result != (reason ? WHIT_ERROR_FAILED : WHIT_OK) || (reason && !strstr(last_error, reason)))
        fail_msg("%s: expected `%s`, said `%s`", name, reason ? reason : "nothing", last_error);
}

static void broken_trees_are_refused(void **state)
{
    (void)state;
    enum { WAYS = sizeof breakages / sizeof *breakages, WORDS = sizeof changes / sizeof *changes };
    random_state = 11;
    struct soup soup = soup_scattered(500, 0.1f);
    for (size_t i = 0; i < WAYS + WORDS; ++i) {
        struct bvh bvh = soup_build(&soup, (struct bvh_params){0});
        if (i < WAYS) {
            if (breakages[i].apply)
                breakages[i].apply(&bvh);
            assert_said(&bvh, soup.boxes, breakages[i].name, breakages[i].reason);
        } else {
            uint32_t at = changes[i - WAYS].node;
            at = at >= INNER ? find_node(&bvh, at == LEAF) : at;
            uint32_t *word = changes[i - WAYS].count ? &bvh.nodes[at].count : &bvh.nodes[at].first;
            *word = (*word & changes[i - WAYS].keep) ^ changes[i - WAYS].change;
            assert_said(&bvh, soup.boxes, changes[i - WAYS].name, changes[i - WAYS].reason);
        }
        bvh_finish(&bvh);
    }
    soup_finish(&soup);
}

/* ---- Split primitives ---- */

/* Box 0 along x is split at 2 between two leaves, which boxes 1 and 2 share with it. */
struct split_tree {
    alignas(64) struct gpu_bvh_node nodes[4];
    struct bvh_box boxes[3];
    uint32_t order[4];
    struct bvh bvh;
};

static void split_tree_init(struct split_tree *tree)
{
    *tree = (struct split_tree){
        .nodes = {{{0, 0, 0}, 2, {4, 1, 1}, 0},
                  {{0}, 0, {0}, 0},
                  {{0, 0, 0}, 0, {2, 1, 1}, 2},
                  {{2, 0, 0}, 2, {4, 1, 1}, 2}},
        .boxes = {{{0, 0, 0}, {4, 1, 1}}, {{0, 0, 0}, {1, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}},
        .order = {0, 1, 0, 2},
        .bvh = {.node_count = 4, .primitive_count = 3, .reference_count = 4, .clipped = true},
    };
    tree->bvh.nodes = tree->nodes;
    tree->bvh.order = tree->order;
    bvh_complete(&tree->bvh, 1.0);
}

static void split_tree_said(const struct split_tree *tree, const char *reason)
{
    assert_said(&tree->bvh, tree->boxes, "split tree", reason);
}

static void split_primitives_must_be_covered(void **state)
{
    (void)state;
    struct split_tree tree;
    split_tree_init(&tree);
    split_tree_said(&tree, NULL);
    tree.order[1] = 0;
    split_tree_said(&tree, "in a leaf twice");
    tree.order[1] = 2;
    split_tree_said(&tree, "holds nothing of its primitive");
    split_tree_init(&tree);
    tree.boxes[0].hi[1] = 2.0f;
    split_tree_said(&tree, "do not cover it");
    split_tree_init(&tree);
    tree.nodes[3].count = 1;
    split_tree_said(&tree, "primitives are missing");
    tree.order[2] = 2;
    split_tree_said(&tree, "records are in no leaf");
    split_tree_init(&tree);
    tree.bvh.reference_count = 3;
    split_tree_said(&tree, "reaches out of range");
    split_tree_init(&tree);
    tree.bvh.primitive_count = 4; /* as if none were split */
    split_tree_said(&tree, "does not contain its primitive");
}

/* Whatever bytes stand in the arrays, the validator ends and reads nothing outside. */
static void validator_survives_any_bytes(void **state)
{
    (void)state;
    random_state = 12;
    struct soup soup = soup_scattered(200, 0.1f);
    uint32_t accepted = 0;
    for (int round = 0; round < 5000; ++round) {
        struct bvh bvh = soup_build(&soup, (struct bvh_params){0});
        uint32_t flips = 1 + random_below(&random_state, 4);
        for (uint32_t k = 0; k < flips; ++k) {
            uint8_t *bytes =
                random_below(&random_state, 8) ? (uint8_t *)bvh.nodes : (uint8_t *)bvh.order;
            size_t size = bytes == (uint8_t *)bvh.order ? 200 * sizeof *bvh.order
                                                        : bvh.node_count * sizeof *bvh.nodes;
            bytes[random_bits(&random_state) % size] = (uint8_t)random_bits(&random_state);
        }
        accepted += bvh_validate(&silent, &bvh, NULL, 4) == WHIT_OK;
        bvh_finish(&bvh);
    }
    assert_true(accepted < 2500); /* widened boxes and the unused node are no faults */
    soup_finish(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broken_trees_are_refused),
        cmocka_unit_test(split_primitives_must_be_covered),
        cmocka_unit_test(validator_survives_any_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
