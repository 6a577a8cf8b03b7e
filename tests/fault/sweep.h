/* A sweep, and what its parts know of it. */
#ifndef FAULT_SWEEP_H
#define FAULT_SWEEP_H

#include <signal.h>
#include <stddef.h>

#include "fault.h"

enum { OUTPUTS_MAX = 4, FAULTS_MAX = 8 };
/* The contents of outputs before a run. */
#define OLD_TEXT "old\n"

struct fault {
    const char *name;
    uint32_t calls, event; /* as of struct fault_shared */
    int code, then;
    int expect;      /* the exit code; not where it goes well nevertheless */
    const char *say; /* part of its message, if not what --say gives */
    bool at_once;    /* The program ends without giving back what it holds. */
};

struct content {
    char *data;
    size_t bytes;
};

struct sweep {
    struct fault_shared *shared;
    int shared_fd;
    const char *inject, *say;
    const char *outputs[OUTPUTS_MAX];
    struct content whole[OUTPUTS_MAX]; /* of the run without a fault */
    uint32_t output_count;
    bool same_stdout;      /* what is printed is an output too */
    bool pictures;         /* it prints states of the viewer: see judge_states */
    bool figures, reports; /* what it measures is other in each run: see is_whole */
    bool may_leak, validated;
    bool cold; /* Each run has a cache folder of its own, which is empty at first. */
    struct content printed;
    const struct fault *faults[FAULTS_MAX], *fault; /* fault: of this run */
    uint32_t fault_count;
    uint32_t max_runs, every, shown, max_submits, step_ms;
    char **command;
    uint32_t runs, fired, failed, fine, said, defects; /* said: fine, but a picture is missing */
    uint32_t kept;    /* reports of what was measured before the end */
    uint32_t left;    /* killed runs that left an unfinished file */
    uint32_t submits; /* the most that a run had after its event */
};

/* The signal that ends the program without a word; 0: it exits. */
static inline int deadly(const struct fault *fault)
{
    bool is_deadly = fault->code == SIGKILL || fault->code == SIGPIPE;
    return is_deadly && fault->event == FAULT_SIGNAL ? fault->code : 0;
}

static inline bool is_interrupt(const struct fault *fault)
{
    return fault->event == FAULT_SIGNAL && fault->code != SIGSEGV && !deadly(fault);
}

/* Ends it all: `what` went wrong, for the reason in errno. */
_Noreturn void sweep_stop(const char *what);
/* `data` is ended by 0, the caller's to free, and NULL where there is no such file. */
struct content sweep_read(const char *path);

#endif
