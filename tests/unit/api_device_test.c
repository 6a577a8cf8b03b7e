/* Devices that another thread opens, through the public header. */
#include <pthread.h>

#include "unit.h"
#include "whit.h"
#include "whit_program.h"

struct heard {
    pthread_t thread; /* that may log */
    bool may_log;
    uint32_t count, errors;
    char text[512]; /* of the first */
};

static void hear(void *user, whit_log_level level, const char *text)
{
    struct heard *heard = user;
    assert_true(heard->may_log);
    assert_true(pthread_equal(heard->thread, pthread_self()));
    if (heard->count++ == 0)
        snprintf(heard->text, sizeof heard->text, "%s", text);
    heard->errors += level == WHIT_LOG_ERROR;
}

static whit_log log_of(struct heard *heard)
{
    *heard = (struct heard){.thread = pthread_self()};
    return (whit_log){.fn = hear, .user = heard, .level = WHIT_LOG_DEBUG};
}

static whit_device_opening *begin(const whit_device_params *params, const whit_log *log)
{
    whit_device_opening *opening = whit_device_open_begin(params, log);
    assert_non_null(opening);
    return opening;
}

TEST(gives_the_device_that_create_gives)
{
    struct heard heard;
    whit_log log = log_of(&heard);
    whit_device *device = NULL, *other = NULL;
    whit_device_info info, other_info;
    whit_device_opening *opening = begin(NULL, &log);
    heard.may_log = true;
    assert_int_equal(whit_device_open_end(opening, &device), WHIT_OK);
    uint32_t at_opening = heard.count;
    assert_int_equal(heard.errors, 0);
    assert_int_equal(whit_device_create(NULL, &log, &other), WHIT_OK);
    assert_int_equal(heard.count, 2 * at_opening);
    memset(&info, 0, sizeof info);
    memset(&other_info, 0, sizeof other_info);
    whit_device_get_info(device, &info);
    whit_device_get_info(other, &other_info);
    assert_string_equal(info.name, other_info.name);
    assert_string_equal(info.driver, other_info.driver);
    whit_device_destroy(other);
    whit_device_destroy(device);
}

TEST(failures_are_said_at_the_end_and_once)
{
    struct heard heard, other;
    whit_log log = log_of(&heard), other_log = log_of(&other);
    whit_device *device = NULL;
    const whit_device_params params = {.selector = "no such device"};
    whit_device_opening *opening = begin(&params, &log);
    heard.may_log = other.may_log = true;
    assert_int_equal(whit_device_open_end(opening, &device), WHIT_ERROR_NO_DEVICE);
    assert_null(device);
    assert_int_equal(whit_device_create(&params, &other_log, &device), WHIT_ERROR_NO_DEVICE);
    assert_int_equal(heard.errors, 1);
    assert_int_equal(heard.count, other.count);
    assert_string_equal(heard.text, other.text);
}

TEST(nothing_is_said_when_abandoned)
{
    const whit_device_params wrong = {.selector = "no such device"};
    struct heard heard;
    whit_log log = log_of(&heard);
    whit_device_open_abandon(begin(&wrong, &log));
    whit_device_open_abandon(begin(NULL, &log));
    whit_device_open_abandon(NULL);
    assert_int_equal(heard.count, 0);
}
