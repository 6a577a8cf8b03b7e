/* Parts of scenes: their names and hashes, differences in words, scenes made of the parts of two
   others, and faults put into them. */
#include <glob.h>

#include "../scenes.h"
#include "../wrapped.h"
#include "base/array.h"
#include "load/load.h"
#include "messages_fixture.h"
#include "scene/change.h"
#include "scene/fault.h"
#include "scene/fields.h"
#include "scene/hash.h"
#include "scene/small.h"
#include "unit.h"

struct loaded {
    struct scene *scene;
    struct scene_parts parts;
    struct scene_side side;
};

static void take(struct loaded *loaded, struct scene *scene)
{
    loaded->scene = scene;
    assert_int_equal(scene_parts_init(scene, &loaded->parts), WHIT_OK);
    loaded->side = (struct scene_side){scene, &loaded->parts};
}

static void drop(struct loaded *loaded)
{
    scene_parts_finish(&loaded->parts);
    scene_destroy(loaded->scene);
}

/* Freed at the end of its block, once take() has filled it. */
#define own_loaded __attribute__((cleanup(drop), unused)) struct loaded

/* A floor, a textured box and a ball below a node that moves, under a sun and a lamp. */
struct wish {
    float ior, sun;
    uint8_t texel;
    float vertex;
    double moved;
    bool stone;       /* the box has another material */
    bool more, other; /* an object in front of all; balls in place of a ball */
    float key;
    bool hidden; /* the wood is a mask, with more changes than the words list */
};

static struct scene *small_scene(const struct wish *wish)
{
    struct scene *scene = scene_begin(NULL, "small");
    struct scene_material glass = material_grey("glass"), wood = material_grey("wood");
    uint8_t rgba[16] = {10, 20, 30, 255, 40, 50, 60, 255, 70, 80, 90, 255, 11, 12, 13, 255};
    const float times_s[] = {0.0f, 1.0f}, values[] = {0, 0, 0, 0, wish->key, 0};
    if (wish->more)
        scene_put(scene, mesh_box(0.1, 0.1, 0.1), &(struct put){.name = "crumb"});
    glass.ior = wish->ior;
    glass.transmission[0] = 0.9f;
    rgba[5] = wish->texel;
    if (wish->hidden) {
        wood.alpha = SCENE_ALPHA_MASK;
        wood.model = WHIT_MODEL_UNLIT;
        wood.two_sided = true;
        wood.opacity = 0.5f;
        wood.priority = 3;
        wood.textures[SCENE_SLOT_DIFFUSE].wrap_u = SCENE_WRAP_MIRROR;
    }
    wood.textures[SCENE_SLOT_DIFFUSE].texture = scene_put_texture(scene, 2, 2, rgba);
    struct scene_mesh box = mesh_box(1, 1, 1);
    box.positions[3] += wish->vertex;
    uint32_t node = scene_put_node(scene, SCENE_NONE, wish->moved, 0, 0);
    scene_put(scene, mesh_plane(4.0), &(struct put){.name = "floor"});
    struct scene_material stone = material_grey("stone");
    scene_put(scene, box, &(struct put){.name = "box", .material = wish->stone ? &stone : &wood});
    scene_put(scene, wish->other ? mesh_icosphere(0.5, 2) : mesh_icosphere(0.5, 1),
              &(struct put){.name = "ball", .material = &glass, .node = &node});
    scene_put_channel(scene, node, SCENE_PATH_TRANSLATION, 2, times_s, values);
    scene_put_sun(scene, 0.2, -1, 0.1, wish->sun);
    scene_put_lamp(scene, 1, 2, 1, 4.0f);
    scene_put_camera(scene, (const double[]){0, 2, 5}, (const double[]){0, 0, 0}, 0.8);
    return scene_ready(scene);
}

static const struct wish usual = {.ior = 1.5f, .sun = 1.0f, .texel = 50, .key = 1.0f};

/* The parts of `after` that differ from those of `before`: "mesh box, material glass". */
static const char *others(const struct loaded *before, const struct loaded *after)
{
    static char text[512];
    text[0] = 0;
    for (uint32_t i = 0; i < before->parts.count; ++i) {
        const struct scene_part *was = &before->parts.items[i];
        const struct scene_part *is = scene_parts_find(&after->parts, was->kind, was->name);
        if (is && is->hash == was->hash)
            continue;
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%s%s%s", used ? ", " : "",
                 scene_part_kind_name(was->kind), was->name[0] ? " " : "", was->name);
    }
    return text;
}

static const char *change(const struct loaded *before, const struct loaded *after,
                          whit_part_kind kind, const char *name)
{
    static char text[512];
    scene_change_write(&before->side, &after->side, kind, name, text, sizeof text);
    return text;
}

/* Checks that a change alters only the hash of its part, and that the words describe it. */
static void check_change(struct wish wish, const char *parts, whit_part_kind kind, const char *name,
                         const char *words)
{
    own_loaded before, after;
    take(&before, small_scene(&usual));
    take(&after, small_scene(&wish));
    assert_string_equal(others(&before, &after), parts);
    assert_string_equal(change(&before, &after, kind, name), words);
}

/* Checks that each plain value of a record is in its hash; else a picture of another scene might be
   taken for one of this scene. `record` is as before in the end. */
static void check_fields(whit_part_kind kind, const void *whole, void *record,
                         const struct scene_field *field)
{
    static const size_t sizes[] = {sizeof(float), sizeof(double), sizeof(int32_t), sizeof(bool),
                                   sizeof(int32_t)};
    for (; field->name; ++field) {
        bool stated =
            kind == WHIT_PART_LIGHT && field->offset == offsetof(struct scene_light, stated);
        if (stated) /* the hash has `color`, which is derived from it */
            continue;
        for (uint32_t i = 0; i < field->count; ++i) {
            char *at = (char *)record + field->offset + i * sizes[field->form];
            uint64_t before = freeze_hash_record(kind, whole);
            *at ^= 1;
            if (freeze_hash_record(kind, whole) == before)
                fail_msg("%s %u is not in the hash", field->name, i);
            *at ^= 1;
        }
    }
}

TEST(plain_values_are_in_the_hash)
{
    struct scene_material material = material_grey("glass");
    struct scene_light light = {.kind = WHIT_LIGHT_RECTANGLE};
    struct scene_camera camera = {.node = SCENE_NONE};
    check_fields(WHIT_PART_MATERIAL, &material, &material, scene_material_fields);
    check_fields(WHIT_PART_MATERIAL, &material, &material.textures[SCENE_SLOT_BUMP],
                 scene_texture_use_fields);
    check_fields(WHIT_PART_LIGHT, &light, &light, scene_light_fields);
    struct scene_environment sky = {.kind = WHIT_ENVIRONMENT_GRADIENT};
    check_fields(WHIT_PART_CAMERA, &camera, &camera, scene_camera_fields);
    check_fields(WHIT_PART_ENVIRONMENT, &sky, &sky, scene_environment_fields);
}

TEST(a_change_is_one_of_its_part_and_is_said)
{
    struct wish wish = usual;
    check_change(wish, "", WHIT_PART_MESH, "box", "");
    wish.ior = 1.51f;
    check_change(wish, "material glass", WHIT_PART_MATERIAL, "glass", "ior from 1.5 to 1.51");
    wish = usual, wish.sun = 2.0f;
    check_change(wish, "light sun", WHIT_PART_LIGHT, "sun", "colour from 1 1 1 to 2 2 2");
    wish = usual, wish.texel = 57;
    check_change(wish, "texture texture", WHIT_PART_TEXTURE, "texture",
                 "1 of 4 texels other by up to 7 of 255, in rows 0 to 0");
    wish = usual, wish.vertex = 0.25f;
    check_change(wish, "mesh box", WHIT_PART_MESH, "box",
                 "vertex 1 moved by 0.25, normals that it had not");
    wish = usual, wish.hidden = true;
    check_change(wish, "material wood", WHIT_PART_MATERIAL, "wood",
                 "model from phong to unlit, two-sided from off to on, priority from 0 to 3, alpha "
                 "mode from opaque to mask and 2 more");
    wish = usual, wish.key = 3.0f;
    check_change(wish, "animation node translation", WHIT_PART_ANIMATION, "node translation",
                 "value of key 1 other by 2");
    wish = usual, wish.moved = 0.5;
    check_change(wish, "objects", WHIT_PART_OBJECTS, "", "node \"node\" moved by 0.5");
    wish = usual, wish.other = true;
    check_change(wish, "mesh ball", WHIT_PART_MESH, "ball",
                 "162 vertices in place of 42, 320 triangles in place of 80");
}

TEST(references_count_by_name)
{
    own_loaded before, after;
    struct wish wish = usual;
    wish.more = true;
    take(&before, small_scene(&usual));
    take(&after, small_scene(&wish));
    assert_string_equal(others(&before, &after), "objects");
    assert_string_equal(change(&before, &after, WHIT_PART_OBJECTS, ""),
                        "mesh \"crumb\" is new, 4 instances in place of 3");
    drop(&after);
    wish = usual, wish.stone = true;
    take(&after, small_scene(&wish));
    assert_string_equal(others(&before, &after), "mesh box, material wood");
    assert_string_equal(change(&before, &after, WHIT_PART_MESH, "box"),
                        "12 of 12 primitives of material \"stone\" in place of \"wood\"");
}

/* The scene `after` with parts of `before` put back: all of them, the one of this kind and name, or
   none where `name` is NULL. */
static struct scene *mix(const struct loaded *before, const struct loaded *after, bool all,
                         whit_part_kind kind, const char *name)
{
    own_memory bool *back = calloc(before->parts.count, sizeof *back);
    struct scene *made = NULL;
    uint32_t found = 0;
    assert_non_null(back);
    for (uint32_t i = 0; i < before->parts.count; ++i) {
        const struct scene_part *part = &before->parts.items[i];
        back[i] = all || (name && part->kind == kind && strcmp(part->name, name) == 0);
        found += back[i];
    }
    assert_true(!name || found == 1);
    assert_int_equal(scene_mix(NULL, &before->side, &after->side, back, &made), WHIT_OK);
    return made;
}

static void check_hash(struct scene *made, uint64_t hash)
{
    assert_true(made->frozen);
    assert_int_equal(made->hash, hash);
    scene_destroy(made);
}

/* Undoes one of the two changes in `both`: the scene then has the hash of one with only the `other`
   change. */
static void check_back(struct wish both, struct wish other, whit_part_kind kind, const char *name)
{
    own_loaded before, after;
    own_scene *expected = small_scene(&other);
    take(&before, small_scene(&usual));
    take(&after, small_scene(&both));
    assert_true(after.scene->hash != expected->hash);
    check_hash(mix(&before, &after, false, kind, name), expected->hash);
    check_hash(mix(&before, &after, true, kind, NULL), before.scene->hash);
    check_hash(mix(&before, &after, false, kind, NULL), after.scene->hash);
}

TEST(a_part_that_is_put_back_leaves_the_others)
{
    struct wish both = usual, other = usual;
    both.ior = 1.6f, both.vertex = 0.1f;
    other.vertex = 0.1f;
    check_back(both, other, WHIT_PART_MATERIAL, "glass");
    other = both, other.vertex = 0.0f;
    check_back(both, other, WHIT_PART_MESH, "box");
    both = usual, both.sun = 3.0f, both.texel = 9, both.more = true;
    other = both, other.sun = usual.sun;
    check_back(both, other, WHIT_PART_LIGHT, "sun");
    other = both, other.texel = usual.texel;
    check_back(both, other, WHIT_PART_TEXTURE, "texture");
    other = both, other.more = false;
    check_back(both, other, WHIT_PART_OBJECTS, "");
    both = usual, both.moved = 2.0, both.key = 7.0f;
    other = both, other.key = usual.key;
    check_back(both, other, WHIT_PART_ANIMATION, "node translation");
}

/* The box of `before` has a material that `after` lacks: the material and its texture come with it.
 */
TEST(what_a_part_names_comes_with_it)
{
    own_loaded before, after;
    struct wish wish = usual;
    wish.stone = true;
    take(&before, small_scene(&usual));
    take(&after, small_scene(&wish));
    own_scene *made = mix(&before, &after, false, WHIT_PART_MESH, "box");
    assert_int_equal(made->material_count, after.scene->material_count + 1);
    const struct scene_material *worn = &made->materials[made->meshes[1].materials[0]];
    assert_string_equal(worn->name, "wood");
    const struct scene_texture *texture =
        &made->textures[worn->textures[SCENE_SLOT_DIFFUSE].texture];
    assert_int_equal(texture->rgba[0], 10);
}

static struct scene *load(const char *path)
{
    struct scene *scene = NULL;
    assert_int_equal(load_scene(NULL, path, NULL, &scene), WHIT_OK);
    return scene;
}

/* Values that whit derives, such as emitters and exposure, are derived again with the same bits,
   for all scenes, each mixed with the one before. */
TEST(scenes_of_all_or_no_parts_are_those_they_are_of)
{
    glob_t files;
    struct loaded before, after;
    assert_int_equal(glob(WHIT_SCENES_DIR "/gallery/*.json", 0, NULL, &files), 0);
    assert_int_equal(glob(WHIT_SCENES_DIR "/[dglrsw]*.json", GLOB_APPEND, NULL, &files), 0);
    assert_true(files.gl_pathc > 16);
    take(&before, load(files.gl_pathv[0]));
    for (size_t i = 1; i < files.gl_pathc; ++i) {
        take(&after, load(files.gl_pathv[i]));
        check_hash(mix(&before, &after, true, 0, NULL), before.scene->hash);
        check_hash(mix(&before, &after, false, 0, NULL), after.scene->hash);
        drop(&before);
        before = after;
        before.side.parts = &before.parts;
    }
    drop(&before);
    globfree(&files);
}

/* A model from another program, whose light whit adjusts: it comes from a glowing material, or from
   lights in its file. */
static struct scene *model(bool lamp_glows, float strength)
{
    struct scene *scene = scene_begin(NULL, "model");
    struct scene_material lamp = material_grey("lamp");
    lamp.emission[0] = lamp.emission[1] = lamp_glows ? strength : 0.0f;
    scene->is_model = true;
    scene_put(scene, mesh_plane(4.0), &(struct put){.name = "floor"});
    scene_put(scene, mesh_box(1, 1, 1), &(struct put){.name = "lamp", .material = &lamp});
    scene->materials[1].origin.file = string_copy("a.mtl");
    if (!lamp_glows) {
        scene_put_lamp(scene, 1, 2, 1, strength);
        scene_put_sun(scene, 0.5, -1, 0.3, 1e-3f);
        for (int i = 0; i < 2; ++i)
            scene->lights[i].origin.file = string_copy("a.gltf");
    }
    return scene_ready(scene);
}

TEST(lights_made_to_suit_are_made_anew)
{
    for (int glows = 0; glows < 2; ++glows) {
        own_loaded before, after;
        take(&before, model(glows, glows ? 20.0f : 1e-3f));
        take(&after, model(glows, glows ? 40.0f : 3e-3f));
        const struct scene_light *light = &before.scene->lights[0];
        assert_int_equal(light->made_by_whit, glows);
        assert_true(glows || light->color[0] > 4.0f * light->stated[0]);
        assert_true(before.scene->cameras[0].made_by_whit);
        const char *other = glows ? "material lamp" : "light lamp";
        assert_string_equal(others(&before, &after), other);
        whit_part_kind kind = glows ? WHIT_PART_MATERIAL : WHIT_PART_LIGHT;
        check_hash(mix(&before, &after, false, kind, "lamp"), before.scene->hash);
        check_hash(mix(&before, &after, false, 0, NULL), after.scene->hash);
    }
}

TEST(names_are_unique)
{
    struct scene *scene = scene_begin(NULL, "names");
    const char *const names[] = {"a", "a", "a#2", "a"};
    for (int i = 0; i < 4; ++i)
        scene_put(scene, mesh_box(1, 1, 1 + i), &(struct put){.name = names[i]});
    scene_put(scene, mesh_box(1, 1, 9), NULL);
    own_loaded loaded;
    take(&loaded, scene_ready(scene));
    const char *const unique[] = {"a", "a#2", "a#2#2", "a#3", "#4"};
    for (uint32_t i = 0; i < 5; ++i) {
        assert_string_equal(loaded.parts.items[i].name, unique[i]);
        assert_ptr_equal(scene_parts_find(&loaded.parts, WHIT_PART_MESH, unique[i]),
                         &loaded.parts.items[i]);
    }
    assert_null(scene_parts_find(&loaded.parts, WHIT_PART_MESH, "b"));
    assert_null(scene_parts_find(&loaded.parts, WHIT_PART_LIGHT, "a")); /* a light by whit */
}

/* Takes minutes where each name is tried with all numbers from 2 on. */
TEST(many_records_of_one_name)
{
    enum { COUNT = 60000 };
    struct scene *scene = scene_begin(NULL, "names");
    for (int i = 0; i < COUNT; ++i)
        scene_put_node(scene, SCENE_NONE, 0, 0, 0);
    own_loaded loaded;
    take(&loaded, scene_ready(scene));
    assert_string_equal(scene_parts_name(&loaded.parts, SCENE_NAMES_NODE, 1), "node#2");
    assert_string_equal(scene_parts_name(&loaded.parts, SCENE_NAMES_NODE, COUNT - 1), "node#60000");
}

/* ---- Faults ---- */

/* The parts that a fault alters are of the kind that it says. */
TEST(a_fault_alters_its_parts_alone)
{
    static const struct {
        whit_fault_kind kind;
        double amount;
        const char *begins;
        uint32_t parts;
    } cases[] = {
        {WHIT_FAULT_VERTEX, 1e-3, "mesh ", 1},
        {WHIT_FAULT_IOR, 0.01, "material glass", 1},
        {WHIT_FAULT_LIGHT, 0.02, "light ", 1},
        {WHIT_FAULT_TEXELS, 0.05, "texture texture", 1},
        {WHIT_FAULT_MATERIALS, 0.0, "material ", 2},
        {WHIT_FAULT_ORDER, 0.0, "objects", 1},
    };
    own_loaded before;
    take(&before, small_scene(&usual));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        for (uint64_t seed = 0; seed < 8; ++seed) {
            whit_fault fault = {cases[i].kind, seed, cases[i].amount};
            own_loaded after;
            struct scene *made;
            assert_int_equal(scene_fault(NULL, &before.side, &fault, 1, &made), WHIT_OK);
            take(&after, made);
            const char *text = others(&before, &after);
            assert_memory_equal(text, cases[i].begins, strlen(cases[i].begins));
            assert_int_equal(1 + (strchr(text, ',') != NULL), cases[i].parts);
        }
    }
    whit_fault none = {WHIT_FAULT_KINDS, 0, 0.0};
    struct scene *made;
    assert_int_equal(scene_fault(NULL, &before.side, &none, 1, &made), WHIT_ERROR_USAGE);
    assert_null(made);
}

TEST(a_fault_of_light_finds_one_that_is_not_black)
{
    struct scene *scene = scene_begin(NULL, "dark");
    for (int i = 0; i < 4; ++i)
        scene_put_lamp(scene, i, 2, 1, i == 2 ? 1.0f : 0.0f);
    own_loaded before;
    take(&before, scene_ready(scene));
    for (uint64_t seed = 0; seed < 8; ++seed) {
        const whit_fault fault = {WHIT_FAULT_LIGHT, seed, 0.5};
        struct scene *made = NULL;
        assert_int_equal(scene_fault(NULL, &before.side, &fault, 1, &made), WHIT_OK);
        own_scene *changed = made;
        assert_true(changed->lights[2].color[0] == 1.5f);
    }
}

/* ---- Memory ---- */

static uint32_t calls, fails_at; /* counts calls for memory, of which this one gives nothing */
static int64_t live;             /* blocks that were not given back */
static bool counts;

static void *took(void *block)
{
    live += counts && block;
    return block;
}

WRAPPED(void *, malloc, size_t bytes)
{
    return counts && ++calls == fails_at ? NULL : took(__real_malloc(bytes));
}

WRAPPED(void *, calloc, size_t count, size_t bytes)
{
    return counts && ++calls == fails_at ? NULL : took(__real_calloc(count, bytes));
}

WRAPPED(void *, realloc, void *block, size_t bytes)
{
    if (counts && ++calls == fails_at)
        return NULL;
    live -= counts && block;
    return took(__real_realloc(block, bytes));
}

WRAPPED(void, free, void *block)
{
    live -= counts && block;
    __real_free(block);
}

/* A scene of half of the parts of two others, and one with a fault. */
static whit_result mix_and_fault(const struct scene *a, const struct scene *b)
{
    const whit_fault fault = {WHIT_FAULT_VERTEX, 1, 1e-3};
    struct scene_parts was = {0}, is = {0};
    struct scene *mixed = NULL, *faulty = NULL;
    bool back[16] = {true, false, true, true};
    whit_result result = a && b ? scene_parts_init(a, &was) : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK)
        result = scene_parts_init(b, &is);
    const struct scene_side before = {a, &was}, after = {b, &is};
    assert_true(was.count <= sizeof back);
    if (result == WHIT_OK)
        result = scene_mix(NULL, &before, &after, back, &mixed);
    if (result == WHIT_OK)
        result = scene_fault(NULL, &before, &fault, 1, &faulty);
    assert_true((faulty != NULL) == (result == WHIT_OK));
    scene_destroy(mixed);
    scene_destroy(faulty);
    scene_parts_finish(&was);
    scene_parts_finish(&is);
    return result;
}

TEST(what_was_made_before_memory_ran_out_is_given_back)
{
    bool failed = true;
    for (fails_at = 1; failed; ++fails_at) {
        calls = 0, live = 0, counts = true;
        messages = (struct messages){0};
        struct scene *a = scene_small(&warnings_log), *b = scene_small(&warnings_log);
        assert_int_equal(messages.errors, !a || !b);
        whit_result result = mix_and_fault(a, b);
        scene_destroy(a);
        scene_destroy(b);
        counts = false;
        failed = calls >= fails_at;
        assert_int_equal(live, 0);
        assert_true(result == WHIT_OK || (result == WHIT_ERROR_MEMORY && failed));
    }
    assert_true(fails_at > 200);
}
