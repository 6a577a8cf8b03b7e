#include "app/check/search.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

/* The changes that are still suspected, by number, and scratch memory to try subsets of them. */
struct sets {
    uint32_t *left, count;
    bool *back;
    struct search *search;
};

/* Tries whether taking back the changes `begin` to `end` of `left` (`others`: all but these) is
   enough to get the old picture. */
static whit_result try_set(struct sets *sets, uint32_t begin, uint32_t end, bool others,
                           bool *enough)
{
    struct search *search = sets->search;
    *enough = false;
    if (search->pictures_max && search->pictures == search->pictures_max) {
        search->end = SEARCH_CUT;
        return WHIT_OK;
    }
    ++search->pictures;
    memset(sets->back, 0, search->count * sizeof *sets->back);
    for (uint32_t i = 0; i < sets->count; ++i)
        sets->back[sets->left[i]] = others != (i >= begin && i < end);
    return search->draw(search->user, sets->back, enough);
}

/* Keeps in `left` only the changes that were taken back last. */
static void keep(struct sets *sets)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < sets->count; ++i) {
        if (sets->back[sets->left[i]])
            sets->left[kept++] = sets->left[i];
    }
    sets->count = kept;
}

/* Tries each of `chunks` pieces of `left` (`others`: `left` without the piece). *found: one was
   enough, and only it is left. */
static whit_result try_chunks(struct sets *sets, uint32_t chunks, bool others, bool *found)
{
    whit_result result = WHIT_OK;
    *found = false;
    for (uint32_t i = 0; result == WHIT_OK && !*found && i < chunks; ++i) {
        uint32_t begin = (uint32_t)((uint64_t)sets->count * i / chunks);
        uint32_t end = (uint32_t)((uint64_t)sets->count * (i + 1) / chunks);
        result = try_set(sets, begin, end, others, found);
        if (result == WHIT_OK && *found)
            keep(sets);
    }
    return result;
}

static whit_result make_smaller(struct sets *sets)
{
    uint32_t chunks = 2;
    whit_result result = WHIT_OK;
    while (result == WHIT_OK && sets->count > 1 && sets->search->end != SEARCH_CUT) {
        bool smaller, other = false;
        result = try_chunks(sets, chunks, false, &smaller);
        if (result == WHIT_OK && !smaller && chunks > 2) /* with two pieces the complements were
                                                            tried already */
            result = try_chunks(sets, chunks, true, &other);
        if (!smaller && !other && chunks == sets->count)
            break;
        chunks = smaller ? 2 : other ? chunks - 1 : 2 * chunks;
        chunks = chunks < sets->count ? chunks : sets->count;
    }
    return result;
}

whit_result search_run(struct search *search)
{
    struct sets sets = {.count = search->count, .search = search};
    bool all = false;
    search->end = SEARCH_FOUND;
    search->pictures = search->cause_count = 0;
    search->cause = array_alloc_zeroed(search->count, sizeof *search->cause);
    sets.left = array_alloc(search->count, sizeof *sets.left);
    sets.back = array_alloc(search->count, sizeof *sets.back);
    whit_result result = search->cause && sets.left && sets.back ? WHIT_OK : WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; result == WHIT_OK && i < search->count; ++i)
        sets.left[i] = i;
    if (result == WHIT_OK)
        result = try_set(&sets, 0, search->count, false, &all);
    if (result == WHIT_OK && all)
        result = make_smaller(&sets);
    else if (search->end != SEARCH_CUT)
        search->end = SEARCH_ELSEWHERE;
    for (uint32_t i = 0; result == WHIT_OK && all && i < sets.count; ++i)
        search->cause[sets.left[i]] = true;
    search->cause_count = all ? sets.count : 0;
    free(sets.left);
    free(sets.back);
    return result;
}
