/* Part of whit's public face, shared by every module: results, logging, text. */
#ifndef WHIT_BASE_H
#define WHIT_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__) || defined(__clang__)
#define WHIT_CHECK        __attribute__((warn_unused_result))
#define WHIT_PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define WHIT_CHECK
#define WHIT_PRINTF(f, a)
#endif

/* Rays that can add less than this to a pixel are not traced, unless asked otherwise: a quarter of
   what 8 bits can show. */
#define WHIT_BAILOUT_DEFAULT (1.0 / 1024.0)

/* Samples of a pixel. */
#define WHIT_SAMPLES_MAX     4096

/* The one vocabulary of failure, from `base` to the public API. The reason is logged once,
   where it happens; callers pass the code up. */
typedef enum whit_result {
    WHIT_OK = 0,
    WHIT_ERROR_FAILED,     /* a result differs, or a promise was not kept */
    WHIT_ERROR_USAGE,      /* arguments that make no sense */
    WHIT_ERROR_INPUT,      /* a file that is missing, damaged or refused */
    WHIT_ERROR_OUTPUT,     /* a file that cannot be written */
    WHIT_ERROR_NO_DEVICE,  /* no Vulkan device that whit can use */
    WHIT_ERROR_DEVICE,     /* a Vulkan call failed, or the device was lost */
    WHIT_ERROR_MEMORY,     /* host or device memory ran out */
    WHIT_ERROR_STATUS,     /* a kernel or a check says that a result is not to be trusted */
    WHIT_ERROR_TIME_LIMIT, /* the caller's time limit passed */
    WHIT_ERROR_CANCELLED,  /* the caller asked to stop */
} whit_result;

typedef enum whit_log_level {
    WHIT_LOG_ERROR = 0,
    WHIT_LOG_WARNING,
    WHIT_LOG_INFO,
    WHIT_LOG_DEBUG,
} whit_log_level;

/* `message` is one line without its newline, as whit_text_show shows it, valid during the call
   only. Called from any thread, one call at a time. */
typedef void (*whit_log_fn)(void *user, whit_log_level level, const char *message);
/* Where messages go. Zeroed, or NULL: nowhere. */
typedef struct whit_log {
    whit_log_fn fn;
    void *user;
    whit_log_level level; /* messages above it are not made */
} whit_log;

/* Files outside of the scene's folder that its files name, and that were not read. */
typedef struct whit_refused {
    uint32_t count;
    char folder[4096]; /* of the first of them, absolute; "" where there is none */
} whit_refused;

/* A short name for a result, for messages: "bad input". Never NULL. */
const char *whit_result_name(whit_result result);

/* ---- Text that others wrote ---- */

/* Names of files, materials and devices, and words of damaged files, may hold what steers a
   terminal, or hides or turns round what they say. Libwhit hands them out as they are; whoever
   prints them shows them by these functions, as libwhit does in its messages: UTF-8 as it is, but
       \u001b  a control character (also U+0080 to U+009F, newlines and tabs), one that sets the
               direction or is not seen, a separator of lines, or none at all (U+FFFE); as in JSON,
               so past 16 bits as a pair, \udb40\udc41
       \xff    a byte that is not UTF-8
   A backslash stays as it is, and with it what was shown before: showing it again changes nothing,
   so that it is done wherever text leaves the program, and nowhere else. */

/* The most bytes of one shown character, with the 0 at its end. */
#define WHIT_SHOWN_BYTES 13
/* The first character of `text`, as it is shown. Gives how many bytes of `text` it takes: 0 at its
   end. */
size_t whit_text_next(const char *text, char shown[WHIT_SHOWN_BYTES]);
/* As much of `text` as has room in `out` with a 0 at its end, in whole characters and escapes;
   where there is more, with `...` at the end. `out_bytes` > 16. Gives `out`. */
char *whit_text_show(const char *text, char *out, size_t out_bytes);

#ifdef __cplusplus
}
#endif

#endif
