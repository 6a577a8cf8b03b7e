/* `whit shader extract`: the functions that a picture carries, as files. */
#ifndef APP_SHADER_EXTRACT_H
#define APP_SHADER_EXTRACT_H

#include "app/job.h"

/* Writes the files below the folder `into`; NULL: a folder in the working folder, named like the
   picture without its ending. The folder must be missing or empty: a folder beside it is filled and
   renamed, so that it appears whole or not at all. Prints each file's path. Gives the exit code;
   errors were printed. */
int extract_run(const char *picture, const char *into, const whit_load_params *params);

#endif
