/* Equal pictures are decoded and kept once, whatever their names. */
#include "load_model_fixture.h"

#include <stdatomic.h>

#include "../wrapped.h"
#include "load/texture_ahead.h"
#include "unit.h"

static atomic_uint decoded;
static uint32_t file_reads, taken;

WRAPPED(whit_result, picture_read, const whit_log *log, const struct foreign_params *params,
        uint64_t pixels_max, const uint8_t *data, size_t size_bytes, struct picture *out,
        char reason[FOREIGN_REASON_BYTES])
{
    whit_result result =
        __real_picture_read(log, params, pixels_max, data, size_bytes, out, reason);
    /* A call that only reads the header gives no picture, but sets its sides. */
    decoded += result == WHIT_OK || out->width == 0;
    return result;
}

WRAPPED(whit_result, file_read, const whit_log *log, const struct roots *roots, const char *path,
        uint64_t limit_bytes, uint8_t **data, size_t *size_bytes)
{
    file_reads++;
    return __real_file_read(log, roots, path, limit_bytes, data, size_bytes);
}

/* Pictures are decoded ahead as on two cores, wherever the test runs. */
WRAPPED(uint32_t, threads_available, void)
{
    return 2;
}

WRAPPED(bool, texture_take_picture, struct scene *scene, const struct texture_source *source,
        uint64_t pixels_max, struct picture *out)
{
    bool took = __real_texture_take_picture(scene, source, pixels_max, out);
    taken += took;
    return took;
}

static int begin(void **state)
{
    decoded = file_reads = taken = 0;
    return fixture_begin(state);
}

/* A TGA of 2x1 texels, and the same in base64. */
static const uint8_t tga[] = {0, 0, 2, 0, 0,  0,    0,  0,  0,  0,  0,  0,
                              2, 0, 1, 0, 24, 0x20, 10, 20, 30, 20, 40, 61};
#define TGA_BASE64 "AAACAAAAAAAAAAAAAgABABggChQeFCg9"

/* Writes a glTF with `count` images, each the texture of a material. */
static const char *write_gltf(const char *const *images, uint32_t count)
{
    char *lists[3] = {string_copy(""), string_copy(""), string_copy("")};
    for (uint32_t i = 0; i < count; i++) {
        char *longer[3] = {
            string_format("%s%s%s", lists[0], i ? "," : "", images[i]),
            string_format("%s%s{'source':%u}", lists[1], i ? "," : "", i),
            string_format("%s%s{'pbrMetallicRoughness':{'baseColorTexture':{'index':%u}}}",
                          lists[2], i ? "," : "", i),
        };
        for (int k = 0; k < 3; k++) {
            free(lists[k]);
            lists[k] = longer[k];
        }
    }
    const char *path = put_json(
        "a.gltf",
        "{'asset':{'version':'2.0'},'buffers':[{'byteLength':24,'uri':'data:;base64," TGA_BASE64
        "'}],'bufferViews':[{'buffer':0,'byteLength':24}],'images':[%s],'textures':[%s],'materials'"
        ":[%s]}",
        lists[0], lists[1], lists[2]);
    for (int k = 0; k < 3; k++)
        free(lists[k]);
    return path;
}

enum { SPELLINGS = 60 };

/* Spellings of a.tga that all lead to one file. */
static void spell(char spellings[SPELLINGS][112])
{
    for (uint32_t i = 0; i < SPELLINGS; i++) {
        char name[80] = "";
        for (uint32_t k = 0; k < i / 2; k++)
            strcat(name, "./");
        snprintf(spellings[i], 112, "{'uri':'%s%s'}", name, i % 2 ? "%61.tga" : "A.TGA");
    }
}

TEST_IN(one_file_of_many_names, begin, fixture_end)
{
    char spellings[SPELLINGS][112];
    const char *images[SPELLINGS];
    spell(spellings);
    for (uint32_t i = 0; i < SPELLINGS; i++)
        images[i] = spellings[i];
    put_data("a.tga", tga, sizeof tga);
    assert_int_equal(fixture_load(write_gltf(images, SPELLINGS)), WHIT_OK);
    assert_int_equal(fixture.scene->material_count, SPELLINGS);
    assert_int_equal(fixture.scene->texture_count, 1);
    assert_int_equal(decoded, 1);
    assert_int_equal(file_reads, 2); /* the model and the picture */
    for (uint32_t i = 0; i < SPELLINGS; i++)
        assert_int_equal(fixture.scene->materials[i].textures[SCENE_SLOT_DIFFUSE].texture, 0);
}

TEST_IN(one_picture_in_many_places, begin, fixture_end)
{
    static const char *const images[] = {
        "{'uri':'a.tga'}",
        "{'uri':'b.tga'}",
        "{'bufferView':0}",
        "{'bufferView':0}",
        "{'uri':'data:;base64," TGA_BASE64 "'}",
        "{'uri':'other.tga'}",
    };
    uint8_t other[sizeof tga];
    memcpy(other, tga, sizeof tga);
    other[sizeof tga - 1]++;
    put_data("a.tga", tga, sizeof tga);
    put_data("b.tga", tga, sizeof tga);
    put_data("other.tga", other, sizeof other);
    assert_int_equal(fixture_load(write_gltf(images, 6)), WHIT_OK);
    assert_int_equal(fixture.scene->texture_count, 2);
    assert_int_equal(decoded, 2);
    assert_int_equal(fixture.scene->materials[5].textures[SCENE_SLOT_DIFFUSE].texture, 1);
}

TEST_IN(limits_keep_pictures_apart, begin, fixture_end)
{
    const whit_load_params params = {.texture_limit = 1};
    uint32_t whole, halved;
    assert_int_equal(load_texture(fixture.scene, "a", tga, sizeof tga, NULL, &whole, NULL),
                     WHIT_OK);
    assert_int_equal(load_texture(fixture.scene, "b", tga, sizeof tga, &params, &halved, NULL),
                     WHIT_OK);
    assert_int_equal(fixture.scene->textures[whole].width, 2);
    assert_int_equal(fixture.scene->textures[halved].width, 1);
}

/* A damaged picture is decoded once, each of its names gets a note, and in a scene file it is an
   error instead of magenta. */
TEST_IN(damaged_pictures_are_tried_once, begin, fixture_end)
{
    uint32_t index, same;
    const char *reason = NULL;
    const char *a = put_data("a.tga", tga, 12);
    const char *b = put_data("b.tga", tga, 12);
    assert_int_equal(load_texture(fixture.scene, a, NULL, 0, NULL, &index, NULL), WHIT_OK);
    assert_int_equal(load_texture(fixture.scene, b, NULL, 0, NULL, &same, NULL), WHIT_OK);
    assert_int_equal(same, index);
    assert_int_equal(decoded, 1);
    assert_true(fixture_noted("texture `a.tga`: "));
    assert_true(fixture_noted("texture `b.tga`: the same as `a.tga`; magenta"));
    assert_int_equal(load_texture(fixture.scene, "c", tga, 12, NULL, &index, &reason),
                     WHIT_ERROR_INPUT);
    assert_non_null(reason);
}

/* Notes quote at most 40 characters of folder or name, also within the reason. */
TEST_IN(notes_quote_little, begin, fixture_end)
{
    uint32_t index;
    char k[61] = "", name[96];
    memset(k, 'k', sizeof k - 1);
    snprintf(name, sizeof name, "%s1.tga", k);
    const char *a = put_data(name, tga, 12);
    snprintf(name, sizeof name, "%s2.tga", k);
    const char *b = put_data(name, tga, 12);
    const char *large = put_data("\033.tga", tga, 12);
    assert_int_equal(truncate(large, (off_t)1 << 30), 0);
    assert_int_equal(load_texture(fixture.scene, a, NULL, 0, NULL, &index, NULL), WHIT_OK);
    assert_int_equal(load_texture(fixture.scene, b, NULL, 0, NULL, &index, NULL), WHIT_OK);
    assert_int_equal(load_texture(fixture.scene, large, NULL, 0, NULL, &index, NULL), WHIT_OK);
    k[40] = 0;
    snprintf(name, sizeof name, "`%s...`: ", k);
    assert_true(fixture_noted(name));
    snprintf(name, sizeof name, "the same as `%s...`; magenta", k);
    assert_true(fixture_noted(name));
    assert_true(fixture_noted("`\033.tga`: 1073741824 bytes, over the limit"));
    k[40] = 'k';
    assert_false(fixture_noted(k));
    assert_false(fixture_noted(folder));
}

TEST_IN(textures_too_large_are_not_decoded, begin, fixture_end)
{
    uint32_t index;
    fixture.scene->memory_limit = 17; /* two texels, on host and device, and smaller levels */
    assert_int_equal(load_texture(fixture.scene, "a", tga, sizeof tga, NULL, &index, NULL),
                     WHIT_ERROR_INPUT);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last_error, "texture `a` of 2x1 pixels would take"));
    assert_int_equal(decoded, 0);
    fixture.scene->memory_limit = 18;
    assert_int_equal(load_texture(fixture.scene, "a", tga, sizeof tga, NULL, &index, NULL),
                     WHIT_OK);
}

/* Writes `count` pictures of different bytes: 0.tga, 1.tga and so on. */
static void put_pictures(uint32_t count)
{
    uint8_t other[sizeof tga];
    char name[16];
    memcpy(other, tga, sizeof tga);
    for (uint32_t i = 0; i < count; i++) {
        other[sizeof tga - 1]++;
        snprintf(name, sizeof name, "%u.tga", i);
        put_data(name, other, sizeof other);
    }
}

/* Pictures that a material reads are decoded ahead, but for data: URIs. Damaged ones are tried
   again, since what ends a child may be the load of the machine. */
TEST_IN(pictures_are_decoded_ahead, begin, fixture_end)
{
    static const char *const images[] = {"{'uri':'0.tga'}", "{'uri':'1.tga'}", "{'bufferView':0}",
                                         "{'uri':'damaged.tga'}",
                                         "{'uri':'data:;base64,AAACAAAAAAAAAAAAAgABABggChQeFCg8'}"};
    put_pictures(2);
    put_data("damaged.tga", tga, 12);
    assert_int_equal(fixture_load(write_gltf(images, 5)), WHIT_OK);
    assert_int_equal(fixture.scene->texture_count, 5);
    assert_int_equal(decoded, 6);
    assert_int_equal(taken, 3);
    assert_int_equal(file_reads, 4);
    assert_true(fixture_noted("texture `damaged.tga`: "));
    assert_null(fixture.scene->ahead);
}

TEST_IN(pictures_that_nothing_reads_are_not_decoded, begin, fixture_end)
{
    put_pictures(3);
    const char *path = put_json(
        "a.gltf", "{'asset':{'version':'2.0'},'images':[{'uri':'0.tga'},{'uri':'1.tga'},{'uri':"
                  "'2.tga'}],'textures':[{'source':0},{'source':1},{'source':2}],'materials':[{"
                  "'occlusionTexture':{'index':0},'emissiveTexture':{'index':1},'normalTexture':{"
                  "'index':2}}]}");
    assert_int_equal(fixture_load(path), WHIT_OK);
    assert_int_equal(decoded, 2);
    assert_int_equal(taken, 2);
}

TEST_IN(pictures_of_an_obj_are_decoded_ahead, begin, fixture_end)
{
    put_pictures(4);
    put_text("a.mtl", "newmtl one\nmap_Kd 0.tga\nmap_Ks 1.tga\nnewmtl two\nmap_Kd 2.tga\n"
                      "newmtl unused\nmap_Kd 3.tga\n");
    const char *path =
        put_text("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl one\n"
                          "f 1/1 2/1 3/1\nusemtl two\nf 3/1 2/1 1/1\n");
    assert_int_equal(fixture_load(path), WHIT_OK);
    assert_int_equal(fixture.scene->texture_count, 3);
    assert_int_equal(decoded, 3);
    assert_int_equal(taken, 3);
}

/* Room for four texels: of two pictures of two, the second gets a share of one, whenever it begins,
   and is decoded when it is needed. */
TEST_IN(pictures_ahead_keep_the_memory_limit, begin, fixture_end)
{
    static const char *const images[] = {"{'uri':'0.tga'}", "{'uri':'1.tga'}"};
    put_pictures(2);
    const char *path = write_gltf(images, 2);
    fixture.scene->memory_limit = fixture.scene->memory_taken + 36;
    assert_int_equal(fixture_load(path), WHIT_OK);
    assert_int_equal(decoded, 2);
    assert_int_equal(taken, 1);
}
