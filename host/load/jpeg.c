#include "load/jpeg.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>

#include <jpeglib.h>

#include <jerror.h>

#include "base/array.h"
#include "base/platform.h"

/* The most scans of a progressive file: each one, however few its bytes, is work for all pixels. */
enum { SCANS_MAX = 64 };

/* libjpeg leaves its functions by longjmp. Whatever must survive that lives in here, outside the
   frame that calls setjmp. */
struct job {
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    struct jpeg_decompress_struct info;
    jmp_buf leave;
    const uint8_t *data;
    size_t size_bytes;
    uint64_t pixels_max;
    struct picture picture, refused; /* refused: its sides, if it has too many pixels */
    const char *reason;
    whit_result result;
};

static _Thread_local char message[JMSG_LENGTH_MAX];

static struct job *job_of(j_common_ptr info)
{
    return (struct job *)info->client_data;
}

static void leave(struct job *job, whit_result result, const char *reason)
{
    job->result = result;
    job->reason = reason;
    longjmp(job->leave, 1);
}

static void on_error(j_common_ptr info)
{
    if (info->err->msg_code == JERR_OUT_OF_MEMORY)
        leave(job_of(info), WHIT_ERROR_MEMORY, "out of memory");
    info->err->format_message(info, message);
    leave(job_of(info), WHIT_ERROR_INPUT, message);
}

/* Whether a warning's code is one that loses no pixels. */
static bool is_harmless(int code)
{
    return code == JWRN_EXTRANEOUS_DATA || code == JWRN_ADOBE_XFORM || code == JWRN_JFIF_MAJOR ||
           code == JWRN_BOGUS_PROGRESSION;
}

static void on_message(j_common_ptr info, int level)
{
    if (level < 0 && !is_harmless(info->err->msg_code))
        on_error(info);
}

static void on_progress(j_common_ptr info)
{
    struct job *job = job_of(info);
    if (job->info.input_scan_number > SCANS_MAX)
        leave(job, WHIT_ERROR_INPUT, "it has too many scans");
}

bool jpeg_is(const uint8_t *data, size_t size_bytes)
{
    return size_bytes >= 3 && data[0] == 0xff && data[1] == 0xd8 && data[2] == 0xff;
}

static void begin(struct job *job)
{
    job->info.err = jpeg_std_error(&job->errors);
    job->errors.error_exit = on_error;
    job->errors.emit_message = on_message;
    job->progress.progress_monitor = on_progress;
    job->info.client_data = job;
}

static void read_header(struct job *job)
{
    struct jpeg_decompress_struct *info = &job->info;
    jpeg_create_decompress(info);
    info->progress = &job->progress;
    jpeg_mem_src(info, job->data, (unsigned long)job->size_bytes);
    (void)jpeg_read_header(info, TRUE); /* fails through `leave` if there is none */
    const char *refused = picture_why_refused(info->image_width, info->image_height,
                                              job->size_bytes, job->pixels_max, &job->refused);
    if (refused)
        leave(job, WHIT_ERROR_INPUT, refused);
    bool inks = info->jpeg_color_space == JCS_CMYK || info->jpeg_color_space == JCS_YCCK;
    info->out_color_space = inks ? JCS_CMYK : JCS_EXT_RGBA;
}

static uint8_t product(uint8_t a, uint8_t b)
{
    return (uint8_t)((a * b + 127) / 255);
}

static void mix_inks(uint8_t *row, uint32_t width)
{
    for (uint32_t x = 0; x < width; ++x, row += 4) {
        for (int i = 0; i < 3; ++i)
            row[i] = product(row[i], row[3]);
        row[3] = 255;
    }
}

static void read_rows(struct job *job)
{
    struct jpeg_decompress_struct *info = &job->info;
    struct picture *picture = &job->picture;
    (void)jpeg_start_decompress(info);
    picture->width = info->output_width;
    picture->height = info->output_height;
    size_t row_bytes = 4 * (size_t)picture->width;
    picture->rgba = array_alloc(picture->height, row_bytes);
    if (!picture->rgba)
        leave(job, WHIT_ERROR_MEMORY, "out of memory");
    platform_expect_much(picture->rgba, picture->height * row_bytes);
    while (info->output_scanline < info->output_height) {
        JSAMPROW row = picture->rgba + info->output_scanline * row_bytes;
        if (jpeg_read_scanlines(info, &row, 1) == 1 && info->out_color_space == JCS_CMYK)
            mix_inks(row, picture->width);
    }
    (void)jpeg_finish_decompress(info);
}

whit_result jpeg_decode(const uint8_t *data, size_t size_bytes, uint64_t pixels_max,
                        struct picture *out, const char **reason)
{
    struct job *job = array_alloc_zeroed(1, sizeof *job);
    *out = (struct picture){0};
    *reason = "out of memory";
    if (!job)
        return WHIT_ERROR_MEMORY;
    job->data = data;
    job->size_bytes = size_bytes;
    job->pixels_max = pixels_max;
    begin(job);
    if (setjmp(job->leave) == 0) {
        read_header(job);
        read_rows(job);
    }
    whit_result result = job->result;
    *out = result == WHIT_OK ? job->picture : job->refused;
    if (result != WHIT_OK)
        picture_finish(&job->picture);
    *reason = job->reason;
    jpeg_destroy_decompress(&job->info);
    free(job);
    return result;
}
