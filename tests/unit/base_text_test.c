/* Text that others wrote is shown without anything that controls a terminal or hides text; the rest
   of it is unchanged. */
#include "../random.h"
#include "base/log.h"
#include "base/text.h"
#include "unit.h"

TEST(each_kind_is_shown)
{
    static const char *const cases[][2] = {
        {"", ""},
        {"wood_01.png", "wood_01.png"},
        {"\xc3\xa4 \xe2\x82\xac \xe4\xb8\xad \xf0\x9f\x94\xa5", /* ä, euro, Chinese, fire */
         "\xc3\xa4 \xe2\x82\xac \xe4\xb8\xad \xf0\x9f\x94\xa5"},
        {"textures\\x.png", "textures\\x.png"},
        {"\x1b]0;title\x07", "\\u001b]0;title\\u0007"},
        {"a\tb\nc\rd\x7f", "a\\u0009b\\u000ac\\u000dd\\u007f"},
        {"\xc2\x80\xc2\x9b\xc2\x9f\xc2\xa0", "\\u0080\\u009b\\u009f\xc2\xa0"}, /* C1, then none */
        {"\xd8\x9c\xe2\x80\x8e\xe2\x80\x8f", "\\u061c\\u200e\\u200f"},         /* directions */
        {"\xe2\x80\xaa\xe2\x80\xae\xe2\x81\xa6\xe2\x81\xa9", "\\u202a\\u202e\\u2066\\u2069"},
        {"\xef\xb8\x80\xef\xb8\x8f", "\\ufe00\\ufe0f"}, /* variants */
        {"\xe2\x80\x8b\xe2\x80\x8d\xe2\x81\xa0\xef\xbb\xbf", "\\u200b\\u200d\\u2060\\ufeff"},
        {"\xc2\xad\xe1\xa0\x8e\xe2\x80\xa8\xe2\x80\xa9", "\\u00ad\\u180e\\u2028\\u2029"},
        {"\xf3\xa0\x80\x81\xf3\xa0\x81\x81", "\\udb40\\udc01\\udb40\\udc41"}, /* tags */
        {"\xef\xbf\xbe\xf4\x8f\xbf\xbf\xef\xb7\x90", "\\ufffe\\udbff\\udfff\\ufdd0"},
        {"\xff\x80", "\\xff\\x80"},
        {"\x9b[2J", "\\x9b[2J"},                      /* C1 of terminals that do not speak UTF-8 */
        {"\xc0\xaf\xc1\xbf", "\\xc0\\xaf\\xc1\\xbf"}, /* longer than needed, as / and DEL */
        {"\xe0\x80\xaf\xf0\x80\x80\xaf", "\\xe0\\x80\\xaf\\xf0\\x80\\x80\\xaf"},
        {"\xed\xa0\x80\xed\xbf\xbf", "\\xed\\xa0\\x80\\xed\\xbf\\xbf"}, /* surrogates */
        {"\xf4\x90\x80\x80\xf5\x80", "\\xf4\\x90\\x80\\x80\\xf5\\x80"}, /* past U+10FFFF */
        {"\xe2\x82", "\\xe2\\x82"},                                     /* cut */
        {"\xe2\x82(\xc3", "\\xe2\\x82(\\xc3"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char shown[128], again[128];
        assert_string_equal(whit_text_show(cases[i][0], shown, sizeof shown), cases[i][1]);
        assert_string_equal(whit_text_show(shown, again, sizeof again), cases[i][1]);
    }
}

/* ---- An independent reader, by the tables of RFC 3629 ---- */

static bool within(unsigned char byte, int first, int last)
{
    return byte >= first && byte <= last;
}

/* Length in bytes of the character at `t` if it is printable; else 0. */
static size_t printable(const unsigned char *t)
{
    if (t[0] < 0x80)
        return t[0] >= 0x20 && t[0] != 0x7f;
    if (within(t[0], 0xc2, 0xdf) && within(t[1], 0x80, 0xbf))
        return t[0] > 0xc2 || t[1] >= 0xa0 ? 2 : 0;
    int low = t[0] == 0xe0 ? 0xa0 : t[0] == 0xf0 ? 0x90 : 0x80;
    int high = t[0] == 0xed ? 0x9f : t[0] == 0xf4 ? 0x8f : 0xbf;
    if (!within(t[0], 0xe0, 0xf4) || !within(t[1], low, high) || !within(t[2], 0x80, 0xbf))
        return 0;
    bool separates = t[0] == 0xe2 && t[1] == 0x80 && (within(t[2], 0x8b, 0x8f) || t[2] >= 0xa8);
    if (t[0] < 0xf0)
        return separates && t[2] <= 0xae ? 0 : 3;
    return within(t[3], 0x80, 0xbf) ? 4 : 0;
}

/* Draws random text from few kinds of bytes, so that valid characters, nearly valid ones and
   escapes come up often. */
static void draw(uint64_t *random, char *text, uint32_t max)
{
    static const unsigned char likely[] = {0x1b, 0x7f, 0x80, 0x81, 0x8e, 0x9b, 0xa0, 0xad,
                                           0xae, 0xbf, 0xc2, 0xe2, 0xed, 0xf0, 0xf3, 0xf4,
                                           '\\', 'x',  'u',  '0',  'f',  'a'};
    uint32_t length = random_below(random, max);
    for (uint32_t i = 0; i < length; ++i) {
        uint32_t any = 1 + random_below(random, 255);
        uint32_t pick = random_below(random, 2 * sizeof likely);
        text[i] = (char)(pick < sizeof likely ? likely[pick] : any);
    }
    text[length] = 0;
}

TEST(any_bytes_are_printable)
{
    uint64_t random = 17;
    for (int i = 0; i < 20000; ++i) {
        char text[48], shown[48 * WHIT_SHOWN_BYTES], again[sizeof shown], brief[24];
        draw(&random, text, sizeof text);
        whit_text_show(text, shown, sizeof shown);
        for (const char *at = shown; *at;) {
            size_t length = printable((const unsigned char *)at);
            assert_true(length > 0);
            at += length;
        }
        assert_string_equal(whit_text_show(shown, again, sizeof again), shown);
        size_t room = 17 + random_below(&random, sizeof brief - 16);
        whit_text_show(text, brief, room);
        size_t kept = strlen(brief);
        bool whole = strlen(shown) < room;
        assert_true(kept < room);
        assert_memory_equal(brief, shown, whole ? kept + 1 : kept - 3);
        assert_true(whole || strcmp(brief + kept - 3, "...") == 0);
    }
}

TEST(tokens_are_short_and_whole)
{
    char text[64] = "";
    assert_string_equal(text_token(NULL).text, "");
    assert_string_equal(text_token("Kd").text, "Kd");
    memset(text, 'a', 40);
    assert_string_equal(text_token(text).text, text);
    strcpy(text + 39, "\xe2\x82\xac"); /* one character more is still the fortieth */
    assert_string_equal(text_token(text).text, text);
    strcpy(text + 42, "b");
    char expected[64];
    snprintf(expected, sizeof expected, "%.42s...", text);
    assert_string_equal(text_token(text).text, expected);
}

static void keep(void *user, whit_log_level level, const char *message)
{
    (void)level;
    snprintf(user, 64, "%s", message);
}

/* Messages of libwhit, which host programs print, are escaped too. */
TEST(messages_are_shown)
{
    char message[64];
    const whit_log log = {keep, message, WHIT_LOG_WARNING};
    log_error(&log, "%s: cannot be read", "a\n\x1b[2J\xff.obj");
    assert_string_equal(message, "a\\u000a\\u001b[2J\\xff.obj: cannot be read");
}

TEST(numbers_are_read_up_to_a_limit)
{
    uint32_t number;
    assert_string_equal(text_number("007/4", 99, &number), "/4");
    assert_true(number == 7);
    assert_string_equal(text_number("4294967295", UINT32_MAX, &number), "");
    assert_true(number == UINT32_MAX);
    assert_null(text_number("4294967296", UINT32_MAX, &number));
    assert_null(text_number("100", 99, &number));
    assert_null(text_number("-1", 99, &number));
    assert_null(text_number("", 99, &number));
}
