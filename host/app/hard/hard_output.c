#include <stdlib.h>
#include <string.h>

#include "app/document.h"
#include "app/hard/hard_output.h"
#include "app/render/stats.h"

/* ---- Text ---- */

static unsigned long long whole(uint64_t value)
{
    return (unsigned long long)value;
}

/* The widths of the first two columns, in characters. */
struct widths {
    int name, place;
};

static int wider(int width, const char *text)
{
    int length = (int)strlen(text) + 2;
    return length > width ? length : width;
}

static struct widths measure(const whit_hard_report *report)
{
    struct widths widths = {wider(0, "case"), wider(0, "at")};
    for (uint32_t i = 0; i < report->row_count; ++i) {
        widths.name = wider(widths.name, report->rows[i].name);
        widths.place = wider(widths.place, report->rows[i].place);
    }
    return widths;
}

static void print_verdict(const whit_hard_report *report)
{
    printf("promises   %u of %u rows broke one\n", report->broken, report->row_count);
    if (report->unanswered)
        printf("answers    none in %u rows\n", report->unanswered);
}

static void print_bits(const whit_hard_report *report)
{
    if (!report->equal_bits)
        puts("bits       not promised to be the twin's, as this device divides or compares "
             "otherwise: see --portable");
    if (report->hash)
        printf("hash       %016llx of the exact identities of 512 rays a case%s\n",
               whole(report->hash),
               report->hash_met == 0              ? ""
               : report->hash_met == report->hash ? ", met by the device"
                                                  : ", NOT met by the device");
    putchar('\n');
}

static void print_heading(const struct hard *hard, struct widths widths)
{
    print_verdict(hard->report);
    stats_print_device("device     ", hard->job.device);
    printf("scene      %s\n", hard->job.settings.scene[0] ? cli_shown(hard->job.settings.scene)
                                                          : "the built-in cases");
    print_bits(hard->report);
    printf("%-*s%-*s%-12s%9s%8s%7s%8s%8s%7s%8s%6s%10s%11s%10s%8s  %s\n", widths.name, "case",
           widths.place, "at", "numerics", "rays", "misses", "leaks", "false", "other", "wrong",
           "double", "self", "ulp", "device ms", "twin ms", "differ", "kept");
}

static const char *verdict_of(const whit_hard_row *row)
{
    if (!row->kept)
        return "NO";
    if (row->unanswered)
        return "no answer";
    return row->numerics == WHIT_NUMERICS_FAST ? "-" : "yes";
}

static void print_row(const whit_hard_row *row, const whit_hard_row *before, struct widths widths)
{
    bool again =
        before && strcmp(before->name, row->name) == 0 && strcmp(before->place, row->place) == 0;
    printf("%-*s%-*s%-12s", widths.name, again ? "" : row->name, widths.place,
           again ? "" : row->place, value_word(values_numerics, (int)row->numerics));
    printf("%9llu%8llu%7llu%8llu%8llu%7llu%8llu%6llu%10.3g", whole(row->tally.rays),
           whole(row->tally.misses), whole(row->tally.leaks), whole(row->tally.false_hits),
           whole(row->tally.other_ids), whole(row->tally.wrong), whole(row->tally.double_hits),
           whole(row->tally.self_hits), row->tally.ulp_max);
    if (row->device_ms >= 0.0)
        printf("%11.2f", row->device_ms);
    else
        printf("%11s", "-");
    printf("%10.2f%8llu  %s\n", row->twin_ms, whole(row->differing), verdict_of(row));
}

/* Sums over all rows of a level. */
static void print_sum(const whit_hard_report *report, whit_numerics numerics, struct widths widths)
{
    whit_hard_row sum = {.name = "all", .place = "", .numerics = numerics, .kept = true};
    for (uint32_t i = 0; i < report->row_count; ++i) {
        const whit_hard_row *row = &report->rows[i];
        if (row->numerics != numerics)
            continue;
        sum.tally.rays += row->tally.rays;
        sum.tally.misses += row->tally.misses;
        sum.tally.leaks += row->promised ? row->tally.leaks : 0;
        sum.tally.false_hits += row->tally.false_hits;
        sum.tally.other_ids += row->tally.other_ids;
        sum.tally.wrong += row->tally.wrong;
        sum.tally.double_hits += row->tally.double_hits;
        sum.tally.self_hits += row->tally.self_hits;
        sum.tally.ulp_max =
            row->tally.ulp_max > sum.tally.ulp_max ? row->tally.ulp_max : sum.tally.ulp_max;
        sum.device_ms += row->device_ms > 0.0 ? row->device_ms : 0.0;
        sum.twin_ms += row->twin_ms;
        sum.differing += row->differing;
        sum.kept &= row->kept;
        sum.unanswered |= row->unanswered;
    }
    if (sum.tally.rays)
        print_row(&sum, NULL, widths);
}

static void print_surface(const whit_hard_report *report)
{
    printf("surface    %llu triangles, %llu edges: %llu open, %llu of more than two triangles, "
           "%llu flipped; %llu duplicate triangles\n",
           whole(report->triangles), whole(report->edges), whole(report->open_edges),
           whole(report->crowded_edges), whole(report->flipped_edges), whole(report->duplicates));
}

int hard_print(const struct hard *hard)
{
    const whit_hard_report *report = hard->report;
    static const whit_numerics levels[] = {WHIT_NUMERICS_FAST, WHIT_NUMERICS_WATERTIGHT,
                                           WHIT_NUMERICS_EXACT};
    struct widths widths = measure(report);
    print_heading(hard, widths);
    for (uint32_t i = 0; i < report->row_count; ++i)
        print_row(&report->rows[i], i ? &report->rows[i - 1] : NULL, widths);
    putchar('\n');
    for (size_t i = 0; i < sizeof levels / sizeof *levels; ++i)
        print_sum(report, levels[i], widths);
    if (hard->job.settings.scene[0]) {
        putchar('\n');
        print_surface(report);
    }
    return cli_finish_stdout(EXIT_FINE);
}

/* ---- JSON ---- */

static void put_row(json_t *out, const whit_hard_row *row)
{
    document_text(out, "case", row->name);
    document_text(out, "place", row->place);
    document_text(out, "numerics", value_word(values_numerics, (int)row->numerics));
    document_count(out, "rays", row->tally.rays);
    document_count(out, "hits", row->tally.hits);
    document_count(out, "misses", row->tally.misses);
    document_count(out, "leaks", row->tally.leaks);
    document_count(out, "false_hits", row->tally.false_hits);
    document_count(out, "other_ids", row->tally.other_ids);
    document_count(out, "wrong_keys", row->tally.wrong_keys);
    document_count(out, "wrong", row->tally.wrong);
    document_count(out, "double_hits", row->tally.double_hits);
    document_count(out, "self_hits", row->tally.self_hits);
    document_count(out, "differing", row->differing);
    document_number(out, "ulp_max", row->tally.ulp_max);
    document_ms(out, "device_ms", row->device_ms);
    document_ms(out, "twin_ms", row->twin_ms);
    document_flag(out, "unanswered", row->unanswered);
    document_flag(out, "promised", row->promised);
    document_flag(out, "kept", row->kept);
}

static void put_surface(json_t *out, const whit_hard_report *report)
{
    document_count(out, "triangles", report->triangles);
    document_count(out, "edges", report->edges);
    document_count(out, "open_edges", report->open_edges);
    document_count(out, "crowded_edges", report->crowded_edges);
    document_count(out, "flipped_edges", report->flipped_edges);
    document_count(out, "duplicates", report->duplicates);
}

whit_result hard_save_json(const struct hard *hard)
{
    const whit_hard_report *report = hard->report;
    json_t *out = document_root();
    whit_device_info device;
    whit_device_get_info(hard->job.device, &device);
    document_text(out, "scene", hard->job.settings.scene);
    document_text(out, "device", device.name);
    document_text(out, "driver", device.driver);
    if (report->hash)
        document_hash(out, "hash", report->hash);
    if (report->hash_met)
        document_hash(out, "hash_met", report->hash_met);
    if (hard->job.settings.scene[0])
        put_surface(document_child(out, "surface"), report);
    document_flag(out, "equal_bits", report->equal_bits);
    document_count(out, "broken", report->broken);
    json_t *rows = document_list(out, "rows");
    for (uint32_t i = 0; i < report->row_count; ++i)
        put_row(document_entry(rows), &report->rows[i]);
    return document_save(out, hard->json_path);
}
