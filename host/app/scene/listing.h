/* The listings of `whit scene`. */
#ifndef APP_SCENE_LISTING_H
#define APP_SCENE_LISTING_H

#include "app/job.h"

/* Both give the exit code. `all`: every item, not only the first of each kind. */
int listing_print_text(const struct job *job, const whit_scene_info *info, bool all);
/* listing_output.c */
int listing_print_json(const struct job *job, const whit_scene_info *info);

/* kernels.c, effect_report.c: --kernels and --effects, which measure on the device and print; the
   exit code. EXIT_DIFFERS where an effect that the scene does not call for changes the picture. */
int kernels_run(struct job *job, bool json);
int effect_report_run(struct job *job, bool json);

/* triangles.c: writes all triangles of the scene at `time_s` to the file `path`. Errors were
   printed. */
WHIT_CHECK whit_result triangles_write(const whit_scene *scene, double time_s, const char *path);

#endif
