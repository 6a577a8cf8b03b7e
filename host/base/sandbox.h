/* A sandbox: the process gives up everything that it no longer needs; for children that run foreign
   code. */
#ifndef BASE_SANDBOX_H
#define BASE_SANDBOX_H

/* The descriptors of a process in the sandbox: 0 to 2 are /dev/null, SANDBOX_REPLY_FD is a pipe. */
enum { SANDBOX_REPLY_FD = 3, SANDBOX_FD_COUNT };

/* From here on this process may only compute, allocate and write to SANDBOX_REPLY_FD; any other
   system call, such as to open, connect, start or signal anything, kills it by SIGSYS. It keeps
   only the four descriptors above. Returns 0, or why the filter of calls could not be set (errno);
   it has then given up all that needs no filter. For processes of one thread; a debugger defeats
   it. */
int sandbox_enter(void);
/* Closes all descriptors from this number on. */
void sandbox_close_from(int first);

#endif
