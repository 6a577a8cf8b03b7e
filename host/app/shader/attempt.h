/* A shader on a device, beside a scene: its kernels, its tests and what it expects. */
#ifndef APP_SHADER_ATTEMPT_H
#define APP_SHADER_ATTEMPT_H

#include "app/document.h"
#include "app/job.h"

struct attempt {
    bool tried; /* there was a device */
    whit_kernel kernels[WHIT_KERNELS_MAX], base[WHIT_KERNELS_MAX];
    uint32_t kernel_count, base_count;
    whit_check_result *checks;            /* of all tests; NULL: none were run */
    double compile_ms, driver_ms, run_ms; /* of tests: by glslang, by the driver, on the device */
    bool expected, held;                  /* something; all of it is so */
};

/* Beside `scene`, or without one whit's own small scene. Where no device can be opened nothing is
   tried if nothing needs one, which is noted; else it is an error. Failures were said. */
WHIT_CHECK whit_result attempt_make(struct job *job, const char *scene, struct attempt *attempt);
void attempt_finish(struct attempt *attempt); /* accepts a zeroed one */

/* Logs each failed check as an error: its place, its text, how many seeds it failed for. */
void attempt_say(const struct attempt *attempt, const whit_shader *shader);
/* Kernels, tests and expectations in text. */
void attempt_print(const struct attempt *attempt, const whit_shader *shader);
void attempt_describe(const struct attempt *attempt, const whit_shader *shader, json_t *object);
/* EXIT_DIFFERS where a test failed or an expectation is not so. */
int attempt_status(const struct attempt *attempt, const whit_shader *shader);

#endif
