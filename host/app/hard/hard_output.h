/* The report of `whit hard`, as text and as JSON. */
#ifndef APP_HARD_HARD_OUTPUT_H
#define APP_HARD_HARD_OUTPUT_H

#include "app/hard/hard.h"

/* On standard output. */
int hard_print(const struct hard *hard);
/* To json_path. */
whit_result hard_save_json(const struct hard *hard);

#endif
