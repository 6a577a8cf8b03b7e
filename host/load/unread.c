#define _GNU_SOURCE /* memmem */
#include "load/unread.h"

#include "base/text.h"
#include <stdlib.h>
#include <string.h>

/* A part of the file. */
struct span {
    const char *at, *end;
};

static struct span span_of(const struct import_file *file)
{
    return (struct span){(const char *)file->data, (const char *)file->data + file->size_bytes};
}

/* Moves the span's begin behind the next `word` in it; false: there is none. */
static bool find(struct span *in, const char *word)
{
    const char *found = memmem(in->at, (size_t)(in->end - in->at), word, strlen(word));
    if (found)
        in->at = found + strlen(word);
    return found;
}

/* Whether the first `within` bytes have these in them. */
static bool holds(struct span in, size_t within, const char *bytes, size_t count)
{
    size_t room = (size_t)(in.end - in.at);
    return memmem(in.at, room < within ? room : within, bytes, count);
}

/* --- COLLADA -------------------------------------------------------------------------------- */

static uint32_t count_wraps(struct span in)
{
    uint32_t count = 0;
    while (find(&in, "<wrap_"))
        count += !holds(in, sizeof "s>CLAMP</wrap_s" - 1, "WRAP", 4);
    return count;
}

/* The first whole number in the quotes that follow; -1: there is none. */
static int quoted_number(struct span in)
{
    const char *end =
        in.at < in.end ? memchr(in.at + 1, *in.at, (size_t)(in.end - in.at - 1)) : NULL;
    int number = -1;
    for (const char *at = in.at; end && at < end && number < 1000; at++)
        if (*at >= '0' && *at <= '9')
            number = (number < 0 ? 0 : number * 10) + *at - '0';
    return number;
}

/* assimp takes the set from the name if that has a number in it. Files may count sets from 1, which
   assimp counts from 0. */
static bool read_uv_sets(struct span in, uint32_t *unread)
{
    struct span double_quotes = in, single_quotes = in;
    bool good = find(&double_quotes, " set=\"0\"") || find(&single_quotes, " set='0'");
    *unread = 0;
    while (find(&in, "<bind_vertex_input")) {
        const char *close = memchr(in.at, '>', (size_t)(in.end - in.at));
        struct span set = {in.at, close ? close : in.at}, name = set;
        if (!find(&set, "input_set=") || !find(&name, " semantic="))
            continue;
        int wanted = quoted_number(set), named = quoted_number(name);
        good &= named < 0 || named == wanted;
        *unread += wanted > 0 && named != wanted;
    }
    return good;
}

bool unread_trusts_sets(const struct import_file *file)
{
    uint32_t unread;
    return read_uv_sets(span_of(file), &unread);
}

static uint32_t count_parameters(struct span in)
{
    uint32_t count = 0;
    while (find(&in, "<param ref="))
        count++;
    return count;
}

static bool is_one(struct span in)
{
    bool one = true;
    for (int i = 0; i < 16; i++) {
        char text[64] = "";
        while (in.at < in.end && *in.at <= ' ')
            in.at++;
        for (size_t k = 0; in.at<in.end && * in.at> ' ' && *in.at != '<' && k < sizeof text - 1;)
            text[k++] = *in.at++;
        one &= text_real(text, NULL) == (i % 5 == 0);
    }
    return one;
}

static uint32_t count_bind_shapes(struct span in)
{
    uint32_t count = 0;
    while (find(&in, "<bind_shape_matrix>"))
        count += !is_one(in);
    return count;
}

const char *unread_refusal(const struct import_file *file)
{
    struct span in = span_of(file);
    return find(&in, "<skew") ? "it has a <skew>, which is not read" : NULL;
}

/* --- FBX ------------------------------------------------------------------------------------ */

/* In a text, the value of a property stands behind the last comma of its line. In a binary file,
   up to three short strings come first. */
static bool has_value(struct span in, bool binary, char value, const char *bytes, size_t count)
{
    if (binary)
        return holds(in, 32, bytes, count);
    const char *end = memchr(in.at, '\n', (size_t)(in.end - in.at));
    while (end && end > in.at && end[-1] <= ' ')
        end--;
    return end && end - in.at > 1 && end[-1] == value && (end[-2] == ',' || end[-2] == ' ');
}

static uint32_t count_values(struct span in, const char *name, bool binary, char value,
                             const char *bytes, size_t count)
{
    uint32_t found = 0;
    while (find(&in, name))
        found += has_value(in, binary, value, bytes, count);
    return found;
}

void unread_count(const struct import_request *request, struct import_counts *counts)
{
    const struct span all = span_of(&request->files[0]);
    if (request->kind == IMPORT_DAE) {
        counts->wraps = count_wraps(all);
        (void)read_uv_sets(all, &counts->uv_sets);
        counts->parameters = count_parameters(all);
        counts->bind_shapes = count_bind_shapes(all);
    } else if (request->kind == IMPORT_FBX) {
        static const char one[] = "I\1\0\0", zero[] = "D\0\0\0\0\0\0\0";
        bool binary = holds(all, 8, "Kaydara ", 8);
        counts->wraps = count_values(all, "WrapModeU", binary, '1', one, sizeof one) +
                        count_values(all, "WrapModeV", binary, '1', one, sizeof one);
        counts->hidden = count_values(all, binary ? "Visibility" : "\"Visibility\", \"Visibility\"",
                                      binary, '0', zero, sizeof zero);
    }
}
