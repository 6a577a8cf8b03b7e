/* Tries a shader on a device with a scene: its kernels, tests and expectations. */
#ifndef APP_SHADER_ATTEMPT_H
#define APP_SHADER_ATTEMPT_H

#include "app/document.h"
#include "app/job.h"

struct attempt {
    whit_shader_info info; /* of the shader that is tried */
    whit_kernel kernels[WHIT_KERNELS_MAX], base[WHIT_KERNELS_MAX];
    uint32_t kernel_count, base_count;
    whit_check_result *checks;            /* of all tests; NULL: none were run */
    double compile_ms, driver_ms, run_ms; /* times of the tests: compilation by glslang, compilation
                                             by the driver, run on the device */
    bool held;                            /* all expectations hold */
};

/* Tries the job's shader with `scene`, or with whit's own small scene where it is NULL. Without a
   device nothing is tried: a note says so if the shader has neither tests nor expectations, else it
   is an error. Errors were printed. */
WHIT_CHECK whit_result attempt_make(struct job *job, const char *scene, struct attempt *attempt);
void attempt_finish(struct attempt *attempt); /* accepts a zeroed one */

/* Logs each failed check as an error: its place, its text, how many seeds it failed for. */
void attempt_say(const struct attempt *attempt);
/* Kernels, tests and expectations in text. */
void attempt_print(const struct attempt *attempt);
void attempt_describe(const struct attempt *attempt, json_t *object);
/* EXIT_DIFFERS where a test failed or an expectation does not hold. */
int attempt_status(const struct attempt *attempt);

#endif
