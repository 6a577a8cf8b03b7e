/* Thumbnails in a folder beside the golden, for people: no verdict depends on them. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/check/thumbnails.h"
#include "base/array.h"
#include "base/file.h"

/* The path of the thumbnails' folder, `looks.thumbnails` for `looks.golden`, or of the file of case
   `name` in it; free() it. */
static char *thumbnail_path(const struct check *check, const char *name)
{
    size_t length = strlen(check->golden_path) - strlen(".golden");
    return string_format("%.*s.thumbnails%s%s%s", (int)length, check->golden_path, name ? "/" : "",
                         name ? name : "", name ? ".png" : "");
}

whit_result check_compare_thumbnail(const struct check *check, const struct drawing *drawing,
                                    struct check_result *result)
{
    const char *folders[SETTING_FOLDERS_MAX];
    whit_load_params load = settings_load(&drawing->job.settings, folders);
    char *path = thumbnail_path(check, result->item->name);
    whit_image *before = NULL;
    whit_result compared = WHIT_OK;
    load.cancel = &cli_cancel;
    if (!path)
        return cli_no_memory();
    if (file_exists(path) && whit_image_load(path, &load, NULL, &before) == WHIT_OK)
        compared = check_pictures_compare(&result->pictures, drawing, before);
    else if (file_exists(path))
        cli_warning("%s: cannot be read: the report goes without it", path);
    whit_image_destroy(before);
    free(path);
    return compared;
}

whit_result check_save_thumbnail(const struct check *check, const struct check_result *result)
{
    const struct check_png *png = &result->pictures.thumbnail;
    char *folder = thumbnail_path(check, NULL);
    char *path = thumbnail_path(check, result->item->name);
    whit_result saved = WHIT_OK;
    if (!folder || !path)
        saved = cli_no_memory();
    else if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        cli_error("%s: cannot make it: %s", folder, strerror(errno));
        saved = WHIT_ERROR_OUTPUT;
    } else {
        saved = file_write_whole(&cli_log, path, png->data, png->size_bytes);
    }
    free(folder);
    free(path);
    return saved;
}

void check_drop_thumbnail(const struct check *check, const char *name)
{
    char *path = thumbnail_path(check, name);
    if (path)
        (void)unlink(path);
    free(path);
}
