/* The search for the cause of a difference, with simulated pictures. */
#include "app/check/search.h"
#include "base/random.h"
#include "unit.h"

/* A simulated difference: the old picture is drawn if all changes in `needed` are undone, or all in
   `instead`. */
struct model {
    uint32_t count;
    const bool *needed, *instead;
    uint32_t fails_at; /* number of the picture that fails, as without a device; 0: none */
    uint32_t drawn;
};

static bool has_all(const struct model *model, const bool *needed, const bool *back)
{
    bool all = needed != NULL;
    for (uint32_t i = 0; all && i < model->count; ++i)
        all = !needed[i] || back[i];
    return all;
}

static whit_result draw(void *user, const bool *back, bool *same)
{
    struct model *model = user;
    *same = has_all(model, model->needed, back) || has_all(model, model->instead, back);
    return ++model->drawn == model->fails_at ? WHIT_ERROR_DEVICE : WHIT_OK;
}

static struct search run(struct model *model, uint32_t pictures_max, whit_result expected)
{
    struct search search = {
        .count = model->count, .pictures_max = pictures_max, .draw = draw, .user = model};
    assert_int_equal(search_run(&search), expected);
    assert_int_equal(search.pictures, model->drawn);
    return search;
}

static uint32_t chosen(const bool *set, uint32_t count)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < count; ++i)
        sum += set[i];
    return sum;
}

TEST(one_cause_is_found_in_few_pictures)
{
    bool needed[64] = {false};
    for (uint32_t count = 1; count <= 64; ++count) {
        for (uint32_t cause = 0; cause < count; ++cause) {
            struct model model = {.count = count, .needed = needed};
            needed[cause] = true;
            struct search search = run(&model, 0, WHIT_OK);
            assert_int_equal(search.end, SEARCH_FOUND);
            assert_int_equal(search.cause_count, 1);
            assert_true(search.cause[cause]);
            assert_true(search.pictures <= 14); /* all undone, and six halvings of two */
            free(search.cause);
            needed[cause] = false;
        }
    }
}

TEST(several_causes_are_found_and_no_other)
{
    uint64_t random = 1;
    for (int round = 0; round < 300; ++round) {
        bool needed[40];
        struct model model = {.count = 1 + (uint32_t)(splitmix64(&random) % 40), .needed = needed};
        uint64_t share = 1 + splitmix64(&random) % 8;
        for (uint32_t i = 0; i < model.count; ++i)
            needed[i] = splitmix64(&random) % 8 < share;
        struct search search = run(&model, 0, WHIT_OK);
        if (chosen(needed, model.count)) {
            assert_int_equal(search.end, SEARCH_FOUND);
            assert_memory_equal(search.cause, needed, model.count * sizeof *needed);
        }
        free(search.cause);
    }
}

TEST(of_two_ways_the_one_that_is_found_has_nothing_that_is_not_needed)
{
    const bool needed[8] = {[1] = true, [6] = true}, instead[8] = {[3] = true};
    struct model model = {.count = 8, .needed = needed, .instead = instead};
    struct search search = run(&model, 0, WHIT_OK);
    assert_int_equal(search.end, SEARCH_FOUND);
    assert_int_equal(search.cause_count, search.cause[3] ? 1 : 2);
    free(search.cause);
}

TEST(a_cause_elsewhere_and_a_search_that_is_cut_are_told)
{
    const bool needed[8] = {[1] = true, [6] = true};
    struct model nothing = {.count = 8};
    struct search search = run(&nothing, 0, WHIT_OK);
    assert_int_equal(search.end, SEARCH_ELSEWHERE);
    assert_int_equal(search.cause_count, 0);
    assert_int_equal(search.pictures, 1);
    free(search.cause);
    for (uint32_t limit = 1; limit < 8; ++limit) {
        struct model model = {.count = 8, .needed = needed};
        search = run(&model, limit, WHIT_OK);
        assert_int_equal(search.end, SEARCH_CUT);
        assert_int_equal(search.pictures, limit);
        assert_true(search.cause[1] && search.cause[6]);
        free(search.cause);
    }
    struct model broken = {.count = 8, .needed = needed, .fails_at = 3};
    search = run(&broken, 0, WHIT_ERROR_DEVICE);
    free(search.cause);
}
