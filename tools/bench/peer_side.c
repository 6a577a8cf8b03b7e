#include "bench/peer_side.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum { LINE = 4200 };

_Noreturn void peer_fail(const struct peer_side *side, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fprintf(stderr, "%s: ", side->name);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
    exit(2);
}

void *peer_alloc(const struct peer_side *side, uint64_t count, size_t record)
{
    void *records = calloc(count ? (size_t)count : 1, record);
    if (!records)
        peer_fail(side, "out of memory");
    return records;
}

static double clock_ms(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

double peer_wall_ms(void)
{
    return clock_ms(CLOCK_MONOTONIC);
}

double peer_cpu_ms(void)
{
    return clock_ms(CLOCK_PROCESS_CPUTIME_ID);
}

/* Reads all records of a file into one block. */
static void *read_records(const struct peer_side *side, const char *path, size_t record,
                          uint64_t *count)
{
    struct stat info;
    FILE *from = fopen(path, "rb");
    if (!from || fstat(fileno(from), &info) != 0 || (uint64_t)info.st_size % record != 0)
        peer_fail(side, "%s: cannot read, or no whole number of records", path);
    *count = (uint64_t)info.st_size / record;
    void *records = peer_alloc(side, *count, record);
    if (fread(records, record, (size_t)*count, from) != *count)
        peer_fail(side, "%s: cannot read", path);
    fclose(from);
    return records;
}

void peer_read_triangles(struct peer_side *side, const char *path)
{
    side->triangles = read_records(side, path, sizeof *side->triangles, &side->triangle_count);
    if (side->triangle_count == 0 || side->triangle_count > UINT32_MAX / 3)
        peer_fail(side, "%s: no triangles, or too many", path);
}

void peer_keep_hit(const struct peer_side *side, uint64_t i, float t, uint32_t triangle)
{
    bool met = triangle != WHIT_NONE;
    const whit_triangle *at = met && !side->any ? &side->triangles[triangle] : NULL;
    side->hits[i] = (whit_hit){.t = met ? t : INFINITY,
                               .primitive = at    ? at->primitive
                                            : met ? 0
                                                  : WHIT_NONE,
                               .instance = at    ? at->instance
                                           : met ? 0
                                                 : WHIT_NONE};
}

/* ---- Lines ---- */

static void load_rays(struct peer_side *side, const char *path, const char *kind)
{
    free(side->rays);
    free(side->hits);
    side->rays = read_records(side, path, sizeof *side->rays, &side->count);
    side->hits = peer_alloc(side, side->count, sizeof *side->hits);
    side->any = strcmp(kind, "any") == 0;
    side->load(side->user);
    printf("rays %llu\n", (unsigned long long)side->count);
}

static void write_hits(const struct peer_side *side, const char *path)
{
    FILE *to = fopen(path, "wb");
    size_t count = (size_t)side->count;
    if (!to || fwrite(side->hits, sizeof *side->hits, count, to) != count || fclose(to) != 0)
        peer_fail(side, "%s: cannot write", path);
    printf("hits %llu\n", (unsigned long long)side->count);
}

static void obey(struct peer_side *side, char *line)
{
    char *word = strtok(line, " \n"), *argument = strtok(NULL, " \n"), *last = strtok(NULL, " \n"),
         *order = strtok(NULL, " \n");
    double ms[2] = {0.0}, bytes = 0.0;
    if (word && strcmp(word, "rays") == 0 && last) {
        load_rays(side, argument, last);
    } else if (word && strcmp(word, "hits") == 0 && argument) {
        write_hits(side, argument);
    } else if (word && strcmp(word, "build") == 0 && last && atoi(last) > 0 && side->build) {
        side->build(side->user, argument, atoi(last), ms, &bytes);
        printf("built %.6f %.0f\n", ms[0], bytes);
    } else if (word && strcmp(word, "trace") == 0 && order) {
        if (side->trace(side->user, argument, strcmp(last, "back") == 0,
                        strcmp(order, "coherent") == 0, ms))
            printf("time %.6f %.6f\n", ms[0], ms[1]);
        else
            puts("none");
    } else {
        peer_fail(side, "no such line: %s", word ? word : "");
    }
}

void peer_serve(struct peer_side *side, const char *version)
{
    char line[LINE];
    printf("ready %s\n", version);
    while (fflush(stdout) == 0 && fgets(line, sizeof line, stdin))
        obey(side, line);
    free(side->triangles);
    free(side->rays);
    free(side->hits);
}
