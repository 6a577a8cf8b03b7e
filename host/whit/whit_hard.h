/* Part of whit.h: hits held against exact arithmetic. */
#ifndef WHIT_HARD_H
#define WHIT_HARD_H

#include "whit_renderer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Hard cases ---- */

/* Meshes and rays at which ray tracers fail, traced at every level of numerics, on the device and
   by its twin, and held against exact arithmetic: docs/numerics.md, "whit hard". */

typedef struct whit_hard_params {
    uint32_t rays;      /* of a row: at least 512, for the hash; 0: 20000 */
    uint32_t levels;    /* bits 1u << whit_numerics; 0: all of them */
    uint32_t threads;   /* on the CPU; 0: one a core */
    const char *filter; /* of the built-in cases those with this in their name; NULL: all, and then
                           there is a hash */
    bool portable;      /* as of whit_renderer_params */
    whit_instances instances; /* of `scene` as it is given; variants and built-in cases say it */
    const volatile bool *cancel;
    double time_limit_s; /* 0: none */
    void (*progress)(void *user, double done);
    void *progress_user;
} whit_hard_params;

/* How hits compare with what exact arithmetic says. Every count is of `rays`. */
typedef struct whit_tally {
    uint64_t rays;
    uint64_t hits;        /* exactly */
    uint64_t misses;      /* of rays that hit, exactly */
    uint64_t leaks;       /* misses of rays that start inside a closed surface; of others, those
                             that pass neither an outline nor an open edge */
    uint64_t false_hits;  /* of rays that miss, exactly */
    uint64_t other_ids;   /* another primitive than exactly */
    uint64_t wrong_keys;  /* the right one, but t is not the exact t's rounding */
    uint64_t wrong;       /* of misses, false hits and other ids: no bound of float errors excuses
                             them; at WHIT_NUMERICS_EXACT all */
    uint64_t double_hits; /* a second primitive at the same place, where exactly there is none */
    uint64_t self_hits;   /* on the surface that the ray started from */
    double ulp_max;       /* error of t where the primitive is right, in floats between it and the
                             exact one's rounding; not of hits nearer than 16 roundings of the
                             origin */
} whit_tally;

/* One level at one case. */
typedef struct whit_hard_row {
    const char *name;  /* "sphere from inside" */
    const char *place; /* "1e5", "as vertices, x1e-6" */
    whit_numerics numerics;
    whit_tally tally;
    uint64_t differing;        /* rays whose hits on the device and of the twin differ by a bit */
    double device_ms, twin_ms; /* of all rays; device: < 0 where not measured */
    bool unanswered; /* the device said that its hits are not to be trusted, as where a driver ends
                        long loops: the twin's are judged */
    bool promised;   /* that there are no leaks: false for cracks that are there */
    bool kept;       /* all that the level promises */
} whit_hard_row;

typedef struct whit_hard_report {
    whit_hard_row *rows;
    uint32_t row_count;
    uint64_t hash;       /* of the exact identities of a fixed set of rays; 0 for a user's scene */
    uint64_t hash_met;   /* of the device's at WHIT_NUMERICS_EXACT; 0 when not traced */
    bool equal_bits;     /* hits of this device are to have the bits of the twin's: it divides and
                            compares as the twin does, by itself or for params.portable */
    uint32_t broken;     /* rows that did not keep a promise */
    uint32_t unanswered; /* rows without an answer of the device */
    /* Counts for a user's scene; vertices with equal coordinates count as one. */
    uint64_t triangles, edges, open_edges, crowded_edges, flipped_edges, duplicates;
} whit_hard_report;

/* `scene` NULL: the built-in cases. `device` NULL: the twin's hits are judged. WHIT_OK also where
   promises are broken: see `broken`. WHIT_ERROR_USAGE for params out of range or a filter that no
   case answers, WHIT_ERROR_INPUT and WHIT_ERROR_DEVICE as of accels and renderers,
   WHIT_ERROR_TIME_LIMIT, WHIT_ERROR_CANCELLED. */
WHIT_CHECK whit_result whit_hard_run(whit_device *device, const whit_scene *scene,
                                     const whit_hard_params *params, const whit_log *log,
                                     whit_hard_report **out);
void whit_hard_report_destroy(whit_hard_report *report);

typedef struct whit_hard_view_params {
    uint32_t width, height; /* 0: 640 x 480 */
    whit_camera camera;
    double time_s;
    bool portable; /* as of whit_renderer_params */
    whit_numerics numerics;
    whit_instances instances;
    uint32_t threads;
} whit_hard_view_params;
/* What camera rays hit, as grey lit from the eye; red where that is wrong: a leak, or beyond the
   bounds of the level's errors; yellow where it is another primitive than exactly, or none, within
   them. Cut-outs count as solid. `scene` NULL: the sphere of the built-in cases. `wrong_pixels`
   and `other_pixels` count the two. Other arguments as for whit_hard_run. WHIT_ERROR_USAGE for a
   size or camera that there is none of, WHIT_ERROR_INPUT and WHIT_ERROR_DEVICE as of accels and
   renderers, WHIT_ERROR_STATUS where hits are not to be trusted. */
WHIT_CHECK whit_result whit_hard_view(whit_device *device, const whit_scene *scene,
                                      const whit_hard_view_params *params, const whit_log *log,
                                      uint64_t *wrong_pixels, uint64_t *other_pixels,
                                      whit_image **out);

/* ---- Judged rays ---- */

/* Rays of a scene with what exact arithmetic says of them (docs/numerics.md), to hold hits against:
   those of its camera, and rays aimed at its vertices, edges and triangles (of `whit hard`: from in
   and around its bounds). Both are the same on every machine. `scene` is borrowed. */
typedef struct whit_judge whit_judge;
typedef struct whit_judge_params {
    bool aimed;     /* else from the camera */
    uint32_t count; /* about as many; 0: 20000. Of a scene without triangles none are aimed. */
    whit_camera camera;
    uint32_t width, height; /* the camera's picture, for its shape; 0: 640 x 480 */
    double time_s;
    whit_instances instances; /* whose triangles: hits that are judged are of such trees */
    uint32_t threads;         /* 0: one a core */
} whit_judge_params;
/* WHIT_ERROR_USAGE where too many rays are asked for or the scene has no such camera,
   WHIT_ERROR_INPUT as of accels. */
WHIT_CHECK whit_result whit_judge_create(const whit_scene *scene, const whit_judge_params *params,
                                         const whit_log *log, whit_judge **out);
void whit_judge_destroy(whit_judge *judge);
const whit_ray *whit_judge_rays(const whit_judge *judge, uint64_t *count);

/* How hits compare with the exact ones, over all of a judge's rays. */
typedef struct whit_judgement {
    whit_tally tally;
    uint64_t non_finite; /* hits with a t, u or v that is NaN or infinite */
    /* |dt| / t where the primitive is right, in floats between t and the exact one's rounding; not
       of hits nearer than 2^-20 of the origin's coordinates. */
    uint64_t ulp_rays;
    double ulp_median, ulp_999, ulp_max; /* ulp_999: of 99.9 % of them it is at most this */
} whit_judgement;
/* `hits`: one for each of the rays, in their order, found at `numerics`. WHIT_ERROR_STATUS where
   the judge's own traversals are not to be trusted. */
WHIT_CHECK whit_result whit_judge_hits(const whit_judge *judge, whit_numerics numerics,
                                       const whit_hit *hits, whit_judgement *out);

#ifdef __cplusplus
}
#endif

#endif
