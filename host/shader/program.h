/* A user's file of hooks as a whole: its functions, its sliders, and the kernels with it. */
#ifndef SHADER_PROGRAM_H
#define SHADER_PROGRAM_H

#include "shader/compile.h"
#include "shader/dbg.h"
#include "shader/tests.h"
#include "whit/whit_shader.h"

/* The kernels that hooks are parts of. */
enum shader_kernel {
    SHADER_KERNEL_CLOSEST,
    SHADER_KERNEL_SHADE,
    SHADER_KERNEL_SHADOW,
    SHADER_KERNEL_RESOLVE,
    SHADER_KERNEL_MISS, /* from here on: of functions alone */
    SHADER_KERNEL_SHAPE,
    SHADER_KERNEL_HIT,
    SHADER_KERNEL_AOV,
    SHADER_KERNEL_POST,
    SHADER_KERNEL_TEST, /* of no picture: see tests.h */
    SHADER_KERNEL_COUNT
};

enum {
    SHADER_SLIDERS_MAX = 64, /* values of all sliders: SLIDERS_MAX of shaders/abi/shade.h */
    SHADER_NAME_BYTES = 64,
    SHADER_HELP_BYTES = 128,
    SHADER_WORDS_MAX = 16,
    SHADER_EXPECTATIONS_MAX = 16,
    SHADER_AOVS_MAX = 16,
    SHADER_FUEL_USUAL = 10000,
    SHADER_FUEL_MAX = 30000, /* what lavapipe leaves of the 65,535 iterations of a group */
};

/* What whit_slider points to, and the line that says it. */
struct shader_slider_text {
    char name[SHADER_NAME_BYTES], help[SHADER_HELP_BYTES];
    char text[SHADER_HELP_BYTES]; /* words, each ended by 0 */
    const char *words[SHADER_WORDS_MAX];
    uint32_t file, line;
};

/* A function below //@ aov, and where that line is. */
struct shader_aov {
    char name[SHADER_NAME_BYTES];
    uint32_t file, line;
};

/* What //@ box says of the shape of intersect(), in world space. */
struct shader_box {
    float lo[3], hi[3];
    float error;                      /* how far from the shape an answer may be */
    char material[SHADER_NAME_BYTES]; /* of the scene, by name; else the first that is worn */
    uint32_t file, line;              /* from 1; line 0: there is no box */
};

struct whit_shader {
    struct shader_text text;      /* without files: the stages alone */
    struct shader_stages *stages; /* NULL: those that are embedded */
    struct shader_tests tests;
    whit_shader_test *test_infos;
    whit_shader_check *check_infos;
    uint32_t hooks; /* bits 1 << whit_hook */
    uint32_t fuel;
    bool trust;
    whit_slider sliders[SHADER_SLIDERS_MAX];
    struct shader_slider_text slider_texts[SHADER_SLIDERS_MAX];
    uint32_t slider_count, value_count;
    whit_shader_expectation expectations[SHADER_EXPECTATIONS_MAX];
    uint32_t expectation_count;
    struct shader_aov aovs[SHADER_AOVS_MAX];
    const char *aov_names[SHADER_AOVS_MAX];
    uint32_t aov_count;
    struct shader_box box;
    struct shader_code codes[SHADER_KERNEL_COUNT]; /* no words where no hook is part of it */
    struct shader_dbg dbg;
    struct shader_code dbg_codes[SHADER_KERNEL_COUNT]; /* the same, that record what dbg(x) is; no
                                                          words without any, and of a stage that
                                                          does the same anew */
    const char *files[SHADER_TEXT_FILES_MAX + SHADER_STAGES_MAX];
    uint32_t file_count;
};

/* program.c */
const char *shader_kernel_name(enum shader_kernel kernel);
static inline bool shader_has(const whit_shader *shader, whit_hook hook)
{
    return shader && (shader->hooks >> hook & 1);
}
/* Its code of the kernel of that name, "shade" for example; NULL: whit's own serves. */
const struct shader_code *shader_code_of(const whit_shader *shader, const char *kernel);
/* The code of that kernel for a probe, which records the value of each dbg(x); NULL: none. */
const struct shader_code *shader_dbg_code_of(const whit_shader *shader, const char *kernel);
/* Whether functions of the user's are part of it. */
bool shader_is_hooked(const whit_shader *shader, const char *kernel);
/* Bits SHADER_REACHES_* of what its functions may come to call. */
uint32_t shader_reaches(const whit_shader *shader);
/* Where a loop begins, by the number that a kernel reports; false: no such loop. */
bool shader_find_loop(const whit_shader *shader, uint32_t number, const char **file,
                      uint32_t *line);
/* Where an operation without a portable form stands first, by the number of portable_lacks; false:
   that is not known. */
bool shader_find_open(const whit_shader *shader, uint32_t number, const char **file,
                      uint32_t *line);
/* Makes a program of a text that was read already, and of stages. Both are the program's from then
   on, also where this fails. WHIT_ERROR_INPUT and others as of whit_shader_load. A text without
   files needs stages: all kernels are made of them then. */
WHIT_CHECK whit_result shader_program_create(const whit_log *log, struct shader_compiler *compiler,
                                             struct shader_text *text, struct shader_stages *stages,
                                             bool trust, whit_shader **out,
                                             struct shader_errors *errors);
/* The stages of a folder, for it; NULL `folder`: *stages is NULL. As shader_stages_read. */
WHIT_CHECK whit_result shader_program_stages(const whit_log *log, const char *folder,
                                             struct shader_stages **stages,
                                             struct shader_errors *errors);
void shader_program_destroy(whit_shader *shader);
/* The kernel that runs its tests, which it must have; errors as above. */
WHIT_CHECK whit_result shader_program_compile_tests(const whit_log *log,
                                                    struct shader_compiler *compiler,
                                                    whit_shader *shader,
                                                    struct shader_errors *errors);
/* whit_shader_kernel_text; NULL: no memory, which was logged. */
char *shader_program_expand(const whit_log *log, const whit_shader *shader,
                            enum shader_kernel kernel);

#endif
