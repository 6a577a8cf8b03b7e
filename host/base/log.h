/* One-line messages to the caller's log function. */
#ifndef BASE_LOG_H
#define BASE_LOG_H

#include "whit/whit_base.h"

whit_log log_or_silence(const whit_log *log);

/* A NULL log is silent. */
void log_message(const whit_log *log, whit_log_level level, const char *format, ...)
    WHIT_PRINTF(3, 4);

/* Logs an error, and gives `result`. */
whit_result log_failure(const whit_log *log, whit_result result, const char *format, ...)
    WHIT_PRINTF(3, 4);

#define log_usage(log, ...)   log_failure((log), WHIT_ERROR_USAGE, __VA_ARGS__)
#define log_error(log, ...)   log_message((log), WHIT_LOG_ERROR, __VA_ARGS__)
#define log_warning(log, ...) log_message((log), WHIT_LOG_WARNING, __VA_ARGS__)
#define log_info(log, ...)    log_message((log), WHIT_LOG_INFO, __VA_ARGS__)
#define log_debug(log, ...)   log_message((log), WHIT_LOG_DEBUG, __VA_ARGS__)

#endif
