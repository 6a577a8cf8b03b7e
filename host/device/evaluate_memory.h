/* What variables hold while a kernel is evaluated. */
#ifndef DEVICE_EVALUATE_MEMORY_H
#define DEVICE_EVALUATE_MEMORY_H

#include "device/evaluate.h"

/* Counts writes, through calls too. */
void evaluate_count_writes(struct evaluation *e);
void evaluate_load(struct evaluation *e, const uint32_t *instruction);
void evaluate_store(struct evaluation *e, const uint32_t *instruction);
/* Parameters become what the call at `call` hands over. */
void evaluate_bind_parameters(struct evaluation *e, const uint32_t *call, uint32_t function_at);

#endif
