/* Steps an arm from outside: a PD controller at 1 kHz. host_c [SYSTEM.toml] */
#include <bough.h>
#include <stdio.h>

int main(int argc, char **argv) {
  const char *file = argc > 1 ? argv[1] : "system.toml";
  bough_model *model = NULL;
  bough_simulation *simulation = NULL;
  static bough_message message;
  if (bough_abi_version() != BOUGH_ABI_VERSION) {
    fprintf(stderr, "libbough.so has another ABI version than bough.h: build this program again\n");
    return 1;
  }
  if (bough_load(file, NULL, &model, &message) != BOUGH_OK ||
      bough_start(model, NULL, &simulation, &message) != BOUGH_OK) {
    fprintf(stderr, "%s\n", message.text);
    return 1;
  }
  const int torque = bough_find(model, BOUGH_INPUTS, "torque");
  const int angle = bough_find(model, BOUGH_OUTPUTS, "angle"), rate = bough_find(model, BOUGH_OUTPUTS, "rate");
  bough_status status = BOUGH_OK;
  for (int k = 0; k <= 1000 && status == BOUGH_OK; ++k) {
    double phi, omega;
    bough_get_outputs(simulation, angle, 1, &phi);
    bough_get_outputs(simulation, rate, 1, &omega);
    if (k % 200 == 0) printf("%6.3f%15.10f%15.10f\n", bough_time(simulation), phi, omega);
    const double command = 60.0 * (0.5 - phi) - 12.0 * omega;
    bough_set_inputs(simulation, torque, 1, &command);
    status = bough_advance(simulation, 0.001 * (k + 1), NULL);
  }
  if (status != BOUGH_OK) fprintf(stderr, "%s\n", bough_last_message(simulation));
  bough_stop(simulation);
  bough_unload(model);
  return status;
}
