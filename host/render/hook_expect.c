/* Expectations of a user's file about what its functions do not change: draws the same picture
   without them, and reports what differs. */
#include <stdio.h>
#include <string.h>

#include "image/image.h"
#include "render/renderer.h"

/* The two pictures: with the user's functions, and without. Index 0 of images is `own`. */
struct pair {
    struct renderer *own, *base;
    struct image ids[2], colors[2];
};

static void say(const struct pair *pair, const whit_shader_expectation *expected, const char *found)
{
    log_error(&pair->own->log, "%s:%u: `%s == base` does not hold: %s", expected->file,
              expected->line, expected->word, found);
}

static const uint32_t *pixel_of(const struct image *image, uint64_t index)
{
    const uint32_t *words = image->words ? image->words : (const uint32_t *)image->pixels;
    return words + index * image->channels;
}

/* Describes what a pixel shows: what its camera ray meets, or its colour. */
static void write_pixel(const struct image *image, uint64_t index, char *text, size_t bytes)
{
    const uint32_t *words = pixel_of(image, index);
    const float *color = (const float *)words;
    if (!image->words)
        snprintf(text, bytes, "%.9g %.9g %.9g", (double)color[0], (double)color[1],
                 (double)color[2]);
    else if (words[0] == HIT_NONE)
        snprintf(text, bytes, "nothing");
    else
        snprintf(text, bytes, "instance %u primitive %u", words[0], words[1]);
}

/* Whether all pixels of two images have the same bytes. `differ`: what is said of those that do
   not. */
static bool images_hold(const struct pair *pair, const whit_shader_expectation *expected,
                        const struct image images[2], const char *differ)
{
    const struct image *own = &images[0], *base = &images[1];
    uint64_t pixels = (uint64_t)own->width * own->height, first = 0, count = 0;
    char found[384], shown[2][64];
    for (uint64_t i = 0; i < pixels; ++i) {
        if (memcmp(pixel_of(own, i), pixel_of(base, i), own->channels * sizeof(uint32_t)) != 0)
            first = count++ ? first : i;
    }
    if (!count)
        return true;
    for (int i = 0; i < 2; ++i)
        write_pixel(&images[i], first, shown[i], sizeof shown[i]);
    snprintf(found, sizeof found,
             "%llu of %llu pixels %s, the first at %llu,%llu: %s, and without the shader %s",
             (unsigned long long)count, (unsigned long long)pixels, differ,
             (unsigned long long)first % own->width, (unsigned long long)first / own->width,
             shown[0], shown[1]);
    say(pair, expected, found);
    return false;
}

static bool rays_hold(const struct pair *pair, const whit_shader_expectation *expected)
{
    whit_stats stats[2];
    renderer_get_stats(pair->own, &stats[0]);
    renderer_get_stats(pair->base, &stats[1]);
    uint64_t counts[2] = {0};
    for (int i = 0; i < 2; ++i) {
        const uint64_t kinds[] = {stats[i].rays_primary, stats[i].rays_shadow,
                                  stats[i].rays_reflected, stats[i].rays_refracted,
                                  stats[i].rays_straight};
        for (uint32_t k = 0; k < 5; ++k) {
            bool wanted = expected->what == WHIT_EXPECT_RAYS ||
                          (uint32_t)expected->what == (uint32_t)WHIT_EXPECT_CAMERA + k;
            counts[i] += wanted ? kinds[k] : 0;
        }
    }
    char found[128];
    if (counts[0] == counts[1])
        return true;
    snprintf(found, sizeof found, "%llu rays, and without the shader %llu",
             (unsigned long long)counts[0], (unsigned long long)counts[1]);
    say(pair, expected, found);
    return false;
}

static bool expects(const whit_shader *shader, whit_expected what)
{
    for (uint32_t i = 0; i < shader->expectation_count; ++i) {
        if (shader->expectations[i].what == what)
            return true;
    }
    return false;
}

/* A picture that was refined has no identities: those are of the first sample. */
static void say_unknown_ids(const struct pair *pair, const whit_shader *shader)
{
    for (uint32_t i = 0; pair->own->params.sampling.first && i < shader->expectation_count; ++i) {
        const whit_shader_expectation *expected = &shader->expectations[i];
        if (expected->what == WHIT_EXPECT_IDS)
            log_error(&pair->own->log, "%s:%u: `ids == base` cannot be checked in this picture",
                      expected->file, expected->line);
    }
}

static whit_result read_pair(struct pair *pair, const whit_shader *shader)
{
    whit_result result = WHIT_OK;
    say_unknown_ids(pair, shader);
    for (int i = 0; i < 2; ++i) {
        struct renderer *renderer = i == 0 ? pair->own : pair->base;
        if (result == WHIT_OK && expects(shader, WHIT_EXPECT_IDS))
            result = renderer_read_ids(renderer, &pair->ids[i]);
        if (result == WHIT_OK && expects(shader, WHIT_EXPECT_PIXELS))
            result = renderer_read_color(renderer, &pair->colors[i]);
    }
    return result;
}

static whit_result draw_base(struct pair *pair)
{
    whit_renderer_params params = pair->own->params;
    params.shader = NULL;
    params.effects_removed &= ~pair->own->effects_unasked;
    params.progress = NULL;
    params.step = NULL;
    params.step_aov = 0;
    whit_result result =
        renderer_create(&pair->own->log, pair->own->device, pair->own->accel, &params, &pair->base);
    return result == WHIT_OK ? renderer_render(pair->base) : result;
}

whit_result renderer_check_expectations(struct renderer *renderer, bool *held)
{
    const whit_shader *shader = renderer->params.shader;
    struct pair pair = {.own = renderer};
    *held = true;
    if (!shader || !shader->expectation_count)
        return WHIT_OK;
    whit_result result = draw_base(&pair);
    if (result == WHIT_OK)
        result = read_pair(&pair, shader);
    for (uint32_t i = 0; result == WHIT_OK && i < shader->expectation_count; ++i) {
        const whit_shader_expectation *expected = &shader->expectations[i];
        bool holds = expected->what == WHIT_EXPECT_IDS
                         ? images_hold(&pair, expected, pair.ids, "meet something else")
                     : expected->what == WHIT_EXPECT_PIXELS
                         ? images_hold(&pair, expected, pair.colors, "have another colour")
                         : rays_hold(&pair, expected);
        *held = *held && holds;
    }
    for (int i = 0; i < 2; ++i) {
        image_finish(&pair.ids[i]);
        image_finish(&pair.colors[i]);
    }
    renderer_destroy(pair.base);
    return result;
}
