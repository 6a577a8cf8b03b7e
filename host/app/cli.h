/* Code that all commands of the program share: options, messages, interrupts, exit codes. */
#ifndef APP_CLI_H
#define APP_CLI_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "settings/settings.h"

enum cli_exit {
    EXIT_FINE = 0,
    EXIT_DIFFERS = 1, /* a result differs, or a promise was not kept */
    EXIT_USAGE = 2,   /* bad usage, bad input, output that cannot be written */
    EXIT_DEVICE = 3,
    EXIT_MISSING = 4, /* there is nothing to compare with */
    EXIT_TIME = 5,
    EXIT_INTERRUPTED = 130,
};

/* ---- Options ---- */

enum { CLI_OTHERS_MAX = 4096 };

/* A subcommand. Its own options end with a zeroed one. They are followed by those rows of the table
   of settings that it takes and does not define itself, by --help, and by --help-all where some
   options are for developers. */
struct cli_command {
    const char *name;
    const char *arguments;                    /* "SCENE -o OUT" */
    const char *summary;                      /* one line, for the list of commands */
    const char *details;                      /* paragraphs below the options; may be NULL */
    const struct setting *options;            /* of the command's own record */
    uint32_t settings;                        /* a bit of enum settings_command; 0: it takes none */
    void (*usual)(struct settings *settings); /* sets defaults of its own; NULL: none */
    uint32_t others_max; /* arguments behind the first that are no options, to CLI_OTHERS_MAX */
    int (*run)(const struct cli_command *command, int argc, char **argv);
    /* Gives word `index` that an option accepts beside its values; NULL: no more words. May be
       NULL. */
    const char *(*word)(const char *option, uint32_t index);
};

/* ---- Messages ---- */

void cli_error(const char *format, ...) WHIT_PRINTF(1, 2);
/* Prints an error and gives `value`, so that it can be returned: false, a whit_result or an exit
   code. It is a macro so that compilers see what it gives. */
#define CLI_FAIL(value, ...) (cli_error(__VA_ARGS__), (value))
void cli_warning(const char *format, ...) WHIT_PRINTF(1, 2);
void cli_note(const char *format, ...) WHIT_PRINTF(1, 2);

/* Prints that memory ran out. It is inline so that compilers see that the result is an error. */
static inline whit_result cli_no_memory(void)
{
    cli_error("out of memory");
    return WHIT_ERROR_MEMORY;
}

/* From this call on errors begin with `where`, as "FILE:LINE: NAME"; NULL: without a prefix.
   `where` is borrowed. */
void cli_errors_of(const char *where);
/* The first error since cli_errors_of, without the prefix; "" where there was none. */
const char *cli_said(void);

/* The log of libwhit's calls: errors and warnings to stderr. cli_log_errors is for loading a scene,
   which keeps its own warnings and notes. */
extern const whit_log cli_log;
extern const whit_log cli_log_errors;
extern const whit_log cli_log_notes; /* errors, warnings and notes */

/* From this call on this thread prints no messages, and sets *said where it would have printed one.
   `said` is borrowed until a call with NULL, which ends the silence. */
void cli_mute(atomic_bool *said);
/* A log with the same effect, for calls of libwhit that log from their own threads, as devices
   do. */
whit_log cli_muted_log(atomic_bool *said);

/* true: errors of libwhit are not printed, for attempts that may be refused. */
void cli_hush(bool on);

/* The exit code for a failed call; prints an error where none was printed yet. */
int cli_exit_of(whit_result result);

/* ---- Interrupts and time limits ---- */

/* Set by SIGINT, SIGTERM and SIGHUP. Should the work not have stopped a moment later, the handler
   ends the process, with all unfinished files removed. */
extern volatile bool cli_cancel;
void cli_catch_interrupts(void);
/* SIGPIPE ends the process without a word and without unfinished files. A crash caused by a lack of
   memory or descriptors becomes an error with a message; any other crash stays a crash. */
void cli_catch_ends(void);
/* _exit() for signal handlers. AddressSanitizer allocates before a call that it knows not to
   return, and waits for ever where the signal came while it did: this wrapper is hidden from it. */
void cli_leave(int code);
/* For signal handlers that end the process: prints KIND WHY and what was written, unless the reason
   was printed already. */
void cli_put_end(const char *kind, const char *why);
/* For the message of interrupted work: `written` of `count` frames were written. Without this call
   the message says that nothing was written. */
void cli_set_written(uint32_t written, uint32_t count);
/* For the message of interrupted work once it saves files: the handler cannot know which files are
   complete, so the message says that each is whole or as it was. */
void cli_set_saving(void);
/* Interrupted work gets `grace_ms` to save its results before the handler ends the process. A
   second signal ends it at once. */
void cli_keep_what_is_done(int grace_ms);
/* The work is done and saved, without an error: threads that do not stop within that time, as they
   may be inside a driver, no longer keep the process from ending. */
void cli_end_soon(void);
/* For the message of interrupted work: "12 of 40 WHAT". */
void cli_set_kept(uint32_t done, uint32_t count, const char *what);
/* For the message of interrupted work, and of a time limit that has passed: the command that
   continues the work, ended by a newline. It is borrowed for good. */
void cli_set_next(const char *command);
/* Prints that command, once, after another failure than these. */
void cli_say_next(void);
/* Ends the process with EXIT_TIME a little after `seconds`, in case the work does not watch the
   limit itself. */
void cli_limit_time(double seconds);
/* When the time limit passes, by whit_clock_ms; 0: no limit. */
double cli_time_end_ms(void);
/* Seconds left of the time limit, never quite 0; 0: no limit. */
double cli_time_left_s(void);
bool cli_time_over(void);

/* ---- Output ---- */

/* Prints an error and returns false where the file `path` cannot be written; pipes and devices are
   not tested. */
bool cli_can_write(const char *path);
/* Escapes names and other text that whit did not write, by whit_text_show. The result is valid
   until the fourth call after this one; only one thread may use it at a time. NULL counts as "". */
const char *cli_shown(const char *text);
/* Whether that report, or NULL, is standard output, which has nothing else on it then. */
bool cli_is_piped(const char *path);
/* Flushes standard output; a failed write is an error, as with `whit ... > /dev/full`. Returns the
   exit code, else `status`. */
int cli_finish_stdout(int status);
/* Prints a jansson value, keys in the order they were added. Takes over the reference. */
struct json_t;
int cli_print_json(struct json_t *value);

/* ---- Progress ---- */

struct cli_progress {
    bool shown, drawn, color;
    double start_ms, last_ms;
};
void cli_progress_init(struct cli_progress *progress, bool quiet);
void cli_progress_update(void *progress, double done); /* whit_renderer_params.progress */
/* Draws the bar with the caller's own estimate of the seconds left, and `what` is being done:
   cost_request.progress. */
void cli_progress_tell(void *progress, double done, double seconds_left, const char *what);
void cli_progress_finish(struct cli_progress *progress);

#endif
