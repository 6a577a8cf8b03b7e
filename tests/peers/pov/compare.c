/* Compares a picture of whit with one of POV-Ray, which saves binary PPM of 16 bits, linear:
       compare colors|masks PICTURE PICTURE.ppm
   masks: each object in a flat colour. Every pixel's colour must be found in the other picture
   within a pixel, both ways round. colors: on 99 % of the pixels every channel, as an sRGB code,
   is within 2/255. Exit code 1 when it is not so. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "whit.h"

#define CLOSE    (2.0 / 255.0)
#define SHARE    0.99
#define SIDE_MAX 4096u

struct picture {
    unsigned width, height;
    double *rgb; /* sRGB codes, 0 to 1 */
};

static double encode(double linear)
{
    linear = fmin(fmax(linear, 0.0), 1.0);
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

static void on_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fprintf(stderr, "compare: %s\n", message);
}

static int alloc_picture(struct picture *picture)
{
    if (picture->width == 0 || picture->height == 0 || picture->width > SIDE_MAX ||
        picture->height > SIDE_MAX)
        return 0;
    picture->rgb = malloc((size_t)picture->width * picture->height * 3 * sizeof *picture->rgb);
    return picture->rgb != NULL;
}

static int load_whit(const char *path, struct picture *picture)
{
    const whit_log log = {.fn = on_message, .level = WHIT_LOG_WARNING};
    whit_image *image;
    whit_image_info info;
    if (whit_image_load(path, NULL, &log, &image) != WHIT_OK)
        return 0;
    whit_image_get_info(image, &info);
    const float *pixels = whit_image_floats(image);
    picture->width = info.width;
    picture->height = info.height;
    int good = pixels && info.channels >= 3 && alloc_picture(picture);
    for (size_t i = 0; good && i < (size_t)info.width * info.height; ++i)
        for (size_t c = 0; c < 3; ++c)
            picture->rgb[3 * i + c] = encode((double)pixels[i * info.channels + c]);
    whit_image_destroy(image);
    return good;
}

/* Between the numbers of a PPM's head: blanks, and comments to the end of the line. */
static int read_head_number(FILE *file, unsigned *out)
{
    int c = getc(file);
    while (c == '#' || isspace(c)) {
        while (c == '#' && (c = getc(file)) != '\n' && c != EOF)
            c = '#';
        c = getc(file);
    }
    ungetc(c, file);
    return fscanf(file, "%u", out) == 1;
}

static int load_ppm(const char *path, struct picture *picture)
{
    FILE *file = fopen(path, "rb");
    unsigned max = 0;
    int good = file && getc(file) == 'P' && getc(file) == '6' &&
               read_head_number(file, &picture->width) &&
               read_head_number(file, &picture->height) && read_head_number(file, &max) &&
               max == 65535 && isspace(getc(file)) && alloc_picture(picture);
    size_t count = (size_t)picture->width * picture->height * 3;
    for (size_t i = 0; good && i < count; ++i) {
        int high = getc(file), low = getc(file);
        good = low != EOF;
        picture->rgb[i] = encode((high * 256 + low) / 65535.0);
    }
    if (file)
        fclose(file);
    if (!good)
        fprintf(stderr, "compare: %s: not a binary PPM of 16 bits\n", path);
    return good;
}

static double difference(const struct picture *a, size_t i, const struct picture *b, size_t j)
{
    double max = 0.0;
    for (size_t c = 0; c < 3; ++c)
        max = fmax(max, fabs(a->rgb[3 * i + c] - b->rgb[3 * j + c]));
    return max;
}

/* Pixels of `a` whose colour is not in `b`, at the same place or next to it. */
static size_t count_lost(const struct picture *a, const struct picture *b, int reach)
{
    size_t lost = 0;
    int width = (int)a->width, height = (int)a->height;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            int found = 0;
            for (int v = y - reach; v <= y + reach; ++v)
                for (int u = x - reach; u <= x + reach; ++u)
                    found |=
                        u >= 0 && v >= 0 && u < width && v < height &&
                        difference(a, (size_t)(y * width + x), b, (size_t)(v * width + u)) <= CLOSE;
            lost += !found;
        }
    }
    return lost;
}

static size_t count_colors(const struct picture *p)
{
    size_t colors = 0, count = (size_t)p->width * p->height;
    for (size_t i = 0; i < count && colors < 8; ++i) {
        size_t j = 0;
        while (j < i && difference(p, i, p, j) > CLOSE)
            ++j;
        colors += j == i;
    }
    return colors;
}

int main(int argc, char **argv)
{
    struct picture a = {0}, b = {0};
    if (argc != 4 || (strcmp(argv[1], "colors") != 0 && strcmp(argv[1], "masks") != 0)) {
        fprintf(stderr, "usage: compare colors|masks PICTURE PICTURE.ppm\n");
        return 2;
    }
    if (!load_whit(argv[2], &a) || !load_ppm(argv[3], &b) || a.width != b.width ||
        a.height != b.height) {
        fprintf(stderr, "compare: no two pictures of one size\n");
        free(a.rgb);
        free(b.rgb);
        return 2;
    }
    double count = (double)a.width * a.height;
    size_t here = count_lost(&a, &b, 0), near = count_lost(&a, &b, 1) + count_lost(&b, &a, 1);
    int bad;
    if (strcmp(argv[1], "masks") == 0) {
        size_t colors = count_colors(&a);
        printf("%zu flat colours; pixels that differ: %zu of %.0f, by more than a pixel: %zu\n",
               colors, here, count, near);
        bad = near > 0 || colors < 3;
    } else {
        printf("within 2/255: %.3f %% of the pixels\n", 100.0 * (1.0 - (double)here / count));
        bad = (double)here > (1.0 - SHARE) * count;
    }
    free(a.rgb);
    free(b.rgb);
    return bad;
}
