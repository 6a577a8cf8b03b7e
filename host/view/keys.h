/* What keys do, with the state of it. */
#ifndef VIEW_KEYS_H
#define VIEW_KEYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct setting;
struct view;

/* The cheat sheet shows keys in these groups, in this order. */
enum key_group { KEYS_CAMERA, KEYS_PICTURE, KEYS_FILES, KEYS_EXPERTS, KEY_GROUPS };

struct key_binding {
    int key;
    unsigned mods;
    const char *keys;  /* as the cheat sheet says them; NULL: they are in another row of it */
    const char *title; /* what it says of them; NULL: the name */
    const char *name;  /* of the state */
    void (*act)(struct view *view);
    void (*state)(const struct view *view, char *text, size_t bytes); /* NULL: none */
    const struct setting *setting; /* that it turns, in place of `act` and `state`; NULL: none */
    int by;
    enum key_group group;
    bool shows_name; /* as a message, when the key is pressed */
};
const struct key_binding *key_bindings(uint32_t *count);
/* False where there is nothing to say. */
bool key_state(const struct view *view, const struct key_binding *key, char *text, size_t bytes);
/* False where the key does nothing. */
bool key_act(struct view *view, int key, unsigned mods);

#endif
