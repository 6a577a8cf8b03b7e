/* One picture of many scenes:
       contact_sheet FOLDER|FILE... -o SHEET.png [--size WxH] [--aa 1|4|16|64] [--columns N]
                     [--device D] [--texture-limit N] [--check yes]

   Folders are searched for scene files, models and all; within them, .json files count when they
   name whit's schema. Single files may be .png pictures. Tiles come in the order of their paths. A
   scene that fails gets a dark tile with the kind of its error, and the exit code is 1. With
   --check each scene has to look right at once (appearance.h), or the exit code is 1 too. */
#define _GNU_SOURCE
#include <ctype.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include <stb/stb_easy_font.h>

#include "appearance.h"
#include "whit.h"
#include "whit_program.h"

enum { LABEL_ROWS = 24, FILES_MAX = 4096, LABEL_SCALE = 2, QUADS_MAX = 1024 };

struct sheet {
    const char *output, *device_name;
    uint32_t width, height, samples, columns, texture_limit;
    uint32_t sheet_width, sheet_height;
    float *pixels; /* sheet_width * sheet_height * 3 */
    bool check;
    struct appearance_shader shader; /* only with `check` */
};

static char *files[FILES_MAX];
static uint32_t file_count;

static void on_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    fprintf(stderr, "contact_sheet: %s%s\n", level == WHIT_LOG_ERROR ? "error: " : "", message);
}

static const whit_log log_errors = {.fn = on_message, .level = WHIT_LOG_ERROR};

/* ---- Files ---- */

static bool names_the_schema(const char *path)
{
    static char head[4097];
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return false;
    size_t length = fread(head, 1, sizeof head - 1, stream);
    fclose(stream);
    head[length] = 0;
    return strstr(head, "scene.schema.json") != NULL;
}

static void add_file(const char *path)
{
    if (file_count == FILES_MAX)
        return;
    files[file_count] = strdup(path);
    if (files[file_count])
        ++file_count;
}

static int visit(const char *path, const struct stat *info, int kind, struct FTW *where)
{
    static const char *const models[] = {".obj", ".gltf", ".glb", ".ply", ".stl",
                                         ".fbx", ".dae",  ".3mf", ".off"};
    (void)info;
    const char *dot = strrchr(path + where->base, '.');
    if (kind != FTW_F || !dot)
        return 0;
    for (size_t i = 0; i < sizeof models / sizeof *models; ++i) {
        if (strcasecmp(dot, models[i]) == 0)
            add_file(path);
    }
    if (strcasecmp(dot, ".json") == 0 && names_the_schema(path))
        add_file(path);
    return 0;
}

static int compare_paths(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* ---- Tiles ---- */

static void fill(struct sheet *sheet, uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                 const float rgb[3])
{
    for (uint32_t row = y; row < y + height && row < sheet->sheet_height; ++row) {
        for (uint32_t column = x; column < x + width && column < sheet->sheet_width; ++column)
            memcpy(sheet->pixels + 3 * ((size_t)row * sheet->sheet_width + column), rgb,
                   3 * sizeof *rgb);
    }
}

/* Writes a label; a text that is too long is cut at its start, as its end says more. */
static void write_text(struct sheet *sheet, uint32_t x, uint32_t y, const char *text)
{
    struct {
        float x, y, z;
        unsigned char color[4];
    } corners[4 * QUADS_MAX];
    static const float white[3] = {0.8f, 0.8f, 0.8f};
    char copy[256];
    uint32_t room = sheet->width / LABEL_SCALE - 4;
    for (;;) {
        snprintf(copy, sizeof copy, "%s", text);
        if ((uint32_t)stb_easy_font_width(copy) <= room || !*text)
            break;
        const char *slash = strchr(text, '/');
        text = slash ? slash + 1 : text + 1;
    }
    int quads = stb_easy_font_print(0.0f, 0.0f, copy, NULL, corners, (int)sizeof corners);
    for (int i = 0; i < quads; ++i) {
        uint32_t left = (uint32_t)corners[4 * i].x, top = (uint32_t)corners[4 * i].y;
        uint32_t right = (uint32_t)corners[4 * i + 2].x, bottom = (uint32_t)corners[4 * i + 2].y;
        fill(sheet, x + LABEL_SCALE * left, y + LABEL_SCALE * top, LABEL_SCALE * (right - left),
             LABEL_SCALE * (bottom - top), white);
    }
}

/* Copies an image to a tile; pixels beyond the tile are cut off. */
static void place(struct sheet *sheet, uint32_t x, uint32_t y, const whit_image *image)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    const float *pixels = whit_image_floats(image);
    for (uint32_t row = 0; row < sheet->height && row < info.height; ++row) {
        for (uint32_t column = 0; column < sheet->width && column < info.width; ++column) {
            const float *from = pixels + info.channels * ((size_t)row * info.width + column);
            float *to = sheet->pixels + 3 * ((size_t)(y + row) * sheet->sheet_width + x + column);
            for (uint32_t c = 0; c < 3; ++c)
                to[c] = from[info.channels >= 3 ? c : 0];
        }
    }
}

static bool is_picture(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ".png") == 0;
}

/* Converts colours to what the viewer and `whit render` display. */
static whit_result read_displayed(const whit_image *color, whit_image **image)
{
    whit_image_info info;
    uint8_t *rgba;
    whit_result result = appearance_display(color, &rgba);
    if (result != WHIT_OK)
        return result;
    whit_image_get_info(color, &info);
    result = whit_image_create_display(info.width, info.height, rgba, image);
    free(rgba);
    return result;
}

static whit_result draw(const struct sheet *sheet, whit_device *device, whit_scene *scene,
                        whit_accel *accel, whit_image **image, struct appearance *appearance)
{
    whit_renderer_params params = whit_renderer_defaults();
    whit_scene_info info;
    whit_renderer *renderer = NULL;
    whit_image *color = NULL;
    whit_scene_get_info(scene, &info);
    params.width = sheet->width;
    params.height = sheet->height;
    params.sampling.count = sheet->samples;
    params.exposure_ev = info.exposure_ev;
    params.soft_highlights = info.exposure_ev != 0.0;
    whit_result result = whit_renderer_create(device, accel, &params, &renderer);
    if (result == WHIT_OK)
        result = whit_renderer_render(renderer);
    if (result == WHIT_OK)
        result = whit_renderer_image(renderer, WHIT_AOV_COLOR, &color);
    if (result == WHIT_OK)
        result = read_displayed(color, image);
    if (result == WHIT_OK && sheet->check)
        result = appearance_measure(
            &sheet->shader, &(struct appearance_of){device, scene, accel, renderer, &params, color},
            appearance);
    whit_image_destroy(color);
    whit_renderer_destroy(renderer);
    return result;
}

static whit_result render(const struct sheet *sheet, whit_device *device, const char *path,
                          whit_image **image, struct appearance *appearance)
{
    const whit_load_params load = {.up = WHIT_UP_AUTO, .texture_limit = sheet->texture_limit};
    whit_scene *scene = NULL;
    whit_accel *accel = NULL;
    whit_result result = whit_scene_load(path, &load, &log_errors, &scene);
    if (result == WHIT_OK)
        result = whit_accel_create(scene, NULL, &accel);
    if (result == WHIT_OK)
        result = draw(sheet, device, scene, accel, image, appearance);
    whit_accel_destroy(accel);
    whit_scene_destroy(scene);
    return result;
}

/* Prints the figures; gives whether the model looks right. */
static bool say_appearance(const struct appearance *a)
{
    char relief[32] = "flat";
    if (!a->is_flat)
        snprintf(relief, sizeof relief, "%.2f", a->relief);
    bool right = appearance_is_right(a);
    printf("%6.1f %% covered%s %6.1f %% burnt %6.1f %% black %8s relief  %s  ", 100.0 * a->covered,
           a->cropped ? ", cropped" : "", 100.0 * a->burnt, 100.0 * a->black, relief,
           right ? "right" : "WRONG");
    return right;
}

/* Fills all tiles; gives the number of scenes that failed. */
static uint32_t fill_sheet(struct sheet *sheet, whit_device *device)
{
    static const float dark[3] = {0.03f, 0.004f, 0.004f};
    uint32_t failed = 0;
    for (uint32_t i = 0; i < file_count; ++i) {
        uint32_t x = i % sheet->columns * sheet->width;
        uint32_t y = i / sheet->columns * (sheet->height + LABEL_ROWS);
        whit_image *image = NULL;
        struct appearance appearance = {.is_flat = true};
        double start_ms = whit_clock_ms();
        whit_result result = is_picture(files[i])
                                 ? whit_image_load(files[i], NULL, &log_errors, &image)
                                 : render(sheet, device, files[i], &image, &appearance);
        if (result == WHIT_OK) {
            place(sheet, x, y, image);
        } else {
            fill(sheet, x, y, sheet->width, sheet->height, dark);
            write_text(sheet, x + 8, y + sheet->height / 2, whit_result_name(result));
            ++failed;
        }
        write_text(sheet, x + 4, y + sheet->height + 4, files[i]);
        printf("%4u  %7.1f s  %-12s ", i + 1, (whit_clock_ms() - start_ms) / 1000.0,
               whit_result_name(result));
        if (sheet->check && result == WHIT_OK)
            failed += !say_appearance(&appearance);
        puts(files[i]);
        fflush(stdout);
        whit_image_destroy(image);
    }
    return failed;
}

/* ---- Command line ---- */

static int usage(void)
{
    fputs("usage: contact_sheet FOLDER|FILE... -o SHEET.png [--size WxH] [--aa 1|4|16|64]\n"
          "                     [--columns N] [--device D] [--texture-limit N] [--check yes]\n",
          stderr);
    return 2;
}

/* Reads a whole number that is all of the text. */
static bool read_number(const char *text, uint32_t *number)
{
    char behind;
    return sscanf(text, "%u%c", number, &behind) == 1;
}

static bool read_option(struct sheet *sheet, const char *name, const char *value)
{
    char behind;
    if (strcmp(name, "-o") == 0)
        sheet->output = value;
    else if (strcmp(name, "--device") == 0)
        sheet->device_name = value;
    else if (strcmp(name, "--size") == 0)
        return sscanf(value, "%ux%u%c", &sheet->width, &sheet->height, &behind) == 2;
    else if (strcmp(name, "--aa") == 0)
        return read_number(value, &sheet->samples);
    else if (strcmp(name, "--columns") == 0)
        return read_number(value, &sheet->columns);
    else if (strcmp(name, "--texture-limit") == 0)
        return read_number(value, &sheet->texture_limit);
    else if (strcmp(name, "--check") == 0)
        return sheet->check = strcmp(value, "yes") == 0;
    else
        return false;
    return true;
}

static bool read_arguments(struct sheet *sheet, int argc, char **argv)
{
    for (int i = 1; i < argc; ++i) {
        struct stat info;
        if (argv[i][0] == '-') {
            if (i + 1 == argc || !read_option(sheet, argv[i], argv[i + 1]))
                return false;
            ++i;
        } else if (stat(argv[i], &info) == 0 && S_ISDIR(info.st_mode)) {
            uint32_t first = file_count;
            if (nftw(argv[i], visit, 16, FTW_PHYS) != 0)
                return false;
            qsort(files + first, file_count - first, sizeof *files, compare_paths);
            if (file_count == first)
                fprintf(stderr, "%s: there is no scene and no model in it\n", argv[i]);
        } else {
            add_file(argv[i]);
        }
    }
    return sheet->output && file_count > 0 && sheet->columns >= 1 && sheet->columns <= 64 &&
           sheet->width >= 64 && sheet->width <= 1024 && sheet->height >= 48 &&
           sheet->height <= 1024;
}

static int make_sheet(struct sheet *sheet)
{
    whit_device *device = NULL;
    whit_image *image = NULL;
    uint32_t failed = 0;
    uint32_t rows = (file_count + sheet->columns - 1) / sheet->columns;
    sheet->columns = sheet->columns < file_count ? sheet->columns : file_count;
    sheet->sheet_width = sheet->columns * sheet->width;
    sheet->sheet_height = rows * (sheet->height + LABEL_ROWS);
    sheet->pixels =
        calloc((size_t)sheet->sheet_width * sheet->sheet_height, 3 * sizeof *sheet->pixels);
    const whit_device_params params = {.selector = sheet->device_name};
    whit_result result = sheet->pixels ? WHIT_OK : WHIT_ERROR_MEMORY;
    if (result == WHIT_ERROR_MEMORY)
        on_message(NULL, WHIT_LOG_ERROR, "out of memory");
    if (result == WHIT_OK)
        result = whit_device_create(&params, &log_errors, &device);
    if (result == WHIT_OK && sheet->check)
        result = appearance_shader_init(&log_errors, &sheet->shader);
    if (result == WHIT_ERROR_OUTPUT)
        on_message(NULL, WHIT_LOG_ERROR, "no temporary file can be written: TMPDIR names a folder");
    if (result == WHIT_OK) {
        failed = fill_sheet(sheet, device);
        result =
            whit_image_create(sheet->sheet_width, sheet->sheet_height, 3, sheet->pixels, &image);
    }
    if (result == WHIT_OK)
        result = whit_image_save(image, sheet->output, NULL, 0, &log_errors);
    if (result == WHIT_OK)
        printf("%s: %u scenes, %u failed\n", sheet->output, file_count, failed);
    bool fine = result == WHIT_OK && failed == 0 &&
                (!device || whit_device_validation_messages(device) == 0);
    whit_image_destroy(image);
    appearance_shader_finish(&sheet->shader);
    whit_device_destroy(device);
    free(sheet->pixels);
    if (result == WHIT_ERROR_NO_DEVICE)
        return 3;
    return fine ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    struct sheet sheet = {.width = 320, .height = 240, .samples = 4, .columns = 6};
    int code = read_arguments(&sheet, argc, argv) ? make_sheet(&sheet) : usage();
    for (uint32_t i = 0; i < file_count; ++i)
        free(files[i]);
    return code;
}
