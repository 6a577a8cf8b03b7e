/* Suite files: cases, alternatives, quotes, and errors with line numbers. */
#include <sys/stat.h>
#include <unistd.h>

#include "app/check/suite.h"
#include "folder_fixture.h"

static char said[8192];

static void say(void *user, const char *text)
{
    size_t used = strlen(said);
    (void)user;
    snprintf(said + used, sizeof said - used, "%s\n", text + strlen(folder) + 1);
}

static struct suite suite; /* read last; the next reading frees it */

static bool read_file(const char *path, const char *root)
{
    said[0] = '\0';
    suite_finish(&suite);
    return suite_read(&suite, path, root, NULL, say, NULL);
}

static bool read_text(const char *text, const char *root)
{
    put_text("a.json", "");
    put_text("my scene.json", "");
    put_text("sky.hdr", "");
    (void)mkdir(in_folder("sub"), 0777);
    put_text("sub/b.json", "");
    return read_file(put_text("s.whit", text), root);
}

static void must_read(const char *text)
{
    if (!read_text(text, NULL))
        fail_msg("%s", said);
}

/* Small suites stay small: what stands in a line once is kept for each of its cases. */
TEST_IN(copies_are_limited, folder_begin, folder_end)
{
    enum { LONG = 600000, CASES = 60 };
    own_memory char *text = malloc(LONG + 1000);
    char *at = text;
    for (int i = 0; i < CASES; ++i)
        at += sprintf(at, "%s%d", i ? "," : "t{", i);
    at += sprintf(at, "} a.json\n* expect rays == ");
    memset(at, '0', LONG);
    strcpy(at + LONG, "1\nx a.json --wrong\n");
    assert_false(read_text(text, NULL));
    assert_string_equal(
        said, "s.whit:2: expectations of more than 64 MiB, each counted for each of its cases\n");

    at = text + sprintf(text, "t{");
    memset(at, 'a', 2000);
    at += 2000 + sprintf(at + 2000, "} a.json ");
    for (int i = 0; i < 600; ++i)
        at += sprintf(at, "{}");
    assert_false(read_text(text, NULL));
    assert_string_equal(said, "s.whit:1: too long with {} filled in, or out of memory\n");
}

TEST_IN(lines_become_cases, folder_begin, folder_end)
{
    must_read("# a comment\n"
              "one a.json\n"
              "\t two 'my scene.json' --size 64x48 # and a comment\r\n"
              "\n"
              "three \"my scene.json\" --background '#102030'\n"
              "four my\\ scene.json --environment sky.hdr\n"
              "level-{fast,exact} sub/b.json --numerics {}\n"
              "l{1,2}.x a.json --depth {} --camera '{}'");
    assert_int_equal(suite.count, 8);
    assert_string_equal(suite.cases[0].name, "one");
    assert_int_equal(suite.cases[0].line, 2);
    assert_string_equal(suite.cases[1].made_by, "'my scene.json' --size 64x48");
    assert_string_equal(suite.cases[1].loaded, "'my scene.json'");
    assert_string_equal(suite.cases[1].settings->scene, in_folder("my scene.json"));
    assert_string_equal(suite.cases[2].settings->scene, in_folder("my scene.json"));
    assert_int_equal(suite.cases[2].settings->load.background[1], 0x20);
    assert_string_equal(suite.cases[3].settings->environment, in_folder("sky.hdr"));
    assert_string_equal(suite.cases[3].loaded, "'my scene.json' --environment sky.hdr");
    assert_string_equal(suite.cases[4].name, "level-fast");
    assert_int_equal(suite.cases[4].settings->picture.numerics, WHIT_NUMERICS_FAST);
    assert_int_equal(suite.cases[5].settings->picture.numerics, WHIT_NUMERICS_EXACT);
    assert_string_equal(suite.cases[7].name, "l2.x");
    assert_int_equal(suite.cases[7].line, 8);
    assert_int_equal(suite.cases[7].settings->picture.depth, 2);
    assert_string_equal(suite.cases[7].settings->camera, "2");
}

TEST_IN(names_are_from_the_root, folder_begin, folder_end)
{
    const char *root = in_folder("sub");
    assert_true(read_text("one b.json", root));
    assert_string_equal(suite.cases[0].settings->scene, in_folder("sub/b.json"));
    assert_false(read_text("one ../a.json", root));
    assert_non_null(strstr(said, "s.whit:1: the scene `../a.json`: it lies outside"));
    /* A name that leads out and back, or an absolute one, would fail in a copy of the folder. */
    assert_false(read_text("one ../sub/b.json", in_folder("sub")));
    assert_non_null(strstr(said, "s.whit:1: the scene `../sub/b.json`: a name from"));
    char text[512];
    snprintf(text, sizeof text, "one %s\ndots ./a..json", in_folder("a.json"));
    put_text("a..json", "");
    assert_false(read_text(text, NULL));
    assert_int_equal(suite.wrong, 1);
    assert_non_null(strstr(said, "/a.json`: a name from the suite's folder down"));
}

TEST_IN(expectations_go_to_their_cases, folder_begin, folder_end)
{
    must_read("a-{x,y} a.json\nb a.json\n"
              "a-{x,y} expect rays == 1, pixel(1,2).instance == \"{}, #, 2\" # why\n"
              "* expect nonfinite == 0\n");
    assert_int_equal(suite.cases[0].expectation_count, 3);
    assert_string_equal(suite.cases[0].expectations[0].text, "rays == 1");
    assert_string_equal(suite.cases[1].expectations[1].text, "pixel(1,2).instance == \"y, #, 2\"");
    assert_int_equal(suite.cases[1].expectations[1].line, 3);
    assert_int_equal(suite.cases[2].expectation_count, 1);
}

/* Each wrong line is reported, whatever else is wrong. */
TEST_IN(wrong_lines_are_told, folder_begin, folder_end)
{
    static const struct {
        const char *line, *told;
    } wrong[] = {
        {"alone", "`alone` alone"},
        {"bad/name a.json", "the name `bad/name`"},
        {"all a.json", "the name `all`"},
        {"-q a.json", "the name `-q`"},
        {".. a.json", "the name `..`"},
        {"x-{a,b a.json", "one {a,b} with a }"},
        {"x-{a,b}{c} a.json", "one {a,b} with a }"},
        {"x-{a,a} a.json", "the name `x-a` is that of line"},
        {"brace a.json --depth {}", "{} stands for"},
        {"quote 'a.json", "a quote has no end"},
        {"quotes \"a.json", "a quote has no end"},
        {"none --depth 3", "a scene is missing"},
        {"many a.json a.json", "one argument too many"},
        {"misspelt a.json --dpeth 3", "did you mean `--depth`"},
        {"value a.json --depth many", "--depth `many`"},
        {"both a.json --time 1 --frame 2", "two ways"},
        {"rate a.json --time 1 --fps 2", "--fps is for --frame"},
        {"gone a.json --no-bvh", "is `--build none` now"},
        {"lost b.json", "the scene `b.json`: there is no such file"},
        {"folder sub", "the scene `sub`: it is a folder"},
        {"input -", "`-`: standard input"},
        {"above ../up.json", "the scene `../up.json`: it lies outside"},
        {"root /etc/passwd", "the scene `/etc/passwd`: it lies outside"},
        {"link away.json", "the scene `away.json`: it lies outside"},
        {"sky a.json --environment away.json", "--environment `away.json`: it lies outside"},
        {"hook a.json --shader ../x.glsl", "--shader `../x.glsl`: it lies outside"},
        {"back sub/../a.json", "the scene `sub/../a.json`: a name from the suite's folder down"},
        {"end a.json --shader sub/..", "--shader `sub/..`: a name from the suite's folder down"},
        {"w1 a.json -o x.png", "option `--output` writes a file"},
        {"w2 a.json --output x.png", "option `--output` writes a file"},
        {"w3 a.json --ids x.exr", "option `--ids` writes a file"},
        {"w4 a.json --stats json", "option `--stats` writes"},
        {"l1 a.json --allow-path /", "option `--allow-path` loosens a limit"},
        {"l2 a.json --shader a.json --trust", "option `--trust` loosens a limit"},
        {"l3 a.json --memory-limit 9G", "option `--memory-limit` loosens a limit"},
        {"l4 a.json --import-limit 99", "option `--import-limit` loosens a limit"},
        {"l5 a.json --stages sub", "option `--stages` loosens a limit"},
        {"c1 a.json --device 1", "option `--device` is for `whit check` itself"},
        {"c2 a.json --budget-ms 3", "option `--budget-ms` goes by measured time"},
        {"c3 a.json --portable", "option `--portable` is always on"},
        {"c5 a.json --cameras x", "option `--cameras` makes several pictures"},
        {"c4 a.json --help", "--help is for the command line"},
        {"nobody expect leaks == 0", "there is no case `nobody` above"},
        {"one a.json\rtwo a.json", "a carriage return that does not end a line"},
        {"fine expect", "an expectation is missing"},
        {"fine expect leaks == 0,", "an expectation is missing"},
    };
    enum { COUNT = sizeof wrong / sizeof *wrong };
    char text[8192] = "fine a.json\n";
    assert_int_equal(symlink("/etc/passwd", in_folder("away.json")), 0);
    for (size_t i = 0; i < COUNT; ++i)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s\n", wrong[i].line);
    assert_false(read_text(text, NULL));
    assert_int_equal(suite.wrong, COUNT);
    char *at = said;
    for (size_t i = 0; i < COUNT; ++i) {
        char where[32], *end = strchr(at, '\n');
        assert_non_null(end);
        *end = '\0';
        snprintf(where, sizeof where, "s.whit:%zu: ", i + 2);
        if (strncmp(at, where, strlen(where)) != 0 || !strstr(at, wrong[i].told))
            fail_msg("`%s` says `%s`", wrong[i].line, at);
        at = end + 1;
    }
    assert_string_equal(at, "");
}

/* A case whose options are wrong is still a case for the lines below. */
TEST_IN(a_wrong_case_has_a_name, folder_begin, folder_end)
{
    assert_false(read_text("a a.json --sice 3\n"
                           "a expect nonfinite == 0, pixel(5000,3) == 0\n"
                           "a a.json\n"
                           "b-{x,y} {}.json\n"
                           "b-y expect hits > 0\n"
                           "c 'a.json\n"
                           "[bc]* expect leeks == 0\n",
                           NULL));
    assert_string_equal(
        said, "s.whit:1: there is no option `--sice`; did you mean `--size`?\n"
              "s.whit:3: the name `a` is that of line 1; expectations of it begin with `expect`\n"
              "s.whit:4: the scene `x.json`: there is no such file\n"
              "s.whit:6: a quote has no end\n"
              "s.whit:7: `leeks`: there is no such field; did you mean `leaks`; "
              "docs/check.md lists them\n");
    assert_int_equal(suite.wrong, 5);
}

TEST_IN(no_suite_is_told, folder_begin, folder_end)
{
    static const char zero[] = "one a.json\0two a.json";
    assert_false(read_text("# nothing\n", NULL));
    assert_string_equal(said, "s.whit: there is no case in it\n");
    const char *path = put_data("z.whit", zero, sizeof zero);
    assert_false(read_file(path, NULL));
    assert_string_equal(said, "z.whit: not a suite: it has bytes that are 0\n");
}

TEST_IN(expectations_are_read, folder_begin, folder_end)
{
    must_read("a a.json --size 64x48\n"
              "a expect leaks==0, max_stack <= 24 , mean within 1e-3 of 0.4 0.5 0.6\n"
              "a expect pixel(63, 47).instance != none, pixel( 0,0 ) > 0.5\n"
              "a expect pixel(1,2).material == \"a == b\"\n");
    const struct check_expectation *all = suite.cases[0].expectations;
    assert_int_equal(suite.cases[0].expectation_count, 6);
    assert_string_equal(expect_fields[all[0].field].name, "leaks");
    assert_int_equal(all[0].op, EXPECT_EQUAL);
    assert_false(expectation_counts(&all[0]));
    assert_true(expectation_counts(&all[1]));
    assert_int_equal(all[1].op, EXPECT_AT_MOST);
    assert_true(all[1].numbers[0] == 24.0);
    assert_int_equal(all[2].op, EXPECT_WITHIN);
    assert_true(all[2].tolerance == 1e-3 && all[2].numbers[2] == 0.6);
    assert_int_equal(all[3].op, EXPECT_OTHER);
    assert_true(all[3].x == 63 && all[3].y == 47);
    assert_null(all[3].word);
    assert_string_equal(expect_fields[all[4].field].name, "pixel");
    assert_int_equal(all[4].count, 1);
    assert_string_equal(all[5].word, "a == b");
}

TEST_IN(wrong_expectations_are_told, folder_begin, folder_end)
{
    static const char *const wrong[][2] = {
        {"leeks == 0", "`leeks`: there is no such field; did you mean `leaks`; docs/check.md"},
        {"instance == 0", "`instance`: there is no such field"},
        {"pixel.instance == none", "`pixel.instance`: there is no such field"},
        {"pixel == 1", "pixel(X,Y) with two whole numbers from 0 on is needed"},
        {"pixel(-1,0) == 1", "pixel(X,Y) with two whole numbers from 0 on is needed"},
        {"pixel(1).t == 1", "pixel(X,Y) with two whole numbers from 0 on is needed"},
        {"pixel(64,0).t == 1", "pixel(64,0) lies outside of 64 x 48 pixels"},
        {"pixel(0,48) == 1", "pixel(0,48) lies outside of 64 x 48 pixels"},
        {"leaks = 0", "`= 0`: == != <= >= < > or `within X of` is needed"},
        {"leaks", "``: == != <="},
        {"leaks == ", "one number is needed"},
        {"leaks == few", "`few`: a number is needed"},
        {"leaks == nan", "`nan`: a number is needed"},
        {"leaks == 0 1", "one number is needed"},
        {"mean == 0 1", "one number, or three"},
        {"mean == 0 1 2 3", "`3` is too much"},
        {"mean within -1 of 0", "`within -1 of 0`: == !="},
        {"mean within 0.1 0.5", "`within 0.1 0.5`: == !="},
        {"pixel(1,1).instance < \"a\"", "names are compared by == and !="},
        {"pixel(1,1).instance == a", "`a`: a name in \"quotes\" or none is needed"},
        {"pixel(1,1).instance == \"a\" b", "`\"a\" b`: a name in"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
        char text[256];
        snprintf(text, sizeof text, "a a.json --size 64x48\na expect %s\n", wrong[i][0]);
        assert_false(read_text(text, NULL));
        assert_int_equal(suite.wrong, 1);
        if (!strstr(said, "s.whit:2: ") || !strstr(said, wrong[i][1]))
            fail_msg("`%s` says `%s`", wrong[i][0], said);
    }
}
