/* Equal pictures are decoded and kept once, whatever their names. */
#include "load_model_fixture.h"

#include "../wrapped.h"
#include "load/picture.h"
#include "unit.h"

static uint32_t decoded, file_reads;

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

static int begin(void **state)
{
    decoded = file_reads = 0;
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
