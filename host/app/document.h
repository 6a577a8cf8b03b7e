/* JSON documents. Values that JSON cannot hold become null. Text keeps all that it has: a byte that
   is not UTF-8 is the characters `\xff` in it, a backslash before an x is `\x5c`, so that
   putting a byte where `\x` and two digits are gives back what it was. What would steer a terminal
   is written as JSON's escapes. When memory runs out the program ends. */
#ifndef APP_DOCUMENT_H
#define APP_DOCUMENT_H

#include <stdbool.h>
#include <stdint.h>

#include <jansson.h>

#include "whit/whit.h"

json_t *document_object(void);
/* An object with the version of whit and that of the names of keys, which begin every document.
   From 2 on keys are added, and none is renamed or removed while the number stays. */
enum { DOCUMENT_FORMAT = 2 };
json_t *document_root(void);
json_t *document_array(void);
void document_append(json_t *array, json_t *value);                /* takes over `value` */
void document_put(json_t *object, const char *key, json_t *value); /* likewise */

void document_text(json_t *object, const char *key, const char *text); /* NULL: null */
void document_number(json_t *object, const char *key, double value);
void document_ms(json_t *object, const char *key, double time_ms); /* in whole microseconds */
void document_float(json_t *object, const char *key, float value); /* shortest that reads back */
void document_count(json_t *object, const char *key, uint64_t value);
void document_flag(json_t *object, const char *key, bool value);
void document_hash(json_t *object, const char *key, uint64_t value); /* 16 hex digits */
void document_floats(json_t *object, const char *key, const float *values, uint32_t count);
void document_numbers(json_t *object, const char *key, const double *values, uint32_t count);
/* Writes it to a file, indented. Takes over `value`. */
WHIT_CHECK whit_result document_save(json_t *value, const char *path);
/* Writes a text that is free()d; NULL: memory ran out for it. Failures were said. */
WHIT_CHECK whit_result document_save_text(char *text, const char *path);
/* In one line, and as what is saved; free() it. NULL: memory ran out. Takes over `value`. */
char *document_line(json_t *value);
char *document_lines(json_t *value);

#endif
