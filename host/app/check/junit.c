/* A run of `whit check` as JUnit XML, which CI services show. */
#include "app/check/check.h"

/* Writes text as the value of an XML attribute. Characters that XML cannot hold become escapes. */
static void put_text(FILE *to, const char *text)
{
    char shown[WHIT_SHOWN_BYTES];
    for (size_t length; (length = whit_text_next(text, shown)) != 0; text += length) {
        const char *entity = *text == '&'   ? "&amp;"
                             : *text == '<' ? "&lt;"
                             : *text == '>' ? "&gt;"
                             : *text == '"' ? "&quot;"
                                            : shown;
        fputs(entity, to);
    }
}

static void put_case(FILE *to, const struct check *check, const struct check_result *result)
{
    bool broken = result->verdict >= CHECK_BROKEN;
    fputs("  <testcase classname=\"", to);
    put_text(to, check->suite.path);
    fprintf(to, "\" name=\"%s\" time=\"%.3f\"", result->item->name, result->time_ms * 1e-3);
    if (result->verdict < CHECK_NEW) {
        fputs("/>\n", to);
        return;
    }
    fprintf(to, ">\n    <%s type=\"%s\" message=\"", broken ? "error" : "failure",
            verdict_word(result->verdict));
    put_text(to, result->text);
    fputs("\"/>\n  </testcase>\n", to);
}

void check_write_junit(FILE *to, const void *user)
{
    const struct check *check = user;
    uint32_t tests = 0, failures = 0, errors = 0;
    double time_ms = 0.0;
    for (uint32_t i = 0; i < check->suite.count; ++i) {
        const struct check_result *result = &check->results[i];
        tests += result->verdict != CHECK_NOT_RUN;
        errors += result->verdict >= CHECK_BROKEN;
        failures += result->verdict >= CHECK_NEW && result->verdict < CHECK_BROKEN;
        time_ms += result->time_ms;
    }
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"", to);
    put_text(to, check->suite.path);
    fprintf(to, "\" tests=\"%u\" failures=\"%u\" errors=\"%u\" time=\"%.3f\">\n", tests, failures,
            errors, time_ms * 1e-3);
    for (uint32_t i = 0; i < check->suite.count; ++i) {
        if (check->results[i].verdict != CHECK_NOT_RUN)
            put_case(to, check, &check->results[i]);
    }
    fputs("</testsuite>\n", to);
}
