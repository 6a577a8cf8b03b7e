/* Collects the library's log messages. */
#ifndef MESSAGES_FIXTURE_H
#define MESSAGES_FIXTURE_H

#include <stdio.h>
#include <string.h>

#include "base/log.h"

static struct messages {
    int count, errors, warnings, validation; /* count: notes too; validation: of the layers */
    char last[1024], last_error[1024];
    int lines;          /* errors and warnings */
    char text[1 << 14]; /* errors and warnings, one per line */
} messages;

static inline void messages_collect(void *user, whit_log_level level, const char *message)
{
    struct messages *told = user;
    ++told->count;
    snprintf(told->last, sizeof told->last, "%s", message);
    if (level > WHIT_LOG_WARNING)
        return;
    told->errors += level == WHIT_LOG_ERROR;
    told->warnings += level == WHIT_LOG_WARNING;
    told->validation += strncmp(message, "validation: ", 12) == 0;
    if (level == WHIT_LOG_ERROR)
        snprintf(told->last_error, sizeof told->last_error, "%s", message);
    ++told->lines;
    size_t used = strlen(told->text);
    snprintf(told->text + used, sizeof told->text - used, "%s\n", message);
}

/* A log of all levels that collects into *told, which is emptied. */
static inline whit_log messages_log(struct messages *told)
{
    *told = (struct messages){0};
    return (whit_log){.fn = messages_collect, .user = told, .level = WHIT_LOG_DEBUG};
}

static const whit_log warnings_log = {
    .fn = messages_collect, .user = &messages, .level = WHIT_LOG_WARNING};

#endif
