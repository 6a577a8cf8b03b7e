/* Code that all benches of whit-bench share. */
#ifndef BENCH_BENCH_H
#define BENCH_BENCH_H

#include "app/bench/request.h"
#include "app/document.h"
#include "base/sample.h"

enum { BENCH_PATH = 2200, BENCH_GRACE_MS = 3000 };

struct bench {
    struct bench_request ask;
    const char *whit; /* path of the program whit */
    whit_device *device;
    whit_device_info device_info;
    bool is_cpu;             /* the device is a CPU: times are processor times, else wall clock */
    char folder[BENCH_PATH]; /* for files: that of --keep, or one that is removed at the end */
    struct cli_progress progress;
    uint32_t step, step_count; /* progress within the current table */
    bool has_head;             /* the text above the first table is printed already */
    json_t *tables;
};

/* Counts one step of the current table as done; an error where the user stopped the bench. */
WHIT_CHECK whit_result bench_step(struct bench *bench);
/* Finds the absolute path of whit's scene `name`, given without .json; with a `/` or a `.` it is a
   file. */
WHIT_CHECK whit_result bench_find(const struct bench *bench, const char *name,
                                  char path[BENCH_PATH]);
/* The same for any file, named from the folder of whit's scenes. False: it is not there. */
bool bench_find_beside(const struct bench *bench, const char *name, char path[BENCH_PATH]);
/* Checks, before anything is measured, that all named files can be read. */
WHIT_CHECK whit_result bench_look_for(const struct bench *bench);
void bench_file(const struct bench *bench, const char *name, char path[BENCH_PATH]);
WHIT_CHECK whit_result bench_write(const struct bench *bench, const char *name, const void *data,
                                   size_t bytes);

/* states.c: the member `key` of the state `name` in a file of states, which `whit view --replay`
   prints; a new reference, NULL: none. */
json_t *states_find(const char *path, const char *name, const char *key);

struct bench_scene {
    whit_scene *scene;
    whit_scene_info info;
    whit_accel *accel; /* made by bench_load_trees */
};
WHIT_CHECK whit_result bench_load(const char *path, struct bench_scene *scene);
/* Also builds its trees, as whit does by itself. */
WHIT_CHECK whit_result bench_load_trees(const char *path, struct bench_scene *scene);
void bench_unload(struct bench_scene *scene);

/* ---- The benches ---- */

whit_result bench_report(struct bench *bench);
whit_result bench_build(struct bench *bench);
whit_result bench_view(struct bench *bench);
whit_result bench_rays(struct bench *bench);
whit_result bench_frame(struct bench *bench);
whit_result bench_start(struct bench *bench);
whit_result bench_shaders(struct bench *bench);
whit_result bench_views(struct bench *bench);
whit_result bench_look(struct bench *bench);

#endif
