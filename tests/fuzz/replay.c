/* Runs the files below the folders given through a fuzz target, in any build: what libFuzzer does
   with a corpus before it mutates it. At least one file must be there. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "fuzz.h"

static void run_file(const char *path)
{
    uint8_t *data;
    size_t size_bytes;
    fuzz_log_clear();
    fuzz_check(file_read(&fuzz_log, NULL, path, 0, &data, &size_bytes) == WHIT_OK,
               "%s: cannot be read", path);
    uint8_t *exact = malloc(size_bytes ? size_bytes : 1);
    fuzz_check(exact, "out of memory");
    memcpy(exact, data, size_bytes);
    free(data);
    printf("%s:", path);
    fflush(stdout); /* the last line names what failed */
    LLVMFuzzerTestOneInput(exact, size_bytes);
    printf(" %s\n", *fuzz_log_last() ? fuzz_log_last() : "fine");
    free(exact);
}

static int run_folder(const char *folder)
{
    struct dirent **entries;
    int count = scandir(folder, &entries, NULL, alphasort), run = 0;
    for (int i = 0; i < count; i++) {
        char *path = string_format("%s/%s", folder, entries[i]->d_name);
        fuzz_check(path, "out of memory");
        if (entries[i]->d_name[0] != '.' && entries[i]->d_type == DT_DIR) {
            run += run_folder(path);
        } else if (entries[i]->d_name[0] != '.') {
            run_file(path);
            run++;
        }
        free(path);
        free(entries[i]);
    }
    if (count >= 0)
        free(entries);
    return run;
}

int main(int argc, char **argv)
{
    int run = 0;
    for (int i = 1; i < argc; i++)
        run += run_folder(argv[i]);
    printf("%d inputs, no finding\n", run);
    return run > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
