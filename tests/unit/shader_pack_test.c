/* Files of functions as they are packed into pictures: they come back as they were, and text that
   was packed wrongly is refused. */
#include "base/hash.h"
#include "folder_fixture.h"
#include "random_fixture.h"
#include "shader/pack.h"

static const struct shader_text_source files[] = {
    {"toon.glsl",
     "#include \"part/a.glsl\"\nvec3 miss(vec3 d) { return a(d); } // \\file \xc3\xa9\r\n", 0},
    {"part/a.glsl", "\\end 0\n\\file x\nvec3 a(vec3 d) { return d; }", 0},
};

/* The files above, packed. */
static char *packed(void)
{
    static char text[2048];
    const char *why;
    struct shader_file read[2] = {0};
    for (int i = 0; i < 2; ++i)
        read[i] = (struct shader_file){.relative = (char *)(uintptr_t)files[i].relative,
                                       .raw = (char *)(uintptr_t)files[i].text,
                                       .bytes = strlen(files[i].text)};
    const struct shader_text all = {.files = read, .file_count = 2};
    own_memory char *made = shader_pack_write(&all, &why);
    assert_non_null(made);
    assert_true(strlen(made) < sizeof text);
    strcpy(text, made);
    return text;
}

/* Makes a packed text of these files, with a valid hash at its end. */
static const char *sealed(const char *names[], const char *texts[], uint32_t count)
{
    static char text[1 << 16];
    uint64_t hash = HASH_START;
    strcpy(text, "\\whit 1\n");
    for (uint32_t i = 0; i < count; ++i) {
        sprintf(text + strlen(text), "\\file %s\n%s\n", names[i], texts[i]);
        hash = hash_bytes(hash, names[i], strlen(names[i]));
        hash = hash_bytes(hash, texts[i], strlen(texts[i]));
    }
    sprintf(text + strlen(text), "\\end %016llx", (unsigned long long)hash);
    return text;
}

/* Whether a packed text can be read; checks that there is one error if not, and that all files are
   complete if it can. */
static bool reads(const char *text)
{
    struct shader_pack pack;
    messages = (struct messages){0};
    whit_result result = shader_pack_read(&warnings_log, "a.png", text, &pack);
    assert_int_equal(messages.count, result == WHIT_OK ? 0 : 1);
    assert_int_equal(pack.count == 0, result != WHIT_OK);
    for (uint32_t i = 0; i < pack.count; ++i) {
        assert_null(shader_pack_name_refused(pack.sources[i].relative));
        assert_int_equal(pack.sources[i].text[pack.sources[i].bytes], 0);
    }
    shader_pack_free(&pack);
    return result == WHIT_OK;
}

TEST(what_is_packed_comes_back)
{
    struct shader_pack pack;
    const char *text = packed();
    for (const char *c = text; *c; ++c)
        assert_true(*c == '\n' || *c == '\t' || (*c >= ' ' && *c <= '~'));
    assert_int_equal(shader_pack_read(NULL, "a.png", text, &pack), WHIT_OK);
    assert_int_equal(pack.count, 2);
    for (uint32_t i = 0; i < 2; ++i) {
        assert_string_equal(pack.sources[i].relative, files[i].relative);
        assert_int_equal(pack.sources[i].bytes, strlen(files[i].text));
        assert_memory_equal(pack.sources[i].text, files[i].text, pack.sources[i].bytes);
    }
    shader_pack_free(&pack);
}

TEST(names_stay_below_their_folder)
{
    static const char *const refused[] = {
        "",     "/etc/passwd", "..",     "../a.glsl",  "a/../../b",   "a/..",
        ".",    "./a",         "a//b",   "a/",         "/",           "nul",
        "CON",  "com1.glsl",   "Lpt9",   "part/aux.x", "c:x",         "a\\b",
        "a\nb", "a|b",         "CONIN$", "a/./b",      "a\x7f",       "part/prn",
        "//a",  "a*",          ".a",     "..a",        ".git/config", "part/.a",
    };
    static const char *const fine[] = {"a",     "a.glsl",       "part/a.glsl", "a..",
                                       "a.",    "com.glsl",     "console",     "a b",
                                       "com10", "\xc3\xa9.glsl"};
    const char *text = "x";
    for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i) {
        if (!shader_pack_name_refused(refused[i]))
            fail_msg("`%s` is taken", refused[i]);
        const char *name = refused[i];
        if (reads(sealed(&name, &text, 1)))
            fail_msg("`%s` is read", name);
    }
    for (size_t i = 0; i < sizeof fine / sizeof *fine; ++i)
        assert_null(shader_pack_name_refused(fine[i]));
    char long_name[SHADER_PACK_NAME_BYTES + 1];
    memset(long_name, 'a', sizeof long_name);
    long_name[sizeof long_name - 1] = 0;
    assert_non_null(shader_pack_name_refused(long_name));
    long_name[300] = 0;
    assert_non_null(shader_pack_name_refused(long_name));
}

TEST(a_name_is_there_once)
{
    const char *texts[] = {"x", "y"};
    const char *pairs[][2] = {{"a", "a"}, {"a", "a/b"}, {"a/b", "a"}, {"a/b", "a/b"}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; ++i)
        assert_false(reads(sealed(pairs[i], texts, 2)));
    const char *other[] = {"a", "ab"};
    assert_true(reads(sealed(other, texts, 2)));
}

TEST(damage_is_one_error)
{
    static const char *const damaged[] = {
        "",
        "x",
        "\\whit 1",
        "\\whit 1\n",
        "\\whit 2\n\\file a\nx\n\\end 0",
        "\\whit 1\n\\end 0",
        "\\whit 1\n\\file a",
        "\\whit 1\n\\file a\n",
        "\\whit 1\n\\file a\nx\n\\end ",
        "\\whit 1\n\\file a\nx\n\\end 0123456789abcdef",
        "\\whit 1\n\\file a\n\\",
        "\\whit 1\n\\file a\n\\x",
        "\\whit 1\n\\file a\n\\x0",
        "\\whit 1\n\\file a\\x00b\nx\n\\end 0",
        "\\whit 1\n\\file a\n\xff\n\\end 0",
        "{\"files\":[]}",
    };
    for (size_t i = 0; i < sizeof damaged / sizeof *damaged; ++i)
        assert_false(reads(damaged[i]));
    const char *whole = packed();
    char cut[2048];
    for (size_t bytes = 0; bytes < strlen(whole); ++bytes) {
        snprintf(cut, bytes + 1, "%s", whole);
        assert_false(reads(cut));
    }
}

/* Packed texts with inserted, removed and changed bytes: files that are read are complete, and
   their names do not lead out of the folder. */
TEST(no_mutation_crashes)
{
    static const char *const pieces[] = {"\\",       "\\x", "\\file ", "\n\\file ../x\n",
                                         "\n\\end ", "/",   "\n",      "\x01"};
    random_state = 7;
    uint32_t good = 0;
    for (int round = 0; round < 20000; ++round) {
        char text[4096];
        strcpy(text, packed());
        for (uint32_t edits = 1 + random_below(&random_state, 3); edits; --edits) {
            size_t length = strlen(text), at = random_below(&random_state, (uint32_t)length);
            const char *piece = pieces[random_below(&random_state, 8)];
            size_t more = strlen(piece);
            switch (random_below(&random_state, 3)) {
            case 0:
                memmove(text + at + more, text + at, length - at + 1);
                memcpy(text + at, piece, more);
                break;
            case 1:
                memmove(text + at, text + at + 1, length - at);
                break;
            default:
                text[at] = (char)(1 + random_below(&random_state, 255));
            }
        }
        good += reads(text);
    }
    assert_true(good < 20); /* some edits undo each other */
}

TEST(there_are_limits)
{
    static char large[SHADER_PACK_BYTES + 2];
    const char *why;
    char name[] = "a.glsl";
    memset(large, 'x', sizeof large - 1);
    assert_false(reads(large));
    struct shader_file file = {.relative = name, .raw = large, .bytes = SHADER_PACK_BYTES};
    const struct shader_text text = {.files = &file, .file_count = 1};
    assert_null(shader_pack_write(&text, &why));
    assert_non_null(strstr(why, "1 MiB"));
    file.bytes = SHADER_PACK_BYTES - 100;
    char *made = shader_pack_write(&text, &why);
    assert_non_null(made);
    assert_null(why);
    assert_true(reads(made));
    free(made);
    char *names[SHADER_TEXT_FILES_MAX + 1];
    const char *texts[SHADER_TEXT_FILES_MAX + 1];
    for (int i = 0; i <= SHADER_TEXT_FILES_MAX; ++i) {
        names[i] = malloc(16);
        snprintf(names[i], 16, "f%d", i);
        texts[i] = "x";
    }
    assert_true(reads(sealed((const char **)names, texts, SHADER_TEXT_FILES_MAX)));
    assert_false(reads(sealed((const char **)names, texts, SHADER_TEXT_FILES_MAX + 1)));
    for (int i = 0; i <= SHADER_TEXT_FILES_MAX; ++i)
        free(names[i]);
}
