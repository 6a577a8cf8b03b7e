/* Prints what `whit probe --shader` adds to a report: which figures the report lacks, and the
   values of each dbg(x) of the user's file; as text and as JSON. */
#include <string.h>

#include "app/probe/probe_shader.h"

/* Figures that the report lacks when a user's file has taken the place of whit's functions. */
static const char own_rays[] = "rays that its functions trace, as by visible() and trace()";
static const char shape[] =
    "the shape of intersect() in twin and exact: of rays that meet it they say "
    "whether something is before it";
static const char before_post[] = "the share of post() in the colour";

static whit_shader_info shader_of(const struct probe *probe)
{
    whit_shader_info info = {0};
    if (probe->job.shader)
        whit_shader_get_info(probe->job.shader, &info);
    return info;
}

enum { MISSING_MAX = 3 };

static uint32_t list_missing(const whit_shader_info *info, const char *missing[MISSING_MAX])
{
    uint32_t count = 0;
    missing[count++] = own_rays;
    if (info->hooks >> WHIT_HOOK_INTERSECT & 1)
        missing[count++] = shape;
    if (info->hooks >> WHIT_HOOK_POST & 1)
        missing[count++] = before_post;
    return count;
}

void probe_print_shader(const struct probe *probe)
{
    const whit_shader_info info = shader_of(probe);
    if (info.hooks == 0)
        return;
    printf("shader     %s:", cli_shown(info.files[0]));
    const char *names[WHIT_HOOKS], *missing[MISSING_MAX];
    uint32_t name_count = job_functions(&info, names);
    for (uint32_t i = 0; i < name_count; ++i)
        printf("%s %s", i ? "," : "", names[i]);
    putchar('\n');
    uint32_t count = list_missing(&info, missing);
    for (uint32_t i = 0; i < count; ++i)
        printf("missing    %s\n", missing[i]);
}

static void print_place(const whit_probe_call *call)
{
    printf("%s:%u: %s", cli_shown(call->file), call->line, cli_shown(call->text));
}

static void print_call(const whit_probe_call *call)
{
    char text[4 * 24];
    for (uint32_t i = 0; i < call->value_count; ++i) {
        const whit_probe_value *value = &call->values[i];
        whit_probe_value_text(value, 9, text, sizeof text);
        print_place(call);
        printf(" = %s", text);
        if (call->value_count > 1)
            printf("   call %u", i + 1);
        if (value->generation)
            printf("   after %u bounce%s", value->generation, value->generation == 1 ? "" : "s");
        putchar('\n');
    }
    if (call->count > call->value_count || !call->count)
        print_place(call);
    if (call->count > call->value_count)
        printf(", %u times more\n", call->count - call->value_count);
    else if (!call->count)
        printf(" was not reached\n");
}

void probe_print_calls(const whit_probe_report *report)
{
    for (uint32_t i = 0; i < report->call_count; ++i)
        print_call(&report->calls[i]);
    if (report->call_count)
        putchar('\n');
}

/* ---- JSON ---- */

static json_t *names_document(const char *const *names, uint32_t count)
{
    json_t *out = document_array();
    for (uint32_t i = 0; i < count; ++i)
        document_append(out, json_string(names[i]));
    return out;
}

json_t *probe_shader_document(const struct probe *probe)
{
    const whit_shader_info info = shader_of(probe);
    const char *names[WHIT_HOOKS], *missing[MISSING_MAX];
    if (info.hooks == 0)
        return json_null();
    json_t *out = document_object();
    document_text(out, "file", info.files[0]);
    document_put(out, "functions", names_document(names, job_functions(&info, names)));
    document_put(out, "missing", names_document(missing, list_missing(&info, missing)));
    return out;
}

static json_t *value_document(const whit_probe_value *value)
{
    json_t *out = document_object(), *components = document_array();
    float reals[4] = {0};
    for (uint32_t i = 0; i < value->size; ++i) {
        reals[i] = (float)value->v[i];
        document_append(components, value->kind == WHIT_VALUE_BOOL
                                        ? json_boolean(value->v[i] != 0.0)
                                        : json_integer((json_int_t)value->v[i]));
    }
    if (value->kind == WHIT_VALUE_FLOAT) {
        json_decref(components);
        document_floats(out, "value", reals, value->size);
    } else {
        document_put(out, "value", components);
    }
    document_count(out, "ray", value->ray);
    document_count(out, "generation", value->generation);
    return out;
}

json_t *probe_calls_document(const whit_probe_report *report)
{
    json_t *out = document_array();
    for (uint32_t i = 0; i < report->call_count; ++i) {
        const whit_probe_call *call = &report->calls[i];
        json_t *one = document_entry(out);
        document_text(one, "file", call->file);
        document_count(one, "line", call->line);
        document_text(one, "text", call->text);
        document_count(one, "count", call->count);
        json_t *values = document_list(one, "values");
        for (uint32_t k = 0; k < call->value_count; ++k)
            document_append(values, value_document(&call->values[k]));
    }
    return out;
}
