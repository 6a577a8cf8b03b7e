/* Kernels of a picture, by `whit scene --kernels`. */
#ifndef APP_SCENE_KERNELS_H
#define APP_SCENE_KERNELS_H

#include "app/job.h"

/* Makes the kernels of a picture and prints them. Gives the exit code. */
int kernels_run(struct job *job, bool json);

#endif
