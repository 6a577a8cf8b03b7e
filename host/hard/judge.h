/* The judge of hits. */
#ifndef HARD_JUDGE_H
#define HARD_JUDGE_H

#include "hard/rays.h"

/* Adds counts of other rays. */
void hard_add_tally(whit_tally *sum, const whit_tally *more);

struct hard_judgement {
    const struct hard_scene *hard;
    const struct hard_ray *rays;
    const struct rational_hit *exact;
    const struct gpu_hit *hits;
    uint32_t numerics; /* NUMERICS_* of the level that is judged */
    uint64_t count;
};

/* rational_trace of every ray. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result hard_trace_exact(const struct hard_scene *hard, const struct hard_ray *rays,
                                        uint64_t count, uint32_t thread_count,
                                        struct rational_hit *exact);
/* The hits by the twin. */
WHIT_CHECK whit_result hard_trace_twin(const struct hard_scene *hard, uint32_t numerics,
                                       const struct hard_ray *rays, uint64_t count,
                                       uint32_t thread_count, struct gpu_hit *hits);
WHIT_CHECK whit_result hard_judge(const struct hard_judgement *judgement, uint32_t thread_count,
                                  whit_tally *tally);
/* The number of float steps between the two. */
double hard_ulps_between(float a, float b);
/* Whether t lies farther from the origin than 2^-20 of the origin's coordinates, 16 times their
   rounding. */
bool hard_goes_far(const struct gpu_ray *ray, float t);
/* The number of rays whose hits differ in any bit. */
uint64_t hard_count_differing(const struct gpu_hit *a, const struct gpu_hit *b, uint64_t count);
/* Hashes the (instance, primitive) pairs of exact hits; `value` is the hash to continue from. */
uint64_t hard_hash(uint64_t value, const struct rational_hit *exact, uint64_t count);

/* Whether all promises of the level `numerics` are kept; `promised`: they include that there are no
   leaks. */
bool hard_promise_kept(uint32_t numerics, bool promised, const whit_tally *tally);

#endif
