#include "base/log.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>

static pthread_mutex_t log_mutex = PTHREAD_MUTEX_INITIALIZER;

whit_log log_or_silence(const whit_log *log)
{
    return log ? *log : (whit_log){0};
}

void log_message(const whit_log *log, whit_log_level level, const char *format, ...)
{
    if (!log || !log->fn || level > log->level)
        return;
    char text[2048], shown[4 * sizeof text];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    whit_text_show(text, shown, sizeof shown);
    pthread_mutex_lock(&log_mutex);
    log->fn(log->user, level, shown);
    pthread_mutex_unlock(&log_mutex);
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
