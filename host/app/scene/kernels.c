/* `whit scene --kernels`: the kernels of a picture, and what the device's driver tells of them. */
#include "app/document.h"
#include "app/render/stats.h"
#include "app/scene/listing.h"
#include "app/settings_json.h"

enum { LINE_WIDTH = 100 };

static void print_kernel(const whit_kernel *kernel)
{
    int used = 0;
    printf("  %s%s\n      %u instructions, %.1f ms to make", kernel->name,
           kernel->deferred ? ", deferred rays" : "", kernel->instructions, kernel->create_ms);
    for (uint32_t i = 0; i < kernel->statistic_count; ++i) {
        char text[192];
        int length = snprintf(text, sizeof text, "%s %.10g", cli_shown(kernel->statistics[i].name),
                              kernel->statistics[i].value);
        bool wraps = i == 0 || used + length > LINE_WIDTH;
        printf("%s%s", wraps ? "\n      " : ", ", text);
        used = wraps ? length : used + length + 2;
    }
    putchar('\n');
}

static int print_text(const struct job *job, const whit_kernel *kernels, uint32_t count)
{
    uint32_t told = 0;
    puts(cli_shown(job->settings.scene));
    stats_print_device("  device    ", job->device);
    putchar('\n');
    for (uint32_t i = 0; i < count; ++i) {
        print_kernel(&kernels[i]);
        told += kernels[i].statistic_count;
    }
    if (told == 0)
        puts("\n  The driver tells nothing of its kernels: it has no "
             "VK_KHR_pipeline_executable_properties.");
    return cli_finish_stdout(EXIT_FINE);
}

static void put_kernel(json_t *object, const whit_kernel *kernel)
{
    document_text(object, "name", kernel->name);
    document_flag(object, "deferred", kernel->deferred);
    document_count(object, "instructions", kernel->instructions);
    document_ms(object, "create_ms", kernel->create_ms);
    json_t *told = document_child(object, "driver");
    for (uint32_t i = 0; i < kernel->statistic_count; ++i)
        document_number(told, kernel->statistics[i].name, kernel->statistics[i].value);
}

static int print_json(const struct job *job, const whit_kernel *kernels, uint32_t count)
{
    whit_device_info info;
    whit_device_get_info(job->device, &info);
    json_t *root = document_root(), *device = document_device(&info);
    document_text(root, "file", job->settings.scene);
    document_count(device, "subgroup_size", info.subgroup_size);
    document_put(root, "device", device);
    settings_describe(&job->settings, IN_SCENE, document_child(root, "picture"));
    json_t *list = document_list(root, "kernels");
    for (uint32_t i = 0; i < count; ++i)
        put_kernel(document_entry(list), &kernels[i]);
    return cli_print_json(root);
}

int kernels_run(struct job *job, bool json)
{
    static whit_kernel kernels[WHIT_KERNELS_MAX];
    uint32_t count = 0;
    whit_result result = job_build(job);
    if (result == WHIT_OK)
        result = job_open_device(job);
    if (result == WHIT_OK) {
        whit_renderer_params params = job_picture(job);
        params.color_only = true; /* as `whit render` */
        result = whit_kernels_list(job->device, job->accel, &params, true, kernels, &count);
    }
    if (result != WHIT_OK)
        return cli_exit_of(result);
    int status = json ? print_json(job, kernels, count) : print_text(job, kernels, count);
    return status == EXIT_FINE ? job_check_validation(job) : status;
}
