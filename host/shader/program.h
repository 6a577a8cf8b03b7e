/* A user's file as a whole: its functions, its sliders, and the kernels made with it. */
#ifndef SHADER_PROGRAM_H
#define SHADER_PROGRAM_H

#include "kernels.h"
#include "shader/compile.h"
#include "shader/dbg.h"
#include "shader/tests.h"
#include "whit/whit_shader.h"

enum {
    SHADER_SLIDERS_MAX = 64, /* values of all sliders: SLIDERS_MAX of shaders/abi/shade.h */
    SHADER_NAME_BYTES = 64,
    SHADER_HELP_BYTES = 128,
    SHADER_WORDS_MAX = 16,
    SHADER_EXPECTATIONS_MAX = 16,
    SHADER_FUEL_USUAL = 10000,
    SHADER_FUEL_MAX = 30000, /* users' part of the 65,535 that lavapipe allows a group */
};

/* The strings that a whit_slider points to, and the place of its annotation. */
struct shader_slider_text {
    char name[SHADER_NAME_BYTES], help[SHADER_HELP_BYTES];
    char text[SHADER_HELP_BYTES]; /* the words of a choice, each ended by 0 */
    const char *words[SHADER_WORDS_MAX];
    uint32_t file, line;
};

/* A function with the annotation //@ aov, and the place of that. */
struct shader_aov {
    char name[SHADER_NAME_BYTES];
    uint32_t file, line;
};

/* The annotation //@ box: a box around the shape of intersect(), in world space. */
struct shader_box {
    float lo[3], hi[3];
    float error;                      /* how far an answer may be off the shape, world units */
    char material[SHADER_NAME_BYTES]; /* name of its material; unknown: the first in use */
    uint32_t file, line;              /* `line` from 1; 0: there is no box */
};

struct whit_shader {
    struct shader_text text;      /* no files in it: the shader is `stages` alone, without hooks */
    struct shader_stages *stages; /* NULL: the embedded stages */
    struct shader_tests tests;
    whit_shader_test *test_infos;
    whit_shader_check *check_infos;
    uint32_t hooks;           /* bits 1 << whit_hook */
    uint32_t fuel, fuel_line; /* fuel_line: of `//@ fuel`; 0: there is none */
    bool trust;
    whit_slider sliders[SHADER_SLIDERS_MAX];
    struct shader_slider_text slider_texts[SHADER_SLIDERS_MAX];
    uint32_t slider_count, value_count;
    whit_shader_expectation expectations[SHADER_EXPECTATIONS_MAX];
    uint32_t expectation_count;
    struct shader_aov aovs[WHIT_LAYERS_MAX];
    const char *aov_names[WHIT_LAYERS_MAX];
    uint32_t aov_count;
    struct shader_box box;
    struct shader_code codes[HOOK_KERNEL_COUNT]; /* no words: no hook is part of the kernel */
    struct shader_dbg dbg;
    /* Variants of the kernels that record dbg(x). No words: the file has no dbg(x), or the stage
       only repeats what another one records. */
    struct shader_code dbg_codes[HOOK_KERNEL_COUNT];
    const char *files[SHADER_TEXT_FILES_MAX + SHADER_STAGES_MAX];
    uint32_t file_count;
};

/* program.c */
static inline bool shader_has(const whit_shader *shader, whit_hook hook)
{
    return shader && (shader->hooks >> hook & 1);
}
/* The shader's code for the kernel of that name, "shade" for example; NULL: whit's own serves. With
   `dbg`, for a probe, rather code that records each dbg(x). */
const struct shader_code *shader_code_of(const whit_shader *shader, const char *kernel, bool dbg);
/* Whether functions of the user are part of that kernel. */
bool shader_is_hooked(const whit_shader *shader, const char *kernel);
/* Bits SHADER_REACHES_* of all of the shader's functions. */
uint32_t shader_reaches(const whit_shader *shader);
/* The place where a loop begins, by the number that a kernel reports; false: no such loop. */
bool shader_find_loop(const whit_shader *shader, uint32_t number, const char **file,
                      uint32_t *line);
/* The first place of an operation without a portable form, by its number of portable_lacks; false:
   it is not known. */
bool shader_find_open(const whit_shader *shader, uint32_t number, const char **file,
                      uint32_t *line);
/* Makes a program of a text that was read already, and of stages. It owns both from then on, also
   after an error. WHIT_ERROR_INPUT and others as whit_shader_load. A text without files needs
   stages: all kernels are then made of them alone. */
WHIT_CHECK whit_result shader_program_create(const whit_log *log, struct shader_compiler *compiler,
                                             struct shader_text *text, struct shader_stages *stages,
                                             bool trust, whit_shader **out,
                                             struct shader_errors *errors);
/* Reads the stages of a folder for shader_program_create, as shader_stages_read. *stages is NULL if
   `folder` is. */
WHIT_CHECK whit_result shader_program_stages(const whit_log *log, const char *folder,
                                             struct shader_stages **stages,
                                             struct shader_errors *errors);
void shader_program_destroy(whit_shader *shader);
/* Compiles the kernel that runs the file's tests, of which there must be some; errors as
   shader_program_create. */
WHIT_CHECK whit_result shader_program_compile_tests(const whit_log *log,
                                                    struct shader_compiler *compiler,
                                                    whit_shader *shader,
                                                    struct shader_errors *errors);
/* See whit_shader_kernel_text. NULL: no memory, which was logged. */
char *shader_program_expand(const whit_log *log, const whit_shader *shader,
                            enum hook_kernel kernel);

#endif
