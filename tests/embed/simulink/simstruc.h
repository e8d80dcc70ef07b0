/* The part of Simulink's SimStruct that sfun_bough.c uses, for tests without MATLAB. */
#ifndef BOUGH_TESTS_SIMSTRUC_H
#define BOUGH_TESTS_SIMSTRUC_H

#include <stddef.h>
#include <string.h>

typedef double real_T;
typedef int int_T;
typedef const real_T *const *InputRealPtrsType;
typedef struct mxArray {
  const char *text; /* NULL: a number */
  double number;
} mxArray;

enum { MAX_PORT_WIDTH = 16 };
typedef struct SimStruct {
  int num_expected_parameters, num_parameters;
  const mxArray *parameters[8];
  int num_inputs, num_outputs, input_width, output_width, has_feedthrough, num_sample_times, num_pwork;
  double sample_time, offset_time, time;
  const real_T *u[MAX_PORT_WIDTH];
  real_T y[MAX_PORT_WIDTH];
  void *pwork[4];
  const char *error;
  int is_stop_requested;
} SimStruct;

#define ssSetNumSFcnParams(S, n) ((S)->num_expected_parameters = (n))
#define ssGetNumSFcnParams(S) ((S)->num_expected_parameters)
#define ssGetSFcnParamsCount(S) ((S)->num_parameters)
#define ssGetSFcnParam(S, i) ((S)->parameters[i])
#define ssSetNumInputPorts(S, n) ((S)->num_inputs = (n), 1)
#define ssSetNumOutputPorts(S, n) ((S)->num_outputs = (n), 1)
#define ssSetInputPortWidth(S, port, n) ((S)->input_width = (n))
#define ssSetOutputPortWidth(S, port, n) ((S)->output_width = (n))
#define ssSetInputPortDirectFeedThrough(S, port, is) ((S)->has_feedthrough = (is))
#define ssSetNumSampleTimes(S, n) ((S)->num_sample_times = (n))
#define ssSetNumPWork(S, n) ((S)->num_pwork = (n))
#define ssSetSampleTime(S, i, t) ((S)->sample_time = (t))
#define ssGetSampleTime(S, i) ((S)->sample_time)
#define ssSetOffsetTime(S, i, t) ((S)->offset_time = (t))
#define ssGetT(S) ((S)->time)
#define ssGetInputPortRealSignalPtrs(S, port) ((InputRealPtrsType)(S)->u)
#define ssGetOutputPortRealSignal(S, port) ((S)->y)
#define ssSetPWorkValue(S, i, value) ((S)->pwork[i] = (value))
#define ssGetPWorkValue(S, i) ((S)->pwork[i])
#define ssSetErrorStatus(S, text) ((S)->error = (text))
#define ssSetStopRequested(S, is) ((S)->is_stop_requested = (is))

static int mxGetString(const mxArray *from, char *to, size_t size) {
  if (!from->text || strlen(from->text) >= size) return 1;
  strcpy(to, from->text);
  return 0;
}
static double mxGetScalar(const mxArray *from) { return from->number; }

#endif
