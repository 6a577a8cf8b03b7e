#include "base/path.h"

#include <string.h>

#include "base/array.h"

const char *path_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

char *path_folder(const char *path)
{
    return string_format("%.*s", (int)(path_name(path) - path), path);
}

char *path_beside(const char *file, const char *relative)
{
    if (relative[0] == '/')
        return string_copy(relative);
    return string_format("%.*s%s", (int)(path_name(file) - file), file, relative);
}

void path_extension(const char *path, char *out, size_t out_bytes)
{
    if (out_bytes == 0)
        return;
    out[0] = 0;
    const char *name = path_name(path);
    const char *dot = strrchr(name, '.');
    if (!dot || dot == name || strlen(dot + 1) >= out_bytes)
        return; /* a truncated extension could look like another one */
    size_t i = 0;
    for (const char *c = dot + 1; *c; ++c, ++i)
        out[i] = (char)(*c >= 'A' && *c <= 'Z' ? *c - 'A' + 'a' : *c);
    out[i] = 0;
}

bool path_is(const char *path, const char *extension)
{
    char own[16];
    path_extension(path, own, sizeof own);
    return strcmp(own, extension) == 0;
}
