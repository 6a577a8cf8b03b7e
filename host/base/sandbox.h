/* A process that has everything it will ever need, and gives the rest up: for children that run
   foreign code. */
#ifndef BASE_SANDBOX_H
#define BASE_SANDBOX_H

/* The descriptors of a process in the sandbox: 0 to 2 lead nowhere, and this is a pipe. */
enum { SANDBOX_REPLY_FD = 3, SANDBOX_FD_COUNT };

/* From here on, for ever, this process may compute, allocate and write to SANDBOX_REPLY_FD; any
   other call of the system, such as to open, connect, start or signal anything, kills it by SIGSYS.
   It keeps no descriptor but the four above. 0, or why the filter of calls could not be set
   (errno); what could be given up without the filter is. One thread; of no use under a debugger. */
int sandbox_enter(void);

#endif
