/* Scene files. Sizes that a file asks for are honoured by whit up to millions of triangles; inputs
   that ask for many are passed over, or one would take all the time. */
#include "fuzz.h"

#include <jansson.h>
#include <string.h>

enum { STEPS_MAX = 48, LEVEL_MAX = 2, COPIES_MAX = 512 };

/* Bounds how many objects `value` and all in it would place in `copies` copies; above COPIES_MAX
   also for a shape of many triangles. */
static double copies_in(const json_t *value, const char *key, double copies)
{
    const char *name;
    json_t *child;
    size_t i;
    double number = json_number_value(value), sum = copies;
    if (json_is_number(value) && number > (strcmp(key, "level") == 0 ? LEVEL_MAX : STEPS_MAX) &&
        (strstr("level steps segments rings sides bays", key) && key[0]))
        return COPIES_MAX + 1.0;
    if (json_is_number(value) && strcmp(key, "count") == 0)
        return number > 1.0 ? number * copies : copies;
    if (json_is_array(value) && strcmp(key, "count") == 0) {
        json_array_foreach(value, i, child) copies = copies_in(child, "count", copies);
        return copies;
    }
    if (json_is_object(value)) {
        const json_t *repeat = json_object_get(value, "repeat");
        if (repeat)
            copies = sum = copies_in(json_object_get(repeat, "count"), "count", copies);
        json_object_foreach((json_t *)(uintptr_t)value, name, child) sum +=
            copies_in(child, name, copies) - copies;
    }
    json_array_foreach(value, i, child) sum += copies_in(child, "", copies);
    return sum;
}

static void prepare(void)
{
    static const char model[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    static const char picture[] = "Pf\n1 1\n-1.0\n\0\0\x80\x3f";
    fuzz_file("a.obj", model, strlen(model));
    fuzz_file("sky.pfm", picture, sizeof picture - 1);
}

static void run(const uint8_t *data, size_t size_bytes)
{
    json_t *root = json_loadb((const char *)data, size_bytes, 0, NULL);
    bool small = copies_in(root, "", 1.0) <= COPIES_MAX;
    json_decref(root);
    if (small)
        fuzz_load(fuzz_file("scene.json", data, size_bytes));
}

const struct fuzz_target fuzz_target = {
    .run = run, .prepare = prepare, .memory_bytes = UINT64_C(256) << 20};
