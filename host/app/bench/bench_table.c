#include <stdarg.h>
#include <string.h>

#include "app/bench/bench.h"

void table_begin(struct table *table, const char *const *heads)
{
    *table = (struct table){0};
    table->row_count = 1;
    for (; heads[table->column_count] && table->column_count < TABLE_COLUMNS_MAX;
         ++table->column_count)
        snprintf(table->cells[0][table->column_count], TABLE_CELL, "%s",
                 heads[table->column_count]);
}

void table_row(struct table *table)
{
    table->row_count += table->row_count < TABLE_ROWS_MAX;
    table->cell = 0;
}

void table_cell(struct table *table, const char *format, ...)
{
    if (table->cell >= table->column_count)
        return;
    va_list args;
    va_start(args, format);
    vsnprintf(table->cells[table->row_count - 1][table->cell++], TABLE_CELL, format, args);
    va_end(args);
}

static int decimals_for(double value)
{
    return value < 10.0 ? 2 : value < 100.0 ? 1 : 0;
}

void table_ms(struct table *table, const struct sample_runs *times)
{
    if (times->count == 0) {
        table_cell(table, "-");
        return;
    }
    double median = sample_of(times).median;
    table_cell(table, "%.*f ± %.*f", decimals_for(median), median, decimals_for(median),
               sample_of(times).spread);
}

/* The number of characters in a UTF-8 text. */
static size_t count_letters(const char *text)
{
    size_t count = 0;
    for (; *text; ++text)
        count += ((unsigned char)*text & 0xc0) != 0x80;
    return count;
}

static void print_spaces(size_t count)
{
    for (size_t i = 0; i < count; ++i)
        putchar(' ');
}

static void print_padded(const char *text, size_t width, bool right, bool ends)
{
    size_t pad = width - count_letters(text);
    putchar(' ');
    print_spaces(right ? pad : 0);
    fputs(text, stdout);
    print_spaces(right ? 0 : pad);
    fputs(ends ? "" : " |", stdout);
}

static void print_rule(const struct table *table, const size_t *widths)
{
    putchar('|');
    for (uint32_t c = 0; c < table->column_count; ++c) {
        for (size_t i = 0; i < widths[c] + 1; ++i)
            putchar('-');
        putchar(c ? ':' : '-');
        fputs(table->is_open && c + 1 == table->column_count ? "" : "|", stdout);
    }
    putchar('\n');
}

void table_print(const struct table *table)
{
    size_t widths[TABLE_COLUMNS_MAX] = {0};
    for (uint32_t r = 0; r < table->row_count; ++r) {
        for (uint32_t c = 0; c < table->column_count; ++c) {
            size_t letters = count_letters(table->cells[r][c]);
            widths[c] = letters > widths[c] ? letters : widths[c];
        }
    }
    for (uint32_t r = 0; r < table->row_count; ++r) {
        putchar('|');
        for (uint32_t c = 0; c < table->column_count; ++c)
            print_padded(table->cells[r][c], widths[c], c > 0,
                         table->is_open && c + 1 == table->column_count);
        putchar('\n');
        if (r == 0)
            print_rule(table, widths);
    }
}
