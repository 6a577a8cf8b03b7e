/* Which settings `whit cost` and --budget-ms give up for time, tested with invented reports. */
#include "base/random.h"
#include "cost/within.h"
#include "unit.h"

enum { REPORTS = 400, SAMPLES_MAX = 64 };
static const double USUAL_MS = 100.0;

static struct cost_report report;

static uint64_t random_state = 1;

static double random_up_to(double most)
{
    return most * (double)(splitmix64(&random_state) % 10000) / 1e4;
}

/* The position of a setting in the order of within.c, from 1; 0: it gives up nothing. */
static uint32_t rank_of(uint32_t knob, uint32_t setting)
{
    const struct knob *k = &knob_table[knob];
    return cost_step_of(k->name, knob_setting_name(k, setting)) + 1;
}

/* Invents the time of a setting as a multiple of the usual one: longer for more samples and for
   settings better than usual, shorter the later in the order a setting is. */
static double ratio_of(uint32_t knob, uint32_t setting)
{
    const struct knob *k = &knob_table[knob];
    double samples = strtod(knob_setting_name(k, setting), NULL);
    uint32_t rank = rank_of(knob, setting);
    if (strcmp(k->name, "aa") == 0)
        return samples < 1.0 ? 80.0 : samples * (0.95 + random_up_to(0.1));
    return rank > 0 ? 1.0 - 0.05 * rank + random_up_to(0.04) : 1.1 + random_up_to(2.0);
}

static void add_row(uint32_t knob, uint32_t setting, uint32_t samples)
{
    const struct knob *k = &knob_table[knob];
    struct cost_row *row = &report.rows[report.row_count++];
    double ratio = ratio_of(knob, setting);
    bool told_apart = splitmix64(&random_state) % 8 > 0;
    *row = (struct cost_row){.knob_index = knob,
                             .setting_index = setting,
                             .change = SETTING_LIGHT,
                             .measured = samples > 0 || splitmix64(&random_state) % 16 > 0};
    snprintf(row->knob, sizeof row->knob, "%s", k->name);
    snprintf(row->setting, sizeof row->setting, "%s", knob_setting_name(k, setting));
    knob_option(k, setting, row->option, sizeof row->option);
    row->price.verdict = samples || told_apart ? (ratio > 1.0 ? 1 : -1) : 0;
    row->price.ratio[COST_WALL].median = ratio;
    row->error = (whit_difference){.pixel_count = 1, .rmse = 0.1 / (samples ? samples : 1)};
    row->alone = (whit_difference){.pixel_count = !samples, .rmse = random_up_to(0.2)};
}

static void make_report(void)
{
    memset(&report, 0, sizeof report);
    report.clock = COST_WALL;
    report.reference_samples = 16;
    report.usual_ms_max = USUAL_MS;
    report.rows[0] = (struct cost_row){.knob_index = WHIT_NONE,
                                       .setting_index = WHIT_NONE,
                                       .measured = true,
                                       .ms = {USUAL_MS},
                                       .error = {.pixel_count = 1, .rmse = 0.1},
                                       .alone = {.pixel_count = 1, .rmse = 0.01}};
    report.row_count = 1;
    for (uint32_t k = 0; k < KNOBS; ++k) {
        bool samples = strcmp(knob_table[k].name, "aa") == 0;
        for (uint32_t s = 0; s < knob_table[k].count && knobs_of_light() >> k & 1; ++s)
            if (s != knob_table[k].usual && (!samples || s < 3))
                add_row(k, s,
                        samples ? (uint32_t)strtoul(knob_table[k].settings[s].text, NULL, 10) : 0);
    }
}

/* Whether the row saves time compared with the settings of its knob that come earlier in the
   order. */
static bool saves_time(const struct cost_row *row)
{
    double ratio = row->price.ratio[COST_WALL].median;
    bool saves = row->measured && row->price.verdict < 0;
    for (uint32_t i = 1; i < report.row_count; ++i) {
        const struct cost_row *other = &report.rows[i];
        if (other->knob_index == row->knob_index && other->measured && other->price.verdict < 0 &&
            rank_of(other->knob_index, other->setting_index) <
                rank_of(row->knob_index, row->setting_index))
            saves = saves && ratio < other->price.ratio[COST_WALL].median;
    }
    return saves;
}

/* Gives the last position in the order that the choice gives up; checks that all earlier ones that
   save time are given up, too. */
static uint32_t check_order(const struct cost_choice *choice)
{
    uint32_t last = 0;
    for (uint32_t k = 0; k < KNOBS; ++k) {
        uint32_t rank = rank_of(k, choice->settings[k]);
        last = rank > last ? rank : last;
    }
    for (uint32_t i = 1; i < report.row_count; ++i) {
        const struct cost_row *row = &report.rows[i];
        uint32_t k = row->knob_index, rank = rank_of(k, row->setting_index);
        if (rank > 0 && rank < last && saves_time(row) && rank_of(k, choice->settings[k]) < rank)
            fail_msg("%s %s stays, and what is missed more is given up", row->knob, row->setting);
    }
    return last;
}

TEST(nothing_is_given_up_before_what_is_missed_less)
{
    uint32_t reached = 0, all = 0, found = 0;
    for (int i = 0; i < REPORTS; ++i) {
        make_report();
        uint32_t last = 0;
        for (double limit = 100.0 * USUAL_MS; limit > 0.005 * USUAL_MS; limit *= 0.8) {
            const struct cost_goal goal = {
                .kind = COST_WITHIN, .metric = COST_RMSE, .limit = limit};
            const struct cost_choice choice = cost_choose(&report, &goal);
            if (!choice.found)
                break;
            last = check_order(&choice);
            assert_true(choice.ms <= limit);
            /* Another sample would not have fitted. */
            if (choice.samples < SAMPLES_MAX)
                assert_true(choice.ms * (choice.samples + 1.2) / choice.samples > limit);
            reached = last > reached ? last : reached;
            ++found;
        }
        all += last == cost_steps();
    }
    print_message("  %u choices; all %u things were given up in %u of %d reports\n", found, reached,
                  all, REPORTS);
    assert_int_equal(reached, cost_steps());
}

/* Where edges get more samples, all pixels get a power of 4, and less is given up. */
TEST(with_edges_all_pixels_have_a_power_of_4_of_samples)
{
    uint32_t fewer = 0, soft_shadows = cost_step_of("light-samples", "4") + 1;
    for (int i = 0; i < REPORTS; ++i) {
        make_report();
        for (double limit = 100.0 * USUAL_MS; limit > 0.005 * USUAL_MS; limit *= 0.8) {
            struct cost_goal goal = {.kind = COST_WITHIN, .metric = COST_RMSE, .limit = limit};
            const struct cost_choice plain = cost_choose(&report, &goal);
            goal.edges = true;
            const struct cost_choice edges = cost_choose(&report, &goal);
            assert_int_equal(edges.found, plain.found);
            if (!plain.found)
                break;
            assert_true(edges.samples == 1 || edges.samples == 4 || edges.samples == 16 ||
                        edges.samples == 64);
            assert_true(edges.ms <= limit);
            assert_true(check_order(&edges) <= check_order(&plain));
            fewer += check_order(&edges) < check_order(&plain);
            if (report.usual_ms_max <= limit) /* one sample fits without this step */
                assert_true(check_order(&edges) < soft_shadows);
        }
    }
    assert_true(fewer > REPORTS);
}

/* If no setting keeps a time in 9 of 10 pictures, one is chosen that keeps it in the median. */
TEST(a_short_budget_is_kept_in_the_median)
{
    make_report();
    report.rows[0].ms[COST_WALL] = USUAL_MS / 1.5;
    struct cost_goal goal = {.kind = COST_WITHIN, .metric = COST_RMSE, .limit = USUAL_MS};
    while (cost_choose(&report, &goal).found)
        goal.limit *= 0.99;
    assert_true(cost_choose_budget(&report, goal.limit, false).found);
    assert_true(cost_choose_budget(&report, goal.limit / 1.49, false).found);
    assert_false(cost_choose_budget(&report, goal.limit / 1.6, false).found);
}

/* The RMSE of whit's pictures of a textured scene with 1, 4, 16 and 64 samples. */
static const double SAMPLED[] = {0.077, 0.029, 0.0089, 0.003};

/* A report whose only rows are those of knob `aa` that a reference of so many samples allows. */
static void make_samples_report(uint32_t reference_samples)
{
    uint32_t aa = knob_find("aa");
    make_report();
    report.reference_samples = reference_samples;
    report.rows[0].error.rmse = report.rows[0].error.flip_mean = SAMPLED[0];
    report.rows[0].alone.rmse = 1e-3;
    report.row_count = 1;
    for (uint32_t s = 1; s < (reference_samples == 64 ? 5 : 3); ++s) {
        add_row(aa, s, 1u << 2 * s);
        report.rows[s].error.rmse = report.rows[s].error.flip_mean = s < 3 ? SAMPLED[s] : 1e-6;
        report.rows[s].ms[COST_WALL] = USUAL_MS * report.rows[s].price.ratio[COST_WALL].median;
    }
}

/* Numbers of samples between powers of 4 are not spread evenly: these are the RMSE of pictures. */
TEST(other_numbers_of_samples_than_powers_of_4_are_not_predicted_too_well)
{
    static const struct {
        uint32_t samples;
        double rmse;
    } drawn[] = {{2, 0.068}, {3, 0.057}, {5, 0.0322}, {13, 0.0187}};
    for (size_t i = 0; i < sizeof drawn / sizeof *drawn; ++i) {
        make_samples_report(16);
        const struct cost_goal goal = {
            .kind = COST_WITHIN, .metric = COST_RMSE, .limit = drawn[i].samples * 1.06 * USUAL_MS};
        const struct cost_choice choice = cost_choose(&report, &goal);
        assert_int_equal(choice.samples, drawn[i].samples);
        assert_true(choice.error > 0.85 * drawn[i].rmse && choice.error < 1.05 * drawn[i].rmse);
    }
}

TEST(an_error_below_what_was_measured_takes_more_samples)
{
    static const uint32_t samples[] = {64, 256};
    static const double limits[] = {0.008, 0.005};
    make_samples_report(16);
    struct cost_goal goal = {.kind = COST_UNDER, .metric = COST_RMSE};
    for (size_t i = 0; i < 2; ++i) {
        goal.limit = limits[i];
        const struct cost_choice choice = cost_choose(&report, &goal);
        assert_true(choice.found && choice.error <= goal.limit);
        assert_int_equal(choice.samples, samples[i]);
    }
    goal.limit = 0.001; /* the bias of the usual settings, which more samples leave */
    assert_false(cost_choose(&report, &goal).found);
}

/* With a reference of 64 samples they take up to as many, and those are the reference's own. */
TEST(adaptive_samples_of_the_reference_are_not_sold_as_right)
{
    char text[COST_SENTENCE_BYTES];
    make_samples_report(64);
    struct cost_row *adaptive = &report.rows[4];
    assert_string_equal(adaptive->setting, "adaptive:0.05");
    adaptive->price.ratio[COST_WALL].median = 10.0;
    adaptive->ms[COST_WALL] = 10.0 * USUAL_MS;
    assert_false(cost_is_judged(&report, adaptive));
    assert_true(cost_error_left(&report, adaptive, COST_FLIP) >= 0.5 * SAMPLED[2]);
    cost_sentence(&report, text);
    assert_null(strstr(text, "adaptive"));
    snprintf(adaptive->option, sizeof adaptive->option, "--aa adaptive:0.05,4,16");
    assert_true(cost_is_judged(&report, adaptive));
}

/* Shadows, glass and textures are given up last, after all that only makes pictures rougher. */
TEST(the_order_ends_with_what_is_missed_most)
{
    static const char *const last[][2] = {{"shadows", "opaque"},
                                          {"depth", "1"},
                                          {"shadows", "none"},
                                          {"depth", "0"},
                                          {"textures", "off"}};
    for (uint32_t i = 0; i < 5; ++i)
        assert_int_equal(cost_step_of(last[i][0], last[i][1]), cost_steps() - 5 + i);
    assert_int_equal(cost_step_of("aa", "4"), WHIT_NONE);
    assert_int_equal(cost_step_of("shadows", "tinted"), WHIT_NONE);
}

static void set_row(uint32_t i, const char *knob, const char *setting, double ms, double rmse)
{
    uint32_t index = knob_find(knob);
    report.rows[i] = (struct cost_row){.knob_index = index,
                                       .setting_index = 0,
                                       .change = SETTING_LIGHT,
                                       .measured = true,
                                       .ms = {ms},
                                       .error = {.pixel_count = 1, .rmse = rmse}};
    snprintf(report.rows[i].knob, sizeof report.rows[i].knob, "%s", knob);
    snprintf(report.rows[i].setting, sizeof report.rows[i].setting, "%s", setting);
    report.row_count = i + 1;
}

/* The row that answers a limit of 80 ms, for which row 3 was chosen; `kept`: it keeps the limit. */
static uint32_t answered(bool kept)
{
    struct cost_answer answer = {
        .goal = {.kind = COST_WITHIN, .limit = 80.0}, .found = true, .kept = kept, .row = 3};
    choose_measured(&report, &answer);
    return answer.row;
}

/* A combination that was chosen for another goal is not known to give up nothing. */
TEST(a_kept_choice_is_left_only_for_a_row_that_gives_up_nothing)
{
    make_report();
    set_row(1, "depth", "2", 70.0, 0.05);
    set_row(2, "chosen", "within 40 ms", 40.0, 0.04);
    set_row(3, "chosen", "within 80 ms", 75.0, 0.06);
    assert_int_equal(answered(true), 3);
    report.rows[3].ms[COST_WALL] = 90.0;
    assert_int_equal(answered(false), 1);
    report.rows[1].measured = false;
    assert_int_equal(answered(false), 2);
    report.rows[3].ms[COST_WALL] = 75.0;
    set_row(4, "aa", "4", 78.0, 0.05);
    assert_int_equal(answered(true), 4);
    report.rows[4].error.rmse = 0.07;
    assert_int_equal(answered(true), 3);
}

/* The opening sentence of a report in which four samples leave the share `left` of the visible
   error, and exact hits take `exact_ratio` times as long. */
static const char *sentence_of(double usual_flip, double left, double exact_ratio)
{
    static char text[COST_SENTENCE_BYTES];
    make_report();
    add_row(knob_find("numerics"), 2, 0);
    report.rows[0].error.flip_mean = usual_flip;
    for (uint32_t i = 1; i < report.row_count; ++i) {
        struct cost_row *row = &report.rows[i];
        bool four = strcmp(row->knob, "aa") == 0 && strcmp(row->setting, "4") == 0;
        row->error.flip_mean = four ? left * usual_flip : usual_flip;
        row->price.verdict = four;
        row->measured = true;
        if (four)
            row->price.ratio[COST_WALL].median = 4.0;
    }
    struct cost_row *exact = &report.rows[report.row_count - 1];
    exact->price.verdict = exact_ratio > 1.2;
    exact->price.ratio[COST_WALL] =
        (struct sample_median){.median = exact_ratio, .high = exact_ratio + 0.04};
    cost_sentence(&report, text);
    return text;
}

TEST(other_scenes_are_told_otherwise)
{
    const char *text = sentence_of(0.08, 0.5, 1.3);
    assert_non_null(strstr(text, "4.0 times the time halves the visible error (aa 4: FLIP 0.0400, "
                                 "was 0.0800)"));
    assert_non_null(strstr(text, "exact hits cost 30 %"));
    text = sentence_of(0.02, 0.3, 1.01);
    assert_non_null(strstr(text, "leaves 30 % of the visible error"));
    assert_non_null(strstr(text, "exact hits cost nothing that can be measured"));
    assert_non_null(strstr(sentence_of(0.02, 0.3, 2.234), "exact hits cost 123 %"));
    text = sentence_of(0.001, 0.3, 1.19);
    assert_non_null(strstr(text, "o eye tells the usual picture from the reference (FLIP 0.0010)"));
    assert_non_null(strstr(text, "exact hits cost at most 23 %, as closely as could be measured"));
}

TEST(hits_that_seem_cheaper_when_exact_cost_nothing)
{
    char text[COST_SENTENCE_BYTES];
    sentence_of(0.02, 0.3, 0.9);
    report.rows[report.row_count - 1].price.verdict = -1;
    cost_sentence(&report, text);
    assert_non_null(strstr(text, "exact hits cost nothing that can be measured"));
}

/* A report that was stopped, or has other knobs alone, says nothing of what was not measured. */
TEST(what_was_not_measured_is_not_called_no_nearer)
{
    char text[COST_SENTENCE_BYTES];
    const char *sampled = sentence_of(0.08, 1.0, 1.0); /* by 16 samples, which cannot be judged */
    assert_non_null(strstr(sampled, "he usual picture has a visible error of FLIP 0.0800"));
    report.reference_samples = 64;
    cost_sentence(&report, text);
    assert_non_null(strstr(text, "othing that was measured comes much nearer to the reference "
                                 "(FLIP 0.0800)"));
    assert_non_null(strstr(text, "(not complete: it was stopped)."));
    report.complete = true;
    report.rows[1].error.flip_mean = 0.04; /* for no time that can be measured */
    report.rows[1].price.verdict = 0;
    cost_sentence(&report, text);
    assert_non_null(strstr(text, "he usual picture has a visible error of FLIP 0.0800"));
    assert_null(strstr(text, "not complete"));
    report.row_count = 1;
    cost_sentence(&report, text);
    assert_non_null(strstr(text, "he usual picture has a visible error of FLIP 0.0800"));
}

TEST(what_no_option_draws_is_not_free_and_what_is_best_buys_something)
{
    make_report();
    add_row(knob_find("arithmetic"), 1, 0);
    struct cost_row *row = &report.rows[report.row_count - 1];
    row->alone.rmse = 0.0;
    row->price.verdict = -1;
    assert_int_equal(cost_use_of(&report, row), COST_USE_TRADE);
    row = &report.rows[1]; /* four samples */
    row->error.rmse = report.rows[0].error.rmse;
    row->price.verdict = 1;
    assert_int_equal(cost_use_of(&report, row), COST_USE_NONE);
    row->best = true; /* by FLIP */
    assert_int_equal(cost_use_of(&report, row), COST_USE_TRADE);
}
