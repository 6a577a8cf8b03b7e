#include "view/ui.h"

#include <fontconfig/fontconfig.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/log.h"

enum { FONT_BYTES_MAX = 16 << 20 };
/* A monospaced font, so that columns of text line up. */
static const char wanted[] = "DejaVu Sans Mono,monospace:scalable=true:fontformat=TrueType";

static bool find_file(FcConfig *config, char *path, size_t bytes)
{
    FcPattern *pattern = FcNameParse((const FcChar8 *)wanted), *match = NULL;
    FcResult result = FcResultNoMatch;
    FcChar8 *file = NULL;
    if (pattern && FcConfigSubstitute(config, pattern, FcMatchPattern)) {
        FcDefaultSubstitute(pattern);
        match = FcFontMatch(config, pattern, &result);
    }
    bool found = match && FcPatternGetString(match, FC_FILE, 0, &file) == FcResultMatch &&
                 (size_t)snprintf(path, bytes, "%s", (const char *)file) < bytes;
    if (match)
        FcPatternDestroy(match);
    if (pattern)
        FcPatternDestroy(pattern);
    return found;
}

bool font_load(uint8_t **data, size_t *size_bytes)
{
    static const uint8_t true_type[4] = {0, 1, 0, 0};
    const whit_log silence = log_or_silence(NULL);
    char path[4096];
    FcConfig *config = FcInitLoadConfigAndFonts();
    bool found = config && find_file(config, path, sizeof path);
    if (config)
        FcConfigDestroy(config);
    *data = NULL;
    if (!found || file_read(&silence, NULL, path, FONT_BYTES_MAX, data, size_bytes) != WHIT_OK)
        return false;
    if (*size_bytes > sizeof true_type && memcmp(*data, true_type, sizeof true_type) == 0)
        return true;
    free(*data);
    *data = NULL;
    return false;
}
