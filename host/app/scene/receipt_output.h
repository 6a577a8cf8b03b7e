/* The report of `whit scene --effects` as text and as JSON. */
#ifndef APP_SCENE_RECEIPT_OUTPUT_H
#define APP_SCENE_RECEIPT_OUTPUT_H

#include "app/scene/receipt.h"

int receipt_print_text(const struct receipt *receipt);
int receipt_print_json(const struct receipt *receipt);

#endif
