/* What every command of the program shares: options, messages, interrupts, exit codes. */
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

/* A subcommand. Its own options end with a zeroed one. Behind them come those rows of the table of
   settings that it takes and has no own option for, --help, and --help-all where some are for
   developers. */
struct cli_command {
    const char *name;
    const char *arguments;                    /* "SCENE -o OUT" */
    const char *summary;                      /* one line, for the list of commands */
    const char *details;                      /* paragraphs below the options; may be NULL */
    const struct setting *options;            /* of the command's own record */
    uint32_t settings;                        /* a bit of enum settings_command; 0: it takes none */
    void (*usual)(struct settings *settings); /* sets defaults of its own; NULL: none */
    bool takes_two;                           /* arguments that are no options; else one */
    bool takes_many;                          /* after the first one: CLI_OTHERS_MAX */
    int (*run)(const struct cli_command *command, int argc, char **argv);
    /* Word `index` of what an option takes beside its values; NULL: no more. May be NULL. */
    const char *(*word)(const char *option, uint32_t index);
};

/* ---- Messages ---- */

void cli_error(const char *format, ...) WHIT_PRINTF(1, 2);
void cli_warning(const char *format, ...) WHIT_PRINTF(1, 2);
void cli_note(const char *format, ...) WHIT_PRINTF(1, 2);

/* From here on errors begin with `where`, as "FILE:LINE: NAME"; NULL: with nothing. `where` is
   borrowed. */
void cli_errors_of(const char *where);
/* The first error since then, without that; "" where there was none. */
const char *cli_said(void);

/* The log of libwhit's calls: errors and warnings to stderr. While a scene loads only errors, for
   the scene keeps its notes. */
extern const whit_log cli_log;
extern const whit_log cli_log_errors;
extern const whit_log cli_log_notes; /* with notes */

/* From here on this thread says nothing, and sets *said where it would have; NULL: it speaks again.
   `said` is borrowed until then. */
void cli_mute(atomic_bool *said);
/* The same for libwhit's calls that log from threads of their own, as devices do. */
whit_log cli_muted_log(atomic_bool *said);

/* Whether errors of libwhit are kept to itself, as where something is tried that may be refused. */
void cli_hush(bool on);

/* The exit code for a failed call; makes sure that something was said. */
int cli_exit_of(whit_result result);

/* ---- Interrupts and time limits ---- */

/* Set by SIGINT, SIGTERM and SIGHUP. Should the work not have stopped a moment later, the handler
   ends the process, with all unfinished files removed. */
extern volatile bool cli_cancel;
void cli_catch_interrupts(void);
/* SIGPIPE ends the process without a word and without unfinished files. A crash for want of memory
   or descriptors is an error, any other one stays what it is. */
void cli_catch_ends(void);
/* _exit() for signal handlers. AddressSanitizer allocates before a call that it knows not to
   return, and waits for ever where the signal came while it did: it is not told of this one. */
void cli_leave(int code);
/* For signal handlers that end the process: KIND WHY, and what was written, unless it is said. */
void cli_put_end(const char *kind, const char *why);
/* For the message of interrupted work: `written` of `count` frames are there. Without it, nothing
   was written. */
void cli_set_written(uint32_t written, uint32_t count);
/* For the message of interrupted work from the first file on that is saved: it cannot know how far
   that got. */
void cli_set_saving(void);
/* Interrupted work gets this long to save what is done, before the handler ends the process. A
   second signal ends it at once. */
void cli_keep_what_is_done(int grace_ms);
/* For the message of interrupted work: "12 of 40 WHAT". */
void cli_set_kept(uint32_t done, uint32_t count, const char *what);
/* For the message of interrupted work, and of a time limit that has passed: the command that goes
   on with it, and a line end. It has to stay. */
void cli_set_next(const char *command);
/* Ends the process with EXIT_TIME some time after `seconds`, for what does not watch the time by
   itself. */
void cli_limit_time(double seconds);
/* Time left of the limit, at least a little; 0: no limit. */
double cli_time_left_s(void);
bool cli_time_over(void);

/* ---- Output ---- */

/* Says so and returns false when `path` cannot be written; leaves pipes and devices alone. */
bool cli_can_write(const char *path);
/* As whit_text_show, for names and all else that is not whit's own. Valid until the fourth call
   from here, of one thread at a time. NULL is as "". */
const char *cli_shown(const char *text);
/* Flushes standard output; a failure is an error, for `whit ... > /dev/full`. */
int cli_finish_stdout(int status);
/* Prints a jansson value, keys in the order they were added. Takes over the reference; NULL means
   that memory ran out. */
struct json_t;
int cli_print_json(struct json_t *value);

/* ---- Progress ---- */

struct cli_progress {
    bool shown, drawn, color;
    double start_ms, last_ms;
};
void cli_progress_init(struct cli_progress *progress, bool quiet);
void cli_progress_update(void *progress, double done); /* whit_renderer_params.progress */
/* With what is being done, and the seconds that are left by the caller's own reckoning. */
void cli_progress_tell(struct cli_progress *progress, double done, double seconds_left,
                       const char *what);
void cli_progress_finish(struct cli_progress *progress);

#endif
