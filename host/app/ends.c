/* Ends that the program has no say in: nobody reads its output, or a driver or a library crashes
   because it got no memory. */
#include <signal.h>
#include <stdalign.h>
#include <stdio.h>
#include <unistd.h>

#include "app/cli.h"
#include "whit/whit_program.h"

enum { STACK_BYTES = 64 << 10 };
static const int crashes[] = {SIGSEGV, SIGBUS, SIGABRT};
enum { CRASH_COUNT = sizeof crashes / sizeof crashes[0] };
/* More than a library asks for at a time, and too little to go on with. */
#define CRASH_ROOM_BYTES ((uint64_t)16 << 20)
static struct sigaction before[CRASH_COUNT];

static void on_pipe(int number)
{
    whit_file_abandon_all();
    signal(number, SIG_DFL);
    raise(number); /* delivered when the handler returns */
}

static void on_crash(int number, siginfo_t *info, void *context)
{
    (void)context;
    const char *lacks = whit_shortage(CRASH_ROOM_BYTES);
    if (lacks) {
        whit_file_abandon_all();
        cli_put_end("whit: error: ", lacks);
        cli_leave(EXIT_USAGE);
    }
    /* It comes again when the handler returns, unless it was sent. */
    for (int i = 0; i < CRASH_COUNT; ++i)
        if (crashes[i] == number)
            sigaction(number, &before[i], NULL);
    if (info->si_code <= 0)
        raise(number);
}

void cli_catch_ends(void)
{
    /* The first thread's own may be what cannot grow. */
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
        sigaction(SIGPIPE, &action, NULL); /* else it is an error of writing */
}
