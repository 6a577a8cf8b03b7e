/* A picture is worth the name when it is finite, of the expected size, and neither black nor of one
   colour:
       picture_check PICTURE WIDTH HEIGHT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "whit.h"

static void on_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fprintf(stderr, "picture_check: %s\n", message);
}

/* Pixels that differ from their right neighbour. */
static uint32_t count_steps(const float *pixels, const whit_image_info *info)
{
    uint32_t steps = 0;
    for (uint32_t y = 0; y < info->height; ++y) {
        for (uint32_t x = 0; x + 1 < info->width; ++x) {
            const float *a = pixels + (size_t)(y * info->width + x) * info->channels;
            float difference = 0.0f;
            for (uint32_t c = 0; c < 3; ++c)
                difference += fabsf(a[c] - a[c + info->channels]);
            steps += difference > 1.0f / 512.0f;
        }
    }
    return steps;
}

static const char *find_fault(const whit_image *image, unsigned long width, unsigned long height)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    const float *pixels = whit_image_floats(image);
    if (!pixels || info.channels < 3 || info.width != width || info.height != height)
        return "it has another size or kind";
    double sum = 0.0;
    size_t count = (size_t)info.width * info.height * info.channels;
    for (size_t i = 0; i < count; ++i) {
        if (!isfinite(pixels[i]) || pixels[i] < 0.0f)
            return "it has a value that is negative or not finite";
        sum += (double)pixels[i];
    }
    if (sum / (double)count < 0.01)
        return "it is black";
    if (count_steps(pixels, &info) < info.width * info.height / 32)
        return "it shows hardly anything";
    return NULL;
}

int main(int argc, char **argv)
{
    const whit_log log = {.fn = on_message, .level = WHIT_LOG_WARNING};
    whit_image *image;
    if (argc != 4) {
        fprintf(stderr, "usage: picture_check PICTURE WIDTH HEIGHT\n");
        return 2;
    }
    if (whit_image_load(argv[1], &log, &image) != WHIT_OK)
        return EXIT_FAILURE;
    const char *fault = find_fault(image, strtoul(argv[2], NULL, 10), strtoul(argv[3], NULL, 10));
    whit_image_destroy(image);
    if (fault)
        fprintf(stderr, "%s: %s\n", argv[1], fault);
    return fault ? EXIT_FAILURE : EXIT_SUCCESS;
}
