/* What `whit cost` was asked for, and its report in all forms. */
#ifndef APP_COST_COST_H
#define APP_COST_COST_H

#include "app/commands.h"
#include "app/document.h"
#include "cost/cost.h"

#define COST_RAYS_UNSAID WHIT_NONE

struct cost {
    struct job job;
    struct cost_request request;
    const char *html, *json, *csv, *markdown; /* files, or NULL */
    bool quick, compares;
    double under, within_ms; /* 0: not asked for */
    uint32_t metric;
    uint32_t rays; /* COST_RAYS_UNSAID: as it suits */
    char *command; /* that made it; owned */
    struct cli_progress progress;
    struct cost_report *report;
};

/* cost_request.progress of a cli_progress. */
void cost_on_progress(void *user, double done, double seconds_left, const char *what);

/* Seconds that `whit cost` may take by itself, with --quick, and for `whit render`'s choices. */
#define COST_SECONDS       150.0
#define COST_SECONDS_QUICK 20.0

/* ---- Tables and sentences, the same in all forms (cost_table.c) ---- */

/* `is_number`: to the right. */
struct cost_column {
    const char *head;
    bool is_number;
};
enum { COST_COLUMNS = 11, COST_HIT_COLUMNS = 13, COST_CELL = 64, COST_COLUMNS_MAX = 13 };
struct cost_cells {
    char text[COST_COLUMNS_MAX][COST_CELL];
};
extern const struct cost_column cost_columns[COST_COLUMNS], cost_hit_columns[COST_HIT_COLUMNS];
void cost_row_cells(const struct cost_report *report, const struct cost_row *row,
                    struct cost_cells *cells);
void cost_hit_cells(const struct cost_row *row, enum cost_set set, struct cost_cells *cells);
/* Calls say() with each sentence: how it was measured; what the figures answer. */
typedef void cost_say(void *user, const char *sentence);
void cost_say_method(const struct cost_report *report, cost_say *say, void *user);
void cost_say_answers(const struct cost_report *report, cost_say *say, void *user);

int cost_print_text(const struct cost *cost);
whit_result cost_save_markdown(const struct cost *cost);
whit_result cost_save_csv(const struct cost *cost);

/* ---- JSON (cost_json.c) ---- */

json_t *cost_document(const struct cost *cost);
whit_result cost_save_json(const struct cost *cost, const char *path);
/* What cost_save_json wrote, for comparisons: no pictures. `scene` gets the name of its scene,
   which the caller frees. False, said: another file. */
bool cost_load_json(const char *path, struct cost_report *report, char **scene);
/* The same as parts of other documents. The second takes over `root`; NULL is no report. */
json_t *cost_report_document(const struct cost_report *report);
bool cost_report_read(json_t *root, struct cost_report *report);

/* ---- Figures and choices in whit's cache (cost_kept.c) ---- */

enum { COST_KEPT_CHOICES = 16, COST_KEPT_NAME = 32 };
struct cost_kept_choice {
    double budget_ms, tried_ms; /* tried: what the picture was expected to take then */
    struct cost_choice choice;
};
struct cost_kept {
    struct cost_report report;
    char made[32]; /* when it was measured */
    uint32_t choice_count;
    struct cost_kept_choice choices[COST_KEPT_CHOICES];
};
/* Under which name whit's cache has it: another one for each scene, device, driver, version of
   whit, and for all settings that decide pixels or time. */
void cost_kept_name(const struct cost_place *place, char name[COST_KEPT_NAME]);
/* False: there is none, or it is broken or of something else. */
bool cost_kept_load(const struct cost_place *place, const char *name, struct cost_kept *kept);
/* Reports that are not complete are not kept. */
void cost_kept_save(const struct cost_kept *kept, const char *name);
void cost_kept_begin(struct cost_kept *kept, const struct cost_report *report);
/* The choice for that time, or NULL. */
const struct cost_kept_choice *cost_kept_find(const struct cost_kept *kept, double budget_ms);
void cost_kept_add(struct cost_kept *kept, const struct cost_kept_choice *choice);
/* view_params.load_figures and save_figures: the same record. */
bool cost_kept_load_figures(void *user, const struct cost_place *place,
                            struct cost_kept_figures *figures);
void cost_kept_save_figures(void *user, const struct cost_place *place,
                            const struct cost_kept_figures *figures);

/* ---- The page (cost_page.c) ---- */

extern const char cost_page_html[]; /* page.html, ended by 0; CMake makes it */
whit_result cost_save_page(const struct cost *cost);

/* Two reports beside each other (cost_compare.c). */
int cost_compare_files(const char *a, const char *b);

#endif
