/* Writes the seeds that are no text: fuzz_seeds FOLDER. One folder a target below it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <png.h>

#include "../unit/stb_write_fixture.h"
#include "base/array.h"
#include "base/child.h"
#include "base/file.h"
#include "fuzz.h"
#include "image/image.h"
#include "image/image_reply.h"
#include "load/picture.h"
#include "trees.h"

const struct fuzz_target fuzz_target = {0};

static const char *folder;

/* In the folder of one target; the caller frees it. */
static char *seed_path(const char *target, const char *name)
{
    char *below = string_format("%s/%s", folder, target);
    char *path = string_format("%s/%s", below, name);
    fuzz_check(below && path, "out of memory");
    mkdir(below, 0777);
    free(below);
    return path;
}

static void write_seed(const char *target, const char *name, const void *data, size_t size_bytes)
{
    char *path = seed_path(target, name);
    FILE *file = fopen(path, "wb");
    fuzz_check(file && fwrite(data, 1, size_bytes, file) == size_bytes && fclose(file) == 0,
               "%s: cannot be written", path);
    free(path);
}

/* --- what the stand-in for the foreign importer reads (foreign.c), from the end backwards ------
 */

struct bytes {
    uint8_t data[1024];
    size_t count;
};

static void put(struct bytes *bytes, const void *data, size_t count)
{
    fuzz_check(bytes->count + count <= sizeof bytes->data, "the seed is too long");
    memcpy(bytes->data + bytes->count, data, count);
    bytes->count += count;
}

/* A pyramid without its base as two meshes: with all arrays, and with none. */
static void put_answer(struct bytes *bytes)
{
    static const uint8_t mesh[] = {
        4, 3, 0, 1, 2, 0, 2, 3, 0, 3, 1, 0, 8, 0, 8, 0, 0, 0xfc, 0, 4, 0, 0, 4,
    };
    struct bytes forward = {0};
    put(&forward, (const uint8_t[]){0, 2, 2, 63, 16}, 5);
    put(&forward, mesh, sizeof mesh);
    for (int i = 0; i < 80; i++)
        put(&forward, (const uint8_t[]){(uint8_t)(i * 7)}, 1);
    put(&forward, (const uint8_t[]){0, 0}, 2);
    put(&forward, mesh, sizeof mesh);
    for (size_t i = forward.count; i > 0; i--)
        put(bytes, &forward.data[i - 1], 1);
}

static void write_model(const char *target, const char *name, const char *text)
{
    struct bytes bytes = {0};
    put(&bytes, text, strlen(text));
    put_answer(&bytes);
    write_seed(target, name, bytes.data, bytes.count);
}

static void write_glb(void)
{
    static const char json[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":216}],\"bufferViews\":[{"
        "\"buffer\":0,\"byteLength\":216}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
        "\"count\":12,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
        "\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}   ";
    struct bytes answer = {0}, glb = {0};
    put_answer(&answer);
    uint32_t json_bytes = (uint32_t)(sizeof json - 1) & ~3u, bin_bytes = 216;
    uint32_t words[] = {0x46546c67, 2, 28 + json_bytes + bin_bytes, json_bytes, 0x4e4f534a};
    put(&glb, words, sizeof words);
    put(&glb, json, json_bytes);
    put(&glb, (const uint32_t[]){bin_bytes, 0x004e4942}, 8);
    put(&glb, (const uint8_t[216]){0}, bin_bytes - answer.count);
    put(&glb, answer.data, answer.count);
    write_seed("gltf", "binary.glb", glb.data, glb.count);
}

static void write_models(void)
{
    write_model("obj", "pyramid.obj", "mtllib other.mtl\nv 0 0 .5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_model("ply", "pyramid.ply",
                "ply\nformat binary_little_endian 1.0\nelement vertex 3\nend_header\n\n");
    write_model("ply", "pyramid.stl", "solid a\nendsolid a\n");
    write_glb();
    static const uint8_t utf16[] = {0xff, 0xfe, 'v', 0, ' ', 0, 0x3d, 0xd8, 0x00, 0xde, '\n', 0};
    write_seed("obj", "utf16.obj", utf16, sizeof utf16);
}

/* --- pictures ------------------------------------------------------------------------------- */

enum { SIDE = 5 };

static void save_image(const char *name, uint32_t channels, bool integers)
{
    static const whit_text texts[] = {{"whit", "render a.json"}, {"scene", "{ \"a\": 1 }"}};
    struct image image;
    fuzz_check(image_init(&image, SIDE, SIDE, channels, integers) == WHIT_OK, "no picture");
    for (uint32_t i = 0; i < SIDE * SIDE * channels; i++) {
        if (integers)
            image.words[i] = i * i;
        else
            image.pixels[i] = (float)i / 100.0f;
    }
    char *path = seed_path("image", name);
    fuzz_check(image_save(&fuzz_log, &image, NULL, 0, path, texts, 2) == WHIT_OK, "%s: not saved",
               path);
    free(path);
    image_finish(&image);
}

static void save_png(const char *name, uint32_t format)
{
    uint8_t colormap[4 * 256] = {0}, pixels[SIDE * SIDE * 8] = {0};
    png_image image = {.version = PNG_IMAGE_VERSION, .width = SIDE, .height = SIDE};
    image.format = format;
    image.colormap_entries = 5;
    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)(i % 5);
    char *path = seed_path("image", name);
    fuzz_check(png_image_write_to_file(&image, path, 0, pixels, 0, colormap), "%s: %s", path,
               image.message);
    free(path);
}

static void write_pictures(void)
{
    static const uint8_t hdr[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n"
                                 "\2\2\0\10\210\1\210\2\210\3\210\200"
                                 "\1\2\3\200\1\1\1\7";
    static const uint8_t gif[] = "GIF89a\2\0\2\0\200\0\0\0\0\0\377\377\377!\371\4\1\0\0\0\0"
                                 ",\0\0\0\0\2\0\2\0\0\2\3\204\217\5\0;";
    uint8_t pixels[SIDE * SIDE * 4];
    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)(i * 37);
    save_image("rgb.png", 3, false);
    save_image("rgba.png", 4, false);
    save_image("grey.png", 1, false);
    save_image("rgb.exr", 3, false);
    save_image("grey.exr", 1, false);
    save_image("ids.exr", 2, true);
    save_image("rgb.pfm", 3, false);
    save_image("grey.pfm", 1, false);
    save_png("palette.png", PNG_FORMAT_RGBA_COLORMAP);
    save_png("deep.png", PNG_FORMAT_LINEAR_RGB_ALPHA);
    write_seed("image", "rows.hdr", hdr, sizeof hdr - 1);
    write_seed("texture", "small.gif", gif, sizeof gif - 1);
    char *paths[] = {seed_path("texture", "a.jpg"), seed_path("texture", "a.bmp"),
                     seed_path("texture", "a.tga"), seed_path("image", "stb.hdr")};
    float floats[SIDE * SIDE * 3] = {0.5f, 2.0f, 1e-3f};
    bool good = stbi_write_jpg(paths[0], SIDE, SIDE, 3, pixels, 80) &&
                stbi_write_bmp(paths[1], SIDE, SIDE, 4, pixels) &&
                stbi_write_tga(paths[2], SIDE, SIDE, 4, pixels) &&
                stbi_write_hdr(paths[3], SIDE, SIDE, 3, floats);
    fuzz_check(good, "pictures that cannot be written");
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        free(paths[i]);
}

/* --- answers of children -------------------------------------------------------------------- */

static uint8_t asker; /* the first byte of a seed of `reply` */

static void write_reply(struct child_reply *reply)
{
    static int number;
    char name[24];
    uint8_t *seed = malloc(reply->size_bytes + 1);
    fuzz_check(seed, "out of memory");
    seed[0] = asker;
    if (reply->size_bytes)
        memcpy(seed + 1, reply->data, reply->size_bytes);
    snprintf(name, sizeof name, "reply%d-%d", asker, number++);
    write_seed("reply", name, seed, reply->size_bytes + 1);
    free(seed);
}

static void ask(uint8_t who, const char *target, const char *name)
{
    char *path = seed_path(target, name);
    struct image image = {0};
    whit_text *texts = NULL;
    uint32_t count;
    whit_result result = WHIT_OK;
    asker = who;
    if (who == 0)
        result = image_load(&fuzz_log, NULL, path, NULL, &image);
    else if (who == 1)
        result = image_load_texts(&fuzz_log, path, NULL, &texts, &count);
    else
        fuzz_load(path);
    fuzz_check(result == WHIT_OK, "%s: no answer", path);
    image_finish(&image);
    free(texts);
    free(path);
}

static void write_replies(void)
{
    static const uint8_t file[] = "BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\x18"
                                  "\0\0\0\0\0\4\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\1\2\3";
    struct picture picture;
    char reason[FOREIGN_REASON_BYTES];
    fuzz_reply = write_reply;
    ask(0, "image", "rgb.png");
    ask(0, "image", "ids.exr");
    ask(1, "image", "rgb.png");
    asker = 2;
    fuzz_check(picture_read(&fuzz_log, NULL, UINT64_MAX, file, sizeof file, &picture, reason) ==
                   WHIT_OK,
               "%s", reason);
    picture_finish(&picture);
    ask(3, "ply", "pyramid.stl");
    fuzz_reply = NULL;
}

/* --- rays and patches ------------------------------------------------------------------------ */

static void write_rays(void)
{
    struct {
        uint8_t where[4];
        struct gpu_ray rays[4];
    } file = {.rays = {{.origin = {3, 0.25f, 0.125f}, .dir = {-1, 0, 0}, .t_max = INFINITY},
                       {.origin = {0, 0, 0}, .dir = {0, -0.0f, 1e-38f}, .t_max = 1e30f},
                       {.origin = {1e6f, 2, 3}, .dir = {-1e6f, -2, -3}, .t_min = 0.5f, .t_max = 2},
                       {.origin = {NAN, 0, 0}, .dir = {INFINITY, 1, 0}, .t_max = -1}}};
    for (int where = 0; where < 3 * FUZZ_SCENE_COUNT; where++) {
        char name[16];
        snprintf(name, sizeof name, "rays%d", where);
        file.where[3] = (uint8_t)where;
        write_seed("rays", name, &file.where[3], 1 + sizeof file.rays);
    }
}

/* Each scene and build as it is, and with a bit flipped. */
static void write_patches(void)
{
    for (int kind = 0; kind < FUZZ_SCENE_COUNT; kind++) {
        for (int build = 0; build < 12; build++) {
            const uint8_t seed[] = {(uint8_t)kind, (uint8_t)build, 128, 3, 7, 0, 0, 0, 0};
            char name[24];
            snprintf(name, sizeof name, "build%d-%d", kind, build);
            write_seed("validate", name, seed, build % 2 ? 2 : sizeof seed);
        }
    }
}

int main(int argc, char **argv)
{
    fuzz_check(argc == 2, "fuzz_seeds FOLDER");
    folder = argv[1];
    write_models();
    write_pictures();
    write_replies();
    write_rays();
    write_patches();
    return 0;
}
