#include <stdarg.h>

#include "app/bench/bench_section.h"

void section_begin(struct section *section, struct bench *bench, const char *name, uint32_t steps)
{
    *section = (struct section){
        .bench = bench,
        .object = document_object(),
        .rows = document_array(),
        .sentences = document_array(),
    };
    document_text(section->object, "table", name);
    bench_begin(bench, steps);
}

void section_say(struct section *section, const char *format, ...)
{
    if (section->said_count == BENCH_NOTES_MAX)
        return;
    char *text = section->said[section->said_count++];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof section->said[0], format, args);
    va_end(args);
    document_append(section->sentences, json_string(text));
}

whit_result section_end(struct section *section, const char *title, whit_result result)
{
    bench_end(section->bench);
    document_put(section->object, "rows", section->rows);
    document_put(section->object, "sentences", section->sentences);
    if (result != WHIT_OK) {
        json_decref(section->object);
        return result;
    }
    printf("\n### %s\n\n", title);
    table_print(&section->table);
    putchar('\n');
    for (uint32_t i = 0; i < section->said_count; ++i)
        printf("- %s\n", section->said[i]);
    fflush(stdout);
    document_append(section->bench->sections, section->object);
    return WHIT_OK;
}

void section_keep(struct section *section, const struct bench_case *c, const char *key,
                  double report)
{
    json_t *row = bench_document(c);
    if (report > 0.0)
        document_number(row, key, report);
    document_append(section->rows, row);
}
