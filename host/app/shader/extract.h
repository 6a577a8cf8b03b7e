/* `whit shader extract`: the functions that a picture carries, as files. */
#ifndef APP_SHADER_EXTRACT_H
#define APP_SHADER_EXTRACT_H

#include "app/job.h"

/* Writes them below `into`, or where that is NULL below a folder of the working folder called as
   the picture is without its ending. The folder must not be there, or be empty: it is filled beside
   and renamed, so that it appears whole or not at all, and nothing in it was there before. Prints
   each file's path. The exit code; failures were said. */
int extract_run(const char *picture, const char *into, const whit_load_params *params);

#endif
