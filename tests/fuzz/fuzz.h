/* The interface of the fuzz targets. Each target is one file that fills in `fuzz_target`; fuzz.c
   holds the entry point that libFuzzer calls, replay.c a main() that runs files through it instead.
 */
#ifndef TESTS_FUZZ_H
#define TESTS_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"

struct child_reply;
struct scene;

struct fuzz_target {
    /* One input, exactly size_bytes long for sanitizers. What is wrong is told by fuzz_check. */
    void (*run)(const uint8_t *data, size_t size_bytes);
    /* The memory that an input may have allocated at a time, beyond ten times its size. It is
       checked where AddressSanitizer is built in. */
    uint64_t memory_bytes;
    void (*prepare)(void); /* once, before the first input; may be NULL */
};
extern const struct fuzz_target fuzz_target;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size_bytes);

/* Prints the text and aborts, which is how libFuzzer learns of a finding. */
void fuzz_check(bool good, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The run's own folder, made at the first call and removed with all in it at the end. */
const char *fuzz_folder(void);
/* Writes a file of that folder, in place of the one that was there, and gives its path. */
const char *fuzz_file(const char *name, const void *data, size_t size_bytes);

/* Counts errors and keeps the last one; every message is formatted. */
extern const whit_log fuzz_log;
void fuzz_log_clear(void);
const char *fuzz_log_last(void); /* "" when there was none since */
/* Checks what a call that ended with `result` logged: nothing on success, else one error, which
   names `path`, or where that is NULL any file by its whole path. Running out of memory is a
   finding: no input is large enough for it. */
void fuzz_check_errors(whit_result result, const char *path);

/* Loads a file by its name's extension. A scene that comes out can be given trees that the
   validator accepts. */
void fuzz_load(const char *path);
void fuzz_check_trees(const struct scene *scene);

/* Gets each answer of a child, and may change it. NULL: the end of a model's bytes says how the
   answer is damaged. */
extern void (*fuzz_reply)(struct child_reply *reply);

/* Copies a file. In a PNG each chunk gets the checksum that fits; other files are copied as they
   are. */
uint8_t *fuzz_signed(const uint8_t *data, size_t size_bytes);

#endif
