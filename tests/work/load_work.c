/* Loading four times as much is about four times the work: branches taken by whit, in the
   importer's child too, which is no process of its own here. */
#include <stdatomic.h>

#include "../child_in_place.h"
#include "base/hash.h"
#include "load_model_fixture.h"

static _Atomic uint64_t branches;
static uint32_t children;

enum child_end __wrap_child_run(const struct child_limits *limits,
                                int (*fn)(void *user, void *to, child_write write), void *user,
                                struct child_reply *reply)
{
    (void)limits;
    children++;
    return child_in_place(fn, user, reply, NULL);
}

void __sanitizer_cov_trace_pc(void);
void __sanitizer_cov_trace_pc(void)
{
    atomic_fetch_add_explicit(&branches, 1, memory_order_relaxed);
}

enum { FEW = 250, MANY = 4 * FEW };

/* Writes `text` with what is in < > written `count` times, # being the number. */
static const char *write_file(const char *name, const char *text, uint32_t count)
{
    char numbered[64];
    snprintf(numbered, sizeof numbered, "%u%s", count, name);
    const char *path = in_folder(numbered);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    const char *start = NULL;
    uint32_t index = 0;
    for (; *text; text++) {
        if (*text == '<') {
            start = text;
            index = 0;
        } else if (*text == '>') {
            index++;
            text = index < count ? start : text;
        } else if (*text == '#') {
            fprintf(file, "%u", start ? index : count);
        } else if (*text != '~' || index) { /* a comma between two */
            fputc(*text == '~' ? ',' : *text, file);
        }
    }
    assert_int_equal(fclose(file), 0);
    return path;
}

static uint64_t work_of(const char *path)
{
    struct scene *scene;
    const whit_log log = {.fn = messages_collect, .user = &messages, .level = WHIT_LOG_ERROR};
    branches = 0;
    if (load_scene(&log, path, NULL, &scene) != WHIT_OK)
        fail_msg("%s", messages.last_error);
    scene_destroy(scene);
    return branches;
}

/* A second file is for the first to name. */
static void check(const char *name, const char *text, const char *more_name, const char *more)
{
    uint64_t work[2];
    for (int i = 0; i < 2; i++) {
        uint32_t count = i ? MANY : FEW;
        if (more)
            write_file(more_name, more, count);
        work[i] = work_of(write_file(name, text, count));
    }
    print_message("%s: %llu and %llu branches\n", name, (unsigned long long)work[0],
                  (unsigned long long)work[1]);
    assert_true(work[0] > FEW);
    assert_true((double)work[1] < 4.1 * (double)work[0]);
}

#define GLTF                                                                                       \
    "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;base64,"     \
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"                                        \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
#define ACCESSOR "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}"

TEST_IN(primitives, folder_begin, folder_end)
{
    check("primitives.gltf",
          GLTF "\"accessors\":[" ACCESSOR "],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":["
               "<~{\"attributes\":{\"POSITION\":0}}>]}]}",
          NULL, NULL);
}

TEST_IN(meshes_and_materials, folder_begin, folder_end)
{
    check("meshes.gltf",
          GLTF
          "\"accessors\":[<~" ACCESSOR ">],\"nodes\":[<~{\"mesh\":#}>],"
          "\"meshes\":[<~{\"primitives\":[{\"attributes\":{\"POSITION\":#},\"material\":#}]}>],"
          "\"materials\":[<~{\"extensions\":{\"KHR_materials_ior\":{},\"EXT_a#\":{}}}>]}",
          NULL, NULL);
}

TEST_IN(options_behind_a_texture, folder_begin, folder_end)
{
    check("options.obj", "mtllib #options.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n",
          "options.mtl", "newmtl m\nmap_Kd x< -blendu a> b\n");
}

TEST_IN(nodes_of_one_skin, folder_begin, folder_end)
{
    check("skin.gltf",
          GLTF "\"accessors\":[" ACCESSOR "],\"meshes\":[{\"primitives\":[{\"attributes\":"
               "{\"POSITION\":0}}]}],\"skins\":[{\"joints\":[<~#>]}],"
               "\"nodes\":[<~{\"mesh\":0,\"skin\":0}>]}",
          NULL, NULL);
}

TEST_IN(missing_pictures, folder_begin, folder_end)
{
    check("pictures.gltf",
          GLTF "\"accessors\":[" ACCESSOR "],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":["
               "{\"attributes\":{\"POSITION\":0}}]}],"
               "\"materials\":[<~{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":#}}}>],"
               "\"textures\":[<~{\"source\":#}>],\"images\":[<~{\"uri\":\"#.png\"}>]}",
          NULL, NULL);
}

TEST_IN(groups_and_their_materials, folder_begin, folder_end)
{
    check("groups.obj",
          "mtllib #groups.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
          "<g g#\nusemtl m#\nf 1 2 3\n>",
          "groups.mtl", "<newmtl m#\nword# 1\n>");
}

TEST_IN(elements_without_properties, folder_begin, folder_end)
{
    check("elements.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
          "float z\n<element a #\n>element face 1\nproperty list uchar int vertex_indices\n"
          "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n<\n>",
          NULL, NULL);
}

TEST_IN(objects, folder_begin, folder_end)
{
    check("objects.json",
          "{\"camera\":{\"eye\":[0,0,9],\"target\":[0,0,0]},\"lights\":[{\"kind\":\"point\","
          "\"position\":[0,9,0]}],\"materials\":{\"m\":{\"diffuse\":0.5}},\"objects\":[<~{"
          "\"shape\":\"sphere\","
          "\"segments\":4,\"rings\":2,\"radius\":1.#1,\"material\":\"m\"}>]}",
          NULL, NULL);
}

/* 2^bits keys that hash_bytes cannot tell apart, whatever it starts from. */
static uint64_t work_of_equal_hashes(uint32_t bits)
{
    struct key_table table = {0};
    uint64_t key[32];
    branches = 0;
    for (uint32_t i = 0; i < 1u << bits; i++) {
        uint32_t value;
        for (uint32_t k = 0; k < 16; k++) {
            key[2 * k] = (uint64_t)(i >> k & 1) << 63;
            key[2 * k + 1] = (uint64_t)(i >> k & 1) << 63 ^ (uint64_t)(i >> k & 1) << 34;
        }
        assert_true(hash_bytes(1, key, sizeof key) == hash_bytes(1, (uint64_t[32]){0}, sizeof key));
        assert_false(key_table_find(&table, key, sizeof key, &value));
        assert_true(key_table_add(&table, key, sizeof key, i));
        assert_true(key_table_find(&table, key, sizeof key, &value) && value == i);
    }
    key_table_finish(&table);
    return branches;
}

TEST(names_of_equal_hashes)
{
    uint64_t few = work_of_equal_hashes(8);
    assert_true((double)work_of_equal_hashes(12) < 16.4 * (double)few);
}

TEST_IN(one_model_under_many_materials, folder_begin, folder_end)
{
    put_text("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const char *path = write_file(
        "models.json",
        "{\"camera\":{\"eye\":[0,0,9],\"target\":[0,0,0]},\"lights\":[{\"kind\":\"point\","
        "\"position\":[0,9,0]}],\"objects\":[<~{\"model\":\"././tri.obj\",\"material\":"
        "{\"diffuse\":0.#1}}>,{\"model\":\"tri.obj\"},{\"model\":\"tri.obj\"}]}",
        FEW);
    struct scene *scene;
    children = 0;
    assert_int_equal(load_scene(&(whit_log){0}, path, NULL, &scene), WHIT_OK);
    assert_int_equal(children, 2); /* under materials, and under its own */
    assert_int_equal(scene->mesh_count, FEW + 1);
    assert_int_equal(scene->instance_count, FEW + 2);
    for (uint32_t i = 0; i < FEW; i++) {
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        const struct scene_material *material = &scene->materials[mesh->materials[0]];
        char expected[16];
        snprintf(expected, sizeof expected, "0.%u1", i);
        assert_float_equal(material->diffuse[0], atof(expected), 1e-6);
    }
    scene_destroy(scene);
}

/* They are where the model is placed. */
TEST_IN(one_model_with_lights_and_cameras, folder_begin, folder_end)
{
    put_text("lamp.gltf",
             GLTF "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"name\":\"lamp\","
                  "\"type\":\"point\"}]}},\"cameras\":[{\"name\":\"eye\",\"type\":"
                  "\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}],"
                  "\"accessors\":[" ACCESSOR "],\"meshes\":[{\"primitives\":[{\"attributes\":"
                  "{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0,\"camera\":0,\"extensions\":"
                  "{\"KHR_lights_punctual\":{\"light\":0}}}]}");
    const char *path = write_file("lamps.json",
                                  "{\"objects\":[<~{\"model\":\"lamp.gltf\",\"lights\":true,"
                                  "\"cameras\":true,\"translation\":[#,0,0]}>,{\"model\":"
                                  "\"lamp.gltf\",\"lights\":true,\"cameras\":true,"
                                  "\"repeat\":{\"count\":[2,1,1]}}]}",
                                  FEW);
    struct scene *scene;
    assert_int_equal(load_scene(&(whit_log){0}, path, NULL, &scene), WHIT_OK);
    assert_int_equal(scene->mesh_count, 1);
    assert_int_equal(scene->instance_count, FEW + 2);
    assert_int_equal(scene->light_count, FEW + 1); /* not repeated */
    assert_int_equal(scene->camera_count, FEW + 1);
    for (uint32_t i = 0; i < FEW; i++) {
        uint32_t node = scene->lights[i].node;
        assert_int_equal(scene->cameras[i].node, node);
        assert_int_equal(scene->nodes[scene->nodes[node].parent].translation[0], i);
        assert_string_equal(scene->lights[i].name, "lamp");
        assert_string_equal(scene->cameras[i].name, "eye");
    }
    scene_destroy(scene);
}
