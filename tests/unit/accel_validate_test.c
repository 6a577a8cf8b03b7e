/* The validator refuses every way of breaking a tree. */
#include "accel_build_fixture.h"
#include "unit.h"

#include "bvh/complete.h"
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
static void repeat_primitive(struct bvh *b)
{
    b->order[0] = b->order[1];
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
    {"cycle", make_cycle, "two parents"},
    {"cycle of inner nodes", make_cycle_of_inner, "two parents"},
    {"children behind the end", exceed_nodes, "children out of range"},
    {"primitive twice", repeat_primitive, "twice"},
    {"another axis", turn_axis, "the axis is not"},
    {"leaves overlap", overlap_leaves, "share a record"},
    {"record lost", lose_record, "primitives are missing"},
    {"pair not reached", pass_by_pair, "not reached"},
};

/* The same, of one word: it becomes ((word & ~clear) ^ flip) + add. Nodes by number, or the first
   of their kind. */
enum { ROOT, SECOND_CHILD = 3, INNER = 1000, LEAF, ORDER, TREE };
enum { FIRST = offsetof(struct gpu_bvh_node, first), COUNT = offsetof(struct gpu_bvh_node, count) };
static const struct {
    const char *name;
    uint32_t node;
    size_t word; /* bytes from the beginning of a node, of `order` or of the tree */
    uint32_t clear, flip, add;
    const char *reason;
} changes[] = {
    {"children far behind the end", INNER, FIRST, ~0u, 0, 0xfffffffeu, "children out of range"},
    {"children at the root", INNER, FIRST, ~0u, 0, 0, "children out of range"},
    {"children at an odd node", ROOT, FIRST, 0, 0, 1, "do not start at an even"},
    {"leaf behind the end", LEAF, FIRST, ~0u, 0, 500, "reaches out of range"},
    {"leaf far behind the end", LEAF, FIRST, ~0u, 0, 0xfffffffeu, "reaches out of range"},
    {"all bits of a count", LEAF, COUNT, ~0u, 0, 0xfffffff0u, "stray bits"},
    {"high bit of a count", 2, COUNT, 128, 0, 128, "stray bits"},
    {"axis of the root", ROOT, COUNT, 0, 1u << BVH_AXIS_SHIFT, 0, "stray bits"},
    {"sign at the second child", SECOND_CHILD, COUNT, 0, BVH_SECOND_LOW, 0, "stray bits"},
    {"a fourth axis", 2, COUNT, BVH_AXIS_MASK << BVH_AXIS_SHIFT, 0, BVH_AXIS_MASK << BVH_AXIS_SHIFT,
     "the axis is not"},
    {"sign of the axis", 2, COUNT, 0, BVH_SECOND_LOW, 0, "the axis is not"},
    {"leaf over the limit", LEAF, COUNT, ~0u, 0, 5, "over the limit"},
    {"NaN", ROOT, offsetof(struct gpu_bvh_node, lo), ~0u, 0, 0x7fc00000u, "not finite"},
    {"infinity", ROOT, offsetof(struct gpu_bvh_node, hi), ~0u, 0, 0x7f800000u, "not finite"},
    {"primitive out of range", ORDER, 12, ~0u, 0, 500, "names a primitive out of range"},
    {"pair beyond the end", TREE, offsetof(struct bvh, node_count), 0, 0, 0u - 2u,
     "children out of range"},
    {"half a pair", TREE, offsetof(struct bvh, node_count), 0, 0, 1, "aligned pairs"},
    {"no nodes", TREE, offsetof(struct bvh, node_count), ~0u, 0, 0, "no nodes for primitives"},
    {"depth", TREE, offsetof(struct bvh, depth), 0, 0, 1, "stated depth"},
};

static void change_word(struct bvh *bvh, size_t row)
{
    uint32_t node = changes[row].node, word;
    uint8_t *at = node == TREE    ? (uint8_t *)bvh
                  : node == ORDER ? (uint8_t *)bvh->order
                  : node >= INNER ? (uint8_t *)&bvh->nodes[find_node(bvh, node == LEAF)]
                                  : (uint8_t *)&bvh->nodes[node];
    memcpy(&word, at + changes[row].word, sizeof word);
    word = ((word & ~changes[row].clear) ^ changes[row].flip) + changes[row].add;
    memcpy(at + changes[row].word, &word, sizeof word);
}

static void assert_said(const struct bvh *bvh, const struct bvh_box *boxes, const char *name,
                        const char *reason)
{
    messages.last_error[0] = 0;
    whit_result result = bvh_validate(&silent, bvh, boxes, 4);
    if (result != (reason ? WHIT_ERROR_FAILED : WHIT_OK) ||
        (reason && !strstr(messages.last_error, reason)))
        fail_msg("%s: expected `%s`, said `%s`", name, reason ? reason : "nothing",
                 messages.last_error);
}

TEST(broken_trees_are_refused)
{
    enum { WAYS = sizeof breakages / sizeof *breakages, WORDS = sizeof changes / sizeof *changes };
    random_state = 11;
    own_soup soup = soup_scattered(500, 0.1f);
    for (size_t i = 0; i < WAYS + WORDS; ++i) {
        own_bvh bvh = soup_build(&soup, (whit_accel_params){0});
        if (i < WAYS) {
            if (breakages[i].apply)
                breakages[i].apply(&bvh);
            assert_said(&bvh, soup.boxes, breakages[i].name, breakages[i].reason);
        } else {
            change_word(&bvh, i - WAYS);
            assert_said(&bvh, soup.boxes, changes[i - WAYS].name, changes[i - WAYS].reason);
        }
    }
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
    tree->bvh.depth = 1;
    bvh_complete(&tree->bvh, 1);
}

static void split_tree_said(const struct split_tree *tree, const char *reason)
{
    assert_said(&tree->bvh, tree->boxes, "split tree", reason);
}

TEST(split_primitives_must_be_covered)
{
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
TEST(validator_survives_any_bytes)
{
    random_state = 12;
    own_soup soup = soup_scattered(200, 0.1f);
    uint32_t accepted = 0;
    for (int round = 0; round < 5000; ++round) {
        own_bvh bvh = soup_build(&soup, (whit_accel_params){0});
        uint32_t flips = 1 + random_below(&random_state, 4);
        for (uint32_t k = 0; k < flips; ++k) {
            uint8_t *bytes =
                random_below(&random_state, 8) ? (uint8_t *)bvh.nodes : (uint8_t *)bvh.order;
            size_t size = bytes == (uint8_t *)bvh.order ? 200 * sizeof *bvh.order
                                                        : bvh.node_count * sizeof *bvh.nodes;
            bytes[random_bits(&random_state) % size] = (uint8_t)random_bits(&random_state);
        }
        accepted += bvh_validate(&silent, &bvh, soup.boxes, 4) == WHIT_OK;
    }
    assert_true(accepted < 2500); /* widened boxes and the unused node are no faults */
}
