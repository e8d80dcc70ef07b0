/* Preloaded into MPI ranks: a rank that waits sleeps instead of asking again at once. On a busy machine sched_yield gives
   the rest of a slice away at each question; a rank that wakes from sleep is served before programs that never pause.
   The pause begins at 10 µs and doubles up to 0.5 ms while nothing comes. Needs mpi_yield_when_idle = 1 (Open MPI). */
#define _GNU_SOURCE
#include <sched.h>
#include <time.h>

enum { FIRST_PAUSE = 10000, MAX_PAUSE = 500000, SAME_WAIT = 20000 }; /* ns */

static long long now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1000000000LL + t.tv_nsec;
}

int sched_yield(void) {
  static _Thread_local long long end, pause;
  pause = now() - end > SAME_WAIT ? FIRST_PAUSE : pause < MAX_PAUSE ? 2 * pause : pause;
  const struct timespec sleep = {0, pause};
  nanosleep(&sleep, 0);
  end = now();
  return 0;
}
