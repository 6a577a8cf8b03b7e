/* Which faults the pictures of a suite notice. */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "app/check/cause.h"
#include "app/check/check.h"
#include "base/random.h"

enum { SEEDS_MAX = 24 };

/* A case without faults, and its picture. */
struct fault_case {
    const char *name;
    struct job input; /* of trial_draw */
    const struct drawing *was;
};

enum fault_end {
    FAULT_NONE, /* the scene has nothing that the fault could change */
    FAULT_SAME, /* the picture did not change */
    FAULT_SEEN,
};

/* The amount of a fault of the kind that changes the picture wherever its place is visible at
   all. */
static double fault_strong(whit_fault_kind kind)
{
    static const double amounts[WHIT_FAULT_KINDS] = {
        [WHIT_FAULT_VERTEX] = 0.1, [WHIT_FAULT_IOR] = 0.5,       [WHIT_FAULT_LIGHT] = 1.0,
        [WHIT_FAULT_TEXELS] = 1.0, [WHIT_FAULT_MATERIALS] = 1.0,
    };
    return amounts[kind];
}

/* Draws the scene with these faults in it. A scene that cannot be drawn counts as seen. *made: the
   scene, for the caller to destroy; may be NULL. */
static whit_result fault_draw(const struct fault_case *item, const whit_fault *faults,
                              uint32_t count, enum fault_end *end, whit_scene **made)
{
    struct job input = item->input;
    struct drawing trial;
    *end = FAULT_NONE;
    cli_hush(true);
    whit_result result = whit_scene_fault(item->input.scene, faults, count, &input.scene);
    if (result == WHIT_OK) {
        result = trial_draw(&trial, &input);
        bool same = result == WHIT_OK && drawing_same(&trial, item->was);
        *end = same ? FAULT_SAME : FAULT_SEEN;
        trial_finish(&trial);
    }
    cli_hush(false);
    if (made)
        *made = input.scene;
    else
        whit_scene_destroy(input.scene);
    return trial_ends_all(result) ? result : WHIT_OK;
}

/* Tries seeds from `random` until a strong fault of the kind is seen. *found: false where none of
   the tries was. */
static whit_result fault_find(const struct fault_case *item, whit_fault_kind kind, uint64_t *random,
                              whit_fault *fault, bool *found)
{
    whit_result result = WHIT_OK;
    *found = false;
    for (int i = 0; result == WHIT_OK && !*found && i < SEEDS_MAX; ++i) {
        enum fault_end end;
        *fault = (whit_fault){kind, splitmix64(random), fault_strong(kind)};
        result = fault_draw(item, fault, 1, &end, NULL);
        if (result != WHIT_OK || end == FAULT_NONE)
            return result;
        *found = end == FAULT_SEEN;
    }
    return result;
}

/* ---- --power ---- */

/* The smallest change that is tried, relative to the strongest. */
static const double SMALLEST = 1e-9;

/* Halves the strength, on a logarithmic scale, between one that is seen and one that is not, until
   they are a factor of 2 apart. This assumes that larger changes are seen too, which need not be
   so. */
static whit_result find_smallest(const struct fault_case *item, whit_fault fault, double *smallest)
{
    double unseen = SMALLEST * fault.amount, seen = fault.amount;
    whit_result result = WHIT_OK;
    while (result == WHIT_OK && seen > 2.0 * unseen) {
        enum fault_end end;
        fault.amount = sqrt(seen * unseen);
        result = fault_draw(item, &fault, 1, &end, NULL);
        if (end == FAULT_SEEN)
            seen = fault.amount;
        else
            unseen = fault.amount;
    }
    *smallest = seen;
    return result;
}

/* Prints a line with the smallest change of each kind that the case notices. */
static whit_result power_case(uint64_t *random, const struct fault_case *item)
{
    static const whit_fault_kind kinds[] = {WHIT_FAULT_VERTEX, WHIT_FAULT_IOR, WHIT_FAULT_LIGHT,
                                            WHIT_FAULT_TEXELS};
    whit_result result = WHIT_OK;
    printf("%s:", item->name);
    for (size_t i = 0; result == WHIT_OK && i < sizeof kinds / sizeof *kinds; ++i) {
        whit_fault fault;
        bool found;
        double smallest = 0.0;
        result = fault_find(item, kinds[i], random, &fault, &found);
        if (result == WHIT_OK && found)
            result = find_smallest(item, fault, &smallest);
        /* A texel changes by whole steps of 1/255. */
        if (kinds[i] == WHIT_FAULT_TEXELS)
            smallest = fmax(smallest, 1.0 / 255.0);
        printf("%s %s ", i ? "," : "", whit_fault_kind_name(kinds[i]));
        if (found)
            printf("%.1e", smallest);
        else
            putchar('-');
    }
    putchar('\n');
    fflush(stdout);
    return result;
}

/* ---- --mutate ---- */

/* One fault in PAIR_EVERY is paired with another one that does not show in the picture. SEEN_MAX
   and UNSEEN_MAX: tries to find a place for a fault that shows, and for one that does not. */
enum { PAIR_EVERY = 20, SEEN_MAX = 24, UNSEEN_MAX = 6, NAME_BYTES = 300 };
enum { PAIRS = WHIT_FAULT_KINDS }; /* index of the class of pairs, the last one */

struct mutate_class {
    uint32_t drawn, caught, right;
};
struct mutate {
    uint64_t random;                                   /* state of the random generator */
    uint32_t begun;                                    /* number of faults so far */
    struct mutate_class classes[WHIT_FAULT_KINDS + 1]; /* the last: pairs of faults, of which only
                                                          one shows */
    uint32_t missing;                                  /* faults for which no place was found */
};

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

/* ---- What a fault alters ---- */

/* Whether the part with the kind and name of `like` differs between `before` and `scene`; `like`
   NULL: whether any part does. `name`: gets the name of the first that differs, or is NULL. */
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
    struct job now = item->input;
    struct cause cause = {.count = 0};
    whit_scene *alone = NULL;
    *right = false;
    now.scene = (whit_scene *)made;
    whit_result result = cause_find(&cause, &item->input, item->was, &now);
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

/* Whether the new order of the scene's objects shows in the picture: some instance that camera rays
   hit is another object now. */
static bool order_is_seen(const struct fault_case *item, const whit_scene *made)
{
    whit_image_info info;
    whit_image_get_info(item->was->ids, &info);
    const uint32_t *words = whit_image_words(item->was->ids);
    uint32_t last = WHIT_NONE;
    bool seen = false;
    for (size_t i = 0; !seen && i < (size_t)info.width * info.height; ++i, words += 2) {
        whit_instance_info was, is;
        if (words[0] == last || words[0] == WHIT_NONE)
            continue;
        last = words[0];
        whit_scene_get_instance(item->input.scene, last, &was);
        whit_scene_get_instance(made, last, &is);
        seen = was.mesh != is.mesh || strcmp(was.name, is.name) != 0;
    }
    return seen;
}

/* Whether the picture shows the place of a fault. Tests it with half the amount (for a vertex in
   both directions), for materials with emission, for objects by their hits. `strong`: tests with
   the strongest amount, for a fault that must not show at all. */
static whit_result is_seen(const struct fault_case *item, whit_fault fault, bool strong,
                           const whit_scene *made, bool *seen)
{
    enum fault_end end = FAULT_SEEN;
    double half = 0.5 * amount_of(fault.kind);
    bool order = fault.kind == WHIT_FAULT_ORDER;
    fault.amount = strong || !(half > 0.0) ? fault_strong(fault.kind) : half;
    *seen = order && order_is_seen(item, made);
    if (order && (*seen || !strong))
        return WHIT_OK;
    whit_result result = fault_draw(item, &fault, 1, &end, NULL);
    *seen = end == FAULT_SEEN;
    if (result != WHIT_OK || !*seen || strong || fault.kind != WHIT_FAULT_VERTEX)
        return result;
    fault.amount = -half;
    result = fault_draw(item, &fault, 1, &end, NULL);
    *seen = end == FAULT_SEEN;
    return result;
}

/* Finds a fault that alters the scene (swapping two equal materials does not) and whose place the
   picture shows, or does not show (`seen` false). */
static whit_result find_place(const struct fault_case *item, whit_fault_kind kind, bool seen,
                              uint64_t *random, whit_fault *fault, bool *found)
{
    whit_result result = WHIT_OK;
    *found = false;
    for (int i = 0; result == WHIT_OK && !*found && i < (seen ? SEEN_MAX : UNSEEN_MAX); ++i) {
        whit_scene *made;
        bool altered = false, shown = false;
        *fault = (whit_fault){kind, splitmix64(random), amount_of(kind)};
        result = whit_scene_fault(item->input.scene, fault, 1, &made);
        if (result == WHIT_ERROR_USAGE)
            return WHIT_OK;
        if (result == WHIT_OK)
            result = is_altered(item->input.scene, made, NULL, &altered, NULL);
        if (result == WHIT_OK && altered)
            result = is_seen(item, *fault, !seen, made, &shown);
        *found = altered && shown == seen;
        whit_scene_destroy(made);
    }
    return result;
}

/* The kind with the fewest faults so far, of those not in `tried`. */
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

/* Tries kinds, the rarest first, until the case has a place for such a fault. */
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

/* Draws the case with one fault. `*pair`: adds a second one that does not show; set to false where
   the case has no place for it. */
static whit_result mutate_once(struct mutate *mutate, const struct fault_case *item, bool *pair)
{
    whit_fault faults[2];
    bool found, beside = false, right = false, any;
    char name[NAME_BYTES] = "";
    whit_result result = find_any(mutate, item, true, 0, &faults[0], &found);
    if (result == WHIT_OK && found && *pair)
        result = find_any(mutate, item, false, 1u << faults[0].kind, &faults[1], &beside);
    if (result != WHIT_OK)
        return result;
    *pair = beside;
    if (!found) {
        ++mutate->missing;
        return WHIT_OK;
    }
    struct mutate_class *row = &mutate->classes[beside ? PAIRS : faults[0].kind];
    enum fault_end end;
    whit_scene *made;
    result = fault_draw(item, faults, beside ? 2 : 1, &end, &made);
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
               beside ? ", and another" : "",
               end == FAULT_SEEN ? "caught, and the cause is another" : "missed");
    fflush(stdout);
    return WHIT_OK;
}

/* Draws the case with `count` faults, one after the other; prints which were missed. */
static whit_result mutate_case(struct mutate *mutate, const struct fault_case *item, uint32_t count)
{
    whit_result result = WHIT_OK;
    bool takes_pairs = true;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        uint32_t pairs = ++mutate->begun / PAIR_EVERY;
        bool asked = takes_pairs && mutate->classes[PAIRS].drawn < pairs, pair = asked;
        result = mutate_once(mutate, item, &pair);
        takes_pairs = takes_pairs && (pair || !asked);
    }
    return result;
}

/* Prints the table; EXIT_DIFFERS where a fault was missed, or fewer than 95 % of causes are right.
 */
static int mutate_sum_up(const struct mutate *mutate)
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

/* ---- Cases ---- */

static whit_result try_case(struct check *check, struct studio *studio, uint32_t index,
                            struct mutate *mutate, uint32_t faults)
{
    const struct check_case *item = &check->suite.cases[index];
    struct drawing drawing;
    suite_errors_of(&check->suite, item);
    whit_result result = studio_draw(studio, index, false, &drawing);
    const struct fault_case faulted = {item->name, studio_input(studio, item, &drawing), &drawing};
    if (result == WHIT_OK)
        result = check->power ? power_case(&mutate->random, &faulted)
                              : mutate_case(mutate, &faulted, faults);
    drawing_finish(&drawing);
    cli_errors_of(NULL);
    return result;
}

int strength_run(struct check *check)
{
    struct studio studio;
    struct mutate mutate = {.random = check->seed};
    uint32_t count = check->wanted_count, at = 0;
    whit_result result = studio_open(&studio, (enum golden_kind)check->on, &check->settings,
                                     &check->suite, check->wanted, &cli_log);
    for (uint32_t i = 0; result == WHIT_OK && i < check->suite.count; ++i) {
        if (!check->wanted[i])
            continue;
        uint32_t before = (uint32_t)((uint64_t)check->mutate * at / count);
        uint32_t behind = (uint32_t)((uint64_t)check->mutate * ++at / count);
        result = try_case(check, &studio, i, &mutate, behind - before);
    }
    studio_close(&studio);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    return cli_finish_stdout(check->power ? EXIT_FINE : mutate_sum_up(&mutate));
}
