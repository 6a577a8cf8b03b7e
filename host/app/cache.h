/* The caches of the program: libwhit's, and that of Mesa's compiled kernels. */
#ifndef APP_CACHE_H
#define APP_CACHE_H

#include <jansson.h>
#include <stdbool.h>

/* Sets environment variables that make Mesa keep compiled kernels below whit's cache folder, in one
   folder for each driver version and vector width, because code of another width crashes Mesa 25.
   Variables that are set already stay. Mesa keeps nothing where its folder's disk is full. `off`:
   neither libwhit nor Mesa keeps anything. Call it before threads are started and before Vulkan. */
void cache_prepare(bool off);

/* Tells lavapipe not to optimize the machine code of kernels, which halves the time to make them,
   unless the environment already says how. Results have the same bits. Call it before
   cache_prepare. */
void cache_plain_code(void);

/* For both caches: the folder, the size and the size limit. */
json_t *cache_document(void);
void cache_print(void);

#endif
