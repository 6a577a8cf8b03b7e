/* The best picture within a time. What is given up for time follows a fixed order and not the
   measured error, by which a picture without shadows may be as right as one with shadows. */
#include <stdlib.h>
#include <string.h>

#include "cost/within.h"

struct step {
    const char *knob, *setting;
    uint32_t samples; /* taken only if fewer samples per pixel than this fit without the step; a
                         quarter of them, at least 1, where edges get more (cost_goal) */
};

/* Settings are given up in this order, first those that the eye misses least. A step is skipped if
   the scene does not call for it or if it saves no time. Samples per pixel fill the time that the
   steps leave; few samples make rough edges, which are seen less than the later steps. The order
   follows the FLIP of docs/accuracy.md, but shadows are given up later than FLIP suggests: without
   them nobody sees where things stand. The remarks say what is lost, and with "from" which setting
   was there before. */
static const struct step order[] = {
    {"bailout", "0.0009765625", 64}, /* from 0: rays too weak to be displayed */
    {"depth", "8", 64},              /* from 16: the ninth bounce is seen in nested glass alone */
    {"light-samples", "16", 64},     /* from 64: each sample of the pixel has points of its own */
    {"bailout", "0.015625", 16},     /* rays of less than 1/64: faint mirror images in glass */
    {"light-samples", "4", 4},       /* steps in soft shadows, which samples smooth */
    {"fresnel", "schlick", 1},       /* a little more or less of a reflection */
    {"depth", "4", 1},               /* mirrors in mirrors, and the back of nested glass */
    {"terminator", "off", 1},        /* facets where light grazes */
    {"light-samples", "1", 1},       /* soft shadows get hard */
    {"bailout", "0.125", 1},         /* reflections on glass and dull metal */
    {"normal-maps", "off", 1},       /* relief */
    {"depth", "2", 1},               /* from here on things are missing, not rough */
    {"shadows", "opaque", 1},        /* glass casts a shadow like stone */
    {"depth", "1", 1},               /* nothing is seen through glass */
    {"shadows", "none", 1},          /* things hover */
    {"depth", "0", 1},               /* neither mirrors nor glass */
    {"textures", "off", 1},          /* what things are made of */
};
enum { STEPS = sizeof order / sizeof *order, SAMPLES_MOST = 64 };

/* Settings better than the usual ones, from which the search starts: they are kept where even with
   them SAMPLES_MOST samples fit. */
static const struct step careful[] = {
    {"bailout", "0", 0}, {"depth", "16", 0}, {"light-samples", "64", 0}};

static bool names(const struct step *step, const char *knob, const char *setting)
{
    return strcmp(step->knob, knob) == 0 && strcmp(step->setting, setting) == 0;
}

uint32_t cost_steps(void)
{
    return STEPS;
}

uint32_t cost_step_of(const char *knob, const char *setting)
{
    for (uint32_t i = 0; i < STEPS; ++i) {
        if (names(&order[i], knob, setting))
            return i;
    }
    return WHIT_NONE;
}

/* The index of the step's knob, and in *setting that of its setting. */
static uint32_t find(const struct step *step, uint32_t *setting)
{
    uint32_t knob = knob_find(step->knob);
    *setting = knob_find_setting(&knob_table[knob], step->setting);
    return knob;
}

/* ---- Samples ---- */

/* The effect of that many samples per pixel, by its row of knob `aa`. NULL: it was not measured. */
static const struct effect *sampled(const struct search *search, uint32_t samples)
{
    const struct knob *aa = &knob_table[search->aa];
    for (uint32_t s = 0; s < aa->count; ++s) {
        const char *name = knob_setting_name(aa, s);
        if (strtoul(name, NULL, 10) == samples)
            return search->effects[search->aa][s].known ? &search->effects[search->aa][s] : NULL;
    }
    return NULL;
}

/* The effect of a power of 4 of samples. Where it was not measured it follows from a quarter of
   them; one sample alone foretells nothing. */
static struct effect power_effect(const struct search *search, uint32_t power)
{
    const struct effect *row = sampled(search, power);
    if (row || power == 1)
        return row ? *row : (struct effect){0};
    const struct effect quarter = power_effect(search, power / 4);
    return (struct effect){
        .ratio = 4.0 * quarter.ratio,
        .error = choose_quadruple(search->report, search->goal->metric, quarter.error),
        .known = power > 4 && quarter.known};
}

/* Between powers of 4 time and error go linearly, squared errors for RMSE: the sequence fills whole
   powers evenly, other numbers of samples leave gaps. Beside 1024 samples at 96x72 the RMSE is 0.67
   to 1.2 times that in whitted, sphereflake, atrium and 8k, and up to twice it in room, where few
   pixels mirror lights. */
struct effect choose_samples(const struct search *search, uint32_t samples)
{
    uint32_t below = 1;
    while (4 * below <= samples)
        below *= 4;
    const struct effect a = power_effect(search, below);
    if (below == samples)
        return a;
    const struct effect b = power_effect(search, 4 * below);
    double share = (double)(samples - below) / (3.0 * below);
    return (struct effect){.ratio = a.ratio + share * (b.ratio - a.ratio),
                           .error = a.error + share * (b.error - a.error),
                           .known = a.known && b.known};
}

/* ---- The choice ---- */

/* Gives the effect of all knobs together, except the number of samples. */
static struct effect others_effect(const struct search *search)
{
    struct effect all = {.ratio = 1.0, .known = true};
    for (uint32_t k = 0; k < KNOBS; ++k) {
        const struct effect *effect = &search->effects[k][search->settings[k]];
        bool light = knob_change(&knob_table[k]) == SETTING_LIGHT;
        if (k == search->aa || (!light && !effect->known))
            continue;
        all.ratio *= effect->ratio;
        all.error += light ? effect->error : 0.0;
    }
    return all;
}

/* Makes the current settings, with the most samples that fit, the best choice, if these are more
   samples than the best choice has. */
static void take(struct search *search)
{
    const struct effect others = others_effect(search);
    uint32_t before = search->best.found ? search->best.samples : 0;
    for (uint32_t n = SAMPLES_MOST; n > before; n = search->goal->edges ? n / 4 : n - 1) {
        const struct effect samples = choose_samples(search, n);
        double ms = search->report->usual_ms_max * others.ratio * samples.ratio;
        if (!samples.known || ms > search->goal->limit)
            continue;
        search->best = (struct cost_choice){
            .samples = n,
            .ms = ms,
            .error = choose_from_sum(samples.error + others.error, search->goal->metric),
            .found = true};
        memcpy(search->best.settings, search->settings, sizeof search->settings);
        return;
    }
}

static void be_careful(struct search *search)
{
    for (size_t i = 0; i < sizeof careful / sizeof *careful; ++i) {
        uint32_t setting, knob = find(&careful[i], &setting);
        const struct effect *effect = &search->effects[knob][setting];
        if (effect->known && effect->error < -CHOOSE_AS_RIGHT * search->usual_bias)
            search->settings[knob] = (uint8_t)setting;
    }
}

void choose_within(struct search *search)
{
    be_careful(search);
    take(search);
    for (uint32_t i = 0; i < STEPS; ++i) {
        uint32_t setting, knob = find(&order[i], &setting);
        const struct effect *effects = search->effects[knob];
        uint32_t samples = search->goal->edges ? (order[i].samples + 3) / 4 : order[i].samples;
        if (search->best.found && search->best.samples >= samples)
            break;
        if (!effects[setting].known ||
            effects[setting].ratio >= effects[search->settings[knob]].ratio)
            continue;
        search->settings[knob] = (uint8_t)setting;
        take(search);
    }
}
