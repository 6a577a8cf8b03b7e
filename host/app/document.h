/* JSON documents. Values that JSON cannot hold become null. Text loses nothing: a byte that is not
   UTF-8 becomes the characters `\xff`, and a backslash before an x becomes `\x5c`, so that
   replacing each `\x` and two digits by that byte gives back the original. Characters that control
   a terminal are written as JSON escapes. When memory runs out the program ends. */
#ifndef APP_DOCUMENT_H
#define APP_DOCUMENT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include <jansson.h>

#include "whit/whit.h"

json_t *document_object(void);
/* Every document begins with the version of whit and this format number. While the number stays the
   same, keys may be added, but none is renamed or removed. */
enum { DOCUMENT_FORMAT = 2 };
json_t *document_root(void);
json_t *document_array(void);
void document_append(json_t *array, json_t *value); /* takes over `value` */
void document_append_text(json_t *array, const char *text);
void document_put(json_t *object, const char *key, json_t *value); /* likewise */

/* An empty object or array, which its parent already holds: keys are written in the order in which
   they were put. */
json_t *document_child(json_t *object, const char *key);
json_t *document_list(json_t *object, const char *key);
json_t *document_entry(json_t *array);

void document_text(json_t *object, const char *key, const char *text); /* NULL: null */
/* Undoes in place what document_text has done to a text. */
void document_restore(char *text);
void document_number(json_t *object, const char *key, double value);
double document_known(double value); /* NAN, which is written as null, where it is negative */
void document_ms(json_t *object, const char *key, double time_ms); /* in whole microseconds */
void document_float(json_t *object, const char *key, float value); /* the shortest text that reads
                                                                      back as the same float */
void document_count(json_t *object, const char *key, uint64_t value);
void document_flag(json_t *object, const char *key, bool value);
void document_hash(json_t *object, const char *key, uint64_t value); /* 16 hex digits */
void document_floats(json_t *object, const char *key, const float *values, uint32_t count);
void document_numbers(json_t *object, const char *key, const double *values, uint32_t count);
json_t *document_device(const whit_device_info *info); /* its name, driver and kind */

/* A number of an object that was read, or `otherwise`; a whole number from 0 on, else 0. */
double document_read_number(const json_t *object, const char *key, double otherwise);
uint64_t document_read_count(const json_t *object, const char *key);

/* Writes `value` to a file, indented, and takes it over. */
WHIT_CHECK whit_result document_save(json_t *value, const char *path);
/* Writes `text` to a file and frees it; `text` NULL: memory ran out before. Errors were printed. */
WHIT_CHECK whit_result document_save_text(char *text, const char *path);
/* Writes what `write` writes to the stream to a file. Errors were printed. */
WHIT_CHECK whit_result document_save_written(const char *path,
                                             void (*write)(FILE *to, const void *user),
                                             const void *user);
/* The text of a document: in one line, or indented as document_save writes it; free() it. Takes
   over `value`. */
char *document_line(json_t *value);
char *document_lines(json_t *value);

#endif
