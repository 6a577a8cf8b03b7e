/* A validator that refuses every way of breaking a tree, and accepts what builders make. */
#include "accel_boxes_fixture.h"

/* ---- Broken trees ---- */

/* Each way must be refused for its own reason. */
struct breakage {
    const char *name;
    void (*apply)(struct bvh *bvh);
    const char *reason;
};

static uint32_t find_node(const struct bvh *bvh, bool leaf)
{
    for (uint32_t i = 2; i < bvh->node_count; ++i) {
        if ((bvh_count(&bvh->nodes[i]) > 0) == leaf)
            return i;
    }
    fail();
    return 0;
}

static void break_none(struct bvh *b)
{
    (void)b;
}
static void break_children_swapped(struct bvh *b)
{
    /* Another inner node's children. */
    b->nodes[find_node(b, false)].first = b->nodes[0].first;
}
static void break_parent_shrunk(struct bvh *b)
{
    struct gpu_bvh_node *n = &b->nodes[find_node(b, false)];
    n->hi[1] = nextafterf(n->hi[1], -INFINITY);
}
static void break_leaf_shrunk(struct bvh *b)
{
    struct gpu_bvh_node *n = &b->nodes[find_node(b, true)];
    n->lo[2] = nextafterf(n->lo[2], INFINITY);
}
static void break_duplicate(struct bvh *b)
{
    b->order[0] = b->order[1];
}
static void break_primitive_range(struct bvh *b)
{
    b->order[3] = b->primitive_count;
}
static void break_cycle(struct bvh *b)
{
    b->nodes[b->nodes[0].first] = b->nodes[0];
}
/* A cycle that never meets a leaf. */
static void break_cycle_of_inner(struct bvh *b)
{
    b->nodes[b->nodes[0].first] = b->nodes[b->nodes[0].first + 1] = b->nodes[0];
}
static void break_child_range(struct bvh *b)
{
    b->nodes[find_node(b, false)].first = b->node_count;
}
static void break_child_huge(struct bvh *b)
{
    b->nodes[find_node(b, false)].first = 0xfffffffeu;
}
static void break_child_root(struct bvh *b)
{
    b->nodes[find_node(b, false)].first = 0;
}
static void break_child_odd(struct bvh *b)
{
    ++b->nodes[0].first;
}
static void break_leaf_range(struct bvh *b)
{
    b->nodes[find_node(b, true)].first = b->primitive_count;
}
static void break_leaf_huge(struct bvh *b)
{
    b->nodes[find_node(b, true)].first = 0xfffffffeu;
}
static void break_count_bits(struct bvh *b)
{
    b->nodes[find_node(b, true)].count = 0xfffffff0u;
}
static void break_count_high(struct bvh *b)
{
    b->nodes[2].count |= 128u;
}
static void break_root_bits(struct bvh *b)
{
    b->nodes[0].count |= 1u << BVH_AXIS_SHIFT;
}
static void break_second_bits(struct bvh *b)
{
    b->nodes[3].count |= BVH_SECOND_LOW;
}
static void break_axis(struct bvh *b)
{
    uint32_t *count = &b->nodes[2].count;
    uint32_t axis = *count >> BVH_AXIS_SHIFT & BVH_AXIS_MASK;
    *count ^= (axis ^ (axis + 1) % 3) << BVH_AXIS_SHIFT;
}
static void break_axis_three(struct bvh *b)
{
    b->nodes[2].count |= BVH_AXIS_MASK << BVH_AXIS_SHIFT;
}
static void break_axis_sign(struct bvh *b)
{
    b->nodes[2].count ^= BVH_SECOND_LOW;
}
static void break_leaf_over_limit(struct bvh *b)
{
    b->nodes[find_node(b, true)].count = 5;
}
static void break_leaf_overlap(struct bvh *b)
{
    struct gpu_bvh_node *n = &b->nodes[find_node(b, true)];
    n->first = n->first > 0 ? n->first - 1 : n->first + 1;
}
static void break_leaf_lost(struct bvh *b)
{
    for (uint32_t i = 0; i < b->node_count; ++i) {
        if (bvh_count(&b->nodes[i]) > 1) {
            --b->nodes[i].count;
            return;
        }
    }
    fail();
}
static void break_orphans(struct bvh *b)
{
    b->node_count -= 2;
}
static void break_unreached(struct bvh *b)
{
    /* Two leaves under one node become one leaf. */
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
static void break_odd_count(struct bvh *b)
{
    ++b->node_count;
}
static void break_nan(struct bvh *b)
{
    b->nodes[0].lo[0] = NAN;
}
static void break_infinite(struct bvh *b)
{
    b->nodes[0].hi[0] = INFINITY;
}
static void break_depth(struct bvh *b)
{
    ++b->depth;
}
static void break_leaf_count_stated(struct bvh *b)
{
    --b->leaf_count;
}
static void break_largest_stated(struct bvh *b)
{
    ++b->leaf_largest;
}
static void break_empty(struct bvh *b)
{
    b->node_count = 0;
}

static void broken_trees_are_refused(void **state)
{
    (void)state;
#define ROW(fn, reason)                                                                            \
    {                                                                                              \
#fn, fn, reason                                                                            \
    }
    static const struct breakage rows[] = {
        ROW(break_children_swapped, "two parents"),
        ROW(break_parent_shrunk, "a child is not inside"),
        ROW(break_leaf_shrunk, "does not contain its primitive"),
        ROW(break_duplicate, "twice"),
        ROW(break_primitive_range, "names a primitive out of range"),
        ROW(break_cycle, "two parents"),
        ROW(break_cycle_of_inner, "two parents"),
        ROW(break_child_range, "children out of range"),
        ROW(break_child_huge, "children out of range"),
        ROW(break_child_root, "children out of range"),
        ROW(break_child_odd, "do not start at an even"),
        ROW(break_leaf_range, "reaches out of range"),
        ROW(break_leaf_huge, "reaches out of range"),
        ROW(break_count_bits, "stray bits"),
        ROW(break_count_high, "stray bits"),
        ROW(break_root_bits, "stray bits"),
        ROW(break_second_bits, "stray bits"),
        ROW(break_axis, "the axis is not"),
        ROW(break_axis_three, "the axis is not"),
        ROW(break_axis_sign, "the axis is not"),
        ROW(break_leaf_over_limit, "over the limit"),
        ROW(break_leaf_overlap, "share a record"),
        ROW(break_leaf_lost, "primitives are missing"),
        ROW(break_orphans, "children out of range"),
        ROW(break_unreached, "not reached"),
        ROW(break_odd_count, "aligned pairs"),
        ROW(break_nan, "not finite"),
        ROW(break_infinite, "not finite"),
        ROW(break_depth, "stated depth"),
        ROW(break_leaf_count_stated, "stated number of leaves"),
        ROW(break_largest_stated, "stated largest leaf"),
        ROW(break_empty, "no nodes for primitives"),
    };
#undef ROW
    random_state = 11;
    struct bvh_box *boxes = soup(500, 0.1f);
    for (size_t i = 0; i <= sizeof rows / sizeof *rows; ++i) {
        struct bvh bvh;
        build_and_check(boxes, 500, NULL, &bvh);
        void (*apply)(struct bvh *) = i == 0 ? break_none : rows[i - 1].apply;
        apply(&bvh);
        char said[201] = "";
        struct log log = {keep_message, said, WHIT_LOG_ERROR};
        whit_result result = bvh_validate(&log, &bvh, boxes, 4);
        assert_int_equal(result, i == 0 ? WHIT_OK : WHIT_ERROR_FAILED);
        if (i > 0 && !strstr(said, rows[i - 1].reason))
            fail_msg("%s: said `%s`", rows[i - 1].name, said);
        bvh_finish(&bvh);
    }
    free(boxes);
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
    char said[201] = "";
    struct log log = {keep_message, said, WHIT_LOG_ERROR};
    whit_result result = bvh_validate(&log, &tree->bvh, tree->boxes, 4);
    assert_int_equal(result, reason ? WHIT_ERROR_FAILED : WHIT_OK);
    if (reason && !strstr(said, reason))
        fail_msg("expected `%s`, said `%s`", reason, said);
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
    struct bvh_box *boxes = soup(200, 0.1f);
    uint32_t accepted = 0;
    for (int round = 0; round < 5000; ++round) {
        struct bvh bvh;
        assert_int_equal(bvh_build(&silent, boxes, 200, NULL, &bvh), WHIT_OK);
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
    free(boxes);
}

/* ---- What builders make ---- */

static struct bvh_box *any_boxes(uint32_t round, uint32_t count)
{
    if (round % 4 == 0)
        return garbage(count);
    struct bvh_box *boxes = soup(count, round % 4 == 1 ? 0.1f : 1e-3f);
    for (uint32_t i = 0; round % 4 == 2 && i < count; ++i) { /* on a grid: many centroids meet */
        for (int a = 0; a < 3; ++a) {
            boxes[i].lo[a] = floorf(8.0f * boxes[i].lo[a]);
            boxes[i].hi[a] = boxes[i].lo[a] + 1.0f;
        }
    }
    return boxes;
}

static void a_thousand_trees_are_valid(void **state)
{
    (void)state;
    for (uint32_t round = 0; round < 1000; ++round) {
        random_state = 5000 + round;
        uint32_t count = 20 + random_below(&random_state, round % 10 == 0 ? 281 : 61);
        struct bvh_box *boxes = any_boxes(round, count);
        check_all(boxes, count);
        free(boxes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broken_trees_are_refused),
        cmocka_unit_test(split_primitives_must_be_covered),
        cmocka_unit_test(validator_survives_any_bytes),
        cmocka_unit_test(a_thousand_trees_are_valid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
