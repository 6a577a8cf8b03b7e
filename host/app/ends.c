/* Handles two ways in which the process is ended from outside: nobody reads its output any more
   (SIGPIPE), or a driver or a library crashes because it got no memory. */
#include <signal.h>
#include <stdalign.h>
#include <stdio.h>
#include <unistd.h>

#include "app/cli.h"
#include "base/file.h"
#include "whit/whit_program.h"

enum { STACK_BYTES = 64 << 10 };
static const int crashes[] = {SIGSEGV, SIGBUS, SIGABRT};
enum { CRASH_COUNT = sizeof crashes / sizeof crashes[0] };
/* A crash counts as caused by lack of memory if this much cannot be allocated when it happens. The
   usual allocations of libraries are smaller, and whit could not go on with less. */
#define CRASH_ROOM_BYTES ((uint64_t)16 << 20)
static struct sigaction before[CRASH_COUNT];

static void on_pipe(int number)
{
    file_abandon_all();
    signal(number, SIG_DFL);
    raise(number); /* delivered when the handler returns */
}

static void on_crash(int number, siginfo_t *info, void *context)
{
    (void)context;
    const char *lacks = whit_shortage(CRASH_ROOM_BYTES);
    if (lacks) {
        file_abandon_all();
        cli_put_end("whit: error: ", lacks);
        cli_leave(EXIT_USAGE);
    }
    /* A fault raises the signal again when the handler returns; one that was sent by kill() must be
       raised again here. */
    for (int i = 0; i < CRASH_COUNT; ++i)
        if (crashes[i] == number)
            sigaction(number, &before[i], NULL);
    if (info->si_code <= 0)
        raise(number);
}

void cli_catch_ends(void)
{
    /* Handlers run on a stack of their own, as the crash may be that the first thread's stack
       cannot grow. */
    static alignas(max_align_t) char memory[STACK_BYTES];
    const stack_t stack = {.ss_sp = memory, .ss_size = sizeof memory};
    struct sigaction action = {.sa_sigaction = on_crash, .sa_flags = SA_ONSTACK | SA_SIGINFO};
    sigemptyset(&action.sa_mask);
    sigaltstack(&stack, NULL);
    for (int i = 0; i < CRASH_COUNT; ++i)
        sigaction(crashes[i], &action, &before[i]);
    action = (struct sigaction){.sa_handler = on_pipe};
    struct sigaction pipe_before;
    if (sigaction(SIGPIPE, NULL, &pipe_before) == 0 && pipe_before.sa_handler != SIG_IGN)
        sigaction(SIGPIPE, &action, NULL); /* where SIGPIPE is ignored, writing to a closed pipe
                                              gives an error instead */
}
