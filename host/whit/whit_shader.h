/* Part of whit.h: files of GLSL functions that stand in the place of whit's own (docs/shaders.md).
 */
#ifndef WHIT_SHADER_H
#define WHIT_SHADER_H

#include "whit_types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WHIT_SHADER_VERSION 1 /* of what such files may use; they name it as `//@ whit 1` */

/* Compiles such files, in a process of its own that is kept for the next file. */
typedef struct whit_shader_compiler whit_shader_compiler;

/* A zeroed one means the defaults. */
typedef struct whit_shader_limits {
    double cpu_s; /* of the processor, for each kernel; 0: 0.8 with functions, 5 of tests and of
                     stages */
    uint64_t memory_bytes; /* of the compiler; 0: 1 GiB */
    bool require_sandbox;  /* where it cannot be locked in: an error in place of a warning */
    const volatile bool *cancel;
} whit_shader_limits;

/* Best made before scenes are loaded: its process has the memory of the caller as it then is.
   `limits` may be NULL. Used by one thread at a time. No errors but WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_shader_compiler_create(const whit_shader_limits *limits,
                                                   const whit_log *log, whit_shader_compiler **out);
void whit_shader_compiler_destroy(whit_shader_compiler *compiler);

/* What is wrong with a file, and where. */
typedef struct whit_shader_error {
    const char *file; /* as it was named */
    uint32_t line;    /* from 1; 0: the file as a whole */
    const char *reason;
    uint32_t column; /* of the token that the reason quotes, from 1, in bytes; 0: not known */
} whit_shader_error;
/* The first of those of the last call of whit_shader_load: their number. They live up to the next
   call. */
uint32_t whit_shader_compiler_errors(const whit_shader_compiler *compiler,
                                     const whit_shader_error **errors);
/* How many there were besides. */
uint32_t whit_shader_compiler_errors_left(const whit_shader_compiler *compiler);

/* Reads the file with all that it includes, or the functions that a .png or .exr carries under
   WHIT_SHADER_KEY, and compiles the kernels that its functions are part of.
   `trust`: its loops and indices are not bounded. WHIT_ERROR_INPUT with what is wrong in the log,
   each as "FILE:line: reason"; WHIT_ERROR_CANCELLED; WHIT_ERROR_USAGE without a sandbox that is
   required. */
WHIT_CHECK whit_result whit_shader_load(whit_shader_compiler *compiler, const char *path,
                                        bool trust, whit_shader **out);
/* The same with the stages of a checkout in place of those that are built in: `stages` is its
   folder shaders/, whose kernel/ is compiled with all that it includes below the folder. `path`
   NULL: they alone. What is in them is taken as whit's own: nothing in it is bounded.
   WHIT_ERROR_INPUT and others as above, for errors in them too, which stand there with file and
   line; a file of abi/ that is not the one whit was built with is one. */
WHIT_CHECK whit_result whit_shader_load_stages(whit_shader_compiler *compiler, const char *path,
                                               const char *stages, bool trust, whit_shader **out);
void whit_shader_destroy(whit_shader *shader);

typedef enum whit_slider_kind {
    WHIT_SLIDER_NUMBER = 0,
    WHIT_SLIDER_COLOR,
    WHIT_SLIDER_TOGGLE,
    WHIT_SLIDER_CHOICE,
} whit_slider_kind;

/* A value of the file that needs no other kernel: whit_renderer_params.sliders. All texts live as
   long as the shader. */
typedef struct whit_slider {
    const char *name, *help; /* help: "" without one */
    whit_slider_kind kind;
    float min, max;           /* NUMBER */
    float value[3];           /* that the file gives; COLOR: sRGB, 0..1; TOGGLE: 0 or 1; CHOICE:
                                 number of the word, from 0 */
    const char *const *words; /* CHOICE */
    uint32_t word_count;
    uint32_t first; /* of its values among those of all sliders; a COLOR has three */
} whit_slider;

/* A test of the file and the checks in it; they are in the order of files and lines. All texts live
   as long as the shader. */
typedef struct whit_shader_test {
    const char *name, *file;
    uint32_t line;                     /* of its function */
    uint32_t first_check, check_count; /* in whit_shader_info.checks */
} whit_shader_test;
typedef struct whit_shader_check {
    const char *text, *file; /* what stands in its brackets, cut where it is long */
    uint32_t line;
} whit_shader_check;

/* `//@ expect WHAT == base`: what its functions may not change of a picture. */
typedef enum whit_expected {
    WHIT_EXPECT_IDS = 0, /* what each pixel's first sample hits */
    WHIT_EXPECT_PIXELS,  /* every bit of every colour */
    WHIT_EXPECT_RAYS,    /* numbers of rays of all kinds, or of one: */
    WHIT_EXPECT_CAMERA,
    WHIT_EXPECT_SHADOW,
    WHIT_EXPECT_REFLECTED,
    WHIT_EXPECT_REFRACTED,
} whit_expected;
typedef struct whit_shader_expectation {
    whit_expected what;
    const char *word; /* as the file writes it: "rays.shadow" */
    const char *file;
    uint32_t line;
} whit_shader_expectation;

/* Whit's functions that such files stand in for. */
typedef enum whit_hook {
    WHIT_HOOK_CAMERA = 0,
    WHIT_HOOK_SURFACE,
    WHIT_HOOK_SHADE,
    WHIT_HOOK_SCATTER,
    WHIT_HOOK_MISS,
    WHIT_HOOK_POST,
    WHIT_HOOK_AOV,       /* functions of any name below //@ aov */
    WHIT_HOOK_INTERSECT, /* with //@ box */
    WHIT_HOOKS,          /* how many there are */
} whit_hook;
/* "camera", "surface", ... as files name them. */
const char *whit_hook_name(whit_hook hook);

/* What a file is made of. All texts live as long as the shader. */
typedef struct whit_shader_info {
    const char *const *files; /* the file and what it includes, as whit opened them */
    uint32_t file_count;
    uint32_t hooks; /* bits 1u << whit_hook: functions that it stands in for */
    const whit_slider *sliders;
    uint32_t slider_count;
    const whit_shader_test *tests;
    const whit_shader_check *checks;
    uint32_t test_count, check_count;
    const whit_shader_expectation *expectations;
    uint32_t expectation_count;
    const char *const *aovs; /* names of its functions beside the colour: WHIT_AOV_SHADER */
    uint32_t aov_count;
    uint32_t dbg_count; /* dbg(x) in all files: whit_probe_report.calls */
    uint32_t fuel;      /* iterations of loops that a call may take; 0: trusted */
    uint32_t kernel_count;
    uint32_t instructions; /* SPIR-V, of all kernels, with all that they may need */
    uint64_t hash;         /* of the texts of all files */
} whit_shader_info;
void whit_shader_get_info(const whit_shader *shader, whit_shader_info *info);

/* Compiles the kernel that runs the file's tests; pictures do without. Errors as of
   whit_shader_load, and WHIT_ERROR_USAGE for a file without tests. */
WHIT_CHECK whit_result whit_shader_compile_tests(whit_shader_compiler *compiler,
                                                 whit_shader *shader);

/* What a check of a test found for the seeds 0 to WHIT_TEST_SEEDS - 1. */
#define WHIT_TEST_SEEDS 4096
typedef struct whit_check_result {
    bool reached;        /* for one seed at least: what is never reached says nothing */
    uint32_t failed;     /* seeds that it failed for */
    uint32_t first_seed; /* the smallest of them; 0 where there is none */
} whit_check_result;
/* Runs all tests of the renderer's shader, of which whit_shader_compile_tests was called, beside
   its scene. `results`: one for each of whit_shader_info.checks. *compile_ms: of the kernel by the
   driver; *run_ms: with reading back. WHIT_ERROR_STATUS where a loop had no fuel left, logged with
   FILE:line; WHIT_ERROR_USAGE without a device or tests; WHIT_ERROR_DEVICE, WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_renderer_run_tests(whit_renderer *renderer, whit_check_result *results,
                                               double *compile_ms, double *run_ms);

/* Draws the picture that was rendered last once more, without the shader, and compares. *held: all
   that the file expects is so, also where it expects nothing and nothing is drawn; what is not is
   logged as "FILE:line: ...", with the first pixel and the number of pixels.
   WHIT_ERROR_USAGE without a device, and others as of whit_renderer_render. */
WHIT_CHECK whit_result whit_renderer_check_expectations(whit_renderer *renderer, bool *held);

/* ---- In pictures ---- */

/* What a picture's recipe calls the text of its functions. */
#define WHIT_SHADER_KEY "whit:shader"

/* All files of a shader in one text of at most 1 MiB, printable ASCII with ends of lines, as a
   picture carries it; to be released by whit_memory_destroy. NULL, with *why, which lives on: they
   are larger than that, a file's name would be refused when it is read, or there is no memory. */
char *whit_shader_pack(const whit_shader *shader, const char **why);

typedef struct whit_shader_file {
    const char *name; /* from a folder of its own, which it does not leave */
    const char *text; /* ends with a 0 that `bytes` does not count */
    size_t bytes;
} whit_shader_file;
/* The files of such a text, the one that was named first: one block, to be released by
   whit_memory_destroy. Nothing is compiled. WHIT_ERROR_INPUT where it is damaged, with the one
   reason in the log behind `where`; WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_shader_unpack(const char *packed, const char *where,
                                          const whit_log *log, whit_shader_file **files,
                                          uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif
