/* The text of a user's functions: included files, refusals with their lines, and the functions that
   it defines. */
#include <sys/stat.h>

#include "folder_fixture.h"
#include "shader/pack.h"
#include "shader/text.h"

static struct shader_text text;
static struct shader_errors errors;

static int begin(void **state)
{
    errors = (struct shader_errors){0};
    text = (struct shader_text){0};
    return folder_begin(state);
}

static int end(void **state)
{
    shader_text_free(&text);
    return folder_end(state);
}

static whit_result read_first(void)
{
    shader_text_free(&text);
    errors = (struct shader_errors){0};
    return shader_text_read(&warnings_log, in_folder("a.glsl"), &text, &errors);
}

/* Asserts that there is one error with this reason, at this line of a file of the folder, and that
   the log has it too. */
static void assert_refused(const char *file, uint32_t line, const char *reason)
{
    char message[1200];
    messages.errors = 0;
    assert_int_equal(read_first(), WHIT_ERROR_INPUT);
    assert_int_equal(errors.count, 1);
    assert_string_equal(errors.items[0].file, in_folder(file));
    assert_int_equal(errors.items[0].line, line);
    if (!strstr(errors.items[0].reason, reason))
        fail_msg("\"%s\" is not in \"%s\"", reason, errors.items[0].reason);
    if (line)
        snprintf(message, sizeof message, "%s:%u: ", in_folder(file), line);
    else
        snprintf(message, sizeof message, "%s: ", in_folder(file));
    assert_int_equal(messages.errors, 1);
    assert_memory_equal(messages.last, message, strlen(message));
    assert_int_equal(text.file_count, 0);
}

static void assert_text_refused(const char *content, uint32_t line, const char *reason)
{
    put_text("a.glsl", content);
    assert_refused("a.glsl", line, reason);
}

#define FUNCTION "float f() { return 1.0; }\n"

TEST_IN(files_are_read_once_with_what_they_include, begin, end)
{
    mkdir(in_folder("lib"), 0777);
    mkdir(in_folder("lib/deep"), 0777);
    put_text("a.glsl", "#include \"lib/b.glsl\"\n\n  # include  \"c.glsl\" // last\n" FUNCTION);
    put_text("lib/b.glsl", "#include \"deep/../deep/d.glsl\"\n#include \"../c.glsl\"\n");
    put_text("lib/deep/d.glsl", "#define D 1\n");
    put_text("c.glsl", "#define C 1");
    assert_int_equal(read_first(), WHIT_OK);
    static const char *const relatives[] = {"a.glsl", "lib/b.glsl", "lib/deep/d.glsl", "c.glsl"};
    assert_int_equal(text.file_count, 4);
    for (uint32_t i = 0; i < 4; ++i) {
        assert_string_equal(text.files[i].relative, relatives[i]);
        assert_string_equal(text.files[i].name, in_folder(relatives[i]));
    }
    assert_int_equal(text.files[0].include_count, 2);
    assert_int_equal(text.files[0].includes[0].line, 1);
    assert_int_equal(text.files[0].includes[0].file, 1);
    assert_int_equal(text.files[0].includes[1].line, 3);
    assert_int_equal(text.files[0].includes[1].file, 3);
    assert_string_equal(text.files[3].text, "#define C 1");
    assert_int_equal(text.files[3].bytes, 11);
    assert_int_equal(errors.count, 0);
}

TEST_IN(texts_in_memory_are_as_files, begin, end)
{
    const struct shader_text_source sources[] = {
        {"a.glsl", "#include \"lib/b.glsl\"\n" FUNCTION, 49},
        {"c.glsl", "#define C 1\n", 12},
        {"lib/b.glsl", "#include \"../c.glsl\"\n", 21},
    };
    mkdir(in_folder("lib"), 0777);
    for (uint32_t i = 0; i < 3; ++i)
        put_file(in_folder(sources[i].relative), sources[i].text, strlen(sources[i].text));
    assert_int_equal(read_first(), WHIT_OK);
    struct shader_text same;
    struct shader_text_source whole[3];
    for (uint32_t i = 0; i < 3; ++i)
        whole[i] = (struct shader_text_source){sources[i].relative, sources[i].text,
                                               strlen(sources[i].text)};
    assert_int_equal(shader_text_from(&warnings_log, whole, 3, &same, &errors), WHIT_OK);
    assert_int_equal(same.file_count, 3);
    assert_true(shader_text_hash(&same) == shader_text_hash(&text));
    assert_string_equal(same.files[1].name, "lib/b.glsl");
    shader_text_free(&same);
    whole[1].text = "#define C 2\n";
    assert_int_equal(shader_text_from(&warnings_log, whole, 3, &same, &errors), WHIT_OK);
    assert_true(shader_text_hash(&same) != shader_text_hash(&text));
    shader_text_free(&same);
    assert_int_equal(shader_text_from(&warnings_log, whole, 2, &same, &errors), WHIT_ERROR_INPUT);
    assert_string_equal(errors.items[0].file, "a.glsl");
    assert_int_equal(errors.items[0].line, 1);
    assert_int_equal(shader_text_from(&warnings_log, NULL, 0, &same, &errors), WHIT_ERROR_INPUT);
}

TEST_IN(what_is_no_file_is_refused_at_its_include, begin, end)
{
    static const struct {
        const char *name, *reason;
    } cases[] = {
        {"a.glsl", "includes itself"},
        {"missing.glsl", "no such file"},
        {"folder", "a folder"},
        {"folder/", "a folder"},
        {"fifo", "a pipe"},
        {"../out.glsl", "leads out"},
        {"folder/../../x", "leads out"},
        {"/dev/zero", "only names from"},
        {"zero", "outside"},
        {"link", "outside"},
        {"inside/passwd", "outside"},
        {"", "no name"},
        {"large.glsl", "larger than 1 MiB"},
        {"http://x/y.glsl", "no such file"},
        {"swapped.glsl", "include each other"},
    };
    char line[256], outside[300];
    snprintf(outside, sizeof outside, "%s.out", folder);
    put_file(outside, FUNCTION, strlen(FUNCTION));
    mkdir(in_folder("folder"), 0777);
    assert_int_equal(mkfifo(in_folder("fifo"), 0666), 0);
    assert_int_equal(symlink("/dev/zero", in_folder("zero")), 0);
    assert_int_equal(symlink(outside, in_folder("link")), 0);
    assert_int_equal(symlink("/etc", in_folder("inside")), 0);
    put_text("swapped.glsl", "\n\n#include \"a.glsl\"\n");
    own_memory char *large = malloc((1 << 20) + 1);
    memset(large, '\n', (1 << 20) + 1);
    put_file(in_folder("large.glsl"), large, (1 << 20) + 1);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        bool swapped = strcmp(cases[i].name, "swapped.glsl") == 0;
        snprintf(line, sizeof line, FUNCTION "#include \"%s\"\n", cases[i].name);
        put_text("a.glsl", line);
        assert_refused(swapped ? "swapped.glsl" : "a.glsl", swapped ? 3 : 2, cases[i].reason);
    }
    put_file(in_folder("large.glsl"), large, 1 << 20);
    put_text("a.glsl", FUNCTION "#include \"large.glsl\"");
    assert_int_equal(read_first(), WHIT_OK);
    assert_int_equal(text.files[1].bytes, 1 << 20);
    unlink(outside);
}

TEST_IN(the_first_file_is_refused_as_any, begin, end)
{
    static const struct {
        const char *path, *reason;
    } cases[] = {{"/dev/zero", "a device"}, {"/tmp", "a folder"}, {"/tmp/no/such", "no such file"}};
    for (size_t i = 0; i < 3; ++i) {
        errors.count = 0;
        assert_int_equal(shader_text_read(&warnings_log, cases[i].path, &text, &errors),
                         WHIT_ERROR_INPUT);
        assert_int_equal(errors.count, 1);
        assert_string_equal(errors.items[0].file, cases[i].path);
        assert_non_null(strstr(errors.items[0].reason, cases[i].reason));
    }
    put_text("real.glsl", FUNCTION);
    assert_int_equal(symlink("real.glsl", in_folder("a.glsl")), 0);
    assert_int_equal(read_first(), WHIT_OK); /* the file that the user names may be a link */
    shader_text_free(&text);
    assert_int_equal(shader_text_read(NULL, in_folder("none"), &text, NULL), WHIT_ERROR_INPUT);
}

TEST_IN(includes_go_16_deep_and_to_64_files, begin, end)
{
    char name[32], content[4096];
    for (int i = 0; i < 17; ++i) {
        snprintf(name, sizeof name, i ? "d%d.glsl" : "a.glsl", i);
        snprintf(content, sizeof content, i < 16 ? FUNCTION "#include \"d%d.glsl\"\n" : FUNCTION,
                 i + 1);
        put_text(name, content);
    }
    assert_refused("d15.glsl", 2, "16 deep");
    put_text("d15.glsl", FUNCTION);
    assert_int_equal(read_first(), WHIT_OK);
    assert_int_equal(text.file_count, 16);
    /* d2 was read where it is 3 deep; b includes it one deeper than there is room for. */
    put_text("a.glsl", "#include \"d2.glsl\"\n#include \"b.glsl\"\n");
    put_text("b.glsl", "#include \"b1.glsl\"\n");
    put_text("b1.glsl", "\n#include \"d2.glsl\"\n");
    assert_refused("b1.glsl", 2, "16 deep");
    for (int last = 64; last >= 63; --last) {
        size_t used = (size_t)snprintf(content, sizeof content, FUNCTION);
        for (int i = 1; i <= last; ++i) {
            snprintf(name, sizeof name, "e%d", i);
            put_text(name, "\n");
            used +=
                (size_t)snprintf(content + used, sizeof content - used, "#include \"e%d\"\n", i);
        }
        put_text("a.glsl", content);
        if (last == 64)
            assert_refused("a.glsl", 65, "more than 64 files");
        else
            assert_int_equal(read_first(), WHIT_OK);
    }
}

TEST_IN(what_is_no_text_is_refused_with_its_line, begin, end)
{
    static const char zero[] = FUNCTION "\n\0" FUNCTION;
    put_file(in_folder("a.glsl"), zero, sizeof zero - 1);
    assert_refused("a.glsl", 3, "a byte 0");
    assert_text_refused("\x7f"
                        "ELF",
                        1, "a byte 127");
    put_text("a.glsl", "\xef\xbb\xbf#define X \"\xc3\x84\"\r\n// \xc3\xa4\r\n" FUNCTION);
    assert_int_equal(read_first(), WHIT_OK);
}

/* What is compiled has neither a byte order mark nor what `#if 0` leaves out, and recipes have
 * both. */
TEST_IN(the_files_own_bytes_are_kept, begin, end)
{
    static const char own[] = "\xef\xbb\xbf// a\r\f\v// b\r\n#if 0\nfloat g();\n#endif\n" FUNCTION;
    put_text("a.glsl", own);
    assert_int_equal(read_first(), WHIT_OK);
    assert_int_equal(text.files[0].bytes, sizeof own - 1);
    assert_string_equal(text.files[0].raw, own);
    assert_string_equal(text.files[0].text,
                        "   // a\n  // b\r\n#if 0\n          \n#endif\n" FUNCTION);
    const char *why;
    own_memory char *packed = shader_pack_write(&text, &why);
    assert_non_null(
        strstr(packed, "\\xef\\xbb\\xbf// a\\x0d\\x0c\\x0b// b\\x0d\n#if 0\nfloat g();\n"));
}

TEST_IN(characters_that_are_not_glsl_are_refused_with_their_column, begin, end)
{
    static const struct {
        uint32_t line, column;
        const char *content, *reason;
    } cases[] = {
        {2, 11, FUNCTION "float a = \xe2\x88\x92 1.0;\n",
         "the character '\xe2\x88\x92' (U+2212) is not GLSL"},
        {1, 9, "float gr\xc3\xb6() { return 1.0; }\n", "the character '\xc3\xb6' (U+00F6)"},
        {1, 9, "#define \xc3\x84 1\n" FUNCTION, "U+00C4"},
        {3, 1, "/* \xc3\xa4 */ // \xfc\n\n\xf0\x9f\x98\x80\n" FUNCTION, "U+1F600"},
        {1, 2, " \xfc\n" FUNCTION, "the byte 0xFC is not GLSL"},
        {1, 1, "\xc3", "the byte 0xC3 is not GLSL"},
        {2, 9, "#define USER @$`\nfloat a @ 1.0;\n" FUNCTION, "the character '@' is not GLSL"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        put_text("a.glsl", cases[i].content);
        assert_int_equal(read_first(), WHIT_ERROR_INPUT);
        assert_int_equal(errors.count, 1);
        assert_int_equal(errors.items[0].line, cases[i].line);
        assert_int_equal(errors.items[0].column, cases[i].column);
        if (!strstr(errors.items[0].reason, cases[i].reason))
            fail_msg("\"%s\" is not in \"%s\"", cases[i].reason, errors.items[0].reason);
    }
}

TEST_IN(what_is_whits_own_is_refused_with_its_line, begin, end)
{
    static const struct {
        uint32_t line;
        const char *content, *reason;
    } cases[] = {
        {1, "#version 100\n" FUNCTION, "#version"},
        {3, "\n/*\n*/#version 460\n" FUNCTION, "#version"},
        {2, "\n # /**/ extension GL_EXT_x : require\n" FUNCTION, "#extension"},
        {2, "\r#extension GL_EXT_x : require\r" FUNCTION, "#extension"},
        {2, "\r\n#\\\r\nline 3\r\n" FUNCTION, "#line"},
        {1, "#li\\\nne 3\n" FUNCTION, "#line"},
        {2, "\n#pragma once\n" FUNCTION, "#pragma"},
        {2, FUNCTION "layout(location = 0) in vec3 x;", "layout"},
        {2, FUNCTION "void main() {}", "main"},
        {1, "shared float x;\n" FUNCTION, "shared"},
        {1, "#define U uniform\n" FUNCTION, "uniform"},
        {2, "\nbuffer B { float x; };\n" FUNCTION, "buffer"},
        {1, "#define J(a, b) a ## b\n" FUNCTION, "##"},
        {1, "#define J(a, b) a #\\\n# b\n" FUNCTION, "##"},
        {2, FUNCTION "/* open", "does not end"},
        {2, FUNCTION "#if 1\n#if 1\n#endif\n", "#if without"},
        {1, "#endif\n" FUNCTION, "#endif without"},
        {1, "#else\n" FUNCTION, "#else"},
        {1, "#define X \"/*\"\n" FUNCTION, "comment in a string"},
        {1, "#define X \"a\n" FUNCTION, "string that does not end"},
        {1, "#define X \"\\\"\"\n" FUNCTION, "backslash"},
        {1, "#include <x.glsl>\n" FUNCTION, "quotes"},
        {1, "#include X\n" FUNCTION, "quotes"},
        {1, "/* */ #include \"b.glsl\"\n" FUNCTION, "line of its own"},
        {1, "#include \"b.glsl\" /*\n*/\n" FUNCTION, "line of its own"},
        {1, "#include \"b.glsl\" x\n" FUNCTION, "line of its own"},
    };
    put_text("b.glsl", "\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
        assert_text_refused(cases[i].content, cases[i].line, cases[i].reason);
    put_text("a.glsl", "// #version 100\n/* \n */ // \\\n #line 3\n/* layout */\n#define layouts "
                       "1\n#error \"x\"\n" FUNCTION);
    assert_int_equal(read_first(), WHIT_OK);
}

TEST_IN(functions_with_a_body_at_the_top_level_are_found, begin, end)
{
    put_text("a.glsl", "float declared(vec3 x);\n"
                       "// float commented() {}\n"
                       "/* float commented() {} */\n"
                       "#define macro() {}\n"
                       "const float array[2] = float[2](1.0, 2.0);\n"
                       "struct S { float x; } s;\n"
                       "#include \"b.glsl\"\n"
                       "vec3 shade(S s,\n"
                       "           float[2] y)\n"
                       "{ if (called(1.0) > 0.0) { inner(); } return vec3(0.0); }\n"
                       "#ifdef A\n"
                       "float either(float a) {\n"
                       "#else\n"
                       "float either(int a) {\n"
                       "#endif\n"
                       "    return 1.0; }\n"
                       "float[2] behind(void) { return array; }");
    put_text("b.glsl", "\n\\\nvoid  surf\\\nace ( inout S s )\n{\n}\n");
    assert_int_equal(read_first(), WHIT_OK);
    static const struct {
        const char *name;
        uint32_t file, line;
    } found[] = {{"shade", 0, 8}, {"surface", 1, 3}, {"either", 0, 12}, {"behind", 0, 17}};
    for (size_t i = 0; i < sizeof found / sizeof *found; ++i) {
        uint32_t file = 9, line = 9;
        assert_true(shader_text_defines(&text, found[i].name, &file, &line));
        assert_int_equal(file, found[i].file);
        assert_int_equal(line, found[i].line);
        assert_true(shader_text_defines(&text, found[i].name, NULL, NULL));
    }
    static const char *const none[] = {"declared", "commented", "macro", "called", "inner",
                                       "S",        "if",        "float", "shad",   ""};
    for (size_t i = 0; i < sizeof none / sizeof *none; ++i)
        assert_false(shader_text_defines(&text, none[i], NULL, NULL));
}

TEST_IN(what_is_hard_to_scan_ends, begin, end)
{
    static const char *const pieces[] = {"\\",
                                         "/",
                                         "*",
                                         "\"",
                                         "#",
                                         "\n",
                                         "\r",
                                         "{",
                                         "}",
                                         "(",
                                         ")",
                                         "a",
                                         "if",
                                         "#if",
                                         "#endif\n",
                                         "#else\n",
                                         "#include \"b\"\n"};
    char content[512];
    uint32_t random = 1;
    put_text("b", "\n");
    for (int i = 0; i < 3000; ++i) {
        content[0] = 0;
        for (int j = 0; j < 40; ++j) {
            random = random * 1664525u + 1013904223u;
            strcat(content, pieces[(random >> 16) % (sizeof pieces / sizeof *pieces)]);
        }
        const struct shader_text_source sources[] = {{"a", content, strlen(content)},
                                                     {"b", "\n", 1}};
        if (shader_text_from(NULL, sources, 2, &text, NULL) == WHIT_OK)
            assert_false(shader_text_defines(&text, "none", NULL, NULL));
        shader_text_free(&text);
    }
}
