/* Golden files: what is written is read again, and errors name the damaged line. */
#include "app/check/golden.h"
#include "folder_fixture.h"

#include <sys/resource.h>

#include "app/cli.h"

static const struct golden_case room = {.name = (char[]){"room"},
                                        .ids = 0x123456789abcdef0,
                                        .colors = 0xfedcba9876543210,
                                        .width = 256,
                                        .height = 192,
                                        .rays = {49152, 686760, 14486, 12725},
                                        .mean = {0.251965, 1e-7, -3.5},
                                        .made_by = (char[]){"room.json --size 256x192"},
                                        .reason = (char[]){"a redder ball"}};

static void fill(struct golden *golden)
{
    struct golden_case cube = room;
    *golden = (struct golden){.exists = true};
    assert_true(golden_put(golden, &room));
    assert_true(golden_case_add_part(&golden->cases[0], 0xdeadbeef));
    assert_true(golden_case_add_part(&golden->cases[0], 0x00000007));
    cube.name = (char[]){"cube"};
    cube.reason = NULL;
    assert_true(golden_put(golden, &cube));
    assert_true(golden_put_part(golden, "mesh ball of room.json", 0xdeadbeef));
    assert_true(golden_put_part(golden, "light 0 of room.json", 0x00000007));
    assert_true(golden_put_part(golden, "light 0 of room.json", 0x00000009)); /* nobody has it */
    golden_sort(golden);
}

#define PICTURE                                                                                    \
    " ids 123456789abcdef0 colors fedcba9876543210 256x192 rays 49152 686760 14486 12725 "         \
    "mean "                                                                                        \
    "0.25196 1e-07 -3.5\n"
#define HEAD "whit check golden 2, whit " WHIT_VERSION "\n"
static const char text[] =
    HEAD "\n"
         "case cube of room.json --size 256x192\n cube" PICTURE "\n"
         "case room of room.json --size 256x192\n room" PICTURE " room parts 00000007 deadbeef\n"
         " room why a redder ball\n"
         "\n"
         "part light 0 of room.json\n"
         " 00000007\n"
         "\n"
         "part mesh ball of room.json\n"
         " deadbeef\n"
         "\n";
/* The same golden file with lines in another order and repeated, as merges may leave it. */
static const char shuffled[] = HEAD "part mesh ball of room.json\n deadbeef\n"
                                    " room why a redder ball\n room parts deadbeef 00000007\n"
                                    "case cube of room.json --size 256x192\n"
                                    "part light 0 of room.json\n 00000007\n cube" PICTURE
                                    "part mesh ball of room.json\n deadbeef\n deadbeef\n"
                                    " room why a redder ball\n room" PICTURE " room" PICTURE
                                    "case room of room.json --size 256x192\n"
                                    "case room of room.json --size 256x192\n"
                                    " room parts 00000007 deadbeef\n";

TEST(text_is_read_again)
{
    struct golden golden, again;
    char copy[sizeof text];
    fill(&golden);
    char *written = golden_text(&golden);
    assert_string_equal(written, text);
    golden_finish(&golden);
    memcpy(copy, text, sizeof text);
    assert_true(golden_read_text(&again, "x.golden", copy, GOLDEN_OF_DEVICE));
    free(written);
    written = golden_text(&again);
    assert_string_equal(written, text);
    assert_string_equal(again.by, WHIT_VERSION);
    assert_string_equal(golden_part_key(&again, 0xdeadbeef), "mesh ball of room.json");
    assert_null(golden_part_key(&again, 1));
    assert_null(golden_find(&again, "roo"));
    assert_string_equal(golden_find(&again, "room")->reason, "a redder ball");
    free(written);
    golden_remove(&again, 1);
    written = golden_text(&again);
    assert_null(strstr(written, "room\n"));
    assert_null(strstr(written, "part"));
    free(written);
    golden_finish(&again);
}

/* Lines may come in any order, and equal lines, as two people's acceptances of the same change,
   count once. */
TEST(order_and_repetition_mean_nothing)
{
    struct golden golden;
    char copy[sizeof shuffled];
    memcpy(copy, shuffled, sizeof shuffled);
    assert_true(golden_read_text(&golden, "x.golden", copy, GOLDEN_OF_DEVICE));
    own_memory char *written = golden_text(&golden);
    assert_string_equal(written, text);
    golden_finish(&golden);
}

#define IDS " a ids 1 colors 2 3x4 rays 5 6 7 8 mean 1 2 3\n"

/* Inserting each where it belongs takes 10 s of the processor, sorting once 0.1 s. */
TEST(falling_order_takes_no_time)
{
    enum { MANY = 100000 };
    struct rlimit limit, before;
    struct golden golden;
    own_memory char *falling = malloc((size_t)MANY * 32);
    char *at = falling + sprintf(falling, HEAD "case a of b\n" IDS " a parts");
    for (int i = MANY; i > 0; --i)
        at += sprintf(at, " %08x", i);
    for (int i = MANY; i > 0; --i)
        at += sprintf(at, "\npart %d\n %08x", i, i);
    assert_int_equal(getrlimit(RLIMIT_CPU, &before), 0);
    limit = (struct rlimit){2, before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_CPU, &limit), 0);
    assert_true(golden_read_text(&golden, "x.golden", falling, GOLDEN_OF_DEVICE));
    assert_int_equal(setrlimit(RLIMIT_CPU, &before), 0);
    assert_int_equal(golden_find(&golden, "a")->part_count, MANY);
    assert_true(golden_case_has_part(golden_find(&golden, "a"), 1));
    assert_false(golden_case_has_part(golden_find(&golden, "a"), MANY + 1));
    assert_int_equal(golden.part_count, MANY);
    golden_finish(&golden);
}

/* A golden file of another version of whit is read all the same, as is one that an editor on
   Windows has written. */
TEST(another_whit_is_no_reason_to_refuse)
{
    struct golden golden;
    char other[] = "\xef\xbb\xbfwhit check golden 2, whit 99.0.1-rc2\r\n";
    assert_true(golden_read_text(&golden, "x.golden", other, GOLDEN_OF_DEVICE));
    assert_string_equal(golden.by, "99.0.1-rc2");
    golden_finish(&golden);
}

TEST(a_part_is_its_place_and_its_content)
{
    assert_int_not_equal(golden_part_hash("mesh a", 1), golden_part_hash("mesh a", 2));
    assert_int_not_equal(golden_part_hash("mesh a", 1), golden_part_hash("mesh b", 1));
}

TEST(paths_are_beside_the_suite)
{
    static const char *const pairs[][2] = {{"looks.whit", "looks.golden"},
                                           {"a.b/looks.whit", "a.b/looks.golden"},
                                           {"a.whit/looks", "a.whit/looks.golden"},
                                           {".whit", ".whit.golden"},
                                           {"a/whit.suite", "a/whit.golden"}};
    char *other = golden_path("a/whit.suite", GOLDEN_OF_REFERENCE);
    assert_string_equal(other, "a/whit.reference.golden");
    free(other);
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; ++i) {
        own_memory char *path = golden_path(pairs[i][0], GOLDEN_OF_DEVICE);
        assert_string_equal(path, pairs[i][1]);
    }
}

#define OTHER                                                                                      \
    "x.golden:4: a line above, from line 2 on, says something else of the case `a`, which two "
TEST(damage_is_told_by_its_line)
{
    static const struct {
        const char *text, *told;
    } damaged[] = {
        {"", "x.golden:1: `whit check golden 2, whit VERSION` is needed"},
        {"whit check golden 1, whit 0\n", "x.golden:1: a golden of format 1"},
        {"whit check reference golden 2, whit 0\n", "x.golden:1: a golden of pictures by the ref"},
        {HEAD "case a of b\n", "x.golden:2: the case `a` lacks a line"},
        {HEAD "\n" IDS, "x.golden:3: the case `a` lacks a line"},
        {HEAD IDS "\n a ids 9 colors 2 3x4 rays 5 6 7 8 mean 1 2 3\n", OTHER},
        {HEAD IDS "\n a ids 1 colors 9 3x4 rays 5 6 7 8 mean 1 2 3\n", OTHER},
        {HEAD IDS "\n a ids 1 colors 2 3x4 rays 5 6 7 9 mean 1 2 3\n", OTHER},
        {HEAD IDS "\n a ids 1 colors 2 3x4 rays 5 6 7 8 mean 1 2 4\n", OTHER},
        {HEAD "case a of b\n\ncase a of c\n", OTHER},
        {HEAD "case a of b\rcase b of c\n", "x.golden:2: a carriage return that does not end"},
        {HEAD " a parts 1\ncase b of c\n a parts 2\n", OTHER},
        {HEAD " a parts 1\ncase b of c\n a parts 1 2\n", OTHER},
        {HEAD " a why 1\n\n a why 2\n", OTHER},
        {HEAD " a ids 1 colors 2\n", "x.golden:2: `ids HASH"},
        {HEAD " a ids 1 colors 2 0x4 rays 5 6 7 8 mean 1 2 3\n", "x.golden:2: `ids HASH"},
        {HEAD " a parts 1 x\n", "x.golden:2: ` x` is no hash"},
        {HEAD " a off b\n", "x.golden:2: `off b`: of, ids, parts or why of the case `a`"},
        {HEAD "case a\n", "x.golden:2: ``: of, ids, parts or why of the case `a`"},
        {HEAD " 7\n", "x.golden:2: `7`: there is no part above"},
        {HEAD "part a\n x\n", "x.golden:3: ``: of, ids, parts or why of the case `x`"},
        {HEAD "<<<<<<< HEAD\n", "x.golden:2: a conflict of a merge is left in it"},
        {HEAD "casea\n", "x.golden:2: `casea`: `case NAME` or `part NAME` is needed"},
    };
    for (size_t i = 0; i < sizeof damaged / sizeof *damaged; ++i) {
        struct golden golden;
        char copy[1024];
        snprintf(copy, sizeof copy, "%s", damaged[i].text);
        cli_errors_of("test");
        assert_false(golden_read_text(&golden, "x.golden", copy, GOLDEN_OF_DEVICE));
        if (strncmp(cli_said(), damaged[i].told, strlen(damaged[i].told)) != 0)
            fail_msg("`%s` says `%s`", damaged[i].told, cli_said());
        golden_finish(&golden);
    }
}
