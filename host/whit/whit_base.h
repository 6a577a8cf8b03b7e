/* Part of whit's public face, shared by every module: results, logging, text. */
#ifndef WHIT_BASE_H
#define WHIT_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Around declarations, for C++. */
#ifdef __cplusplus
#define WHIT_C_BEGIN extern "C" {
#define WHIT_C_END   }
#else
#define WHIT_C_BEGIN
#define WHIT_C_END
#endif

WHIT_C_BEGIN

#if defined(__GNUC__) || defined(__clang__)
#define WHIT_CHECK        __attribute__((warn_unused_result))
#define WHIT_PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define WHIT_CHECK
#define WHIT_PRINTF(f, a)
#endif

/* The default bail-out: rays that can add less than this to a pixel are not traced. It is a quarter
   of one step of 8-bit colour. */
#define WHIT_BAILOUT_DEFAULT (1.0 / 1024.0)

/* The most samples per pixel. */
#define WHIT_SAMPLES_MAX     4096

/* The error codes of all of whit, from `base` to the public API. The reason of a failure is logged
   once, where it happens; callers pass the code up. */
typedef enum whit_result {
    WHIT_OK = 0,
    WHIT_ERROR_FAILED,     /* a result differs, or a promise was not kept */
    WHIT_ERROR_USAGE,      /* arguments that make no sense */
    WHIT_ERROR_INPUT,      /* a file that is missing, damaged or refused */
    WHIT_ERROR_OUTPUT,     /* a file that cannot be written */
    WHIT_ERROR_NO_DEVICE,  /* no Vulkan device that whit can use */
    WHIT_ERROR_DEVICE,     /* a Vulkan call failed, or the device was lost */
    WHIT_ERROR_MEMORY,     /* host or device memory ran out */
    WHIT_ERROR_STATUS,     /* a kernel or a check reports that a result cannot be trusted */
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
   only. The function may be called from any thread, but never by two at once. */
typedef void (*whit_log_fn)(void *user, whit_log_level level, const char *message);
/* The receiver of messages. Zeroed, or NULL: messages go nowhere. */
typedef struct whit_log {
    whit_log_fn fn;
    void *user;
    whit_log_level level; /* less severe messages (higher levels) are not produced */
} whit_log;

/* Files that a scene refers to but that were not read because they lie outside of its folder. */
typedef struct whit_refused {
    uint32_t count;
    char folder[4096]; /* of the first refused file, absolute; "" where none was refused */
} whit_refused;

/* A short name for a result, for messages: "bad input". Never NULL. */
const char *whit_result_name(whit_result result);

/* ---- Text that others wrote ---- */

/* Names of files, materials and devices, and words of damaged files, may hold characters that
   control a terminal, hide text or reverse its direction. Libwhit hands them out unchanged; code
   that prints them must pass them through these functions, as libwhit does for its messages. These
   keep UTF-8 as it is, with two exceptions:
       \u001b  stands for a control character (also U+0080 to U+009F, newlines and tabs), one that
               sets the direction or is invisible, a line separator, or a noncharacter (U+FFFE); as
               in JSON, above U+FFFF as a surrogate pair, \udb40\udc41
       \xff    stands for a byte that is not UTF-8
   A backslash stays as it is, so escaping a second time changes nothing. Escape wherever text
   leaves the program, and nowhere else. */

/* The most bytes of one shown character, with the 0 at its end. */
#define WHIT_SHOWN_BYTES 13
/* Writes the first character of `text`, escaped, to `shown`. Returns how many bytes of `text` it
   takes: 0 at the end of `text`. */
size_t whit_text_next(const char *text, char shown[WHIT_SHOWN_BYTES]);
/* Writes as much of `text`, escaped, as fits in `out`, in whole characters and escapes, ended by a
   0. Text that does not fit is cut and ends with `...`. `out_bytes` > 16. Returns `out`. */
char *whit_text_show(const char *text, char *out, size_t out_bytes);

WHIT_C_END

#endif
