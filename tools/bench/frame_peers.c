#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "frame.h"

/* Whether `program --version` runs, and its line with `word` into `line`. */
static bool ask_version(const struct peers *peers, const char *program, const char *word,
                        char line[128])
{
    char path[BENCH_PATH];
    const char *const arguments[] = {program, "--version", NULL};
    const struct bench_child child = {.program = program,
                                      .arguments = arguments,
                                      .folder = peers->folder,
                                      .is_tried = true,
                                      .out = "version",
                                      .err = "version.err"};
    bool runs = bench_child_run(&child, NULL) == WHIT_OK;
    line[0] = 0;
    static const char *const files[] = {"version", "version.err"};
    for (size_t i = 0; runs && !line[0] && i < 2; ++i) {
        snprintf(path, sizeof path, "%s/%s", peers->folder, files[i]);
        FILE *from = fopen(path, "r");
        while (from && fgets(line, 128, from) && strncmp(line, word, strlen(word)) != 0)
            line[0] = 0;
        if (from)
            fclose(from);
    }
    line[strcspn(line, "\n")] = 0;
    return line[0] != 0;
}

static void find_pov(struct peers *peers)
{
    struct figures *figures = peers->figures;
    char path[BENCH_PATH], line[128];
    whit_result found = bench_find(figures->section.bench, "34k", path, sizeof path);
    char *slash = found == WHIT_OK ? strrchr(path, '/') : NULL;
    if (slash)
        *slash = 0;
    snprintf(peers->pov_scenes, sizeof peers->pov_scenes, "%.1900s/../tests/peers/pov/scenes.sh",
             slash ? path : ".");
    if (access(peers->pov_scenes, R_OK) != 0) {
        figures_leave_out(figures, "glass, wine, flake, hollow, mesh",
                          "tests/peers/pov/scenes.sh is not beside whit's scenes");
    } else if (!ask_version(peers, "povray", "POV-Ray", line)) {
        figures_leave_out(figures, "glass, wine, flake, hollow, mesh",
                          "povray is not installed (Debian: povray)");
    } else {
        peers->has_pov = true;
        section_say(&figures->section, "Beside %s.", cli_shown(line));
    }
}

whit_result peers_find_against(struct peers *peers)
{
    struct bench *bench = peers->figures->section.bench;
    char line[128];
    if (bench->against) {
        char *whole = strchr(bench->against, '/') ? realpath(bench->against, NULL) : NULL;
        snprintf(peers->against, sizeof peers->against, "%s", whole ? whole : bench->against);
        free(whole);
        if (!ask_version(peers, peers->against, "whit ", line)) {
            cli_error("--against %s: is no whit that runs", cli_shown(bench->against));
            return WHIT_ERROR_INPUT;
        }
        bench->against = peers->against;
    } else {
        figures_leave_out(peers->figures, "another whit", "--against PROGRAM names it");
    }
    return WHIT_OK;
}

whit_result frame_find_peers(struct peers *peers)
{
    whit_result result = peers_find_against(peers);
    if (result != WHIT_OK)
        return result;
    peers->has_embree = peer_is_here();
    if (!peers->has_embree)
        figures_leave_out(peers->figures, "Embree",
                          "`whit-embree` is not beside this program; the build makes it where "
                          "Embree 3 is installed (Debian: libembree-dev)");
    if (peers->wants_pov)
        find_pov(peers);
    return WHIT_OK;
}
