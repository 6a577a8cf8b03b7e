/* Figures and choices in whit's cache. */
#ifndef APP_COST_COST_KEPT_H
#define APP_COST_COST_KEPT_H

#include "app/cost/cost.h"

enum { COST_KEPT_CHOICES = 16, COST_KEPT_NAME = 32 };
struct cost_kept_choice {
    double budget_ms, tried_ms; /* tried_ms: the time that trials predicted for the picture */
    struct cost_choice choice;
};
struct cost_kept {
    char name[COST_KEPT_NAME]; /* the record's in whit's cache: set by cost_kept_load */
    struct cost_report report;
    char made[32]; /* date of the measurement */
    uint32_t choice_count;
    struct cost_kept_choice choices[COST_KEPT_CHOICES];
};
/* Reads the record for the conditions. False: there is none, or it is damaged or belongs to
   something else; cost_kept_begin begins it. */
bool cost_kept_load(const struct cost_place *place, struct cost_kept *kept);
/* Reports that are not complete are not kept. */
void cost_kept_save(const struct cost_kept *kept);
void cost_kept_begin(struct cost_kept *kept, const struct cost_report *report);
/* The choice for this budget whose tries took no longer, or NULL: the device may be faster now. */
const struct cost_kept_choice *cost_kept_find(const struct cost_kept *kept, double budget_ms);
/* Adds the choice to the record as it is by now, since other runs may have added theirs, or else to
   `kept`, and saves it. It replaces the one for the same budget, or, where there is no room, the
   oldest. */
void cost_kept_add(const struct cost_place *place, const struct cost_kept *kept,
                   const struct cost_kept_choice *choice);
/* view_params.load_figures and save_figures, which use the same record. */
bool cost_kept_load_figures(const struct cost_place *place, struct cost_kept_figures *figures);
void cost_kept_save_figures(const struct cost_place *place,
                            const struct cost_kept_figures *figures);

#endif
