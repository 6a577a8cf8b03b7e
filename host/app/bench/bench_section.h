/* A section of the report: a table, sentences below it, and both as JSON. */
#ifndef APP_BENCH_BENCH_SECTION_H
#define APP_BENCH_BENCH_SECTION_H

#include "app/bench/bench.h"

#define CASES(array) (uint32_t)(sizeof(array) / sizeof((array)[0]))

struct section {
    struct bench *bench;
    json_t *object, *rows, *sentences;
    struct table table;
    char said[BENCH_NOTES_MAX][400];
    uint32_t said_count;
};

/* `steps`: of its progress. */
void section_begin(struct section *section, struct bench *bench, const char *name, uint32_t steps);
/* A sentence below the table. */
void section_say(struct section *section, const char *format, ...) WHIT_PRINTF(2, 3);
/* One measured case as a row of JSON, with the report's figure where it has one (else 0). */
void section_keep(struct section *section, const struct bench_case *c, const char *key,
                  double report);
/* Prints it, unless it was cut short: gives `result`. */
WHIT_CHECK whit_result section_end(struct section *section, const char *title, whit_result result);

/* bench_builders.c: sections on numbers of bins, and on spatial splits in a scene. */
WHIT_CHECK whit_result bench_numbers_of_bins(struct bench *bench);
WHIT_CHECK whit_result bench_spatial_splits(struct bench *bench, const char *scene_name,
                                            const char *title);

#endif
