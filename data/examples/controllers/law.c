/* y = -k u1 - c z, tau z' = u2 - z: a law of the angle and the lagged rate. parameters = [k, c, tau]
 *     cc -shared -fPIC -I include law.c -o liblaw.so */
#include <stdlib.h>

#include "bough_controller.h"

struct law {
  double k, c, tau;
};

int bough_controller_version(void) { return BOUGH_CONTROLLER_VERSION; }

int bough_controller_open(struct bough_controller* controller) {
  struct law* law;
  if (controller->inputs != 2 || controller->num_parameters != 3) return 1;
  law = malloc(sizeof *law);
  if (law == NULL) return 2;
  law->k = controller->parameters[0];
  law->c = controller->parameters[1];
  law->tau = controller->parameters[2];
  controller->outputs = 1;
  controller->states = 1;
  controller->instance = law;
  return 0;
}

int bough_controller_outputs(void* instance, double t, const double* u, const double* z, const double* d, double* y) {
  const struct law* law = instance;
  (void)t, (void)d;
  y[0] = -law->k * u[0] - law->c * z[0];
  return 0;
}

int bough_controller_derivatives(void* instance, double t, const double* u, const double* z, const double* d,
                                 double* z_dot) {
  const struct law* law = instance;
  (void)t, (void)d;
  z_dot[0] = (u[1] - z[0]) / law->tau;
  return 0;
}

void bough_controller_close(void* instance) { free(instance); }
