/* The keys of the viewer, their actions, and the states that they change. */
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
    /* As the cheat sheet names the keys; NULL: another row of it names them. */
    const char *keys;
    const char *title; /* what the cheat sheet says about the keys; NULL: `name` */
    const char *name;  /* name of the state */
    void (*act)(struct view *view);
    void (*state)(const struct view *view, char *text, size_t bytes); /* NULL: it has no state */
    const struct setting *setting; /* stepped through by the key, instead of `act`; NULL: none */
    void (*turn)(struct view *view, int by); /* called instead of `act`; NULL: none */
    int by;                                  /* for `setting` and `turn` */
    enum key_group group;
};
const struct key_binding *key_bindings(uint32_t *count);
/* Writes the state of a key; false: it has none. */
bool key_state(const struct view *view, const struct key_binding *key, char *text, size_t bytes);
/* Does what the key does; false: nothing. `held`: the key was down already, which only
   turns settings and scenes on. */
bool key_act(struct view *view, int key, unsigned mods, bool held);

#endif
