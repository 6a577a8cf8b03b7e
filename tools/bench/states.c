#include "bench/bench.h"

#include <string.h>

json_t *states_find(const char *path, const char *name, const char *key)
{
    json_t *found = NULL, *state = NULL;
    FILE *from = fopen(path, "r");
    while (from && !found && (state = json_loadf(from, JSON_DISABLE_EOF_CHECK, NULL)) != NULL) {
        const char *at = json_string_value(json_object_get(state, "at"));
        if (at && strcmp(at, name) == 0)
            found = json_incref(json_object_get(state, key));
        json_decref(state);
    }
    if (from)
        fclose(from);
    return found;
}
