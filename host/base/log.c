#include "base/log.h"
#include "base/text.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>

static pthread_mutex_t log_mutex = PTHREAD_MUTEX_INITIALIZER;

whit_log log_or_silence(const whit_log *log)
{
    return log ? *log : (whit_log){0};
}

static void show(const whit_log *log, whit_log_level level, const char *format, va_list args)
{
    if (!log || !log->fn || level > log->level)
        return;
    char text[2048], shown[4 * sizeof text];
    text_print(text, sizeof text, format, args);
    whit_text_show(text, shown, sizeof shown);
    pthread_mutex_lock(&log_mutex);
    log->fn(log->user, level, shown);
    pthread_mutex_unlock(&log_mutex);
}

void log_message(const whit_log *log, whit_log_level level, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    show(log, level, format, args);
    va_end(args);
}

whit_result log_failure(const whit_log *log, whit_result result, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    show(log, WHIT_LOG_ERROR, format, args);
    va_end(args);
    return result;
}

const char *whit_result_name(whit_result result)
{
    static const char *const names[] = {
        [WHIT_OK] = "ok",
        [WHIT_ERROR_FAILED] = "failed",
        [WHIT_ERROR_USAGE] = "bad usage",
        [WHIT_ERROR_INPUT] = "bad input",
        [WHIT_ERROR_OUTPUT] = "cannot write",
        [WHIT_ERROR_NO_DEVICE] = "no usable device",
        [WHIT_ERROR_DEVICE] = "device failed",
        [WHIT_ERROR_MEMORY] = "out of memory",
        [WHIT_ERROR_STATUS] = "kernel status",
        [WHIT_ERROR_TIME_LIMIT] = "time limit",
        [WHIT_ERROR_CANCELLED] = "cancelled",
    };
    bool known = (size_t)result < sizeof names / sizeof *names && names[result];
    return known ? names[result] : "unknown result";
}
