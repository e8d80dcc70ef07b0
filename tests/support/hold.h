/* Stops a process at a point that a test chooses, until a signal has been handled: no test waits for a time. */
#ifndef BOUGH_TESTS_HOLD_H
#define BOUGH_TESTS_HOLD_H
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

/* Writes "PID\n" into the pipe and sleeps. A signal that comes between the two is not missed. */
static void hold(const char* pipe) {
  sigset_t all, before;
  char line[32];
  int to;
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, &before);
  to = open(pipe, O_WRONLY);
  snprintf(line, sizeof line, "%d\n", (int)getpid());
  if (to >= 0) {
    if (write(to, line, strlen(line)) < 0) perror(pipe);
    close(to);
  }
  sigsuspend(&before);
  sigprocmask(SIG_SETMASK, &before, NULL);
}
#endif
