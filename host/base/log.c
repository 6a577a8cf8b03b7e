#include "base/log.h"

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
    vsnprintf(text, sizeof text, format, args);
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
    switch (result) {
    case WHIT_OK:
        return "ok";
    case WHIT_ERROR_FAILED:
        return "failed";
    case WHIT_ERROR_USAGE:
        return "bad usage";
    case WHIT_ERROR_INPUT:
        return "bad input";
    case WHIT_ERROR_OUTPUT:
        return "cannot write";
    case WHIT_ERROR_NO_DEVICE:
        return "no usable device";
    case WHIT_ERROR_DEVICE:
        return "device failed";
    case WHIT_ERROR_MEMORY:
        return "out of memory";
    case WHIT_ERROR_STATUS:
        return "kernel status";
    case WHIT_ERROR_TIME_LIMIT:
        return "time limit";
    case WHIT_ERROR_CANCELLED:
        return "cancelled";
    }
    return "unknown result";
}
