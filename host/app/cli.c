#include "app/cli.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "app/document.h"
#include "base/file.h"
#include "whit/whit_program.h"

/* Time in which interrupted work must stop by itself, so that Ctrl+C takes at most 0.2 s. */
enum { GRACE_MS = 80 };

volatile bool cli_cancel;
static volatile sig_atomic_t interrupt_signal, end_said;
static timer_t grace_timer;
static volatile sig_atomic_t has_grace_timer;
static double limit_end_ms;
static volatile sig_atomic_t error_said;
static bool hushed;
static _Thread_local atomic_bool *muted; /* set while cli_mute silences this thread, else NULL */
static const char *errors_of;
static char first_error[1024];
static volatile sig_atomic_t grace_ms = GRACE_MS;
static volatile sig_atomic_t is_done; /* see cli_end_soon */
/* Signal handlers read the one of these two texts that is not being written. */
static char written_texts[2][64] = {"nothing was written", ""};
static const char *volatile written_text = written_texts[0];
static const char saving_text[] = "each file is whole or as it was";
static const char *volatile next_command; /* or NULL */
static volatile sig_atomic_t progress_drawn;

/* ---- Messages ---- */

/* Held by the thread that prints why the program ends, because the handler of SIGALRM, which runs
   in any thread, prints it too. The thread that holds the lock blocks that signal. */
static atomic_flag reason_lock = ATOMIC_FLAG_INIT;
static _Thread_local bool holds_reason;

static void lock_reason(sigset_t *before)
{
    sigset_t alarm;
    sigemptyset(&alarm);
    sigaddset(&alarm, SIGALRM);
    pthread_sigmask(SIG_BLOCK, &alarm, before);
    while (atomic_flag_test_and_set(&reason_lock))
        ;
    holds_reason = true;
}

static void unlock_reason(const sigset_t *before)
{
    holds_reason = false;
    atomic_flag_clear(&reason_lock);
    pthread_sigmask(SIG_SETMASK, before, NULL);
}

void cli_errors_of(const char *where)
{
    errors_of = where;
    first_error[0] = '\0';
}

const char *cli_said(void)
{
    return first_error;
}

void cli_mute(atomic_bool *said)
{
    muted = said;
}

/* Whether cli_mute silences the thread; if so, notes that it had something to say. */
static bool keeps_silent(void)
{
    if (muted)
        atomic_store(muted, true);
    return muted != NULL;
}

static void on_muted(void *user, whit_log_level level, const char *message)
{
    (void)level;
    (void)message;
    atomic_store((atomic_bool *)user, true);
}

whit_log cli_muted_log(atomic_bool *said)
{
    return (whit_log){.fn = on_muted, .user = said, .level = WHIT_LOG_WARNING};
}

static void say(const char *kind, const char *text)
{
    char shown[16384];
    fprintf(stderr, "whit: %s: %s\n", kind, whit_text_show(text, shown, sizeof shown));
}

static void vsay(const char *kind, const char *format, va_list args)
{
    char text[8192];
    if (keeps_silent())
        return;
    vsnprintf(text, sizeof text, format, args);
    say(kind, text);
}

/* Prints an error. The caller holds the lock (lock_reason), so that threads do so one at a time. */
static void say_error(const char *format, va_list args)
{
    char text[8192], kind[512] = "error";
    vsnprintf(text, sizeof text, format, args);
    if (errors_of && !first_error[0])
        whit_text_show(text, first_error, sizeof first_error);
    if (errors_of)
        snprintf(kind, sizeof kind, "error: %.480s", cli_shown(errors_of));
    say(kind, text);
}

void cli_error(const char *format, ...)
{
    sigset_t before;
    va_list args;
    if (keeps_silent())
        return;
    va_start(args, format);
    lock_reason(&before);
    say_error(format, args);
    error_said = 1;
    unlock_reason(&before);
    va_end(args);
}

void cli_warning(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsay("warning", format, args);
    va_end(args);
}

void cli_note(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsay("note", format, args);
    va_end(args);
}

static void on_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    if (cli_cancel || hushed)
        return;
    if (level == WHIT_LOG_ERROR)
        cli_error("%s", message);
    else if (level == WHIT_LOG_WARNING)
        cli_warning("%s", message);
    else
        cli_note("%s", message);
}

const whit_log cli_log = {.fn = on_message, .level = WHIT_LOG_WARNING};
const whit_log cli_log_notes = {.fn = on_message, .level = WHIT_LOG_INFO};
const whit_log cli_log_errors = {.fn = on_message, .level = WHIT_LOG_ERROR};

void cli_hush(bool on)
{
    hushed = on;
}

static int code_of(whit_result result)
{
    switch (result) {
    case WHIT_OK:
        return EXIT_FINE;
    case WHIT_ERROR_FAILED:
    case WHIT_ERROR_STATUS:
        return EXIT_DIFFERS;
    case WHIT_ERROR_USAGE:
    case WHIT_ERROR_INPUT:
    case WHIT_ERROR_OUTPUT:
    case WHIT_ERROR_MEMORY:
        return EXIT_USAGE;
    case WHIT_ERROR_NO_DEVICE:
    case WHIT_ERROR_DEVICE:
        return EXIT_DEVICE;
    case WHIT_ERROR_TIME_LIMIT:
        return EXIT_TIME;
    case WHIT_ERROR_CANCELLED:
        return EXIT_INTERRUPTED;
    }
    return EXIT_DIFFERS;
}

int cli_exit_of(whit_result result)
{
    if (result == WHIT_OK)
        return EXIT_FINE;
    sigset_t before;
    lock_reason(&before);
    bool cancelled = cli_cancel;
    if (cancelled)
        fprintf(stderr, "whit: interrupted, %s\n", written_text);
    else if (!error_said)
        fprintf(stderr, "whit: error: %s\n",
                result == WHIT_ERROR_TIME_LIMIT ? "the time limit passed"
                                                : whit_result_name(result));
    if (next_command && (cancelled || cli_time_over()))
        fprintf(stderr, "whit: to go on: %s", next_command);
    end_said = error_said = 1;
    unlock_reason(&before);
    if (cancelled)
        return interrupt_signal ? 128 + (int)interrupt_signal : EXIT_INTERRUPTED;
    if (cli_time_over())
        return EXIT_TIME;
    return code_of(result);
}

/* ---- Interrupts and time limits ---- */

static void put(const char *text)
{
    static const char line_end[] = "\n";
    if (progress_drawn && write(STDERR_FILENO, line_end, 1) < 0)
        return;
    progress_drawn = 0;
    ssize_t written = write(STDERR_FILENO, text, strlen(text));
    (void)written;
}

void cli_put_end(const char *kind, const char *why)
{
    /* Waits for a thread that is printing why the program ends, unless this thread itself crashed
       while it printed that and still holds the lock: it would wait for ever. */
    while (!holds_reason && atomic_flag_test_and_set(&reason_lock))
        ;
    /* The reason was printed already. */
    if (end_said || (error_said && !interrupt_signal))
        return;
    put(kind);
    put(why);
    put(", ");
    put(written_text);
    put("\n");
    if (next_command) {
        put("whit: to go on: ");
        put(next_command);
    }
}

__attribute__((no_sanitize_address)) void cli_leave(int code)
{
    _exit(code);
}

/* Ends the process: the work did not stop in time, as it may be inside a driver or a compiler. */
static void on_alarm(int number)
{
    (void)number;
    file_abandon_all();
    if (is_done && !interrupt_signal)
        cli_leave(EXIT_FINE);
    cli_put_end(interrupt_signal ? "whit: " : "whit: error: ",
                interrupt_signal ? "interrupted" : "the time limit has passed");
    cli_leave(interrupt_signal ? 128 + (int)interrupt_signal : EXIT_TIME);
}

/* Asks for a SIGALRM; false where there is no timer. Safe in a signal handler. */
static bool set_timer(long milliseconds)
{
    const struct itimerspec when = {
        .it_value = {.tv_sec = milliseconds / 1000, .tv_nsec = milliseconds % 1000 * 1000000L}};
    return has_grace_timer && timer_settime(grace_timer, 0, &when, NULL) == 0;
}

void cli_end_soon(void)
{
    is_done = 1;
    (void)set_timer(grace_ms);
}

static void on_interrupt(int number)
{
    int reason = errno;
    cli_cancel = true;
    if (interrupt_signal) {
        file_abandon_all();
        cli_leave(128 + number);
    }
    interrupt_signal = number;
    if (!set_timer(grace_ms)) {
        file_abandon_all();
        cli_leave(128 + number);
    }
    errno = reason;
}

void cli_keep_what_is_done(int milliseconds)
{
    grace_ms = milliseconds;
}

void cli_set_kept(uint32_t done, uint32_t count, const char *what)
{
    char *text = written_texts[written_text == written_texts[0]];
    snprintf(text, sizeof written_texts[0], "%u of %u %s", done, count, what);
    written_text = text;
}

void cli_set_next(const char *command)
{
    next_command = command;
}

void cli_say_next(void)
{
    if (next_command && !cli_cancel && !cli_time_over()) /* else cli_exit_of has said it */
        fprintf(stderr, "whit: to go on: %s", next_command);
    next_command = NULL;
}

void cli_set_saving(void)
{
    written_text = saving_text;
}

void cli_set_written(uint32_t written, uint32_t count)
{
    cli_set_kept(written, count, "frames were written");
}

void cli_catch_interrupts(void)
{
    struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGALRM};
    struct sigaction action = {.sa_handler = on_alarm, .sa_flags = SA_RESTART};
    sigfillset(&action.sa_mask);
    sigaction(SIGALRM, &action, NULL);
    has_grace_timer = timer_create(CLOCK_MONOTONIC, &event, &grace_timer) == 0;
    signal(SIGXFSZ, SIG_IGN); /* so that a file above `ulimit -f` is an error of its write */
    action.sa_handler = on_interrupt;
    sigaction(SIGTERM, &action, NULL);
    /* SIGINT ends the program even where it was ignored at the start, as in background jobs of
       scripts: a signal that is sent there is meant for it. */
    sigaction(SIGINT, &action, NULL);
    struct sigaction before;
    if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &action, NULL); /* not under nohup */
    cli_catch_ends();
}

void cli_limit_time(double seconds)
{
    if (!(seconds > 0.0))
        return;
    limit_end_ms = whit_clock_ms() + seconds * 1e3;
    /* Rendering stops at the limit by itself. SIGALRM ends other work a little later, and work that
       saves its results when interrupted (cli_keep_what_is_done) later by the time it was
       granted. */
    (void)set_timer((long)(seconds * 1050.0 + 250.0) + grace_ms - GRACE_MS);
    if (interrupt_signal) /* The timer already ran for the interrupt. */
        (void)set_timer(grace_ms);
}

double cli_time_end_ms(void)
{
    return limit_end_ms;
}

double cli_time_left_s(void)
{
    if (limit_end_ms == 0.0)
        return 0.0;
    double left_s = (limit_end_ms - whit_clock_ms()) * 1e-3;
    return left_s > 1e-3 ? left_s : 1e-3;
}

bool cli_time_over(void)
{
    return limit_end_ms != 0.0 && whit_clock_ms() >= limit_end_ms;
}

/* ---- Output ---- */

bool cli_can_write(const char *path)
{
    struct stat info;
    struct file_write file;
    /* The test below opens and closes the file, which would end the reader of a pipe. */
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))
        return true;
    if (file_write_begin(&cli_log, path, &file) != WHIT_OK)
        return false;
    file_write_abandon(&file);
    return true;
}

bool cli_is_piped(const char *path)
{
    return path && strcmp(path, "/dev/stdout") == 0;
}

const char *cli_shown(const char *text)
{
    static _Thread_local char kept[4][16384];
    static _Thread_local unsigned turn;
    char *out = kept[turn++ % 4];
    return whit_text_show(text ? text : "", out, sizeof kept[0]);
}

int cli_finish_stdout(int status)
{
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout))
        return status;
    cli_error("standard output: cannot write: %s", strerror(errno ? errno : EIO));
    return status == EXIT_FINE ? EXIT_USAGE : status;
}

int cli_print_json(json_t *value)
{
    char *text = document_lines(value);
    /* putchar() writes through the buffer of stdout, which keeps text that cannot be written, so
       that cli_finish_stdout learns why it failed. */
    for (const char *c = text; *c; ++c)
        putchar(*c);
    putchar('\n');
    free(text);
    return cli_finish_stdout(EXIT_FINE);
}

/* ---- Progress ---- */

enum { PROGRESS_WIDTH = 30, PROGRESS_WHAT = 24, PROGRESS_QUIET_MS = 300, PROGRESS_EVERY_MS = 80 };

void cli_progress_init(struct cli_progress *progress, bool quiet)
{
    const char *terminal = getenv("TERM");
    const char *no_color = getenv("NO_COLOR");
    *progress = (struct cli_progress){
        .shown = !quiet && isatty(STDERR_FILENO) && terminal && strcmp(terminal, "dumb") != 0,
        .color = !(no_color && no_color[0]),
        .start_ms = whit_clock_ms(),
    };
}

static bool is_time_to_draw(struct cli_progress *progress)
{
    double now_ms = whit_clock_ms();
    if (!progress->shown || now_ms - progress->start_ms < PROGRESS_QUIET_MS ||
        now_ms - progress->last_ms < PROGRESS_EVERY_MS)
        return false;
    progress->last_ms = now_ms;
    progress->drawn = true;
    progress_drawn = 1;
    return true;
}

static void draw_bar(const struct cli_progress *progress, double done)
{
    char bar[PROGRESS_WIDTH + 1] = {0};
    for (int i = 0; i < PROGRESS_WIDTH; ++i)
        bar[i] = (double)i < done * PROGRESS_WIDTH ? '#' : '.';
    fprintf(stderr, "\r%s[%s]%s %3d %%", progress->color ? "\033[36m" : "", bar,
            progress->color ? "\033[0m" : "", (int)(done * 100.0));
}

void cli_progress_update(void *user, double done)
{
    struct cli_progress *progress = user;
    double spent_ms = whit_clock_ms() - progress->start_ms;
    if (!is_time_to_draw(progress))
        return;
    done = done < 0.0 ? 0.0 : done > 1.0 ? 1.0 : done;
    draw_bar(progress, done);
    if (done > 0.01)
        fprintf(stderr, "  %.1f s left  ", spent_ms * 1e-3 * (1.0 - done) / done);
    fflush(stderr);
}

void cli_progress_tell(void *user, double done, double seconds_left, const char *what)
{
    struct cli_progress *progress = user;
    progress->last_ms = 0.0; /* draws at once: every step is shown */
    if (!is_time_to_draw(progress))
        return;
    draw_bar(progress, done);
    fprintf(stderr, "  %.0f s left  %-*.*s", seconds_left, PROGRESS_WHAT, PROGRESS_WHAT, what);
    fflush(stderr);
}

void cli_progress_finish(struct cli_progress *progress)
{
    if (progress->drawn)
        fprintf(stderr, "\r%*s\r", PROGRESS_WIDTH + PROGRESS_WHAT + 24, "");
    progress->drawn = progress->shown = false;
    progress_drawn = 0;
}
