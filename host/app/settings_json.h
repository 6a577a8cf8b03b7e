/* Settings in JSON. */
#ifndef APP_SETTINGS_JSON_H
#define APP_SETTINGS_JSON_H

#include "app/document.h"
#include "settings/settings.h"

/* Adds to an object the settings that decide the pixels of a picture, of those that a command
   takes. */
void settings_describe(const struct settings *settings, enum settings_command command,
                       json_t *object);

#endif
