/* A user library that fails where a test says. parameters = [place, act, time]: at `place`, from `time` on, does `act`
   (IN_SIZES: sets outputs, states or memory, act 1 to 3, to 2e9). ASTRAY_LOADING=ACT: while it is loaded. ASTRAY=0: does
   nothing. Its output is its first input. */
#define _GNU_SOURCE
#include <stdlib.h>
#include <stdint.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include "bough_controller.h"
#include "hold.h"

enum place { IN_OPEN = 1, IN_START, IN_OUTPUTS, IN_CLOSE, IN_SIZES };
enum act { EXIT = 1, EXIT_AT_ONCE, QUICK_EXIT, ABORT, WRITE_NOWHERE, DIVIDE, OVERFLOW, HOLD, LOOP, FORK };

static volatile int goes_on = 1;
static int overflow(volatile char* before) {
  volatile char room[4096];
  room[0] = before ? before[0] : 1;
  return goes_on ? overflow(room) + room[0] : 0;
}

static void go_astray(int act) {
  static int is_held = 0;
  volatile int zero = 0;
  const char* pipe = getenv("ASTRAY_PIPE");
  switch (act) {
    case EXIT: exit(0);
    case EXIT_AT_ONCE: _exit(0);
    case QUICK_EXIT: quick_exit(0);
    case ABORT: abort();
    case WRITE_NOWHERE: *(volatile int*)(uintptr_t)zero = 1; break;
    case DIVIDE: zero = 1000 / zero; break;
    case OVERFLOW: overflow(NULL); break;
    case HOLD:  /* once */
      if (pipe && !is_held) {
        is_held = 1;
        hold(pipe);
      }
      break;
    case LOOP: if (pipe) for (;;) hold(pipe); break;
    case FORK: {
      int status = 0;
      const pid_t child = fork();
      if (child == 0) _exit(7);
      waitpid(child, &status, 0);
      if (!WIFEXITED(status) || WEXITSTATUS(status) != 7) abort();
      break;
    }
    default: break;
  }
}

struct law {
  int place, act, inputs;
  double time;
};

static void reach(const struct law* law, int place, double t) {
  const char* is_on = getenv("ASTRAY");
  if (law->place == place && t >= law->time && !(is_on && is_on[0] == '0')) go_astray(law->act);
}

__attribute__((constructor)) static void load(void) {
  const char* act = getenv("ASTRAY_LOADING");
  if (act) go_astray(atoi(act));
}

int bough_controller_version(void) { return BOUGH_CONTROLLER_VERSION; }
int bough_controller_open(struct bough_controller* c) {
  struct law* law = calloc(1, sizeof *law);
  if (c->num_parameters != 3) return 1;
  law->place = (int)c->parameters[0];
  law->act = (int)c->parameters[1];
  law->time = c->parameters[2];
  law->inputs = c->inputs;
  c->instance = law;
  if (law->place == IN_SIZES) {
    c->outputs = law->act == 1 ? 2000000000 : 1;
    c->states = law->act == 2 ? 2000000000 : 0;
    c->memory = law->act == 3 ? 2000000000 : 0;
    return 0;
  }
  reach(law, IN_OPEN, law->time);
  return 0;
}
int bough_controller_start(void* instance, double* z, double* d) {
  (void)z, (void)d;
  reach(instance, IN_START, ((struct law*)instance)->time);
  return 0;
}
int bough_controller_outputs(void* instance, double t, const double* u, const double* z, const double* d, double* y) {
  (void)z, (void)d;
  reach(instance, IN_OUTPUTS, t);
  y[0] = u[0];
  return 0;
}
int bough_controller_derivatives(void* instance, double t, const double* u, const double* z, const double* d,
                                 double* z_dot) {
  (void)instance, (void)t, (void)u, (void)z, (void)d, (void)z_dot;
  return 0;
}
int bough_controller_update(void* instance, double t, const double* u, const double* z, const double* d, double* next) {
  (void)instance, (void)t, (void)u, (void)z, (void)d, (void)next;
  return 0;
}
void bough_controller_close(void* instance) {
  reach(instance, IN_CLOSE, ((struct law*)instance)->time);
  free(instance);
}
