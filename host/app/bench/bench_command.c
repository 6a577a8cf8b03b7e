/* `whit bench` replaces its process by the program whit-bench. */
#define _GNU_SOURCE
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/arguments.h"
#include "app/bench/request.h"
#include "app/cache.h"
#include "app/commands.h"

static int list_benches(void)
{
    for (int i = 0; i < BENCH_COUNT; ++i)
        printf("%-9s %s\n", bench_kinds[i].name, bench_kinds[i].summary);
    return cli_finish_stdout(EXIT_FINE);
}

/* Finds the paths of this program and of whit-bench, which lies beside it in a build folder and in
   ../libexec/whit where both are installed. */
static bool find_programs(char whit[2048], char bench[2200])
{
    static const char *const places[] = {"whit-bench", "../libexec/whit/whit-bench"};
    ssize_t length = readlink("/proc/self/exe", whit, 2047);
    whit[length > 0 ? length : 0] = 0;
    const char *slash = strrchr(whit, '/');
    for (size_t i = 0; slash && i < sizeof places / sizeof places[0]; ++i) {
        snprintf(bench, 2200, "%.*s/%s", (int)(slash - whit), whit, places[i]);
        if (access(bench, X_OK) == 0)
            return true;
    }
    return false;
}

/* Returns only where whit-bench cannot be run. */
static int run_bench(int argc, char **argv)
{
    char whit[2048], bench[2200];
    char **arguments = calloc((size_t)argc + 3, sizeof *arguments);
    if (!arguments)
        return CLI_FAIL(EXIT_USAGE, "out of memory");
    if (find_programs(whit, bench)) {
        arguments[0] = bench;
        arguments[1] = whit;
        memcpy(arguments + 2, argv, (size_t)argc * sizeof *argv);
        execv(bench, arguments);
        cli_error("%s: cannot be run: %s", bench, strerror(errno));
    } else {
        cli_error("`whit-bench` is neither beside this program nor in ../libexec/whit; the build "
                  "makes it with WHIT_BENCH=ON");
    }
    free(arguments);
    return EXIT_USAGE;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct bench_request request;
    cli_reader_init(&reader, command, argc, argv);
    if (!bench_read(&reader, &request))
        return reader.status;
    if (request.which == BENCH_COUNT)
        return list_benches();
#ifndef WHIT_VIEWER
    if (request.which == BENCH_VIEW) {
        cli_error("there is no viewer to measure: this whit was built without it (WHIT_VIEWER)");
        return EXIT_USAGE;
    }
#endif
    cache_prepare(request.settings.no_cache); /* in the environment, which whit-bench inherits */
    return run_bench(argc, argv);
}

const struct cli_command command_bench = {
    .name = "bench",
    .arguments = "[BENCH] [MODEL or SCENE...] [options]",
    .others_max = CLI_OTHERS_MAX,
    .summary = "Measures what choices cost on this machine, and prints the tables.",
    .details = "Without BENCH it lists the benches. Tables are Markdown, on standard output.\n",
    .options = bench_options,
    .settings = IN_BENCH,
    .run = run,
};
