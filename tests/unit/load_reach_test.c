/* References in foreign files cannot lead out of their folder: each trick to name a file is tried
   with each kind of reference, and every file that is opened is checked. */
#define _GNU_SOURCE
#include "../scenes.h"
#include "../wrapped.h"
#include "base/array.h"
#include "load/model.h"
#include "messages_fixture.h"
#include "unit.h"

#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

WHIT_PRINTF(2, 3)
static void print_path(char to[PATH_MAX], const char *format, ...)
{
    va_list args;
    va_start(args, format);
    assert_in_range(vsnprintf(to, PATH_MAX, format, args), 1, PATH_MAX - 1);
    va_end(args);
}

/* ---- What is opened ---- */

static char outside[PATH_MAX];         /* nothing below this folder may be opened or listed */
static uint32_t leak_count, odd_count; /* opened: files outside, and what is no regular file */
static const char
    *swapped;          /* a folder that is replaced by a link after its path was resolved ... */
static int swap_after; /* ... this many times */

static int look_at(int fd, int flags)
{
    char link[64], path[PATH_MAX] = "";
    struct stat info;
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    if (fd < 0 || !outside[0] || (flags & O_PATH) || readlink(link, path, sizeof path - 1) < 0)
        return fd;
    leak_count += strncmp(path, outside, strlen(outside)) == 0;
    odd_count += fstat(fd, &info) == 0 && !S_ISREG(info.st_mode) && strcmp(path, "/dev/null") != 0;
    return fd;
}

WRAPPED(int, open, const char *path, int flags, ...)
{
    return look_at(__real_open(path, flags, 0666), flags);
}

WRAPPED(int, openat, int folder, const char *path, int flags, ...)
{
    return look_at(__real_openat(folder, path, flags, 0666), flags);
}

WRAPPED(char *, realpath, const char *path, char *resolved)
{
    char *result = __real_realpath(path, resolved);
    if (result && swapped && strstr(result, "/swapped/") && --swap_after == 0) {
        char kept[PATH_MAX];
        print_path(kept, "%s.kept", swapped);
        assert_int_equal(rename(swapped, kept), 0);
        assert_int_equal(symlink(outside, swapped), 0);
        swapped = NULL;
    }
    return result;
}

WRAPPED(DIR *, opendir, const char *path)
{
    DIR *folder = __real_opendir(path);
    char resolved[PATH_MAX];
    if (folder && outside[0] && __real_realpath(path, resolved))
        leak_count += strncmp(resolved, outside, strlen(outside)) == 0;
    return folder;
}

/* ---- Folders: `in` has the model, `out` has secrets ---- */

static struct {
    char top[PATH_MAX], in[PATH_MAX];
} place;

static void write_file(const char *folder, const char *name, const void *data, size_t bytes)
{
    char path[PATH_MAX];
    print_path(path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, bytes, file), bytes);
    assert_int_equal(fclose(file), 0);
}

static void write_text(const char *folder, const char *name, const char *text)
{
    write_file(folder, name, text, strlen(text));
}

/* Writes one secret file of each kind. */
static void write_secrets(const char *folder)
{
    static const uint8_t tga[] = {0, 0, 2, 0, 0, 0,  0,    0,   0,   0, 0,
                                  0, 1, 0, 1, 0, 24, 0x20, 255, 255, 0};
    static const float corners[9] = {0, 0, 0, 1234.5f, 0, 0, 0, 1, 0};
    write_text(folder, "secret.mtl", "newmtl secret\nKd 0.1 0.2 0.3\nsecret nonsense\n");
    write_text(folder, "secret.obj", "o secret\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_file(folder, "secret.tga", tga, sizeof tga);
    write_file(folder, "secret.bin", corners, sizeof corners);
}

static void make_link(const char *folder, const char *name, const char *to)
{
    char path[PATH_MAX];
    print_path(path, "%s/%s", folder, name);
    assert_int_equal(symlink(to, path), 0);
}

static const char *const extensions[] = {"mtl", "obj", "tga", "bin"};

static void make_links(void)
{
    make_link(place.in, "link", "../out");
    make_link(place.in, "absolute", outside);
    make_link(place.in, "chain", "link");
    make_link(place.in, "sub/up", "../../out");
    make_link(place.in, "loop", "loop");
    for (size_t i = 0; i < sizeof extensions / sizeof *extensions; i++) {
        char name[32], to[PATH_MAX];
        snprintf(name, sizeof name, "link.%s", extensions[i]);
        print_path(to, "../out/secret.%s", extensions[i]);
        make_link(place.in, name, to);
    }
}

static void make_folder(char *to, const char *folder, const char *name)
{
    print_path(to, "%s/%s", folder, name);
    assert_int_equal(mkdir(to, 0777), 0);
}

static int begin(void **state)
{
    (void)state;
    char sub[PATH_MAX], top[] = "/tmp/whit-reach-XXXXXX", *resolved;
    resolved = mkdtemp(top) ? __real_realpath(top, NULL) : NULL;
    assert_non_null(resolved);
    snprintf(place.top, sizeof place.top, "%s", resolved);
    free(resolved);
    make_folder(place.in, place.top, "in");
    make_folder(outside, place.top, "out");
    make_folder(sub, place.in, "sub");
    write_secrets(outside);
    make_links();
    leak_count = odd_count = 0;
    return 0;
}

static int end(void **state)
{
    (void)state;
    char command[PATH_MAX + 16];
    snprintf(command, sizeof command, "rm -r %s", place.top);
    outside[0] = 0;
    return system(command);
}

/* ---- References ---- */

/* Kinds of references: the text of a file, with %s for the reference in it. */
static const struct kind {
    const char *file, *extension, *text;
    bool percent; /* the reference is a URI */
} kinds[] = {
    {"a.obj", "mtl", "mtllib %s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl secret\nf 1 2 3\n", false},
    {"colour.mtl", "tga", "newmtl m\nmap_Kd %s\n", false},
    {"bump.mtl", "tga", "newmtl m\nmap_Bump %s\n", false},
    {"buffer.gltf", "bin",
     "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}],"
     "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
     "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":"
     "[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]}",
     true},
    {"image.gltf", "tga",
     "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;base64,"
     "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
     "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
     "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"images\":[{\"uri\":\"%s\"}],"
     "\"textures\":[{\"source\":0}],\"materials\":[{\"pbrMetallicRoughness\":{"
     "\"baseColorTexture\":{\"index\":0}}}],\"meshes\":[{\"primitives\":[{\"attributes\":"
     "{\"POSITION\":0},\"material\":0}]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]}",
     true},
    {"model.json", "obj", "{\"objects\": [{\"model\": \"%s\"}]}", false},
    {"texture.json", "tga",
     "{\"materials\": {\"m\": {\"texture\": \"%s\"}},"
     " \"objects\": [{\"shape\": \"sphere\", \"material\": \"m\"}]}",
     false},
    {"sky.json", "tga",
     "{\"environment\": {\"map\": \"%s\"}, \"objects\": [{\"shape\": \"sphere\"}]}", false},
};
enum { KIND_COUNT = sizeof kinds / sizeof *kinds };

enum { NOTED = 1, PERCENT = 2 };

/* Tricks: references that lead out of the folder. %O: the absolute path of `out`; %E: the
   extension. NOTED: the message names the option that would allow it; PERCENT: only for URIs. */
static const struct trick {
    const char *name;
    int flags;
} tricks[] = {
    {"../out/secret.%E", NOTED},
    {"%O/secret.%E", NOTED},
    {"/%O/secret.%E", NOTED},
    {"sub/../../out/secret.%E", NOTED},
    {"./../out/./secret.%E", NOTED},
    {"..//out///secret.%E", NOTED},
    {"../in/../out/secret.%E", NOTED},
    {"missing/../../out/secret.%E", NOTED},
    {"link/secret.%E", NOTED},
    {"link/../out/secret.%E", NOTED},
    {"absolute/secret.%E", NOTED},
    {"chain/secret.%E", NOTED},
    {"sub/up/secret.%E", NOTED},
    {"link.%E", NOTED},
    {"/proc/self/root%O/secret.%E", NOTED},
    {"../out/missing.%E", NOTED},
    {"/etc/passwd.%E", NOTED},
    {"../OUT/SECRET.%E", NOTED},
    {"LINK/SECRET.%E", 0},
    {"link/SECRET.%E", 0},
    {"loop/secret.%E", 0},
    {"file://%O/secret.%E", 0},
    {"file:%O/secret.%E", 0},
    {"FILE:../out/secret.%E", 0},
    {"http://localhost/secret.%E", 0},
    {"%2e%2e/out/secret.%E", PERCENT},
    {"%2E%2E%2Fout%2Fsecret.%E", PERCENT},
    {"..%2fout%2fsecret.%E", PERCENT},
    {"..%5cout%5csecret.%E", PERCENT},
    {"../out/secret.%E%00", PERCENT | NOTED},
    {"%6cink/secret.%E", PERCENT | NOTED},
    {"%66ile://%O/secret.%E", PERCENT},
};
enum { TRICK_COUNT = sizeof tricks / sizeof *tricks };

static void spell(const char *name, const char *extension, char *to, size_t bytes)
{
    size_t used = 0;
    to[0] = 0;
    for (const char *at = name; *at; at++) {
        const char *part = at[0] == '%' && at[1] == 'O'   ? outside
                           : at[0] == '%' && at[1] == 'E' ? extension
                                                          : NULL;
        used +=
            (size_t)snprintf(to + used, bytes - used, "%.*s", part ? INT_MAX : 1, part ? part : at);
        at += part ? 1 : 0;
    }
}

/* Writes a model with the reference; an MTL gets an OBJ that refers to it. */
static void write_model(const struct kind *kind, const char *reference, char *path)
{
    char text[4096];
    snprintf(text, sizeof text, "mtllib %s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n",
             kind->file);
    bool library = strstr(kind->file, ".mtl") != NULL;
    const char *named = library ? "m.obj" : kind->file;
    if (library)
        write_text(place.in, named, text);
    const char *gap = strstr(kind->text, "%s");
    snprintf(text, sizeof text, "%.*s%s%s", (int)(gap - kind->text), kind->text, reference,
             gap + 2);
    write_text(place.in, kind->file, text);
    print_path(path, "%s/%s", place.in, named);
}

struct outcome {
    whit_result result;
    bool secret, magenta;
    char text[16384]; /* errors and notes */
    whit_refused refused;
};

/* Whether the scene has anything of the secret files: a diffuse colour, a texel, a coordinate, the
   environment, or the object in model.json. */
static bool holds_secret(const struct scene *scene)
{
    static const uint8_t cyan[3] = {0, 255, 255};
    bool found = false;
    for (uint32_t i = 0; i < scene->material_count; i++)
        found |= scene->materials[i].diffuse[1] == 0.2f;
    for (uint32_t i = 0; i < scene->texture_count; i++)
        found |= memcmp(scene->textures[i].rgba, cyan, 3) == 0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t v = 0; v < scene->meshes[i].vertex_count * 3; v++)
            found |= scene->meshes[i].positions[v] == 1234.5f;
    return found || (scene->environment.rgb && scene->environment.rgb[1] == 1.0f) ||
           (scene->instance_count && !scene->texture_count && strstr(scene->name, "model.json"));
}

static void load(const char *path, const char *allowed, struct outcome *out)
{
    own_scene *scene = NULL;
    *out = (struct outcome){0};
    const whit_log log = messages_log(&messages);
    const whit_load_params params = {
        .allowed_folders = &allowed, .allowed_count = allowed ? 1 : 0, .refused = &out->refused};
    out->result = load_scene(&log, path, &params, &scene);
    size_t used = (size_t)snprintf(out->text, sizeof out->text, "%s", messages.text);
    for (uint32_t i = 0; scene && i < scene->note_count; i++)
        used += (size_t)snprintf(out->text + used, sizeof out->text - used, "%s\n",
                                 scene->notes[i].text);
    out->secret = scene && holds_secret(scene);
}

TEST_IN(nothing_outside_is_read, begin, end)
{
    struct outcome out;
    uint32_t count = 0;
    for (size_t k = 0; k < KIND_COUNT; k++) {
        for (size_t t = 0; t < TRICK_COUNT; t++) {
            const struct kind *kind = &kinds[k];
            char reference[PATH_MAX], path[PATH_MAX];
            if ((tricks[t].flags & PERCENT) && !kind->percent)
                continue;
            spell(tricks[t].name, kind->extension, reference, sizeof reference);
            write_model(kind, reference, path);
            load(path, NULL, &out);
            count++;
            bool told = strstr(out.text, "--allow-path") != NULL;
            if (leak_count || odd_count || out.secret || strstr(out.text, "nonsense") ||
                told != ((tricks[t].flags & NOTED) != 0) || told != (out.refused.count > 0))
                fail_msg("%s: `%s`: %u leaks, %u odd, secret %d: %s", kind->file, reference,
                         leak_count, odd_count, out.secret, out.text);
            if (out.result != WHIT_OK)
                assert_int_equal(out.result, WHIT_ERROR_INPUT);
        }
    }
    printf("%u references, none leads out\n", count);
    assert_true(count >= 60);
}

/* Shows that the test above can fail: every kind reads the secret if its folder is allowed. */
TEST_IN(an_allowed_folder_is_read, begin, end)
{
    static const char *const names[] = {"../out/secret.%E", "%O/secret.%E", "link/secret.%E"};
    struct outcome out;
    for (size_t k = 0; k < KIND_COUNT; k++) {
        for (size_t t = 0; t < sizeof names / sizeof *names; t++) {
            char reference[PATH_MAX], path[PATH_MAX], folder[PATH_MAX];
            spell(names[t], kinds[k].extension, reference, sizeof reference);
            write_model(&kinds[k], reference, path);
            load(path, NULL, &out);
            assert_string_equal(out.refused.folder, outside);
            leak_count = 0;
            print_path(folder, "%s", out.refused.folder);
            load(path, folder, &out);
            if (!out.secret || !leak_count || out.refused.count)
                fail_msg("%s: `%s`: %s", kinds[k].file, reference, out.text);
            leak_count = 0;
        }
    }
}

TEST_IN(the_model_itself_may_be_a_link, begin, end)
{
    struct outcome out;
    char path[PATH_MAX];
    make_link(place.in, "model.obj", "../out/secret.obj");
    print_path(path, "%s/model.obj", place.in);
    load(path, NULL, &out);
    assert_int_equal(out.result, WHIT_OK);
    assert_int_equal(out.refused.count, 0);
    leak_count = 0;
}

TEST_IN(a_folder_that_is_not_there_cannot_be_allowed, begin, end)
{
    struct outcome out;
    char path[PATH_MAX], file[PATH_MAX];
    write_model(&kinds[0], "x.mtl", path);
    load(path, "/tmp/no such folder", &out);
    assert_int_equal(out.result, WHIT_ERROR_INPUT);
    assert_non_null(strstr(out.text, "/tmp/no such folder: cannot be allowed: No such file"));
    print_path(file, "%s/secret.bin", outside);
    load(path, file, &out);
    assert_non_null(strstr(out.text, "cannot be allowed: Not a directory"));
    load(path, "", &out);
    assert_non_null(strstr(out.text, ": cannot be allowed: No such file"));
}

/* The folder is replaced by a link after the first, second, ... time that its path is resolved, and
   so also between the check and the opening. */
TEST_IN(a_folder_that_is_swapped_is_not_followed, begin, end)
{
    struct outcome out;
    char path[PATH_MAX], folder[PATH_MAX];
    make_folder(folder, place.in, "swapped");
    write_secrets(folder);
    for (size_t k = 0; k < KIND_COUNT; k++) {
        char reference[64], kept[PATH_MAX];
        snprintf(reference, sizeof reference, "swapped/secret.%s", kinds[k].extension);
        write_model(&kinds[k], reference, path);
        print_path(kept, "%s.kept", folder);
        int times = 0;
        for (bool more = true; more; times++) {
            swapped = folder;
            swap_after = times + 1;
            load(path, NULL, &out);
            assert_int_equal(leak_count, 0);
            more = swapped == NULL;
            if (more) {
                assert_int_equal(unlink(folder), 0);
                assert_int_equal(rename(kept, folder), 0);
            }
        }
        assert_true(times > 1);
    }
    swapped = NULL;
}

/* Entries inside of the folder that are no regular files are neither opened nor waited for. */
TEST_IN(what_is_no_file_is_not_opened, begin, end)
{
    static const char *const names[] = {"pipe", "socket", "zero", "sub", "."};
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    struct outcome out;
    char path[PATH_MAX];
    print_path(path, "%s/pipe", place.in);
    assert_int_equal(mkfifo(path, 0666), 0);
    int socket_fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    snprintf(address.sun_path, sizeof address.sun_path, "%.90s/socket", place.in);
    assert_int_equal(bind(socket_fd, (struct sockaddr *)&address, sizeof address), 0);
    make_link(place.in, "zero", "/dev/zero");
    for (size_t k = 0; k < KIND_COUNT; k++) {
        for (size_t t = 0; t < sizeof names / sizeof *names; t++) {
            if (strstr(kinds[k].file, "model.json"))
                continue; /* its names end in those of models */
            write_model(&kinds[k], names[t], path);
            load(path, NULL, &out);
            assert_int_equal(odd_count, 0);
            bool link = strcmp(names[t], "zero") == 0;
            if (!strstr(out.text, link ? "it lies outside" : "not a file"))
                fail_msg("%s: `%s`: %s", kinds[k].file, names[t], out.text);
        }
    }
    close(socket_fd);
}

/* The option in a message can be pasted into a shell, whatever characters the folder's name has. */
TEST_IN(the_option_can_be_pasted, begin, end)
{
    struct outcome out;
    char path[PATH_MAX];
    write_model(&kinds[2], "../a folder/x.png", path);
    load(path, NULL, &out);
    char wanted[PATH_MAX];
    print_path(wanted, "--allow-path '%s/a folder' lets", place.top);
    assert_non_null(strstr(out.text, wanted));
    write_model(&kinds[2], "../a'$(reboot)'/x.png", path);
    load(path, NULL, &out);
    assert_non_null(strstr(out.text, "--allow-path FOLDER lets"));
}
