/* The caches of the program: libwhit's, and that of Mesa's compiled kernels. */
#ifndef APP_CACHE_H
#define APP_CACHE_H

#include <jansson.h>
#include <stdbool.h>

/* Says in the environment where Mesa keeps compiled kernels: below whit's folder, apart by driver
   version and vector width, for code of another width crashes Mesa 25. What the environment says
   already stays. `off`: nothing is kept, neither by libwhit nor by Mesa. Before any thread, and
   before Vulkan. */
void cache_prepare(bool off);

/* Before cache_prepare: lavapipe is not to optimize the machine code of kernels, which takes half
   of the time to make them, unless the environment says otherwise. Results have the same bits. */
void cache_plain_code(void);

/* Where both are, how large and how large they may grow. */
json_t *cache_document(void);
void cache_print(void);

#endif
