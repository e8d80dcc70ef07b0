/* A controller that computes in its instance: y = u1, by way of numbers kept there for a while. */
#include <stdlib.h>

#include "bough_controller.h"

enum { SIZE = 64, ROUNDS = 200 };

int bough_controller_version(void) { return BOUGH_CONTROLLER_VERSION; }

int bough_controller_open(struct bough_controller* c) {
  c->instance = calloc(SIZE, sizeof(double));
  return c->instance == NULL;
}

int bough_controller_outputs(void* instance, double t, const double* u, const double* z, const double* d, double* y) {
  volatile double* own = instance;
  int round, i;
  (void)t, (void)z, (void)d;
  for (i = 0; i < SIZE; ++i) own[i] = u[0];
  for (round = 0; round < ROUNDS; ++round)
    for (i = 0; i + 1 < SIZE; ++i) own[i] = 0.5 * (own[i] + own[i + 1]);
  y[0] = own[0];
  return 0;
}

void bough_controller_close(void* instance) { free(instance); }
