/* The library in a host program: foreign files are read in child processes, which leave the host
   unchanged, and all values of enumerations have words. */
#include <dirent.h>
#include <errno.h>
#include <locale.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "../wrapped.h"
#include "base/foreign.h"
#include "folder_fixture.h"
#include "whit.h"
#include "whit_program.h"

/* The state of this process that a sandbox or a signal handler would change. */
struct host {
    char confinement[512];
    void (*handlers[NSIG])(int);
    sigset_t blocked;
    int descriptors;
};

static void look_at_host(struct host *host)
{
    char line[128];
    struct sigaction action;
    memset(host, 0, sizeof *host);
    FILE *status = fopen("/proc/self/status", "r");
    while (status && fgets(line, sizeof line, status))
        if (strstr(line, "NoNewPrivs") || strstr(line, "Seccomp"))
            strcat(host->confinement, line);
    if (status)
        (void)fclose(status);
    for (int i = 1; i < NSIG; ++i)
        if (sigaction(i, NULL, &action) == 0)
            host->handlers[i] = action.sa_handler;
    assert_int_equal(sigprocmask(SIG_BLOCK, NULL, &host->blocked), 0);
    DIR *opened = opendir("/proc/self/fd");
    while (opened && readdir(opened))
        host->descriptors++;
    closedir(opened);
}

static const char model[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/* A model by the importer, and a picture by a decoder. */
TEST_IN(the_host_is_left_as_it_was, folder_begin, folder_end)
{
    static const char sky[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81";
    static const char scene_text[] =
        "{\"objects\": [{\"model\": \"a.obj\"}], \"environment\": {\"map\": \"a.hdr\"}}";
    static struct host before, after;
    whit_scene *scene = NULL;
    assert_int_equal(chdir(folder), 0);
    put_file("a.obj", model, sizeof model - 1);
    put_file("a.hdr", sky, sizeof sky - 1);
    put_file("a.json", scene_text, sizeof scene_text - 1);
    look_at_host(&before);
    assert_non_null(strstr(before.confinement, "NoNewPrivs:\t0"));
    assert_int_equal(whit_scene_load("a.json", NULL, NULL, &scene), WHIT_OK);
    look_at_host(&after);
    assert_string_equal(before.confinement, after.confinement);
    assert_memory_equal(before.handlers, after.handlers, sizeof before.handlers);
    assert_memory_equal(&before.blocked, &after.blocked, sizeof before.blocked);
    assert_int_equal(before.descriptors, after.descriptors);
    assert_true(waitpid(-1, NULL, WNOHANG) == -1 && errno == ECHILD);
    whit_scene_destroy(scene);
    assert_true(remove("a.obj") == 0 && remove("a.hdr") == 0 && remove("a.json") == 0);
    assert_int_equal(rmdir(folder), 0);
}

/* Sets a locale whose numbers have a comma, by a file as glibc reads it. */
static void expect_commas(void)
{
    static const unsigned char
        numeric[] = {0x14, 0x11, 0x03, 0x20, 6,  0, 0, 0,   32, 0, 0, 0, 34, 0, 0, 0, /* where the
                                                                                         six are: */
                     36,   0,    0,    0,    40, 0, 0, 0,   44, 0, 0, 0, 48, 0, 0, 0,   ',',
                     0,    0,    0,    0xff, 0,  0, 0, ',', 0,  0, 0, 0, 0,  0, 0, 'A', 'S',
                     'C',  'I',  'I',  0}; /* as numbers of 32 bits: the point, the separator */
    char text[8];
    assert_int_equal(mkdir(in_folder("comma"), 0700), 0);
    put_data("comma/LC_NUMERIC", numeric, sizeof numeric);
    setenv("LOCPATH", folder, 1);
    if (!setlocale(LC_NUMERIC, "comma"))
        skip();
    snprintf(text, sizeof text, "%g", 0.5);
    assert_string_equal(text, "0,5");
}

static whit_image *ramp_with_legend(void)
{
    const float ramp[2] = {0.0f, 0.5f};
    whit_image *values = NULL, *heat = NULL;
    assert_int_equal(whit_image_create(2, 1, 1, ramp, &values), WHIT_OK);
    assert_int_equal(whit_image_heat(values, NULL, &heat), WHIT_OK);
    whit_image_destroy(values);
    return heat;
}

static uint64_t hash_of(const char *path)
{
    whit_scene *scene = NULL;
    whit_scene_info info;
    assert_int_equal(whit_scene_load(path, NULL, NULL, &scene), WHIT_OK);
    whit_scene_get_info(scene, &info);
    whit_scene_destroy(scene);
    return info.hash;
}

/* A host program may have set any locale. */
TEST_IN(numbers_have_a_point_in_any_locale, folder_begin, folder_end)
{
    const char *obj =
        put_text("a.obj", "mtllib a.mtl\nv 0.5 0 0\nv 1.5 0 0\nv 0 1.25 0\nvt 0.5 0.5\n"
                          "usemtl a\nf 1/1 2/1 3/1\n");
    const char *pfm = put_data("a.pfm", "Pf\n1 1\n-1.0\n\0\0\0\x3f", 17);
    put_text("a.mtl", "newmtl a\nKd 0.25 0.5 0.75\nmap_Kd -mm 0.25 0.5 a.pfm\n");
    const whit_probe_value vector = {.size = 2, .v = {0.5, 1.5}};
    whit_shader_compiler *compiler = NULL;
    whit_shader *shader = NULL;
    whit_image *loaded = NULL, *before = ramp_with_legend(), *after;
    whit_difference difference;
    char text[32];
    uint64_t hash = hash_of(obj);
    expect_commas();
    assert_int_equal(whit_shader_compiler_create(NULL, NULL, &compiler), WHIT_OK);
    assert_int_equal(
        whit_shader_load(compiler, WHIT_SCENES_DIR "/../shaders/examples/sdf.glsl", false, &shader),
        WHIT_OK);
    assert_int_equal(whit_image_load(pfm, NULL, NULL, &loaded), WHIT_OK);
    assert_true(whit_image_floats(loaded)[0] == 0.5f);
    assert_int_equal(hash_of(obj), hash);
    whit_probe_value_text(&vector, 9, text, sizeof text);
    assert_string_equal(text, "(0.5, 1.5)");
    after = ramp_with_legend();
    assert_int_equal(whit_image_compare(before, after, NULL, NULL, &difference, NULL), WHIT_OK);
    assert_int_equal(difference.differing_pixels, 0);
    setlocale(LC_NUMERIC, "C");
    whit_image_destroy(before);
    whit_image_destroy(after);
    whit_image_destroy(loaded);
    whit_shader_destroy(shader);
    whit_shader_compiler_destroy(compiler);
}

/* Wrapped at link time: the limits of the last child. */
static struct child_limits allowed;

WRAPPED(enum child_end, child_run, const struct child_limits *limits,
        int (*fn)(void *user, void *to, child_write write), void *user, struct child_reply *reply)
{
    allowed = *limits;
    return __real_child_run(limits, fn, user, reply);
}

static void loads(const char *path, const whit_load_params *params)
{
    whit_scene *scene = NULL;
    assert_int_equal(whit_scene_load(path, params, NULL, &scene), WHIT_OK);
    whit_scene_destroy(scene);
}

TEST_IN(limits_are_those_that_were_asked_for, folder_begin, folder_end)
{
    const whit_load_params asked = {.import_limit_s = 99.0,
                                    .time_limit_s = 7.0,
                                    .memory_limit_bytes = UINT64_C(1) << 30,
                                    .require_sandbox = true};
    const char *path = put_text("a.obj", model);
    loads(path, NULL);
    assert_true(allowed.cpu_s >= 8.0 && allowed.cpu_s < 8.001);
    assert_true(child_clock_limit_s(&allowed) >= 80.0 && !allowed.require_sandbox);
    loads(path, &asked);
    assert_true(allowed.cpu_s == 99.0 && allowed.clock_s == 7.0 && allowed.require_sandbox);
    assert_int_equal(allowed.memory_bytes, UINT64_C(1) << 29); /* half of the scene's */
    assert_true(remove(path) == 0 && rmdir(folder) == 0);
    const double seconds[] = {8.0, 12.0, 60.0};
    const uint64_t bytes[] = {0, 10000000, 1000000000};
    for (int i = 0; i < 3; ++i)
        assert_true(foreign_limits(NULL, "importer", bytes[i], 1).cpu_s == seconds[i]);
}

/* The words that programs print for `count` kinds: each its own, and none past the last. */
#define CHECK_WORDS(name_of, count)                                                                \
    for (unsigned i = 0; i < (count); ++i) {                                                       \
        assert_true(name_of(i)[0] != '\0');                                                        \
        for (unsigned k = 0; k < i; ++k)                                                           \
            assert_string_not_equal(name_of(i), name_of(k));                                       \
    }                                                                                              \
    assert_string_equal(name_of(count), "")

TEST(where_nothing_was_read_nothing_was_refused)
{
    static whit_refused refused;
    const whit_load_params params = {.refused = &refused};
    whit_scene *scene;
    memset(&refused, 'x', sizeof refused);
    assert_int_equal(whit_scene_load("nowhere.json", &params, NULL, &scene), WHIT_ERROR_INPUT);
    assert_int_equal(refused.count, 0);
    assert_string_equal(refused.folder, "");
}

TEST(every_kind_has_a_word)
{
    CHECK_WORDS(whit_material_model_name, WHIT_MODEL_UNLIT + 1);
    CHECK_WORDS(whit_light_kind_name, WHIT_LIGHT_KINDS);
    CHECK_WORDS(whit_camera_kind_name, WHIT_CAMERA_PANORAMA + 1);
    CHECK_WORDS(whit_environment_kind_name, WHIT_ENVIRONMENT_MAP + 1);
    CHECK_WORDS(whit_device_kind_name, WHIT_DEVICE_OTHER + 1);
    CHECK_WORDS(whit_hook_name, WHIT_HOOKS);
    CHECK_WORDS(whit_part_kind_name, WHIT_PART_KINDS);
    CHECK_WORDS(whit_fault_kind_name, WHIT_FAULT_KINDS);
    CHECK_WORDS(whit_probe_end_name, WHIT_PROBE_ENDS);
}
