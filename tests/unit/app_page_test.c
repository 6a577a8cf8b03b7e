/* Pages of HTML: whatever text goes in, well-formed XML comes out, and nothing in it asks for
   anything from elsewhere. WHIT_PAGE=FILE keeps the sample page, to be looked at. */
#include <math.h>

#include "image_fixture.h"

#include "app/page.h"
#include "app/plot.h"

static uint32_t count_of(const char *text, const char *part)
{
    uint32_t count = 0;
    for (; (text = strstr(text, part)); text += strlen(part))
        ++count;
    return count;
}

/* ---- A page with all there is ---- */

static whit_image *make_picture(uint32_t phase)
{
    enum { WIDTH = 240, HEIGHT = 160 };
    static float pixels[WIDTH * HEIGHT * 3];
    whit_image *image;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i) {
        uint32_t x = i % WIDTH, y = i / WIDTH;
        float dx = (float)x - 120.0f - (float)phase, dy = (float)y - 80.0f;
        float inside = dx * dx + dy * dy < 3000.0f ? 0.8f : 0.1f;
        pixels[3 * i] = inside;
        pixels[3 * i + 1] = (float)y / HEIGHT * 0.5f;
        pixels[3 * i + 2] = (float)x / WIDTH * 0.5f;
    }
    assert_int_equal(whit_image_create(WIDTH, HEIGHT, 3, pixels, &image), WHIT_OK);
    return image;
}

static const char nasty[] =
    "</title><script>alert(\"1\")</script> & 'it' \x01\xff\xc0\xaf\xed\xa0\x80 "
    "\xce\xb5 \xf0\x9f\x94\xa5";

static void put_plots(struct page *page)
{
    static struct plot_point points[PLOT_STYLES][6];
    static struct plot_series series[PLOT_STYLES];
    static const char *const names[PLOT_STYLES] = {"fast",  "watertight", "exact", nasty,
                                                   "depth", "aa",         "lights"};
    for (uint32_t s = 0; s < PLOT_STYLES; ++s) {
        for (uint32_t i = 0; i < 6; ++i) {
            double x = 2.0 * pow(2.1, i) * (1.0 + 0.1 * s), y = 0.3 * pow(0.2, i) * (1 + s);
            points[s][i] = (struct plot_point){.x = x,
                                               .y = i == 5 && s % 2 ? 0.0 : y,
                                               .x_low = x * 0.93,
                                               .x_high = x * 1.1,
                                               .title = s == 3 ? nasty : "64 samples: 93 ms",
                                               .marked = s == 0};
        }
        series[s] = (struct plot_series){names[s], points[s], 6, s % 3 == 0, false};
    }
    points[1][2].y = NAN;
    const struct plot both = {.title = "Price and error, both logarithmic, some errors 0",
                              .x = {"ms a frame", true},
                              .y = {"RMSE", true},
                              .series = series,
                              .series_count = PLOT_STYLES};
    plot_write(page, &both);
    const struct plot linear = {.title = nasty,
                                .x = {"ms a frame", false},
                                .y = {"FLIP", false},
                                .series = series,
                                .series_count = 2};
    plot_write(page, &linear);
    const struct plot empty = {.title = "Nothing", .x = {"x", true}, .y = {"y", false}};
    plot_write(page, &empty);
}

static void put_everything(struct page *page)
{
    static const struct page_column columns[] = {
        {"setting", false}, {"ms a frame", true}, {nasty, true}};
    static const char *const rows[][3] = {{"fast", "12.3", "0.0012"},
                                          {"watertight", "13.1", "0"},
                                          {nasty, "-", "not distinguishable"}};
    whit_image *a = make_picture(0), *b = make_picture(12);
    page_begin(page, nasty);
    page_paragraph(page, "Measured on %s in %d rounds.", nasty, 15);
    page_code(page, "whit cost scenes/default.json --size 640x480 <> &");
    page_heading(page, "Prices");
    page_table_begin(page, "ms of one frame: medians with their 95 % intervals", columns, 3);
    for (int i = 0; i < 3; ++i)
        page_table_row(page, columns, 3, rows[i], i == 1);
    page_table_end(page);
    page_heading(page, "Plots");
    put_plots(page);
    page_heading(page, "Pictures");
    page_picture(page, a, nasty, "The reference");
    page_flip(page, a, "reference", b, nasty);
    page_end(page);
    whit_image_destroy(a);
    whit_image_destroy(b);
}

/* ---- Checks ---- */

static void assert_escaped(const char *text, const char *expected)
{
    struct page page = {0};
    page_text(&page, text);
    assert_string_equal(page.text ? page.text : "", expected);
    page_finish(&page);
}

TEST(text_is_escaped)
{
    assert_escaped("", "");
    assert_escaped("<b a=\"1\" c='2'> & </b>",
                   "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt; &amp; &lt;/b&gt;");
    assert_escaped("\x01\x1b[2J\n\t\x7f", "\\u0001\\u001b[2J\\u000a\\u0009\\u007f");
    assert_escaped("\xc3\xa4 \xe2\x82\xac \xf0\x9f\x94\xa5",
                   "\xc3\xa4 \xe2\x82\xac \xf0\x9f\x94\xa5");
    assert_escaped("\xc3(<", "\\xc3(&lt;");
    assert_escaped("\xc0\xbc", "\\xc0\\xbc");  /* a long < */
    assert_escaped("\xef\xbf\xbf", "\\uffff"); /* not allowed in XML */
    assert_escaped("\xe2\x80\xae>", "\\u202e&gt;");
}

/* By another program: as XML it is stricter than HTML, and asks for UTF-8. */
TEST_IN(everything_is_well_formed, folder_begin, folder_end)
{
    struct page page = {0};
    char command[128];
    put_everything(&page);
    assert_false(page.failed);
    assert_int_equal(page.length, strlen(page.text));
    assert_true(count_of(page.text, "<") - count_of(page.text, "</") > 150); /* elements */
    assert_null(strstr(page.text, "<script"));
    assert_non_null(strstr(page.text, "&lt;script&gt;"));
    assert_int_equal(page_save(&page, in_folder("page.html"), NULL), WHIT_OK);
    const char *path = getenv("WHIT_PAGE");
    if (path)
        assert_int_equal(page_save(&page, path, NULL), WHIT_OK);
    page_finish(&page);
    /* Debian: libxml2-utils. Without it the check fails: nothing else reads the page. */
    snprintf(command, sizeof command, "xmllint --noout --nonet %s", in_folder("page.html"));
    assert_int_equal(system(command), 0);
}

/* Memory ran out on the way: there is no half page. */
TEST_IN(half_a_page_is_not_saved, folder_begin, folder_end)
{
    char *path = in_folder("half.html");
    struct page page = {0};
    page_begin(&page, "half");
    page.failed = true;
    page_paragraph(&page, "more");
    assert_null(strstr(page.text, "more"));
    const whit_log log = {collect, NULL, WHIT_LOG_INFO};
    assert_int_equal(page_save(&page, path, &log), WHIT_ERROR_MEMORY);
    assert_int_equal(messages.errors, 1);
    assert_int_not_equal(access(path, F_OK), 0);
    page_finish(&page);
}

/* Links would be requests; names of namespaces are none. */
TEST(nothing_comes_from_elsewhere)
{
    struct page page = {0};
    put_everything(&page);
    assert_int_equal(count_of(page.text, "http:"),
                     count_of(page.text, "xmlns=\"http://www.w3.org/"));
    assert_int_equal(count_of(page.text, "https:"), 0);
    assert_int_equal(count_of(page.text, "default-src 'none'"), 1);
    assert_int_equal(count_of(page.text, "src="),
                     count_of(page.text, "src=\"data:image/png;base64,"));
    assert_int_equal(count_of(page.text, "src="), 3);
    static const char *const never[] = {"href", "url(", "@import", "<link", "<iframe", "onload"};
    for (size_t i = 0; i < sizeof never / sizeof never[0]; ++i)
        assert_null(strstr(page.text, never[i]));
    page_finish(&page);
}

/* Points that are not finite are left out, all others are there with their titles. */
TEST(plots_hold_every_point)
{
    struct page page = {0};
    put_plots(&page);
    assert_int_equal(count_of(page.text, "<g class=\"point"), 6 * PLOT_STYLES - 1 + 12 - 1);
    assert_int_equal(count_of(page.text, "<title>"), 6 * PLOT_STYLES - 1 + 12 - 1);
    assert_int_equal(count_of(page.text, "class=\"point mark\""), 12);
    assert_int_equal(count_of(page.text, "grid zero"), 1); /* errors of 0, on one axis */
    assert_null(strstr(page.text, "nan"));
    assert_null(strstr(page.text, "inf"));
    page_finish(&page);
}

/* RFC 4648, section 10. */
TEST(base64_is_that_of_the_standard)
{
    static const char *const known[] = {"",         "Zg==",     "Zm8=",    "Zm9v",
                                        "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
    for (size_t length = 0; length < 7; ++length) {
        struct page page = {0};
        page_base64(&page, (const uint8_t *)"foobar", length);
        assert_string_equal(page.text ? page.text : "", known[length]);
        page_finish(&page);
    }
}

TEST(pictures_are_whole)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    whit_image *image = make_picture(3);
    struct page page = {0};
    uint8_t *png;
    size_t size_bytes, at = 0;
    assert_int_equal(whit_image_encode_png(image, NULL, 0, NULL, &png, &size_bytes), WHIT_OK);
    assert_memory_equal(png, "\x89PNG", 4);
    page_picture(&page, image, "", NULL);
    const char *text = strstr(page.text, "base64,") + strlen("base64,");
    uint32_t bits = 0, held = 0;
    for (; *text != '"' && *text != '='; ++text) {
        assert_non_null(strchr(digits, *text));
        bits = bits << 6 | (uint32_t)(strchr(digits, *text) - digits);
        held += 6;
        if (held < 8)
            continue;
        held -= 8;
        assert_true(at < size_bytes);
        assert_int_equal(bits >> held & 255, png[at++]);
    }
    assert_int_equal(at, size_bytes);
    whit_memory_destroy(png);
    page_finish(&page);
    whit_image_destroy(image);
}

static void assert_ticks(double low, double high, bool is_log, uint32_t wanted, uint32_t count,
                         const double *expected)
{
    double ticks[PLOT_TICKS_MAX];
    assert_int_equal(plot_ticks(low, high, is_log, wanted, ticks), count);
    for (uint32_t i = 0; i < count; ++i)
        assert_true(fabs(ticks[i] - expected[i]) <= 1e-9 * fabs(expected[i]));
}

TEST(ticks_read_well)
{
    assert_ticks(0.0, 10.0, false, 5, 6, (const double[]){0, 2, 4, 6, 8, 10});
    assert_ticks(-1.0, 1.0, false, 4, 5, (const double[]){-1, -0.5, 0, 0.5, 1});
    assert_ticks(103.0, 117.0, false, 7, 7, (const double[]){104, 106, 108, 110, 112, 114, 116});
    assert_ticks(0.0, 3e-7, false, 3, 4, (const double[]){0, 1e-7, 2e-7, 3e-7});
    assert_ticks(0.9, 1100.0, true, 6, 10,
                 (const double[]){1, 2, 5, 10, 20, 50, 100, 200, 500, 1000});
    assert_ticks(1e-6, 1.0, true, 6, 7, (const double[]){1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1});
    assert_ticks(1e-12, 1.0, true, 6, 7, (const double[]){1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1});
    assert_ticks(3.1, 4.2, true, 6, 6, (const double[]){3.2, 3.4, 3.6, 3.8, 4.0, 4.2});
}

/* In order, inside, and few enough to be read. */
TEST(ticks_of_any_range)
{
    uint64_t seed = 5;
    for (int trial = 0; trial < 20000; ++trial) {
        double ticks[PLOT_TICKS_MAX], low, high;
        bool is_log = trial % 2;
        low = pow(10.0, (double)random_below(&seed, 24000) * 1e-3 - 12.0);
        high = low * (1.0 + pow(10.0, (double)random_below(&seed, 15000) * 1e-3 - 5.0));
        if (!is_log && trial % 4 == 0)
            low = -low;
        uint32_t count = plot_ticks(low, high, is_log, 6, ticks);
        assert_true(count >= 2 && count <= 16);
        for (uint32_t i = 0; i < count; ++i) {
            assert_true(ticks[i] >= low - 1e-6 * (high - low));
            assert_true(ticks[i] <= high + 1e-6 * (high - low));
            assert_true(i == 0 || ticks[i] > ticks[i - 1]);
        }
    }
}

TEST(axes_are_widened)
{
    static const struct {
        double low, high;
        bool is_log;
        double from, to;
    } known[] = {{10.0, 100.0, false, 0.0, 104.5},    {90.0, 100.0, false, 89.5, 100.5},
                 {5.0, 5.0, false, 4.75, 5.25},       {0.0, 0.0, false, 0.0, 1.0},
                 {1.0, -1.0, false, 0.0, 1.0},        {1.0, -1.0, true, 1.0, 10.0},
                 {1.0, 1e4, true, 0.630957, 15848.9}, {3.0, 3.0, true, 2.72727, 3.3},
                 {-2.0, 2.0, false, -2.2, 2.2}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i) {
        double low = known[i].low, high = known[i].high;
        plot_widen(&low, &high, known[i].is_log);
        assert_true(fabs(low - known[i].from) < 1e-5 && fabs(high - known[i].to) < 0.1);
        assert_true(low < high);
    }
}
