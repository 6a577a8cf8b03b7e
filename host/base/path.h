/* Paths as text. */
#ifndef BASE_PATH_H
#define BASE_PATH_H

#include <stdbool.h>
#include <stddef.h>

/* Folder part of `path` with its slash, "" when there is none. Release with free(). */
char *path_folder(const char *path);
/* The path of `relative`, taken from the folder of `file`; absolute paths are kept. Release with
   free(). */
char *path_beside(const char *file, const char *relative);
/* Lower-case extension without the dot, "" when there is none. */
void path_extension(const char *path, char *out, size_t out_bytes);
bool path_is(const char *path, const char *extension); /* `extension` as path_extension gives it */
const char *path_name(const char *path);               /* behind the last slash */

#endif
