/* Part of whit.h: hits held against exact arithmetic. */
#ifndef WHIT_HARD_H
#define WHIT_HARD_H

#include "whit_renderer.h"

WHIT_C_BEGIN

/* ---- Hard cases ---- */

/* Meshes and rays at which ray tracers fail, traced at every level of numerics, on the device and
   by its twin, and held against exact arithmetic: docs/numerics-evidence.md, "whit hard". */

typedef struct whit_hard_params {
    uint32_t rays;      /* per row; at least 512, which the hash needs; 0: 20000 */
    uint32_t levels;    /* bits 1u << whit_numerics; 0: all of them */
    uint32_t threads;   /* on the CPU; 0: one a core */
    const char *filter; /* runs only the built-in cases whose name contains this; NULL: runs all,
                           which the hash needs */
    bool portable;      /* as of whit_renderer_params */
    whit_instances instances; /* for `scene` as it is given; its variants and the built-in cases set
                                 their own */
    const volatile bool *cancel;
    double time_limit_s; /* not below 0; 0: none */
    void (*progress)(void *user, double done);
    void *progress_user;
} whit_hard_params;

/* A comparison of hits with those of exact arithmetic. Every count is a number of rays out of
   `rays`. */
typedef struct whit_tally {
    uint64_t rays;
    uint64_t hits;        /* rays that hit by exact arithmetic */
    uint64_t misses;      /* reported as misses, but by exact arithmetic they hit */
    uint64_t leaks;       /* misses of rays that start inside a closed surface, and misses of other
                             rays that pass neither an outline nor an open edge */
    uint64_t false_hits;  /* reported as hits, but by exact arithmetic they miss */
    uint64_t other_ids;   /* hits on another primitive than by exact arithmetic */
    uint64_t wrong_keys;  /* hits on the right primitive whose t is not the exact t rounded to
                             nearest */
    uint64_t wrong;       /* misses, false hits and other ids that exceed the level's float error
                             bounds; at WHIT_NUMERICS_EXACT all of them */
    uint64_t double_hits; /* another primitive reported at the same place, where exact arithmetic
                             finds none */
    uint64_t self_hits;   /* on the surface that the ray started from */
    double ulp_max;       /* largest error of t where the primitive is right, in ulps from the exact
                             t rounded to nearest; hits nearer to the origin than 16 roundings of
                             its coordinates are left out */
} whit_tally;

/* The result of one case at one level of numerics. */
typedef struct whit_hard_row {
    const char *name;  /* "sphere from inside" */
    const char *place; /* "1e5", "as vertices, x1e-6" */
    whit_numerics numerics;
    whit_tally tally;
    uint64_t differing;        /* rays whose hits on the device and by the twin differ in any bit */
    double device_ms, twin_ms; /* time for all rays; device_ms < 0: not measured */
    bool unanswered; /* the device reported that its hits cannot be trusted, as where a driver ends
                        long loops; the twin's hits are judged instead */
    bool promised;   /* the level promises no leaks here; false where the mesh itself has cracks */
    bool kept;       /* every promise of the level was kept */
} whit_hard_row;

typedef struct whit_hard_report {
    whit_hard_row *rows;
    uint32_t row_count;
    uint64_t hash;       /* of the exact identities of a fixed set of rays; 0 for a user's scene */
    uint64_t hash_met;   /* the same hash of the hits on the device at WHIT_NUMERICS_EXACT; 0 where
                            these were not traced */
    bool equal_bits;     /* hits on this device must equal the twin's bit for bit: it divides and
                            compares as the twin does, by itself or because of params.portable */
    uint32_t broken;     /* rows that did not keep a promise */
    uint32_t unanswered; /* rows whose `unanswered` is true */
    /* Counts for a user's scene; vertices with equal coordinates count as one, and so do the edges
       of triangles with equal corners. */
    uint64_t triangles, edges, open_edges, crowded_edges, flipped_edges, duplicates;
} whit_hard_report;

/* `scene` NULL: runs the built-in cases. `device` NULL: judges the twin's hits. Gives WHIT_OK also
   where promises are broken: see `broken`. WHIT_ERROR_USAGE for params out of range or a filter
   that matches no case, WHIT_ERROR_INPUT and WHIT_ERROR_DEVICE as of whit_accel_create and
   whit_renderer_create, WHIT_ERROR_TIME_LIMIT, WHIT_ERROR_CANCELLED. */
WHIT_CHECK whit_result whit_hard_run(whit_device *device, const whit_scene *scene,
                                     const whit_hard_params *params, const whit_log *log,
                                     whit_hard_report **out);
void whit_hard_report_destroy(whit_hard_report *report);

typedef struct whit_hard_view_params {
    uint32_t width, height; /* up to 32768; 0: 640 x 480 */
    whit_camera camera;
    double time_s;
    bool portable; /* as of whit_renderer_params */
    whit_numerics numerics;
    whit_instances instances;
    uint32_t threads;
} whit_hard_view_params;
/* Draws what camera rays hit, in grey lit from the eye. Red: the hit is wrong, a leak or an error
   beyond the bounds of the level. Yellow: another primitive than by exact arithmetic, or none,
   within these bounds. Cut-outs count as solid. `scene` NULL: the sphere of the built-in cases.
   `wrong_pixels` and `other_pixels` count red and yellow ones. Other arguments as for
   whit_hard_run. WHIT_ERROR_USAGE for params out of range or a camera that is not possible,
   WHIT_ERROR_INPUT and WHIT_ERROR_DEVICE as of whit_accel_create and whit_renderer_create,
   WHIT_ERROR_STATUS where hits cannot be trusted. */
WHIT_CHECK whit_result whit_hard_view(whit_device *device, const whit_scene *scene,
                                      const whit_hard_view_params *params, const whit_log *log,
                                      uint64_t *wrong_pixels, uint64_t *other_pixels,
                                      whit_image **out);

/* ---- Judged rays ---- */

/* Rays of a scene with their hits by exact arithmetic (docs/numerics.md), to compare other hits
   with. They are camera rays, or rays aimed at vertices, edges and triangles from in and around the
   scene's bounds, as `whit hard` makes them. Both are the same on every machine. `scene` is
   borrowed. */
typedef struct whit_judge whit_judge;
typedef struct whit_judge_params {
    bool aimed;     /* aimed rays; false: camera rays */
    uint32_t count; /* about how many rays, and never more, up to 2^24; 0: 20000. A scene without
                       triangles has no rays. */
    whit_camera camera;
    uint32_t width, height; /* of the camera's picture, which set its aspect ratio, up to 65535; 0:
                               640 x 480 */
    double time_s;
    whit_instances instances; /* must match the trees that the judged hits come from */
    uint32_t threads;         /* 0: one a core */
} whit_judge_params;
/* WHIT_ERROR_USAGE for params out of range or a camera that the scene does not have,
   WHIT_ERROR_INPUT as of whit_accel_create. */
WHIT_CHECK whit_result whit_judge_create(const whit_scene *scene, const whit_judge_params *params,
                                         const whit_log *log, whit_judge **out);
void whit_judge_destroy(whit_judge *judge);
const whit_ray *whit_judge_rays(const whit_judge *judge, uint64_t *count);

/* A comparison of hits with the exact ones, over all of a judge's rays. */
typedef struct whit_judgement {
    whit_tally tally;
    uint64_t non_finite; /* hits with a t, u or v that is NaN or infinite */
    /* Error of t where the primitive is right, in ulps from the exact t rounded to nearest; hits
       nearer than 2^-20 of the origin's coordinates are left out. ulp_rays: how many rays count. */
    uint64_t ulp_rays;
    double ulp_median, ulp_999, ulp_max; /* ulp_999: the 99.9th percentile */
} whit_judgement;
/* `hits`: one for each of the rays, in their order, found at `numerics`. WHIT_ERROR_STATUS where
   the judge's own traversals cannot be trusted, WHIT_ERROR_USAGE if `numerics` is none of
   its values. */
WHIT_CHECK whit_result whit_judge_hits(const whit_judge *judge, whit_numerics numerics,
                                       const whit_hit *hits, whit_judgement *out);

WHIT_C_END

#endif
