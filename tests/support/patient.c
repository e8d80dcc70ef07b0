/* Preloaded into MPI ranks: a rank that waits long sleeps. On a busy machine sched_yield gives the rest of a slice away
   at each question, and a rank that asks without end takes a core from those that work; one that wakes from sleep is
   served before programs that never pause. Needs mpi_yield_when_idle = 1 (Open MPI). */
#define _GNU_SOURCE
#include <sched.h>
#include <time.h>

enum { SAME_WAIT = 20000, SPIN = 150000, PAUSE = 50000 }; /* ns: between questions of one wait, without sleep, asleep */

static long long now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1000000000LL + t.tv_nsec;
}

int sched_yield(void) {
  static _Thread_local long long start, last;
  const struct timespec pause = {0, PAUSE};
  const long long time = now();
  if (time - last > SAME_WAIT) start = time;
  if (time - start > SPIN) nanosleep(&pause, 0);
  last = now();
  return 0;
}
