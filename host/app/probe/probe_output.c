#include "app/probe/probe_output.h"

#include <string.h>

#include "app/document.h"
#include "app/settings_json.h"

static bool was_traced(const whit_probe_ray *ray)
{
    return ray->end != WHIT_PROBE_DEPTH && ray->end != WHIT_PROBE_BAILOUT;
}

static bool has_met(const whit_probe_hit *hit)
{
    return hit->primitive != WHIT_NONE;
}

static whit_material_info material_of(const struct probe *probe, uint32_t index)
{
    whit_material_info material = {0};
    if (index != WHIT_NONE)
        whit_scene_get_material(probe->job.scene, index, &material);
    return material;
}

static whit_instance_info instance_of(const struct probe *probe, uint32_t index)
{
    whit_instance_info instance = {0};
    if (index != WHIT_NONE)
        whit_scene_get_instance(probe->job.scene, index, &instance);
    return instance;
}

static whit_light_info light_of(const struct probe *probe, uint32_t index)
{
    whit_light_info light = {0};
    if (index != WHIT_NONE)
        whit_scene_get_light(probe->job.scene, index, &light);
    return light;
}

/* Counts the traced rays of a kind. Rays that go straight on through a surface have the kind of
   their parent. */
static uint32_t count_kind(const whit_probe_report *report, whit_ray_kind kind)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < report->ray_count; ++i)
        count += report->rays[i].kind == kind && was_traced(&report->rays[i]);
    return count;
}

/* ---- What --shader adds, as text ---- */

/* Figures that the report lacks when a user's file has taken the place of whit's functions. */
static const char own_rays[] = "rays that its functions trace, as by visible() and trace()";
static const char shape[] =
    "the shape of intersect() in twin and exact: of rays that meet it they say "
    "whether something is before it";
static const char before_post[] = "the share of post() in the colour";

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

/* Prints nothing without --shader. */
static void print_shader(const struct probe *probe)
{
    const whit_shader_info info = job_shader_info(probe->job.shader);
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

static void print_calls(const whit_probe_report *report)
{
    for (uint32_t i = 0; i < report->call_count; ++i)
        print_call(&report->calls[i]);
    if (report->call_count)
        putchar('\n');
}

/* ---- Text ---- */

enum { TEXT_MAX = 96 };

static void put_vector(const char *name, const float v[3])
{
    printf("%-11s%.9g %.9g %.9g\n", name, (double)v[0], (double)v[1], (double)v[2]);
}

static void print_first(const struct probe *probe)
{
    const whit_probe_ray *first = &probe->report->rays[0];
    const whit_material_info material = material_of(probe, first->material);
    if (!has_met(&first->device)) {
        printf("instance   none: the environment\n");
        return;
    }
    printf("instance   %u %s\n", first->device.instance,
           cli_shown(instance_of(probe, first->device.instance).name));
    printf("primitive  %u\nmaterial   %u %s", first->device.primitive, first->material,
           cli_shown(material.name));
    if (material.file)
        printf(", %s:%u", cli_shown(material.file), material.line);
    printf("\n");
    put_vector("position", first->point);
    put_vector("normal", first->normal);
    printf("depth      %.9g\n", first->device.t);
}

static void print_why(const struct probe *probe)
{
    char why[WHIT_PROBE_WHY_BYTES];
    whit_probe_why(probe->report, probe->job.scene, why, sizeof why);
    if (why[0])
        printf("why        %s\n", cli_shown(why));
}

static void print_head(const struct probe *probe)
{
    const whit_probe_report *report = probe->report;
    const whit_renderer_params *picture = &probe->job.settings.picture;
    const float *c = report->color;
    printf("pixel      %u,%u of %u x %u, %u sample%s, %s\n", report->x, report->y, picture->width,
           picture->height, report->samples, report->samples == 1 ? "" : "s",
           value_word(values_numerics, (int)probe->job.settings.picture.numerics));
    printf("colour     %.9g %.9g %.9g linear, #%02x%02x%02x as shown\n", (double)c[0], (double)c[1],
           (double)c[2], report->shown[0], report->shown[1], report->shown[2]);
    print_first(probe);
    print_why(probe);
    uint32_t traced = 0, exact = 0, exact_other = 0;
    printf("rays       ");
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind) {
        uint32_t count = count_kind(report, (whit_ray_kind)kind);
        printf("%u %s, ", count, value_word(values_rays, (int)kind));
        traced += count;
    }
    for (uint32_t i = 0; i < report->ray_count; ++i) {
        exact += report->rays[i].exact_known;
        exact_other += report->rays[i].exact_known && !report->rays[i].exact_equal;
    }
    printf("%u not traced, %u not recorded\n", report->ray_count - traced, report->dropped);
    printf("twin       differs in %u of %u\n", report->differing, traced);
    printf("exact      differs in %u of %u\n", exact_other, exact);
    print_shader(probe);
    putchar('\n');
}

static void ray_text(const struct probe *probe, const whit_probe_ray *ray, uint32_t count,
                     char text[TEXT_MAX])
{
    int indent = (int)(ray->generation < 20 ? ray->generation : 20) * 2;
    char name[34];
    if (ray->kind == WHIT_RAY_SHADOW)
        whit_text_show(light_of(probe, ray->light).name, name, sizeof name);
    if (count > 1)
        snprintf(text, TEXT_MAX, "%*s%u shadow, %s", indent, "", count, name);
    else if (ray->kind == WHIT_RAY_SHADOW)
        snprintf(text, TEXT_MAX, "%*sshadow, %s, point %u", indent, "", name, ray->light_sample);
    else
        snprintf(text, TEXT_MAX, "%*s%s%s", indent, "", value_word(values_rays, (int)ray->kind),
                 ray->straight ? ", straight on" : "");
}

static void hit_text(const whit_probe_hit *hit, char text[TEXT_MAX])
{
    if (has_met(hit))
        snprintf(text, TEXT_MAX, "%.9g at %u/%u", hit->t, hit->instance, hit->primitive);
    else
        snprintf(text, TEXT_MAX, "nothing");
}

static void end_text(const whit_probe_ray *ray, uint32_t count, char text[TEXT_MAX])
{
    const char *name = whit_probe_end_name(ray->end), *all = count > 1 ? "all " : "";
    if (ray->passed)
        snprintf(text, TEXT_MAX, "%s%s, passed %u", all, name, ray->passed);
    else
        snprintf(text, TEXT_MAX, "%s%s", all, name);
}

/* The columns of the table of rays. */
enum { COLUMN_RAY, COLUMN_END, COLUMN_DEVICE, COLUMN_TWIN, COLUMN_EXACT, COLUMNS };

static void cell_text(const struct probe *probe, const whit_probe_row *row, int column,
                      char text[TEXT_MAX])
{
    const whit_probe_ray *ray = &probe->report->rays[row->ray];
    bool equal = column == COLUMN_TWIN ? ray->equal : ray->exact_equal;
    const whit_probe_hit *hit = column == COLUMN_TWIN ? &ray->twin : &ray->exact;
    snprintf(text, TEXT_MAX, "-");
    if (column == COLUMN_RAY)
        ray_text(probe, ray, row->count, text);
    else if (column == COLUMN_END)
        end_text(ray, row->count, text);
    else if (!was_traced(ray) || (column == COLUMN_EXACT && !ray->exact_known))
        return;
    else if (column == COLUMN_DEVICE)
        hit_text(&ray->device, text);
    else if (equal && (column == COLUMN_TWIN || (float)hit->t == (float)ray->device.t ||
                       ray->kind == WHIT_RAY_SHADOW))
        snprintf(text, TEXT_MAX, "=");
    else
        hit_text(hit, text);
}

static void print_row_end(const struct probe *probe, const whit_probe_row *row)
{
    const whit_probe_ray *ray = &probe->report->rays[row->ray];
    const float *added = row->added;
    printf("%.4g %.4g %.4g", (double)ray->weight[0], (double)ray->weight[1],
           (double)ray->weight[2]);
    printf("  %.4g %.4g %.4g", (double)added[0], (double)added[1], (double)added[2]);
    if (ray->material != WHIT_NONE)
        printf("  %s, %s%s", cli_shown(instance_of(probe, ray->device.instance).name),
               cli_shown(material_of(probe, ray->material).name),
               ray->inside ? " from inside" : "");
    if (ray->medium != WHIT_NONE)
        printf(" (through %s, ior %g)", cli_shown(material_of(probe, ray->medium).name),
               (double)ray->ior);
    putchar('\n');
}

static void print_rows(const struct probe *probe, const whit_probe_row *rows, uint32_t count)
{
    static const char *const heads[COLUMNS] = {"ray", "ended", "device: t at instance/primitive",
                                               "twin", "exact"};
    char text[TEXT_MAX];
    int widths[COLUMNS];
    for (int c = 0; c < COLUMNS; ++c) {
        size_t width = strlen(heads[c]);
        for (uint32_t i = 0; i < count; ++i) {
            cell_text(probe, &rows[i], c, text);
            width = strlen(text) > width ? strlen(text) : width;
        }
        widths[c] = (int)width;
        printf("%-*s  ", widths[c], heads[c]);
    }
    printf("weight, added, what it met\n");
    for (uint32_t i = 0; i < count; ++i) {
        for (int c = 0; c < COLUMNS; ++c) {
            cell_text(probe, &rows[i], c, text);
            printf("%-*s  ", widths[c], text);
        }
        print_row_end(probe, &rows[i]);
    }
}

int probe_print(const struct probe *probe)
{
    whit_probe_row *rows;
    uint32_t count;
    if (whit_probe_rows(probe->report, &rows, &count) != WHIT_OK)
        return CLI_FAIL(EXIT_USAGE, "out of memory");
    print_head(probe);
    print_calls(probe->report);
    print_rows(probe, rows, count);
    whit_memory_destroy(rows);
    return cli_finish_stdout(EXIT_FINE);
}

/* ---- JSON ---- */

static void put_names(json_t *out, const char *const *names, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i)
        document_append(out, json_string(names[i]));
}

/* null without --shader. */
static json_t *shader_document(const struct probe *probe)
{
    const whit_shader_info info = job_shader_info(probe->job.shader);
    const char *names[WHIT_HOOKS], *missing[MISSING_MAX];
    if (info.hooks == 0)
        return json_null();
    json_t *out = document_object();
    document_text(out, "file", info.files[0]);
    put_names(document_list(out, "functions"), names, job_functions(&info, names));
    put_names(document_list(out, "missing"), missing, list_missing(&info, missing));
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

static void put_calls(json_t *out, const whit_probe_report *report)
{
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
}

static void put_index(json_t *object, const char *key, uint32_t index)
{
    if (index == WHIT_NONE)
        document_text(object, key, NULL);
    else
        document_count(object, key, index);
}

static json_t *hit_document(const whit_probe_hit *hit, bool known)
{
    if (!known)
        return json_null();
    json_t *out = document_object();
    document_number(out, "t", hit->t);
    put_index(out, "instance", hit->instance);
    put_index(out, "primitive", hit->primitive);
    return out;
}

static json_t *material_document(const struct probe *probe, uint32_t index)
{
    if (index == WHIT_NONE)
        return json_null();
    whit_material_info material = material_of(probe, index);
    json_t *out = document_object();
    document_count(out, "index", index);
    document_text(out, "name", material.name);
    document_text(out, "file", material.file);
    document_count(out, "line", material.line);
    return out;
}

static void put_surface(const struct probe *probe, const whit_probe_ray *ray, json_t *out)
{
    bool met = ray->material != WHIT_NONE;
    put_index(out, "instance", ray->device.instance);
    document_text(out, "instance_name", instance_of(probe, ray->device.instance).name);
    put_index(out, "primitive", ray->device.primitive);
    document_put(out, "material", material_document(probe, ray->material));
    document_floats(out, "position", ray->point, met ? 3 : 0);
    document_floats(out, "normal", ray->normal, met ? 3 : 0);
    document_flag(out, "inside", ray->inside);
}

static void put_ray(json_t *out, const struct probe *probe, const whit_probe_ray *ray)
{
    bool traced = was_traced(ray);
    document_text(out, "kind", value_word(values_rays, (int)ray->kind));
    document_flag(out, "straight", ray->straight);
    document_text(out, "end", whit_probe_end_name(ray->end));
    put_index(out, "parent", ray->parent);
    document_count(out, "generation", ray->generation);
    document_floats(out, "origin", ray->ray.origin, 3);
    document_floats(out, "direction", ray->ray.dir, 3);
    document_floats(out, "weight", ray->weight, 3);
    document_floats(out, "added", ray->added, 3);
    document_put(out, "device", hit_document(&ray->device, traced));
    document_put(out, "twin", hit_document(&ray->twin, traced));
    document_put(out, "exact", hit_document(&ray->exact, ray->exact_known));
    document_flag(out, "twin_equal", ray->equal);
    document_flag(out, "exact_equal", ray->exact_equal);
    document_count(out, "passed", ray->passed);
    put_surface(probe, ray, out);
    document_put(out, "medium", material_document(probe, ray->medium));
    document_float(out, "ior", ray->ior);
    put_index(out, "light", ray->light);
    document_text(out, "light_name", light_of(probe, ray->light).name);
    put_index(out, "light_sample", ray->light_sample);
}

static void put_pixel(json_t *out, const struct probe *probe)
{
    const whit_probe_report *report = probe->report;
    const whit_probe_ray *first = &report->rays[0];
    char shown[8];
    snprintf(shown, sizeof shown, "#%02x%02x%02x", report->shown[0], report->shown[1],
             report->shown[2]);
    document_count(out, "x", report->x);
    document_count(out, "y", report->y);
    document_floats(out, "color", report->color, 3);
    document_text(out, "shown", shown);
    put_surface(probe, first, out);
    document_number(out, "depth", first->device.t);
}

whit_result probe_save_json(const struct probe *probe)
{
    const whit_probe_report *report = probe->report;
    json_t *out = document_root();
    whit_device_info device;
    whit_device_get_info(probe->job.device, &device);
    document_text(out, "scene", probe->job.settings.scene);
    document_text(out, "device", device.name);
    document_text(out, "driver", device.driver);
    settings_describe(&probe->job.settings, IN_PROBE, document_child(out, "picture"));
    put_pixel(document_child(out, "pixel"), probe);
    document_put(out, "shader", shader_document(probe));
    put_calls(document_list(out, "dbg"), report);
    document_count(out, "differing", report->differing);
    document_count(out, "dropped", report->dropped);
    json_t *rays = document_list(out, "rays");
    for (uint32_t i = 0; i < report->ray_count; ++i)
        put_ray(document_entry(rays), probe, &report->rays[i]);
    return document_save(out, probe->json_path);
}
