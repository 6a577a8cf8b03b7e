/* A temporary folder for a test, by TEST_IN(name, folder_begin, folder_end), with its messages. */
#ifndef FOLDER_FIXTURE_H
#define FOLDER_FIXTURE_H

#include <unistd.h>

#include "messages_fixture.h"
#include "unit.h"

static char folder[32];

static inline int folder_begin(void **state)
{
    (void)state;
    messages = (struct messages){0};
    strcpy(folder, "/tmp/whit-test-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static inline int folder_end(void **state)
{
    (void)state;
    char command[64];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

/* A path in the folder; the string stays valid for fifteen more calls. */
static inline char *in_folder(const char *name)
{
    static char paths[16][320];
    static int next;
    char *path = paths[next++ % 16];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static inline void put_file(const char *path, const void *data, size_t bytes)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, bytes, file), bytes);
    assert_int_equal(fclose(file), 0);
}

/* Writes a file in the folder; gives its path, as in_folder(). */
static inline const char *put_data(const char *name, const void *data, size_t bytes)
{
    const char *path = in_folder(name);
    put_file(path, data, bytes);
    return path;
}

static inline const char *put_text(const char *name, const char *text)
{
    return put_data(name, text, strlen(text));
}

#endif
