/* What whit's own programs use of libwhit beside whit.h: files that appear whole or not at all,
   clocks, what is kept from one run to the next. It is not installed, the shared library does not
   have it, and it may change with every commit. */
#ifndef WHIT_PROGRAM_H
#define WHIT_PROGRAM_H

#include "whit_device.h"
#include "whit_image.h"
#include "whit_renderer.h"

/* ---- Files and clocks ---- */

/* A file under construction, hidden beside `path`: commit renames it over `path`, abandon removes
   it. Exactly one of the two ends it. */
typedef struct whit_file whit_file;
/* WHIT_ERROR_OUTPUT where the file cannot be written. */
WHIT_CHECK whit_result whit_file_begin(const char *path, const whit_log *log, whit_file **out);
WHIT_CHECK whit_result whit_file_append(whit_file *file, const void *data, size_t size_bytes);
WHIT_CHECK whit_result whit_file_commit(whit_file *file);
void whit_file_abandon(whit_file *file);

/* Writes a whole file beside `path` and renames it. WHIT_ERROR_OUTPUT where it cannot be written.
 */
WHIT_CHECK whit_result whit_file_write(const char *path, const void *data, size_t size_bytes,
                                       const whit_log *log);
/* Removes unfinished output; safe in a signal handler. */
void whit_file_abandon_all(void);
uint64_t whit_peak_memory_bytes(void);
double whit_clock_ms(void);
double whit_clock_cpu_ms(void); /* used by all threads of this process */

/* ---- Pictures in strips ---- */

/* A picture that is written in strips of rows, from the top down, so that no more than one of them
   is in memory: each but the last has a multiple of WHIT_STRIP_ROWS rows. The file appears at
   commit, with the bytes that whit_image_save of the whole picture gives it. */
#define WHIT_STRIP_ROWS 16
typedef struct whit_image_strips whit_image_strips;
/* `like`: a strip, for all but the height. Names and log of `texts` have to stay. WHIT_ERROR_OUTPUT
   also for pipes. */
WHIT_CHECK whit_result whit_image_strips_begin(const char *path, const whit_image *like,
                                               uint32_t height, const whit_text *texts,
                                               uint32_t text_count, const whit_log *log,
                                               whit_image_strips **out);
WHIT_CHECK whit_result whit_image_strips_add(whit_image_strips *strips, const whit_image *strip);
/* One of the two ends it; abandon takes NULL too. WHIT_ERROR_OUTPUT: the file could not be
   written, and there is none. */
WHIT_CHECK whit_result whit_image_strips_commit(whit_image_strips *strips);
void whit_image_strips_abandon(whit_image_strips *strips);
/* Makes an image of integers, as hit identities are: it copies width * height * channels of them
   from `words`. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_image_create_words(uint32_t width, uint32_t height, uint32_t channels,
                                               const uint32_t *words, whit_image **out);
/* The floats of a picture, to be changed; NULL where it has integers. */
float *whit_image_edit(whit_image *image);

/* ---- Overlays ---- */

typedef struct whit_overlay {
    bool grid; /* on the ground, behind what stands before it */
    bool edges_of_instances, edges_of_primitives;
    const uint32_t *ids; /* hit identities that edges are of, two a pixel, borrowed; NULL: those of
                            the picture that the renderer has just drawn */
} whit_overlay;
/* Draws over `color`, a picture of the renderer's view. WHIT_ERROR_USAGE where nothing
   was rendered, WHIT_ERROR_DEVICE, WHIT_ERROR_MEMORY, WHIT_ERROR_CANCELLED. */
WHIT_CHECK whit_result whit_renderer_draw_over(whit_renderer *renderer, const whit_overlay *overlay,
                                               whit_image *color);

/* ---- A device, opened beside other work ---- */

/* What whit_device_create does, in a thread of its own, while the caller does something else, such
   as loading a scene. `params` is read, and its selector borrowed, until the end; what there is to
   say is logged at the end, by the thread that asks for it. NULL when memory or threads run out:
   then whit_device_create is left. */
typedef struct whit_device_opening whit_device_opening;
WHIT_CHECK whit_device_opening *whit_device_open_begin(const whit_device_params *params,
                                                       const whit_log *log);
/* Waits; gives what whit_device_create would have given, and frees `opening`. */
WHIT_CHECK whit_result whit_device_open_end(whit_device_opening *opening, whit_device **out);
/* Instead: nothing is logged, and a device is destroyed again. NULL is fine. */
void whit_device_open_abandon(whit_device_opening *opening);
/* For programs that draw many small pictures: from here on kernels stay with the device, and who
   makes a renderer that needs the same ones has them at once. Before any renderer. */
void whit_device_keep_kernels(whit_device *device);
/* Kernels that the driver has been asked for so far: nothing was compiled between two equal counts.
 */
uint64_t whit_device_kernels_made(const whit_device *device);
/* Whether a program that opens the same device again gets further by drawing with both at once: a
   CPU, unless validation layers check or a test counts calls. */
bool whit_device_takes_peers(const whit_device *device);

/* ---- What can be made again, kept from one run to the next ---- */

/* In $XDG_CACHE_HOME/whit or ~/.cache/whit, which is closed to others; nothing where that folder
   cannot be had, belongs to somebody else or may be written by others (a warning, once), and where
   WHIT_NO_CACHE is set. What is kept has a checksum; files used longest ago are removed beyond
   512 MiB, or $WHIT_CACHE_LIMIT MiB. libwhit keeps pipelines there. */

/* Reads what was kept under `name`. The caller releases *data, which has one zero byte behind its
   size, by whit_memory_destroy. False: nothing was kept, or it was damaged and is thrown away. */
bool whit_cache_read(const char *name, const whit_log *log, uint8_t **data, size_t *size_bytes);
/* `name`: of what and in which version it is; no slash, at most 200 bytes. What cannot be kept is
   not. */
void whit_cache_write(const char *name, const void *data, size_t size_bytes, const whit_log *log);
/* The folder, made when it is not there, for whit_memory_destroy. NULL: nothing is kept. */
char *whit_cache_folder(void);
typedef struct whit_cache_info {
    char folder[4096]; /* "": there is no such place */
    char why_not[128]; /* nothing is kept; "" when it is */
    uint64_t used_bytes, limit_bytes;
} whit_cache_info;
void whit_cache_get_info(whit_cache_info *info);

#endif
