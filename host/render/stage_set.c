/* The kernels that draw a picture together: which stages have one, which of them stay when a user's
   file changes, and which are made later than the rest. */
#include <string.h>

#include "base/threads.h"
#include "device/device.h"
#include "device/pipeline.h"
#include "render/stage_set.h"

/* Generations that are recorded for the first tile, before it is known how many there are. */
enum { EXPECTED_FIRST = 4 };

/* Makes two stages share one kernel if their constants differ only in SPEC_GENERATIONS. */
static void share_kernel(struct stages_job *job, enum stage first, enum stage later)
{
    struct gpu_spec spec = job->stages[first].spec;
    if (!job->wanted[later])
        return;
    spec.SPEC_GENERATIONS = job->stages[later].spec.SPEC_GENERATIONS;
    if (memcmp(&spec, &job->stages[later].spec, sizeof spec) != 0)
        return;
    job->stages[later].spec.SPEC_GENERATIONS = 3;
    job->wanted[first] = false;
    job->of[first] = later;
}

/* Decides which hits ask for light that the shadow stages bring, and leaves these stages out if
   none does. `apart`: some tiles are shaded without STAGE_SHADE_DIRECT. */
static void choose_who_asks(struct stages_job *job, const whit_shader *shader, bool apart)
{
    /* A user's shade() has added the light itself; only shadow catchers still ask for it. */
    bool may = !shader_has(shader, WHIT_HOOK_SHADE) || job->spec.SPEC_CATCHERS;
    const struct gpu_spec *plain = &job->stages[STAGE_SHADE].spec,
                          *glass = &job->stages[STAGE_SHADE_GLASS].spec;
    bool glass_asks = may && job->classes == CLASSES_MAX && glass->SPEC_LIGHTS;
    bool plain_asks = may && plain->SPEC_LIGHTS;
    job->asks = plain_asks || glass_asks;
    job->asks_directly = glass_asks || (plain_asks && job->spec.SPEC_NUMERICS == NUMERICS_EXACT);
    if (!job->asks)
        job->wanted[STAGE_SHAPE_LIGHT] = false;
    if (!(apart ? job->asks : job->asks_directly))
        job->wanted[STAGE_SHADOW] = job->wanted[STAGE_SHADOW_LATER] = false;
}

void stages_job_init(const struct target *target, const struct gpu_spec *spec, bool own, bool few,
                     struct stages_job *job)
{
    const struct renderer *renderer = target->renderer;
    const whit_shader *shader = renderer->params.shader;
    *job = (struct stages_job){.spec = *spec};
    job->classes = own ? variant_classes(target) : 1;
    bool direct = own && !few && variant_lights_directly(target, spec, job->classes);
    /* Timed tiles are shaded without it, so that each light has its time. */
    bool apart = !direct || renderer->params.time_stages;
    bool splits = variant_splits_hits(target);
    for (int i = 0; i < STAGE_COUNT; ++i) {
        job->of[i] = (enum stage)i;
        bool later = i == STAGE_CLOSEST || i == STAGE_SHADOW_LATER || i == STAGE_RESOLVE_LATER;
        bool part = i == STAGE_HIT_FETCH || i == STAGE_HIT_CALL;
        job->wanted[i] = (!later || renderer->has_secondary) && (i != STAGE_SHADE || apart) &&
                         (i != STAGE_SHADE_DIRECT || direct) && (!part || splits) &&
                         (i != STAGE_HIT || !splits) &&
                         (i != STAGE_MISS || shader_has(shader, WHIT_HOOK_MISS)) &&
                         (i != STAGE_SHAPE || shader_has(shader, WHIT_HOOK_INTERSECT)) &&
                         (i != STAGE_SHAPE_LIGHT ||
                          (shader_has(shader, WHIT_HOOK_INTERSECT) && spec->SPEC_SHADOWS)) &&
                         (i != STAGE_HIT || shader_has(shader, WHIT_HOOK_SURFACE) ||
                          shader_has(shader, WHIT_HOOK_SHADE)) &&
                         (i != STAGE_AOV || spec->SPEC_AOVS > 0) &&
                         (i != STAGE_POST || shader_has(shader, WHIT_HOOK_POST)) &&
                         (i != STAGE_SHADE_GLASS || job->classes == CLASSES_MAX);
        if (job->wanted[i] || i == STAGE_SHADE)
            variant_job_init(target, spec, job->classes, (enum stage)i, &job->stages[i]);
    }
    choose_who_asks(job, shader, apart);
    job->stages[STAGE_RESOLVE].spec.SPEC_DIRECT = direct;
    job->stages[STAGE_RESOLVE_LATER].spec.SPEC_DIRECT = direct;
    /* Without packets, the shadow rays of all generations have the same code. */
    share_kernel(job, STAGE_SHADOW, STAGE_SHADOW_LATER);
    if (!few)
        return;
    share_kernel(job, STAGE_CAMERA, STAGE_CLOSEST);
    share_kernel(job, STAGE_RESOLVE, STAGE_RESOLVE_LATER);
}

/* A set in the making: its kernels are made in parallel, by as many threads as there are. */
struct set_making {
    struct device *device;
    const struct stages_job *job;
    struct stage_set *set;
    whit_result results[STAGE_COUNT];
};

static void make_stage(void *context, uint32_t i)
{
    struct set_making *making = context;
    if (making->job->wanted[i])
        making->results[i] =
            variant_job_run(making->device, &making->job->stages[i], &making->set->passes[i]);
}

whit_result stages_job_run(struct device *device, const struct stages_job *job,
                           struct stage_set *out)
{
    struct set_making making = {.device = device, .job = job, .set = out};
    whit_result result = WHIT_OK;
    *out = (struct stage_set){.classes = job->classes,
                              .asks = job->asks,
                              .asks_directly = job->asks_directly,
                              .hit_rows = variant_hit_rows(&job->spec),
                              .lights_each = job->spec.SPEC_LIGHTS_EACH,
                              .shares_hits = job->spec.SPEC_LIGHTS_EACH > 1};
    memcpy(out->of, job->of, sizeof out->of);
    for (uint32_t i = 0; i < job->classes; ++i)
        out->calls[i] = variant_calls_rays(&job->stages[STAGE_SHADE + i].spec) ||
                        job->spec.SPEC_PROBE; /* a probe records sums */
    threads_for(device_compile_threads(device), STAGE_COUNT, make_stage, &making);
    for (int i = 0; result == WHIT_OK && i < STAGE_COUNT; ++i)
        result = making.results[i];
    if (result != WHIT_OK)
        stage_set_finish(out);
    return result;
}

void stage_set_finish(struct stage_set *set)
{
    for (int i = 0; i < STAGE_COUNT; ++i)
        pass_finish(&set->passes[i]);
    *set = (struct stage_set){0};
}

bool stage_set_is_made(const struct stage_set *set)
{
    return set->passes[set->of[STAGE_CAMERA]].pipeline != NULL;
}

whit_result stages_bind(struct target *target)
{
    struct stages *stages = &target->stages;
    whit_result result = WHIT_OK;
    if (stages->set.passes[stages->set.of[STAGE_CAMERA]].set)
        return WHIT_OK;
    for (int i = 0; result == WHIT_OK && i < STAGE_COUNT; ++i) {
        if (stages->set.passes[i].pipeline)
            result = variant_bind_stage(target, &stages->set.passes[i]);
    }
    stages->expected = !target->renderer->has_secondary    ? 1
                       : stages->expected > EXPECTED_FIRST ? stages->expected
                                                           : EXPECTED_FIRST;
    if (result != WHIT_OK)
        stages_unbind(stages);
    return result;
}

static void count_instructions(struct target *target)
{
    target->stats.kernel_instructions = 0;
    for (int i = 0; i < STAGE_COUNT; ++i) {
        const struct pass *pass = &target->stages.set.passes[i];
        struct pipeline_info info = {0};
        bool idle = i == STAGE_HIT_FETCH && target->stages.set.passes[STAGE_HIT].pipeline;
        if (pass->pipeline && !idle)
            pipeline_get_info(pass->pipeline, &info);
        target->stats.kernel_instructions += info.instructions;
    }
}

whit_result stages_take(struct target *target, struct stage_set *set)
{
    stage_set_finish(&target->stages.set);
    target->stages.set = *set;
    *set = (struct stage_set){0};
    count_instructions(target);
    return stages_bind(target);
}

/* Whether two stages have different kernels. `closely`: if their SPIR-V differs, both are
   specialized and compared again. That is not done where a second, deferred kernel exists, which
   would not be compared. */
static bool is_other(const struct variant_job *a, const struct variant_job *b, bool closely)
{
    struct gpu_spec second;
    bool same_words = a->params.spirv_bytes == b->params.spirv_bytes &&
                      memcmp(a->params.spirv, b->params.spirv, a->params.spirv_bytes) == 0;
    return memcmp(&a->spec, &b->spec, sizeof a->spec) != 0 ||
           (!same_words && !(closely && !variant_defers(&b->params, &second) &&
                             pipeline_is_same(&a->params, &b->params)));
}

/* Drops from `job` the kernels that are the same as in `was`. */
static void drop_same(const struct stages_job *was, struct stages_job *job)
{
    /* These stages have functions of the user's file. A change of one function may renumber the
       SPIR-V ids in the kernels of the others. */
    static const enum stage own[] = {STAGE_SHAPE, STAGE_SHAPE_LIGHT, STAGE_HIT, STAGE_HIT_CALL,
                                     STAGE_AOV,   STAGE_MISS,        STAGE_POST};
    for (int i = 0; i < STAGE_COUNT; ++i) {
        bool closely = false;
        for (size_t k = 0; k < sizeof own / sizeof *own; ++k)
            closely |= (int)own[k] != i && was->wanted[own[k]] && job->wanted[own[k]];
        job->wanted[i] = job->wanted[i] &&
                         (!was->wanted[i] || is_other(&was->stages[i], &job->stages[i], closely));
    }
}

/* If a new version of shade() needs another kernel and `splits`, `job` gets the kernels of its two
   parts, and the whole kernel is left to stages_complete. Removes outdated kernels from `set`. */
static void put_off_hits(bool splits, struct stage_set *set, struct stages_job *job)
{
    if (!splits || job->wanted[STAGE_HIT_FETCH])
        pass_finish(&set->passes[STAGE_HIT_FETCH]);
    if (!splits || job->wanted[STAGE_HIT_CALL])
        pass_finish(&set->passes[STAGE_HIT_CALL]);
    if (splits && job->wanted[STAGE_HIT_CALL])
        pass_finish(&set->passes[STAGE_HIT]);
    bool needed = splits && !set->passes[STAGE_HIT].pipeline;
    job->wanted[STAGE_HIT_FETCH] = needed && !set->passes[STAGE_HIT_FETCH].pipeline;
    job->wanted[STAGE_HIT_CALL] = needed && !set->passes[STAGE_HIT_CALL].pipeline;
}

whit_result stages_replace(struct target *target, const whit_shader *before)
{
    struct renderer *renderer = target->renderer;
    struct stage_set *set = &target->stages.set, made;
    const whit_shader *shader = renderer->params.shader;
    struct stages_job was, job;
    struct gpu_spec spec;
    bool few = variant_few_kernels(target);
    renderer->kept.known &= stage_set_is_made(set);
    if (!stage_set_is_made(set))
        return WHIT_OK;
    renderer->params.shader = before;
    spec = variant_spec(target);
    stages_job_init(target, &spec, true, few, &was);
    renderer->params.shader = shader;
    spec = variant_spec(target);
    stages_job_init(target, &spec, true, few, &job);
    drop_same(&was, &job);
    put_off_hits(variant_splits_hits(target), set, &job);
    for (int i = 0; i < STAGE_COUNT; ++i)
        renderer->kept.known &= !job.wanted[i] || i == STAGE_AOV || i == STAGE_POST;
    renderer->kept.aovs &= !job.wanted[STAGE_AOV];
    whit_result result = stages_job_run(renderer->device, &job, &made);
    if (result != WHIT_OK) {
        stage_set_finish(set);
        return result;
    }
    stages_unbind(&target->stages);
    for (int i = 0; i < STAGE_COUNT; ++i) {
        if (job.wanted[i])
            pass_finish(&set->passes[i]);
        else
            made.passes[i] = set->passes[i];
    }
    *set = made;
    count_instructions(target);
    return WHIT_OK;
}

/* Makes the kernels that the set lacks. The kernel of shade() takes the place of its two parts. */
static whit_result make_missing(struct target *target)
{
    struct stage_set *set = &target->stages.set, made;
    struct gpu_spec spec = variant_spec(target);
    struct stages_job job;
    stages_job_init(target, &spec, true, variant_few_kernels(target), &job);
    for (int i = 0; i < STAGE_COUNT; ++i)
        job.wanted[i] = job.wanted[i] && !set->passes[i].pipeline;
    whit_result result = stages_job_run(target->renderer->device, &job, &made);
    if (result != WHIT_OK)
        return result;
    stages_unbind(&target->stages);
    for (int i = 0; i < STAGE_COUNT; ++i) {
        if (job.wanted[i])
            set->passes[i] = made.passes[i];
    }
    memcpy(set->of, made.of, sizeof set->of);
    if (set->passes[STAGE_HIT].pipeline)
        pass_finish(&set->passes[STAGE_HIT_CALL]);
    target->stages.times.tiles = 0; /* the first tile makes machine code, and is not timed */
    count_instructions(target);
    return WHIT_OK;
}

whit_result stages_complete(struct target *target)
{
    const struct pass *passes = target->stages.set.passes;
    bool parts = passes[STAGE_HIT_CALL].pipeline && !variant_splits_hits(target);
    bool apart = (target->renderer->params.time_stages || target->stages.no_direct) &&
                 passes[STAGE_SHADE_DIRECT].pipeline && !passes[STAGE_SHADE].pipeline;
    whit_result result = parts || apart ? make_missing(target) : WHIT_OK;
    return result == WHIT_OK ? stages_bind(target) : result;
}

whit_result stages_compile(struct target *target)
{
    struct stages_job job;
    struct stage_set set;
    struct gpu_spec spec = variant_spec(target);
    if (stage_set_is_made(&target->stages.set))
        return stages_bind(target);
    stages_job_init(target, &spec, true, variant_few_kernels(target), &job);
    whit_result result = stages_job_run(target->renderer->device, &job, &set);
    if (result == WHIT_OK)
        result = stages_take(target, &set);
    return result == WHIT_OK ? translation_share(target, &job) : result;
}

void stages_unbind(struct stages *stages)
{
    for (int i = 0; i < STAGE_COUNT; ++i)
        pass_unbind(&stages->set.passes[i]);
    stages->blocks_max = 0;
}
