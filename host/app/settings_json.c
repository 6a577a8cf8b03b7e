/* Settings as JSON, by the rows of their table. */
#include <stdlib.h>
#include <string.h>

#include "app/settings_json.h"

/* Whether the JSON of a command lists a setting. Settings of heat maps (SETTING_PAINT) have no
   meaning for pictures of colours. */
static bool is_described(const struct setting *row, const struct settings *settings,
                         enum settings_command command)
{
    return row->commands & (uint32_t)command && row->change >= SETTING_LIGHT &&
           row->kind != SETTING_FOLDERS &&
           (settings->paint != PAINT_COLOR || row->change != SETTING_PAINT);
}

/* Adds the text as a JSON number where it is one, else as a string. */
static void put_text(json_t *object, const char *key, const char *text)
{
    char *end;
    double number = strtod(text, &end);
    if (text[0] && !text[strspn(text, "0123456789")])
        document_count(object, key, strtoull(text, NULL, 10));
    else if (text[0] && !*end)
        document_number(object, key, number);
    else
        document_text(object, key, text[0] ? text : NULL);
}

static void put(json_t *object, const struct setting *row, const struct settings *settings)
{
    char key[32], text[SETTING_VALUE_BYTES];
    snprintf(key, sizeof key, "%s", row->json ? row->json : row->name);
    for (char *at = key; *at; ++at)
        *at = *at == '-' ? '_' : *at;
    bool set = setting_write(row, settings, 0, text);
    if (row->kind == SETTING_FLAG) {
        document_flag(object, key, set);
    } else if (row->kind == SETTING_SIZE) {
        document_count(object, "width", settings->picture.width);
        document_count(object, "height", settings->picture.height);
    } else if (row->kind == SETTING_TEXT) { /* a camera named 1 stays a string */
        document_text(object, key, text[0] ? text : NULL);
    } else {
        put_text(object, key, text);
    }
}

void settings_describe(const struct settings *settings, enum settings_command command,
                       json_t *object)
{
    struct settings told = *settings;
    told.exposure_auto = false;              /* lists the exposure that `auto` chose as a number */
    if (told.picture.effects_removed == 0) { /* added effects do not change the picture */
        told.picture.effects_added = 0;
        told.picture.all_effects = false;
    }
    for (const struct setting *row = settings_table; row->name; ++row) {
        if (is_described(row, &told, command))
            put(object, row, &told);
    }
}
