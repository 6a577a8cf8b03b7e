#include <stdlib.h>
#include <string.h>

#include "bench/frame_peers.h"
#include "bench/process.h"

/* Whether `program --version` runs; `line` gets the line of its output that has `word`. */
static bool ask_version(const struct bench *bench, const char *program, const char *word,
                        char line[128])
{
    static const char *const files[] = {"version", "version.err"};
    struct process process = {.program = program,
                              .folder = bench->folder,
                              .is_tried = true,
                              .out = files[0],
                              .err = files[1]};
    process_add(&process, program, "--version", NULL);
    bool runs = process_run(&process, NULL) == WHIT_OK;
    line[0] = 0;
    for (size_t i = 0; runs && !line[0] && i < 2; ++i) {
        char path[BENCH_PATH];
        bench_file(bench, files[i], path);
        FILE *from = fopen(path, "r");
        while (from && fgets(line, 128, from) && strncmp(line, word, strlen(word)) != 0)
            line[0] = 0;
        if (from)
            fclose(from);
    }
    line[strcspn(line, "\n")] = 0;
    return line[0] != 0;
}

static void find_pov(struct peers *peers, struct table *table)
{
    static const char pictures[] = "glass, wine, flake, hollow, mesh";
    char line[128];
    if (!bench_find_beside(table->bench, "../tests/peers/pov/scenes.sh", peers->pov_scenes)) {
        table_leave_out(table, pictures, "tests/peers/pov/scenes.sh is not beside whit's scenes");
    } else if (!ask_version(table->bench, "povray", "POV-Ray", line)) {
        table_leave_out(table, pictures, "povray is not installed (Debian: povray)");
    } else {
        peers->has_pov = true;
        table_say(table, "Beside %s.", line);
    }
}

/* Whether that whit has --packets and --classes. */
static bool has_choices(const struct bench *bench, const char *program)
{
    struct process process = {.program = program,
                              .folder = bench->folder,
                              .is_tried = true,
                              .out = "choices",
                              .err = "choices.err"};
    process_add(&process, program, "render", "--packets", "off", "--classes", "many", "--help",
                NULL);
    return process_run(&process, NULL) == WHIT_OK;
}

whit_result peers_find_against(struct peers *peers, struct table *table)
{
    const char *against = table->bench->ask.against;
    char line[128];
    if (!against) {
        table_leave_out(table, "another whit", "--against PROGRAM names it");
        return WHIT_OK;
    }
    char *whole = strchr(against, '/') ? realpath(against, NULL) : NULL;
    snprintf(peers->against, sizeof peers->against, "%s", whole ? whole : against);
    free(whole);
    if (!ask_version(table->bench, peers->against, "whit ", line))
        return CLI_FAIL(WHIT_ERROR_INPUT, "--against %s: is no whit that runs", cli_shown(against));
    peers->against_chooses = has_choices(table->bench, peers->against);
    return WHIT_OK;
}

void peers_find(struct peers *peers, struct table *table, bool wants_pov)
{
    peers->has_embree = !peer_why_not(PEER_EMBREE, NULL);
    if (!peers->has_embree)
        table_leave_out(table, "Embree", peer_why_not(PEER_EMBREE, NULL));
    if (wants_pov)
        find_pov(peers, table);
}
