/* Part of whit.h: files of GLSL functions that stand in the place of whit's own (docs/shaders.md).
 */
#ifndef WHIT_SHADER_H
#define WHIT_SHADER_H

#include "whit_types.h"

WHIT_C_BEGIN

/* The version of the functions that such files may use; they state it as `//@ whit 1`. */
#define WHIT_SHADER_VERSION 1

/* A compiler of such files, in a separate process that is reused for the next file. */
typedef struct whit_shader_compiler whit_shader_compiler;

/* A zeroed one means the defaults. */
typedef struct whit_shader_limits {
    double cpu_s; /* processor time for each kernel; 0: 0.8 for kernels with functions, 5 for tests
                     and for stages of a checkout */
    uint64_t memory_bytes; /* of the compiler's process; 0: 1 GiB */
    bool require_sandbox;  /* where the compiler cannot be run in a sandbox: an error in place of a
                              warning */
    const volatile bool *cancel;
} whit_shader_limits;

/* Best created before scenes are loaded: its process is forked with the caller's memory at that
   time. `limits` may be NULL. Used by one thread at a time. No errors but WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_shader_compiler_create(const whit_shader_limits *limits,
                                                   const whit_log *log, whit_shader_compiler **out);
void whit_shader_compiler_destroy(whit_shader_compiler *compiler);

/* An error in a file. */
typedef struct whit_shader_error {
    const char *file; /* as it was named */
    uint32_t line;    /* from 1; 0: the file as a whole */
    const char *reason;
    uint32_t column; /* of the token that the reason quotes, from 1, in bytes; 0: not known */
} whit_shader_error;
/* The first errors of the last call of whit_shader_load. Returns how many `errors` has; they live
   until the next call. */
uint32_t whit_shader_compiler_errors(const whit_shader_compiler *compiler,
                                     const whit_shader_error **errors);
/* The number of errors of that call beyond those, as far as known: reading annotations ends at the
   first one. */
uint32_t whit_shader_compiler_errors_left(const whit_shader_compiler *compiler);

/* Reads the file with all that it includes, or the functions that a .png or .exr carries under
   WHIT_SHADER_KEY, and compiles the kernels that its functions are part of. `trust`: leaves loops
   and indices of the file unbounded. WHIT_ERROR_INPUT, with each error logged as "FILE:line:
   reason"; WHIT_ERROR_CANCELLED; WHIT_ERROR_USAGE for a NULL path, and where a sandbox is required
   and there is none. */
WHIT_CHECK whit_result whit_shader_load(whit_shader_compiler *compiler, const char *path,
                                        bool trust, whit_shader **out);
/* As whit_shader_load, with the stages of a source checkout in place of the built-in ones: `stages`
   is its folder shaders/, from which kernel/ is compiled with all its includes. `path` NULL: only
   the stages. They are trusted as whit's own: their loops and indices are not bounded.
   WHIT_ERROR_INPUT and others as of whit_shader_load, also for errors in the stages, which are
   logged with file and line, and for a file of abi/ that differs from the one whit was built
   with. */
WHIT_CHECK whit_result whit_shader_load_stages(whit_shader_compiler *compiler, const char *path,
                                               const char *stages, bool trust, whit_shader **out);
void whit_shader_destroy(whit_shader *shader);

typedef enum whit_slider_kind {
    WHIT_SLIDER_NUMBER = 0,
    WHIT_SLIDER_COLOR,
    WHIT_SLIDER_TOGGLE,
    WHIT_SLIDER_CHOICE,
} whit_slider_kind;

/* A value of the file that can be changed without a new kernel, by whit_renderer_params.sliders.
   All texts live as long as the shader. */
typedef struct whit_slider {
    const char *name, *help; /* help: "" without one */
    whit_slider_kind kind;
    float min, max;           /* NUMBER */
    float value[3];           /* the default in the file; COLOR: sRGB, 0..1; TOGGLE: 0 or 1; CHOICE:
                                 index of the word, from 0 */
    const char *const *words; /* CHOICE */
    uint32_t word_count;
    uint32_t first; /* index of its first value among the values of all sliders; a COLOR has
                       three */
} whit_slider;

/* A test of the file with its checks. Tests and checks are in the order of files and lines. All
   texts live as long as the shader. */
typedef struct whit_shader_test {
    const char *name, *file;
    uint32_t line;                     /* of its function */
    uint32_t first_check, check_count; /* in whit_shader_info.checks */
} whit_shader_test;
typedef struct whit_shader_check {
    const char *text, *file; /* text: the checked expression, cut where it is long */
    uint32_t line;
} whit_shader_check;

/* `//@ expect WHAT == base`: a property of the picture that the file's functions must not
   change. */
typedef enum whit_expected {
    WHIT_EXPECT_IDS = 0, /* what each pixel's first sample hits */
    WHIT_EXPECT_PIXELS,  /* every bit of every colour */
    WHIT_EXPECT_RAYS,    /* the numbers of rays of all kinds; below, of one kind */
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

/* The functions of whit that such files can replace. */
typedef enum whit_hook {
    WHIT_HOOK_CAMERA = 0,
    WHIT_HOOK_SURFACE,
    WHIT_HOOK_SHADE,
    WHIT_HOOK_SCATTER,
    WHIT_HOOK_MISS,
    WHIT_HOOK_POST,
    WHIT_HOOK_AOV,       /* functions of any name that follow //@ aov */
    WHIT_HOOK_INTERSECT, /* with //@ box */
    WHIT_HOOKS,          /* how many there are */
} whit_hook;
/* "camera", "surface", ... as files name them. */
const char *whit_hook_name(whit_hook hook);

/* Describes a loaded file. All texts live as long as the shader. */
typedef struct whit_shader_info {
    const char *const *files; /* the file and what it includes, as whit opened them */
    uint32_t file_count;
    uint32_t hooks; /* bits 1u << whit_hook: the functions that the file replaces */
    const whit_slider *sliders;
    uint32_t slider_count;
    const whit_shader_test *tests;
    const whit_shader_check *checks;
    uint32_t test_count, check_count;
    const whit_shader_expectation *expectations;
    uint32_t expectation_count;
    const char *const *aovs; /* names of its aov functions, whose images are WHIT_AOV_SHADER +
                                index */
    uint32_t aov_count;
    uint32_t dbg_count; /* number of dbg(x) in all files; see whit_probe_report.calls */
    uint32_t fuel;      /* most loop iterations per call of a function; 0: unlimited, the file is
                           trusted */
    bool traces; /* a function of the file calls one that traces rays: trace(), visible(), lit_by(),
                    whit_shade */
    uint32_t kernel_count;
    uint32_t instructions; /* SPIR-V instructions of all kernels, before specialization */
    uint64_t hash;         /* of the texts of all files */
} whit_shader_info;
void whit_shader_get_info(const whit_shader *shader, whit_shader_info *info);

/* Compiles the kernel that runs the file's tests, which pictures do not need. Errors as of
   whit_shader_load, and WHIT_ERROR_USAGE for a file without tests. */
WHIT_CHECK whit_result whit_shader_compile_tests(whit_shader_compiler *compiler,
                                                 whit_shader *shader);

/* The result of a check of a test for the seeds 0 to WHIT_TEST_SEEDS - 1. */
#define WHIT_TEST_SEEDS 4096
typedef struct whit_check_result {
    bool reached;        /* for at least one seed; a check that is never reached proves nothing */
    uint32_t failed;     /* number of seeds for which it failed */
    uint32_t first_seed; /* the smallest seed for which it failed; 0 where it never failed */
} whit_check_result;
/* Runs all tests of the renderer's shader, for which whit_shader_compile_tests must have been
   called, with the renderer's scene bound. `results`: one for each of whit_shader_info.checks.
   *compile_ms: the driver's time to compile the kernel; *run_ms: the time to run it and read
   results back. WHIT_ERROR_STATUS where a loop ran out of fuel (whit_shader_info.fuel), logged with
   FILE:line, or the driver ended loops early; WHIT_ERROR_USAGE without a device or tests;
   WHIT_ERROR_DEVICE, WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_renderer_run_tests(whit_renderer *renderer, whit_check_result *results,
                                               double *compile_ms, double *run_ms);

/* Draws the picture that was rendered last once more without the shader, and compares the two.
   *held: every expectation of the file holds; without any it is true and nothing is drawn. Broken
   expectations are logged as "FILE:line: ...", with the first pixel and the number of pixels.
   WHIT_ERROR_USAGE without a device, or for identities of a picture that lacks its first sample,
   and others as of whit_renderer_render. */
WHIT_CHECK whit_result whit_renderer_check_expectations(whit_renderer *renderer, bool *held);

/* ---- In pictures ---- */

/* The key in a picture's recipe under which the text of its functions is stored. */
#define WHIT_SHADER_KEY "whit:shader"

/* Packs all files of a shader into one text of at most 1 MiB, printable ASCII with newlines, as a
   picture carries it; to be released by whit_memory_destroy. NULL: the files are larger than that,
   a file's name would be refused by whit_shader_unpack, or there is no memory. *why: the reason, a
   static string; NULL where there is none. */
char *whit_shader_pack(const whit_shader *shader, const char **why);

typedef struct whit_shader_file {
    const char *name; /* a path relative to the folder of the packed files, never outside of it */
    const char *text; /* followed by a 0 that `bytes` does not count */
    size_t bytes;
} whit_shader_file;
/* The files in a packed text, the shader's main file first: one block, to be released by
   whit_memory_destroy. Nothing is compiled. WHIT_ERROR_INPUT where the text is damaged, logged once
   as `where` followed by the reason; WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_shader_unpack(const char *packed, const char *where,
                                          const whit_log *log, whit_shader_file **files,
                                          uint32_t *count);

WHIT_C_END

#endif
