// The law of law.c in C++. An exception ends the run with the name of the controller and the time.
//     c++ -shared -fPIC -I include law.cpp -o liblaw.so
#include <stdexcept>

#include "bough_controller.h"

namespace {
struct Law {
  double k, c, tau;
};
}  // namespace

extern "C" {

int bough_controller_version() { return BOUGH_CONTROLLER_VERSION; }

int bough_controller_open(bough_controller* controller) {
  if (controller->inputs != 2 || controller->num_parameters != 3) return 1;
  const double* p = controller->parameters;
  controller->states = 1;
  controller->instance = new Law{p[0], p[1], p[2]};
  return 0;
}

int bough_controller_outputs(void* instance, double, const double* u, const double* z, const double*, double* y) {
  const Law& law = *static_cast<Law*>(instance);
  if (u[0] > 1) throw std::runtime_error("the angle is beyond this law");
  y[0] = -law.k * u[0] - law.c * z[0];
  return 0;
}

int bough_controller_derivatives(void* instance, double, const double* u, const double* z, const double*,
                                 double* z_dot) {
  z_dot[0] = (u[1] - z[0]) / static_cast<Law*>(instance)->tau;
  return 0;
}

void bough_controller_close(void* instance) { delete static_cast<Law*>(instance); }
}
