/* Compares the pixels of each class of MTL material with the formulas of the format. Every material
   is on a strip of its own. */
#include "folder_fixture.h"
#include "load/model.h"
#include "picture_fixture.h"
#include "unit.h"

/* The eye looks down on the strips at 60 degrees to their normal; the light comes in at 30. */
#define COS_VIEW   0.5
#define COS_LIGHT  0.86602540378443865
#define COS_HALF   0.70710678118654752
#define COS_INSIDE 0.81649658092772603 /* behind a surface of index 1.5 */

static const double zenith[3] = {0.2, 0.4, 0.9}, horizon[3] = {0.8, 0.7, 0.6},
                    ground[3] = {0.1, 0.3, 0.2};
static const double sun[3] = {0.9, 1.0, 0.8}, air[3] = {0.4, 0.3, 0.2};

/* The material that all strips vary. */
static const double ka[3] = {0.3, 0.2, 0.1}, kd[3] = {0.3, 0.35, 0.4}, ks[3] = {0.25, 0.5, 0},
                    tf[3] = {0.5, 1, 0.25};
#define COMMON           "Ka 0.3 0.2 0.1\nKd 0.3 0.35 0.4\nKs 0.25 0.5 0\nNs 4\nNi 1.5\nTf 0.5 1 0.25\n"
/* Values of the texels: code 188 as sRGB, codes 51 and 128 as numbers. */
#define PICTURE_COLOR    0.50288646
#define PICTURE_SPECULAR (51.0 / 255.0)
#define PICTURE_EXPONENT (128.0 / 255.0)
#define FRESNEL_60       0.08919

struct strip {
    const char *name, *text;
    double ambient, diffuse; /* shares of ambient and diffuse light that are visible */
    double exponent;         /* of the highlight; 0: no highlight */
    double mirrored;         /* weight of reflected light, times Ks */
    double fresnel;          /* weight of reflected light without Ks */
    double straight;         /* weight of light that passes straight on */
    double refracted;        /* weight of refracted light, times Tf */
    double less_ks;          /* `refracted` is multiplied by 1 - less_ks Ks */
    double plain, emitted;
};

/* Values are in the order of the members of `struct strip`. */
static const struct strip strips[] = {
    {"0", "illum 0", 0, 0, 0, 0, 0, 0, 0, 0, 1, 0},
    {"1", "illum 1", 1, 1, 0, 0, 0, 0, 0, 0, 0, 0},
    {"2", "illum 2", 1, 1, 4, 0, 0, 0, 0, 0, 0, 0},
    {"3", "illum 3", 1, 1, 4, 1, 0, 0, 0, 0, 0, 0},
    {"4", "illum 4\nd 0.25", 0.25, 0.25, 4, 1, 0, 0.75, 0, 0, 0, 0},
    /* Schlick: Ks + (1 - Ks) (1 - 0.5)^5 */
    {"5", "illum 5", 1, 1, 4, 1 - 0.03125, 0.03125, 0, 0, 0, 0, 0},
    {"6", "illum 6", 1, 1, 4, 1, 0, 0, 1, 1, 0, 0},
    {"7", "illum 7", 1, 1, 4, 0, FRESNEL_60, 0, 1 - FRESNEL_60, 0, 0, 0},
    {"8", "illum 8", 1, 1, 4, 0, 0, 0, 0, 0, 0, 0},
    {"9", "illum 9\nTr 0.25", 0.75, 0.75, -4, 0, 0, 0.25, 0, 0, 0, 0},
    /* No shadow falls here, so that the catcher is invisible. */
    {"10", "illum 10", 0, 0, 0, 0, 0, 1, 0, 0, 0, 0},
    {"map_Kd", "illum 1\nmap_Kd color.png", PICTURE_COLOR, PICTURE_COLOR, 0, 0, 0, 0, 0, 0, 0, 0},
    {"map_Ks", "illum 3\nmap_Ks fifth.png", 1, 1, 4, PICTURE_SPECULAR, 0, 0, 0, 0, 0, 0},
    {"map_Ns", "illum 2\nmap_Ns half.png", 1, 1, 4 * PICTURE_EXPONENT, 0, 0, 0, 0, 0, 0, 0},
    {"Ke", "illum 1\nKe 0.1 0.1 0.1", 1, 1, 0, 0, 0, 0, 0, 0, 0, 0.1},
    {"map_Ke", "illum 1\nKe 0.1 0.1 0.1\nmap_Ke color.png", 1, 1, 0, 0, 0, 0, 0, 0, 0,
     0.1 * PICTURE_COLOR},
    {"map_d clear", "illum 1\nmap_d fifth.png", 0, 0, 0, 0, 0, 1, 0, 0, 0, 0},
    {"map_d solid", "illum 1\nmap_d half.png", 1, 1, 0, 0, 0, 0, 0, 0, 0, 0},
    {"map_d -mm", "illum 1\nmap_d -mm 0.4 1 fifth.png", 1, 1, 0, 0, 0, 0, 0, 0, 0, 0},
};
enum { STRIPS = sizeof strips / sizeof *strips };

/* The sky's colour where the cosine between a ray and the way up is `up`. */
static double sky(double up, int c)
{
    double far = up > 0 ? zenith[c] : ground[c];
    return horizon[c] + (far - horizon[c]) * fabs(up);
}

/* Schlick's 0.04 + 0.96 (1 - 0.5)^5 in place of exact Fresnel, where there is glass. */
static double expected(const struct strip *strip, bool schlick, int c)
{
    struct strip changed = *strip;
    const struct strip *s = &changed;
    if (schlick && strip->refracted > 0 && strip->fresnel > 0) {
        changed.fresnel = 0.07;
        changed.refracted = 1 - 0.07;
    }
    double seen = s->plain * kd[c] + s->emitted + s->ambient * ka[c] * air[c] +
                  s->diffuse * kd[c] * COS_LIGHT * sun[c];
    double exponent = fabs(s->exponent), share = s->exponent < 0 ? 1 - s->straight : 1;
    bool mapped = strcmp(s->name, "map_Ks") == 0;
    if (exponent > 0)
        seen += share * ks[c] * (mapped ? PICTURE_SPECULAR : 1) * pow(COS_HALF, exponent) * sun[c];
    seen += (s->mirrored * ks[c] + s->fresnel) * sky(COS_VIEW, c);
    seen += s->straight * sky(-COS_VIEW, c);
    return seen + s->refracted * tf[c] * (1 - s->less_ks * ks[c]) * sky(-COS_INSIDE, c);
}

static void write_picture(const char *name, int code)
{
    own_image image = {0};
    assert_int_equal(image_init(&image, 1, 1, 3, false), WHIT_OK);
    for (int k = 0; k < 3; k++)
        image.pixels[k] = image_linear_from_srgb((float)code / 255.0f);
    assert_int_equal(image_save(&fixture_log, &image, NULL, 0, name, NULL, 0), WHIT_OK);
}

/* Strip i lies at y = 0 from x = i to i + 1. */
static struct scene *load_strips(void)
{
    static char obj[16384], mtl[16384];
    size_t to = (size_t)snprintf(obj, sizeof obj, "mtllib a.mtl\nvt 0.5 0.5\n"), at = 0;
    for (int i = 0; i < STRIPS; i++) {
        to += (size_t)snprintf(obj + to, sizeof obj - to,
                               "v %d 0 1\nv %d 0 1\nv %d 0 -1\nv %d 0 -1\nusemtl m%d\n"
                               "f -4/1 -3/1 -2/1 -1/1\n",
                               i, i + 1, i + 1, i, i);
        at += (size_t)snprintf(mtl + at, sizeof mtl - at, "newmtl m%d\n" COMMON "%s\n", i,
                               strips[i].text);
    }
    assert_true(to < sizeof obj && at < sizeof mtl);
    assert_int_equal(folder_begin(NULL), 0);
    assert_int_equal(chdir(folder), 0);
    put_text("a.obj", obj);
    put_text("a.mtl", mtl);
    write_picture("color.png", 188);
    write_picture("fifth.png", 51);
    write_picture("half.png", 128);
    struct scene *scene = scene_begin(&fixture_log, "classes");
    assert_int_equal(roots_init(&scene->roots, "a.obj"), WHIT_OK);
    assert_int_equal(load_model(scene, "a.obj", SCENE_NONE, false, false, NULL), WHIT_OK);
    assert_int_equal(chdir("/"), 0);
    assert_int_equal(folder_end(NULL), 0);
    return scene;
}

static void set_floats(float *out, const double *rgb)
{
    set_rgb(out, (float)rgb[0], (float)rgb[1], (float)rgb[2]);
}

static struct image render_strips(const whit_renderer_params *params)
{
    struct scene *scene = load_strips();
    scene->has_environment = true;
    scene->environment.kind = WHIT_ENVIRONMENT_GRADIENT;
    set_rgb(scene->environment.scale, 1, 1, 1);
    set_floats(scene->environment.zenith, zenith);
    set_floats(scene->environment.horizon, horizon);
    set_floats(scene->environment.ground, ground);
    scene->has_ambient = true;
    set_floats(scene->ambient, air);
    scene_put_sun(scene, 0, -COS_LIGHT, -0.5, 1.0f);
    set_floats(scene->lights[0].color, sun);
    /* One pixel a strip, through its middle. */
    scene_put_camera(scene, (double[]){0.5 * STRIPS, 5 * COS_VIEW, 5 * COS_LIGHT},
                     (double[]){0.5 * STRIPS, 0, 0}, 0);
    scene->cameras[0].kind = WHIT_CAMERA_ORTHOGRAPHIC;
    scene->cameras[0].height = 1;
    return color_of(scene, NULL, params);
}

static void check_strips(const struct image *image, bool schlick)
{
    int bad = 0;
    for (int i = 0; i < STRIPS; i++)
        for (int c = 0; c < 3; c++) {
            double value = (double)image->pixels[4 * i + c];
            double right = expected(&strips[i], schlick, c);
            if (fabs(value - right) <= 1e-5)
                continue;
            print_message("  %s, channel %d: %.6f is not %.6f\n", strips[i].name, c, value, right);
            bad++;
        }
    assert_int_equal(bad, 0);
}

static const whit_renderer_params strip_params = {.width = STRIPS, .height = 1, .depth = 8};

TEST(classes_mean_what_the_format_says)
{
    own_image image = render_strips(&strip_params);
    check_strips(&image, false);
}

/* --fresnel schlick works with every set of compiled effects. */
TEST(schlick_takes_the_place_of_fresnel)
{
    whit_renderer_params params = strip_params;
    params.schlick = true;
    own_image image = render_strips(&params);
    params.all_effects = true;
    own_image all = render_strips(&params);
    check_strips(&image, true);
    assert_same_image("with every effect", &image, &all);
}
