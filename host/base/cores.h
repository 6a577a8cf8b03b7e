/* Threads that a library starts, each on a core of its own. */
#ifndef BASE_CORES_H
#define BASE_CORES_H

#include <stdbool.h>

enum { CORES_NAME_BYTES = 16 };

/* Gives the calling thread the name `name`, and `before` the name that it had. Threads that a
   library starts from this thread inherit the name, unless they take another. */
void cores_name_threads(char name[CORES_NAME_BYTES], char before[CORES_NAME_BYTES]);
/* Gives the calling thread its name back. */
void cores_end_names(const char before[CORES_NAME_BYTES]);

/* If other threads named so are one, and after it as many as there are cores, keeps each of the
   latter on a core of its own, unless one of them may run on other cores than the caller. True: it
   has done so. In lavapipe these are the thread of a queue, and threads that it wakes all at once
   for each dispatch. As the waking thread holds a core, Linux would send two of the others to one
   core, where one waits for up to 5 ms while a core is idle. */
bool cores_spread(const char name[CORES_NAME_BYTES]);

#endif
