/* Calls an S-function as Simulink does, with the PD controller of the example hosts as the rest of the diagram.
 * PROGRAM SYSTEM.toml OUTPUTS: angle and rate come first among the outputs. */
#include <stdio.h>

static int fail(const SimStruct *S) {
  fprintf(stderr, "%s\n", S->error);
  return 1;
}

int main(int argc, char **argv) {
  static SimStruct block;
  SimStruct *S = &block;
  const mxArray file = {argc > 1 ? argv[1] : "system.toml", 0}, outputs = {argc > 2 ? argv[2] : "angle rate", 0};
  const mxArray sample_time = {NULL, 0.001};
  real_T command = 0;
  S->num_parameters = 3;
  S->parameters[0] = &file;
  S->parameters[1] = &outputs;
  S->parameters[2] = &sample_time;
  mdlInitializeSizes(S);
  if (S->error) return fail(S);
  if (S->input_width != 1 || S->output_width != 2 || S->has_feedthrough || S->num_pwork != 1) return 2;
  S->u[0] = &command;
  mdlInitializeSampleTimes(S);
  mdlStart(S);
  for (int k = 0; k <= 1000 && !S->error && !S->is_stop_requested; ++k) {
    S->time = k * S->sample_time;
    mdlOutputs(S, 0);
    if (k % 200 == 0) printf("%6.3f%15.10f%15.10f\n", S->time, S->y[0], S->y[1]);
    command = 60.0 * (0.5 - S->y[0]) - 12.0 * S->y[1];
    mdlUpdate(S, 0);
  }
  mdlTerminate(S);
  return S->error ? fail(S) : S->is_stop_requested ? 3 : 0;
}
