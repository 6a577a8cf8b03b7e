#include "app/check/lanes.h"

#include <pthread.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/threads.h"

/* A lane opens a device of its own, and loads scenes and makes kernels that another lane may have
   too. This only pays with at least CASES_A_LANE cases per lane. */
enum { LANES_MAX = 3, CASES_A_LANE = 8 };

enum case_state { CASE_FREE, CASE_TAKEN, CASE_DRAWN, CASE_LEFT };

struct lane {
    struct lanes *lanes;
    struct thread *thread;
    atomic_bool said; /* a message was suppressed since the case began */
};

struct lanes {
    struct check *check;
    lanes_draw *draw;
    pthread_mutex_t lock; /* guards all fields below */
    pthread_cond_t changed;
    enum case_state *states; /* per case of the suite */
    bool ends;
    struct lane lanes[LANES_MAX];
};

/* Takes the last case that is still free; false: there is none. */
static bool take_last(struct lanes *lanes, uint32_t *index)
{
    const struct check *check = lanes->check;
    pthread_mutex_lock(&lanes->lock);
    uint32_t i = lanes->ends ? 0 : check->suite.count;
    while (i > 0 && (!check->wanted[i - 1] || lanes->states[i - 1] != CASE_FREE))
        --i;
    if (i > 0)
        lanes->states[i - 1] = CASE_TAKEN;
    pthread_mutex_unlock(&lanes->lock);
    *index = i - 1;
    return i > 0;
}

static void give(struct lanes *lanes, uint32_t index, bool drawn)
{
    pthread_mutex_lock(&lanes->lock);
    lanes->states[index] = drawn ? CASE_DRAWN : CASE_LEFT;
    pthread_cond_broadcast(&lanes->changed);
    pthread_mutex_unlock(&lanes->lock);
}

static void draw_cases(void *context)
{
    struct lane *lane = context;
    struct lanes *lanes = lane->lanes;
    struct check *check = lanes->check;
    const whit_log log = cli_muted_log(&lane->said);
    struct studio studio;
    uint32_t index;
    cli_mute(&lane->said);
    whit_result opened = studio_open(&studio, GOLDEN_OF_DEVICE, &check->settings, &check->suite,
                                     check->wanted, &log);
    studio.backwards = true;
    while (opened == WHIT_OK && take_last(lanes, &index)) {
        struct check_result *result = &check->results[index];
        atomic_store(&lane->said, false);
        bool drawn = lanes->draw(check, &studio, index) == WHIT_OK && !atomic_load(&lane->said);
        if (!drawn) {
            verdict_finish(result);
            studio_forget(&studio);
        }
        give(lanes, index, drawn);
    }
    studio_close(&studio);
}

static uint32_t count_lanes(const struct check *check, const struct studio *first)
{
    uint32_t count = check->wanted_count / CASES_A_LANE, cores = threads_available();
    count = count < cores ? count : cores;
    /* With --base all cases are drawn by the first device, which also draws the old pictures. */
    if (!count || check->base || !first->job.device || !whit_device_takes_peers(first->job.device))
        return 0;
    return count - 1 < LANES_MAX ? count - 1 : LANES_MAX;
}

struct lanes *lanes_begin(struct check *check, const struct studio *first, lanes_draw *draw)
{
    uint32_t count = count_lanes(check, first);
    struct lanes *lanes = count ? calloc(1, sizeof *lanes) : NULL;
    if (!lanes)
        return NULL;
    lanes->states = array_alloc_zeroed(check->suite.count, sizeof *lanes->states);
    if (!lanes->states) {
        free(lanes);
        return NULL;
    }
    lanes->check = check;
    lanes->draw = draw;
    pthread_mutex_init(&lanes->lock, NULL);
    pthread_cond_init(&lanes->changed, NULL);
    for (uint32_t i = 0; i < count; ++i) {
        struct lane *lane = &lanes->lanes[i];
        lane->lanes = lanes;
        atomic_init(&lane->said, false);
        lane->thread = thread_start(draw_cases, lane);
    }
    return lanes;
}

bool lanes_have(struct lanes *lanes, uint32_t index)
{
    if (!lanes)
        return false;
    pthread_mutex_lock(&lanes->lock);
    enum case_state *state = &lanes->states[index];
    while (*state == CASE_TAKEN)
        pthread_cond_wait(&lanes->changed, &lanes->lock);
    bool drawn = *state == CASE_DRAWN;
    if (!drawn)
        *state = CASE_TAKEN;
    pthread_mutex_unlock(&lanes->lock);
    return drawn;
}

void lanes_end(struct lanes *lanes)
{
    if (!lanes)
        return;
    pthread_mutex_lock(&lanes->lock);
    lanes->ends = true;
    pthread_mutex_unlock(&lanes->lock);
    for (uint32_t i = 0; i < LANES_MAX; ++i)
        thread_join(lanes->lanes[i].thread);
    pthread_cond_destroy(&lanes->changed);
    pthread_mutex_destroy(&lanes->lock);
    free(lanes->states);
    free(lanes);
}
