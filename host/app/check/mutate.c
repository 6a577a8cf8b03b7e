#include <inttypes.h>
#include <string.h>

#include "app/check/cause.h"
#include "app/check/faults.h"
#include "app/check/strength.h"
#include "base/random.h"

/* One fault in so many has another beside it, which nobody sees. */
enum { PAIR_EVERY = 20, PLACES_MAX = 8, NAME_BYTES = 300 };
enum { PAIRS = WHIT_FAULT_KINDS }; /* the last class */

static double amount_of(whit_fault_kind kind)
{
    static const double amounts[WHIT_FAULT_KINDS] = {
        [WHIT_FAULT_VERTEX] = 1e-3,
        [WHIT_FAULT_IOR] = 0.01,
        [WHIT_FAULT_LIGHT] = 0.02,
        [WHIT_FAULT_TEXELS] = 0.05,
    };
    return amounts[kind];
}

/* The probe for a place that is seen: half as much, of a vertex the other way; materials that glow,
   objects that move. */
static double probe_of(whit_fault_kind kind)
{
    double half = 0.5 * amount_of(kind);
    return kind == WHIT_FAULT_VERTEX ? -half : half > 0.0 ? half : fault_strong(kind);
}

/* ---- What a fault alters ---- */

/* Whether the part like that is another in `scene` than in `before`; NULL: whether any is. `name`:
   gets the first such one, or is NULL. */
static whit_result is_altered(const whit_scene *before, const whit_scene *scene,
                              const whit_part *like, bool *altered, char name[NAME_BYTES])
{
    whit_part *a = NULL, *b = NULL;
    uint32_t count_a = 0, count_b = 0;
    *altered = false;
    whit_result result = whit_scene_parts(before, &a, &count_a);
    if (result == WHIT_OK)
        result = whit_scene_parts(scene, &b, &count_b);
    for (uint32_t i = 0; result == WHIT_OK && i < count_a && i < count_b; ++i) {
        bool meant = !like || (a[i].kind == like->kind && strcmp(a[i].name, like->name) == 0);
        if (!meant || *altered || a[i].hash == b[i].hash)
            continue;
        *altered = true;
        if (name)
            snprintf(name, NAME_BYTES, "%s \"%s\"", whit_part_kind_name(a[i].kind), a[i].name);
    }
    whit_memory_destroy(a);
    whit_memory_destroy(b);
    return result;
}

/* Whether each cause is a part that the first fault altered. */
static whit_result is_right(const struct fault_case *item, const whit_fault *fault,
                            const whit_scene *made, bool *right)
{
    struct trial_input now = item->input;
    struct cause cause = {.count = 0};
    whit_scene *alone = NULL;
    *right = false;
    now.scene = (whit_scene *)made;
    whit_result result = cause_find(&cause, &item->input, &item->was, &now);
    if (result == WHIT_OK)
        result = whit_scene_fault(item->input.scene, fault, 1, &alone);
    *right = result == WHIT_OK && cause.search.end == SEARCH_FOUND && cause.search.cause_count > 0;
    for (uint32_t i = 0; result == WHIT_OK && i < cause.count; ++i) {
        bool altered = false;
        if (!cause.search.cause[i])
            continue;
        if (cause.changes[i].kind == CAUSE_PART)
            result = is_altered(item->input.scene, alone, &cause.parts[cause.changes[i].part],
                                &altered, NULL);
        *right = *right && altered;
    }
    whit_scene_destroy(alone);
    cause_finish(&cause);
    return result;
}

/* ---- One fault ---- */

/* A fault whose place is seen, or not; and which alters something, as materials with the same
   values do not where they are swapped. */
static whit_result find_place(const struct fault_case *item, whit_fault_kind kind, bool seen,
                              uint64_t *random, whit_fault *fault, bool *found)
{
    whit_result result = WHIT_OK;
    bool altered = false, any = true;
    for (int i = 0; result == WHIT_OK && any && !altered && i < PLACES_MAX; ++i) {
        whit_scene *made = NULL;
        double amount = seen ? probe_of(kind) : fault_strong(kind);
        result = fault_find(item, kind, amount, seen, random, fault, &any);
        if (result != WHIT_OK || !any)
            break;
        fault->amount = amount_of(kind);
        result = whit_scene_fault(item->input.scene, fault, 1, &made);
        if (result == WHIT_OK)
            result = is_altered(item->input.scene, made, NULL, &altered, NULL);
        whit_scene_destroy(made);
    }
    *found = altered;
    return result;
}

/* The kind of which there were fewest, of those that are not in `tried`. */
static whit_fault_kind rarest(const struct mutate *mutate, uint32_t tried)
{
    whit_fault_kind best = WHIT_FAULT_KINDS;
    for (whit_fault_kind kind = 0; kind < WHIT_FAULT_KINDS; ++kind) {
        if (!(tried >> kind & 1) &&
            (best == WHIT_FAULT_KINDS || mutate->classes[kind].drawn < mutate->classes[best].drawn))
            best = kind;
    }
    return best;
}

/* Kind by kind until the case has a place for one. */
static whit_result find_any(struct mutate *mutate, const struct fault_case *item, bool seen,
                            uint32_t tried, whit_fault *fault, bool *found)
{
    whit_result result = WHIT_OK;
    *found = false;
    for (whit_fault_kind kind; result == WHIT_OK && !*found; tried |= 1u << kind) {
        kind = rarest(mutate, tried);
        if (kind == WHIT_FAULT_KINDS)
            break;
        result = find_place(item, kind, seen, &mutate->random, fault, found);
    }
    return result;
}

static whit_result mutate_once(struct mutate *mutate, const struct fault_case *item, bool pair)
{
    whit_fault faults[2];
    bool found, beside = false, right = false, any;
    char name[NAME_BYTES] = "";
    whit_result result = find_any(mutate, item, true, 0, &faults[0], &found);
    if (result == WHIT_OK && found && pair)
        result = find_any(mutate, item, false, 1u << faults[0].kind, &faults[1], &beside);
    if (result != WHIT_OK)
        return result;
    if (!found || (pair && !beside)) {
        ++mutate->missing;
        return WHIT_OK;
    }
    struct mutate_class *row = &mutate->classes[pair ? PAIRS : faults[0].kind];
    enum fault_end end;
    whit_scene *made;
    result = fault_draw(item, faults, pair ? 2 : 1, &end, &made);
    if (result == WHIT_OK && made)
        result = is_altered(item->input.scene, made, NULL, &any, name);
    if (result == WHIT_OK && end == FAULT_SEEN)
        result = is_right(item, &faults[0], made, &right);
    whit_scene_destroy(made);
    if (result != WHIT_OK)
        return result;
    ++row->drawn;
    row->caught += end == FAULT_SEEN;
    row->right += right;
    if (!right)
        printf("%s: %s of %s, seed %016" PRIx64 "%s: %s\n", item->name,
               whit_fault_kind_name(faults[0].kind), cli_shown(name), faults[0].seed,
               pair ? ", and another" : "",
               end == FAULT_SEEN ? "caught, and the cause is another" : "missed");
    fflush(stdout);
    return WHIT_OK;
}

whit_result mutate_case(struct mutate *mutate, const struct fault_case *item, uint32_t count)
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        uint32_t done = mutate->missing;
        for (int kind = 0; kind <= PAIRS; ++kind)
            done += mutate->classes[kind].drawn;
        result = mutate_once(mutate, item, done % PAIR_EVERY == PAIR_EVERY - 1);
    }
    return result;
}

int mutate_sum_up(const struct mutate *mutate)
{
    struct mutate_class all = {0};
    printf("%-10s %6s %7s %12s\n", "fault", "drawn", "caught", "cause right");
    for (int kind = 0; kind <= PAIRS; ++kind) {
        const struct mutate_class *row = &mutate->classes[kind];
        printf("%-10s %6u %7u %12u\n",
               kind == PAIRS ? "two parts" : whit_fault_kind_name((whit_fault_kind)kind),
               row->drawn, row->caught, row->right);
        all.drawn += row->drawn;
        all.caught += row->caught;
        all.right += row->right;
    }
    printf("%-10s %6u %7u %12u\n", "all", all.drawn, all.caught, all.right);
    if (mutate->missing)
        printf("%u more found no place that is seen\n", mutate->missing);
    return all.caught == all.drawn && all.drawn &&
                   20 * (uint64_t)all.right >= 19 * (uint64_t)all.drawn
               ? EXIT_FINE
               : EXIT_DIFFERS;
}
