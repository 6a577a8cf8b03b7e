/* All functions of ui.h that draw names escape control characters in them. */
#include "unit.h"
#include "view/ui.h"

void text_begin(void);
const char *text_end(void);

#define EVIL  "a\n\x1b]0;t\x07\xc2\x9b\xe2\x80\xae\xff"
#define SHOWN "a\\u000a\\u001b]0;t\\u0007\\u009b\\u202e\\xff"

static uint32_t count(const char *text, const char *part)
{
    uint32_t found = 0;
    for (; (text = strstr(text, part)) != NULL; text += strlen(part))
        ++found;
    return found;
}

TEST(names_are_shown)
{
    static const char *const names[] = {"one", "two"};
    float width, height, shown_width, shown_height;
    int value = 0;
    text_begin();
    ui_text("plain %s", EVIL);
    ui_text_dim("dim %s", EVIL);
    ui_text_color(0xFFFFFFFFu, "color %s", EVIL);
    ui_text_beside(0xFFFFFFFFu, "beside %s", EVIL);
    if (ui_table_begin("table", 1)) {
        ui_cell(0xFFFFFFFFu, "cell " EVIL);
        ui_table_end();
    }
    ui_choice("choice", EVIL, names, 2, &value);
    ui_progress(0.5f, "progress " EVIL);
    ui_text_size(EVIL, &width, &height);
    ui_text_size(SHOWN, &shown_width, &shown_height);
    const char *said = text_end();
    assert_int_equal(count(said, SHOWN), 7);
    static const char *const steering[] = {"\x1b", "\x07", "\xc2\x9b", "\xe2\x80\xae", "\xff"};
    for (size_t i = 0; i < sizeof steering / sizeof *steering; ++i)
        assert_null(strstr(said, steering[i]));
    assert_true(width == shown_width && height == shown_height);
}
