/* The table of settings: a row an option, in the order of help. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "settings/settings.h"

enum { DEPTH_MAX = 255, FRAMES_MAX = 1000000000 };

enum {
    IN_PICTURES = IN_RENDER | IN_VIEW | IN_PROBE,
    IN_SCENES = IN_PICTURES | IN_COST | IN_SCENE | IN_BVH | IN_TRACE | IN_HARD,
    IN_TREES = IN_PICTURES | IN_TRACE | IN_BVH,
    IN_LIMITED = IN_SCENES & ~IN_VIEW
};

static const struct setting_value values_stats[] = {
    {"text", STATS_TEXT, NULL}, {"json", STATS_JSON, NULL}, {0}};
static const struct setting_value values_edges[] = {{"off", EDGES_OFF, NULL},
                                                    {"objects", EDGES_OBJECTS, NULL},
                                                    {"triangles", EDGES_TRIANGLES, NULL},
                                                    {0}};
static const struct setting_value values_boxes[] = {{"off", BOXES_OFF, NULL},
                                                    {"meshes", BOXES_MESHES, "of meshes"},
                                                    {"instances", BOXES_INSTANCES, "of instances"},
                                                    {0}};
static const struct setting_value values_switch[] = {{"off", 0, NULL}, {"on", 1, NULL}, {0}};
static const struct setting_value values_at_rest[] = {{"refine", 1, NULL}, {"stay", 0, NULL}, {0}};
static const struct setting_value values_segments[] = {
    {"auto", 0, NULL}, {"1", 1, NULL}, {"2", 2, NULL}, {0}};
static const struct setting_value values_nodes[] = {
    {"auto", 0, NULL}, {"16", 16, NULL}, {"32", 32, NULL}, {0}};

/* ---- What keys and panels of the viewer turn through ---- */

static const struct setting_value steps_aa[] = {{"1", 0, "1 a pixel"},
                                                {"4", 0, "4 a pixel"},
                                                {"16", 0, "16 a pixel"},
                                                {"64", 0, "64 a pixel"},
                                                {"adaptive:0.05", 0, "adaptive"},
                                                {0}};
static const struct setting_value steps_background[] = {{"env", 0, "sky"},
                                                        {"#ffffff", 0, "white"},
                                                        {"#808080", 0, "grey"},
                                                        {"#000000", 0, "black"},
                                                        {0}};
static const struct setting_value steps_bailout[] = {{"0", 0, "0: every ray"},
                                                     {"0.000244140625", 0, "1/4096"},
                                                     {"0.0009765625", 0, "1/1024"},
                                                     {"0.00390625", 0, "1/256"},
                                                     {"0.015625", 0, "1/64"},
                                                     {"0.0625", 0, "1/16"},
                                                     {0}};
static const struct setting_value more_build[] = {{"binned+opt", 0, NULL}, {"binned:4", 0, NULL},
                                                  {"binned:7", 0, NULL},   {"binned:8", 0, NULL},
                                                  {"binned:16", 0, NULL},  {"binned:32", 0, NULL},
                                                  {"binned:64", 0, NULL},  {"binned:128", 0, NULL},
                                                  {"binned:256", 0, NULL}, {0}};

/* ---- Kinds of their own ---- */

/* Reads `,LEAST,MOST` of adaptive samples. */
static bool read_limits(const char *text, whit_sampling *sampling)
{
    char expected[16];
    for (sampling->count = 1; sampling->count < 64; sampling->count *= 4) {
        for (sampling->count_max = 4 * sampling->count; sampling->count_max <= 64;
             sampling->count_max *= 4) {
            snprintf(expected, sizeof expected, ",%u,%u", sampling->count, sampling->count_max);
            if (strcmp(text, expected) == 0)
                return true;
        }
    }
    return false;
}

static bool read_aa(const struct setting *row, const char *text, void *record, char *why)
{
    static const char prefix[] = "adaptive:";
    whit_renderer_params *picture = &((struct settings *)record)->picture;
    size_t length = strlen(prefix);
    char *end;
    (void)row;
    if (strncmp(text, prefix, length) != 0) {
        uint32_t count;
        const char *rest = text_number(text, WHIT_SAMPLES_MAX, &count);
        if (!rest || *rest || count < 1)
            return setting_refuse(why, " `%s`: a whole number from 1 to %d or adaptive:X is needed",
                                  text, WHIT_SAMPLES_MAX);
        picture->sampling = (whit_sampling){.count = count};
        return true;
    }
    double contrast = strtod(text + length, &end);
    if (end == text + length || (*end && *end != ',') || !(contrast > 0.0 && contrast <= 1.0))
        return setting_refuse(why, " `%s`: after adaptive: a number above 0, up to 1, is needed",
                              text);
    whit_sampling sampling = {
        .kind = WHIT_SAMPLING_ADAPTIVE, .count = 4, .count_max = 64, .contrast = contrast};
    if (*end && !read_limits(end, &sampling))
        return setting_refuse(why,
                              " `%s`: after a comma the least and the most samples of a pixel are "
                              "needed: 1,4 1,16 1,64 4,16 4,64 or 16,64",
                              text);
    picture->sampling = sampling;
    return true;
}

static bool write_aa(const void *record, char text[SETTING_VALUE_BYTES])
{
    const whit_renderer_params *picture = &((const struct settings *)record)->picture;
    if (picture->sampling.kind == WHIT_SAMPLING_ADAPTIVE) {
        const whit_sampling *sampling = &picture->sampling;
        strcpy(text, "adaptive:");
        setting_write_number(sampling->contrast, text + strlen(text), 40);
        if (sampling->count_max && (sampling->count != 4 || sampling->count_max != 64))
            snprintf(text + strlen(text), 16, ",%u,%u", sampling->count, sampling->count_max);
    } else {
        snprintf(text, SETTING_VALUE_BYTES, "%u",
                 picture->sampling.count ? picture->sampling.count : 1);
    }
    return true;
}

static bool read_build(const struct setting *row, const char *text, void *record, char *why)
{
    (void)row;
    return builder_read(text, &((struct settings *)record)->trees, why);
}

static bool write_build(const void *record, char text[SETTING_VALUE_BYTES])
{
    builder_write(&((const struct settings *)record)->trees, text, SETTING_VALUE_BYTES);
    return true;
}

/* Reads auto or a number; for auto `number` is unchanged. */
static bool read_auto(const struct setting *row, const char *text, bool *is_auto, double *number,
                      char *why)
{
    char *end;
    double value = setting_number(text, &end);
    *is_auto = strcmp(text, "auto") == 0;
    if (*is_auto)
        return true;
    if (end == text || *end || !(value >= row->min && value <= row->max))
        return setting_refuse(why, " `%s`: auto or a number from %g to %g is needed", text,
                              row->min, row->max);
    *number = value;
    return true;
}

static bool read_exposure(const struct setting *row, const char *text, void *record, char *why)
{
    struct settings *settings = record;
    bool is_auto;
    if (!read_auto(row, text, &is_auto, &settings->picture.exposure_ev, why))
        return false;
    settings->exposure_auto = is_auto;
    settings->picture.soft_highlights = false;
    return true;
}

static bool write_exposure(const void *record, char text[SETTING_VALUE_BYTES])
{
    const struct settings *settings = record;
    if (settings->exposure_auto)
        strcpy(text, "auto");
    else
        setting_write_number(settings->picture.exposure_ev, text, SETTING_VALUE_BYTES);
    return true;
}

static bool read_scale(const struct setting *row, const char *text, void *record, char *why)
{
    struct settings *settings = record;
    bool is_auto;
    if (!read_auto(row, text, &is_auto, &settings->paint_scale, why))
        return false;
    if (is_auto)
        settings->paint_scale = 0.0;
    return true;
}

static bool write_scale(const void *record, char text[SETTING_VALUE_BYTES])
{
    double scale = ((const struct settings *)record)->paint_scale;
    if (scale > 0.0)
        setting_write_number(scale, text, SETTING_VALUE_BYTES);
    else
        strcpy(text, "auto");
    return true;
}

static bool read_background(const struct setting *row, const char *text, void *record, char *why)
{
    whit_load_params *load = &((struct settings *)record)->load;
    unsigned rgb[3];
    int length = 0;
    (void)row;
    bool plain = strcmp(text, "env") == 0;
    if (!plain && (sscanf(text, "#%2x%2x%2x%n", &rgb[0], &rgb[1], &rgb[2], &length) != 3 ||
                   length != 7 || text[length] || strspn(text + 1, "0123456789abcdefABCDEF") != 6))
        return setting_refuse(why, " `%s`: env or a colour such as #ffcc88 is needed", text);
    load->has_background = !plain;
    for (int i = 0; i < 3; ++i)
        load->background[i] = plain ? 0 : (uint8_t)rgb[i];
    return true;
}

static bool write_background(const void *record, char text[SETTING_VALUE_BYTES])
{
    const whit_load_params *load = &((const struct settings *)record)->load;
    const uint8_t *rgb = load->background;
    if (load->has_background)
        snprintf(text, SETTING_VALUE_BYTES, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    else
        strcpy(text, "env");
    return true;
}

/* Adaptive samples mean nothing for costs, which use a fixed number of samples. */
static bool aa_tells(const void *record, bool recipe)
{
    const struct settings *settings = record;
    (void)recipe;
    return settings->paint == PAINT_COLOR || settings->picture.sampling.kind == WHIT_SAMPLING_FIXED;
}

/* Overlays mean nothing for heat maps. */
static bool overlays_tell(const void *record, bool recipe)
{
    return !recipe || ((const struct settings *)record)->paint == PAINT_COLOR;
}

/* Added effects do not change the picture, so recipes only need removed ones. */
static bool effects_tell(const void *record, bool recipe)
{
    return !recipe || ((const struct settings *)record)->picture.effects_removed != 0;
}

static bool read_effects(const struct setting *row, const char *text, void *record, char *why)
{
    (void)row;
    return effects_read(text, &((struct settings *)record)->picture, why);
}

static bool write_effects(const void *record, char text[SETTING_VALUE_BYTES])
{
    effects_write(&((const struct settings *)record)->picture, text);
    return true;
}

/* ---- The table ---- */

#define AT(kind, member) SETTING_AT_##kind(struct settings, member)
#define AT_OWN(name)     .kind = SETTING_OWN, .read = read_##name, .write = write_##name

const struct setting settings_table[] = {
    {"size", 0, "WxH", "pixels", SETTING_AT_SIZE(struct settings, picture.width, picture.height),
     .commands = IN_PICTURES | IN_COST | IN_SCENE, .change = SETTING_PLACE, .always = true},
    {"camera", 0, "NAME|N|auto|numbers",
     "a camera of the scene, by name or number; auto: whit's own,\n"
     "as for files that have none; or\n"
     "ex,ey,ez,tx,ty,tz,ux,uy,uz,fov: eye, target, up and\n"
     "vertical angle in degrees",
     "the scene's first", AT(TEXT, camera), .commands = IN_PICTURES | IN_COST | IN_SCENE,
     .change = SETTING_PLACE},
    {"time", 0, "T", "seconds of the animation", AT(NUMBER, picture.time_s), .min = -1e6,
     .max = 1e6, .commands = IN_SCENES, .change = SETTING_PLACE, .json = "time_s"},
    {"frame", 0, "N", "instead of --time: frame N of the animation", "", AT(COUNT, frame),
     .max = FRAMES_MAX, .commands = IN_SCENES},
    {"fps", 0, "F", "frames in a second, for --frame", AT(NUMBER, fps), .min = 1e-3, .max = 1e6,
     .commands = IN_SCENES},

    {"aa", 0, "N|adaptive:X[,LEAST,MOST]",
     "samples a pixel, 1 to 4096 (powers of 4 are spread evenly);\n"
     "adaptive: LEAST (4), where neighbours differ by more than\n"
     "X 4 times as many, and so on up to MOST (64)",
     AT_OWN(aa), .values = values_samples, .commands = IN_PICTURES | IN_SCENE,
     .change = SETTING_LIGHT, .always = true, .tells = aa_tells, .title = "anti-aliasing",
     .steps = steps_aa, .key = 'Y'},
    {"depth", 0, "N", "most bounces; 0: only what is seen directly", AT(COUNT, picture.depth),
     .max = DEPTH_MAX, .commands = IN_PICTURES | IN_SCENE, .change = SETTING_LIGHT, .always = true,
     .title = "bounces", .step = 1.0, .shown_max = 32.0, .key = '=', .key_back = '-'},
    {"bailout", 0, "X",
     "rays that can add less than X to a pixel are not traced;\n"
     "0: all are",
     "1/1024", AT(NUMBER, picture.bailout), .max = 1.0, .commands = IN_PICTURES,
     .change = SETTING_LIGHT, .title = "bail-out", .steps = steps_bailout},
    {"shadows", 0, NULL,
     "of glass and blended surfaces: light comes through, or\n"
     "not; none: light reaches everything",
     AT(CHOICE, picture.shadows), .values = values_shadows, .commands = IN_PICTURES,
     .change = SETTING_LIGHT, .need = SETTING_NEEDS_KERNEL, .title = "shadows"},
    {"light-samples", 0, NULL, "points of an area light that are tested",
     AT(CHOICE, picture.light_samples), .values = values_light_samples, .commands = IN_PICTURES,
     .change = SETTING_LIGHT, .title = "light samples"},
    {"fresnel", 0, NULL, "or Schlick's approximation in its place", AT(EITHER, picture.schlick),
     .values = values_fresnel, .commands = IN_PICTURES, .change = SETTING_LIGHT,
     .need = SETTING_NEEDS_KERNEL, .title = "Fresnel"},
    {"minification", 0, NULL,
     "what textures show of a pixel that covers many of their\n"
     "texels: the mean of about as many, or those where its\n"
     "samples are",
     AT(CHOICE, picture.minification), .values = values_minification,
     .commands = IN_PICTURES | IN_SCENE, .change = SETTING_LIGHT, .need = SETTING_NEEDS_KERNEL,
     .title = "minification"},
    {"portable", 0, NULL,
     "on: the same bits on every device; nothing is left to its\n"
     "driver, as division, roots and powers are",
     AT(EITHER, picture.portable), .values = values_switch,
     .commands = IN_PICTURES | IN_TRACE | IN_HARD, .change = SETTING_LIGHT,
     .need = SETTING_NEEDS_KERNEL, .title = "portable"},
    {"exposure", 0, "auto|EV",
     "what is displayed, in the window, PNG and FLIP, times 2^EV;\n"
     "auto: as suits what the first camera sees of a model, with\n"
     "soft highlights; EXR and PFM stay as they are",
     AT_OWN(exposure), .offset = offsetof(struct settings, picture.exposure_ev), .min = -32.0,
     .max = 32.0, .commands = IN_PICTURES | IN_COST, .change = SETTING_LIGHT, .title = "exposure",
     .step = 0.5, .shown_min = -8.0, .shown_max = 8.0, .key = 'Z', .json = "exposure_ev"},
    {"effects", 0, "auto|all|+NAME,-NAME",
     "compile what the scene calls for, or everything: the\n"
     "picture is the same; or more and less by name: less\n"
     "changes it. Names and prices: `whit scene --effects`",
     AT_OWN(effects), .values = values_effects, .commands = IN_PICTURES, .change = SETTING_LIGHT,
     .need = SETTING_NEEDS_KERNEL, .tells = effects_tell},

    {"edges", 0, NULL,
     "black over the picture where neighbouring pixels meet another\n"
     "object, or another triangle",
     AT(CHOICE, edges), .values = values_edges, .commands = IN_RENDER | IN_VIEW,
     .change = SETTING_LIGHT, .tells = overlays_tell, .title = "edges"},
    {"grid", 0, NULL,
     "on: lines on the ground, just below the scene, behind what\n"
     "stands before them",
     AT(EITHER, grid), .values = values_switch, .commands = IN_RENDER | IN_VIEW,
     .change = SETTING_LIGHT, .tells = overlays_tell, .title = "grid"},

    {"shader", 0, "FILE",
     "GLSL functions in the place of whit's own: see\n"
     "docs/shaders.md and `whit shader`",
     "", AT(TEXT, shader), .commands = IN_RENDER | IN_VIEW | IN_PROBE | IN_SCENE,
     .change = SETTING_LIGHT, .need = SETTING_NEEDS_KERNEL},
    {"stages", 0, "FOLDER",
     "whit's own stages out of FOLDER, the shaders/ of a checkout,\n"
     "in place of those that are built in",
     "", AT(TEXT, stages), .commands = IN_RENDER | IN_VIEW | IN_SHADER, .change = SETTING_LIGHT,
     .need = SETTING_NEEDS_KERNEL, .trusted = true},
    {"set", 0, "NAME=VALUE",
     "sliders of the shader; several by commas, or by several\n"
     "--set",
     "", AT(PAIRS, sliders), .commands = IN_RENDER | IN_VIEW | IN_PROBE | IN_SHADER | IN_SCENE,
     .change = SETTING_LIGHT},
    {"trust", 0, NULL, "the shader's loops and indices are not bounded", AT(FLAG, trust),
     .commands = IN_RENDER | IN_VIEW | IN_PROBE | IN_SHADER | IN_SCENE, .change = SETTING_LIGHT,
     .need = SETTING_NEEDS_KERNEL, .trusted = true},

    {"aov", 0, "NAME",
     "what the shader's function below `//@ aov NAME` gives, in place\n"
     "of the colour",
     "", AT(TEXT, aov), .commands = IN_RENDER | IN_VIEW, .change = SETTING_LIGHT},

    {"budget-ms", 0, "T",
     "choose the best of these settings that take at most T ms, by\n"
     "`whit cost`, which measures the scene for 20 s the first time",
     "", AT(NUMBER, budget_ms), .min = 1e-3, .max = 1e9, .commands = IN_RENDER | IN_VIEW},
    {"max-error", 0, "E",
     "the cheapest ones with an RMSE of at most E (FLIP, as of\n"
     "`whit cost --under`, is another number)",
     "", AT(NUMBER, max_error), .min = 1e-9, .max = 1e6, .commands = IN_RENDER | IN_VIEW},

    {"view", 0, NULL,
     "what traversals cost instead of colours: a heat map\n"
     "(.png) or the numbers (.exr, .pfm)",
     AT(CHOICE, paint), .values = values_view, .commands = IN_RENDER | IN_VIEW,
     .change = SETTING_PAINT, .title = "view", .key = 'V'},
    {"view-rays", 0, NULL, "of which rays, or of all", AT(CHOICE, paint_rays),
     .values = values_rays, .commands = IN_RENDER | IN_VIEW, .change = SETTING_PAINT,
     .title = "rays of costs"},
    {"view-scale", 0, "auto|X", "the number of the brightest colour", AT_OWN(scale), .min = 1e-9,
     .max = 1e12, .commands = IN_RENDER | IN_VIEW, .change = SETTING_PAINT},

    {"boxes", 0, NULL,
     "boxes of trees over the picture: of those of meshes, or of\n"
     "the one over instances",
     AT(CHOICE, boxes), .values = values_boxes, .commands = IN_VIEW, .change = SETTING_PAINT,
     .title = "boxes of trees", .steps = values_boxes, .key = 'N'},
    {"boxes-level", 0, "N",
     "of the tree, 0 to 127: the root is 0, leaves above are shown\n"
     "too",
     AT(COUNT, boxes_level), .max = 127, .commands = IN_VIEW, .change = SETTING_PAINT,
     .title = "level of boxes", .step = 1.0, .shown_max = 32.0, .key = 'J'},

    {"build", 0, "BUILDER[+opt]",
     "how trees are built: binned[:K] with 2 to 256 bins,\n"
     "median, sweep, spatial[:ALPHA[,BUDGET]];\n"
     "+opt improves them by reinsertion; none: no trees, rays\n"
     "test every triangle",
     AT_OWN(build), .values = values_build, .commands = IN_PICTURES | IN_TRACE,
     .change = SETTING_COST, .need = SETTING_NEEDS_TREES, .title = "tree builder",
     .more_steps = more_build, .key = 'K', .key_skips = "none"},
    {"leaf", 0, "N", "most triangles in a leaf, 1 to 15", AT(COUNT, trees.leaf_limit), .min = 1,
     .max = 15, .commands = IN_TREES, .change = SETTING_COST, .need = SETTING_NEEDS_TREES},
    {"instances", 0, NULL,
     "off: one tree over the triangles of all instances, placed\n"
     "in the world; auto: off where nothing moves and no mesh is\n"
     "placed twice, single balls aside",
     AT(CHOICE, trees.instances), .values = values_instances, .commands = IN_TREES | IN_HARD,
     .change = SETTING_HITS, .need = SETTING_NEEDS_TREES, .title = "instance tree", .key = 'O'},
    {"instance-build", 0, NULL, "how the tree over instances is built",
     AT(CHOICE, trees.instance_build), .values = values_instance_build, .commands = IN_TREES,
     .change = SETTING_COST, .need = SETTING_NEEDS_TREES},
    {"instance-update", 0, NULL,
     "for another time: a new tree over instances, or new\n"
     "boxes for the old one",
     AT(EITHER, trees.instance_refit), .values = values_instance_update, .commands = IN_TREES,
     .change = SETTING_COST, .need = SETTING_NEEDS_TREES},
    {"traversal", 0, NULL,
     "which of two nodes comes first: the nearer, by the ray's\n"
     "sign, as they come",
     AT(CHOICE, picture.traversal), .values = values_traversal, .commands = IN_TREES,
     .change = SETTING_COST, .need = SETTING_NEEDS_KERNEL, .title = "traversal", .key = 'T'},
    {"numerics", 0, NULL,
     "what decides hits: quick tests that leak, tests that do\n"
     "not, exact arithmetic",
     AT(CHOICE, picture.numerics), .values = values_numerics, .commands = IN_TREES | IN_SCENE,
     .change = SETTING_HITS, .need = SETTING_NEEDS_KERNEL, .title = "numerics", .key = 'M'},
    {"load-path", 0, NULL, "how kernels read the trees", AT(CHOICE, picture.load_path),
     .values = values_load_path, .commands = IN_TREES, .change = SETTING_COST,
     .need = SETTING_NEEDS_KERNEL},
    {"threads", 0, "N", "threads on the CPU, 0: one a core", AT(COUNT, trees.threads), .max = 1024,
     .commands = IN_RENDER | IN_PROBE | IN_TRACE | IN_HARD},

    {"up", 0, NULL,
     "the axis of a model that points up, once an axis that its\n"
     "format or file states has become y; auto: y, and of\n"
     "OBJ, PLY, STL and OFF as their shape says; trace, bvh, hard\n"
     "and --triangles take it as it is unless told",
     AT(CHOICE, load.up), .values = values_up, .commands = IN_SCENES, .change = SETTING_HITS,
     .need = SETTING_NEEDS_SCENE, .title = "up", .key = '7'},
    {"clip", 0, "NAME|N",
     "of a glTF with many animations: the one that is played, by name\n"
     "or number",
     "the first, and those for other nodes", AT(TEXT, clip), .commands = IN_SCENES,
     .change = SETTING_HITS, .need = SETTING_NEEDS_SCENE},
    {"light", 0, NULL,
     "what lights the scene: what the file has, and whit's own\n"
     "where that lights nothing; nothing but the file's; no\n"
     "light; whit's in place of the file's",
     AT(CHOICE, load.lights), .values = values_lights, .commands = IN_PICTURES | IN_COST | IN_SCENE,
     .change = SETTING_LIGHT, .need = SETTING_NEEDS_SCENE, .title = "light", .key = '8',
     .steps = values_lights},
    {"environment", 0, "FILE", "a picture all around, in place of the file's sky", "",
     AT(TEXT, environment), .commands = IN_PICTURES | IN_COST | IN_SCENE, .change = SETTING_LIGHT,
     .need = SETTING_NEEDS_SCENE, .trusted = true},
    {"background", 0, "#rrggbb|env", "one colour in place of the sky; env: the sky",
     AT_OWN(background), .commands = IN_PICTURES | IN_COST | IN_SCENE, .change = SETTING_LIGHT,
     .need = SETTING_NEEDS_SCENE, .title = "background", .key = '/', .steps = steps_background},
    {"texture-limit", 0, "N", "halve textures with a longer side", AT(COUNT, load.texture_limit),
     .min = 1, .max = 16384, .commands = IN_PICTURES | IN_SCENE | IN_BVH, .change = SETTING_LIGHT,
     .need = SETTING_NEEDS_SCENE},
    {"allow-path", 0, "FOLDER",
     "files of the scene may name files below FOLDER too, not\n"
     "only below the scene's own; may be given again",
     "", .kind = SETTING_FOLDERS, .offset = offsetof(struct settings, allowed),
     .commands = IN_SCENES, .change = SETTING_HITS, .need = SETTING_NEEDS_SCENE, .trusted = true},
    {"memory-limit", 0, "SIZE",
     "refuse what takes more on host and device, in bytes or with\n"
     "K, M, G",
     "half of the machine's", AT(BYTES, load.memory_limit_bytes),
     .commands = IN_SCENES | IN_COMPARE, .trusted = true},
    {"import-limit", 0, "S",
     "seconds of the processor for each file that foreign code\n"
     "reads; ten times that by the clock",
     "8 to 60, by the file's size", AT(NUMBER, load.import_limit_s), .min = 1e-3, .max = 1e6,
     .commands = IN_SCENES | IN_COMPARE | IN_MERGE, .trusted = true},
    {"require-sandbox", 0, NULL,
     "fail where foreign code cannot be locked in, in place of a\n"
     "warning",
     AT(FLAG, load.require_sandbox), .commands = IN_SCENES | IN_COMPARE | IN_MERGE | IN_CHECK,
     .trusted = true},

    {"device", 0, "auto|N|NAME", "Vulkan device; see `whit devices`", "auto", AT(TEXT, device),
     .commands = IN_SCENES | IN_BATCH | IN_BENCH | IN_SHADER | IN_CHECK, .change = SETTING_COST,
     .need = SETTING_NEEDS_KERNEL, .of_machine = true},
    {"no-cache", 0, NULL, "keep nothing for the next run, and use nothing that was kept",
     AT(FLAG, no_cache), .commands = IN_SCENES | IN_BATCH | IN_BENCH | IN_SHADER | IN_CHECK},
    {"fps-goal", 0, "F",
     "pictures a second to hold while something moves, by\n"
     "smaller ones",
     AT(NUMBER, fps_goal), .min = 0.1, .max = 1000.0, .commands = IN_VIEW, .change = SETTING_COST},
    {"at-rest", 0, NULL,
     "refine: where nothing moves, more samples by themselves,\n"
     "until that changes nothing that is seen",
     AT(EITHER, refines), .values = values_at_rest, .commands = IN_VIEW, .change = SETTING_COST,
     .title = "at rest"},
    {"stats", 0, NULL, "print times, rays and figures of the trees", "", AT(CHOICE, stats),
     .values = values_stats, .commands = IN_RENDER},
    {"time-limit", 0, "S", "give up after S seconds, with exit code 5", "",
     AT(NUMBER, time_limit_s), .min = 1e-3, .max = 1e6,
     .commands = IN_LIMITED | IN_BATCH | IN_CHECK},
    {"validation", 0, NULL, "run with the Vulkan validation layers", AT(FLAG, validation),
     .commands = (IN_SCENES & ~IN_SCENE) | IN_BATCH | IN_SHADER | IN_CHECK},
    {"quiet", 'q', NULL, "no notes, no progress, only errors", AT(FLAG, quiet),
     .commands = IN_SCENES | IN_COMPARE | IN_MERGE | IN_BATCH | IN_BENCH | IN_CHECK},

    {"tile-size", 0, "N", "pixels on a tile's side, 16 to 1024", "by measured time",
     AT(COUNT, picture.tile_size), .min = 16, .max = 1024, .developer = true,
     .commands = IN_RENDER},
    {"packets", 0, NULL,
     "whether camera rays and the shadow rays of what they meet\n"
     "walk together; auto: where that is quicker",
     AT(CHOICE, picture.packets), .values = values_packets, .developer = true,
     .commands = IN_RENDER},
    {"classes", 0, NULL,
     "one: a kernel for all materials, and for camera rays and\n"
     "later ones; many: for each its own; auto: many where the\n"
     "picture has enough rays to pay for them",
     AT(CHOICE, picture.classes), .values = values_classes, .developer = true,
     .commands = IN_RENDER},
    {"segments", 0, NULL,
     "how many segments lists have; 2: one for each thread of\n"
     "lavapipe",
     AT(CHOICE, picture.segments), .values = values_segments, .developer = true,
     .commands = IN_RENDER},
    {"nodes", 0, NULL,
     "bytes of the nodes that rays outside of packets read;\n"
     "auto: 16 in large trees without instances",
     AT(CHOICE, picture.node_bytes), .values = values_nodes, .developer = true,
     .commands = IN_RENDER},

    /* Removed options come last: settings.given has only 64 bits, and none for these rows. */
    {"tree", 0, NULL, "is gone: trees are built for each run", .kind = SETTING_GONE,
     .commands = IN_TREES & ~IN_BVH},
    {"no-bvh", 0, NULL, "is `--build none` now", .kind = SETTING_GONE,
     .commands = IN_PICTURES | IN_TRACE},
    {"no-shadows", 0, NULL, "is `--shadows none` now", .kind = SETTING_GONE,
     .commands = IN_PICTURES},
    {"opaque-shadows", 0, NULL, "is `--shadows opaque` now", .kind = SETTING_GONE,
     .commands = IN_PICTURES},
    {0},
};
