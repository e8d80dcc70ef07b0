/* A system of Bough as an S-function of level 2 (Simulink). Parameters: system file, names of outputs separated by
 * blanks, sample time. Inputs: all [[input]]s. In MATLAB:
 *     mex sfun_bough.c -IPREFIX/include -LPREFIX/lib -lbough
 */
#define S_FUNCTION_NAME sfun_bough
#define S_FUNCTION_LEVEL 2

#include <bough.h>
#include <stdlib.h>
#include <string.h>

#include "simstruc.h"

enum { MAX_OUTPUTS = 256, MAX_TEXT = 8192 };
enum { FILE_PARAMETER, OUTPUTS_PARAMETER, SAMPLE_TIME_PARAMETER, NUM_PARAMETERS };

/* Memory of one block. */
typedef struct Block {
  bough_model *model;
  bough_simulation *simulation;
  int num_inputs, num_outputs, outputs[MAX_OUTPUTS];
} Block;

/* Text of the last failure; Simulink keeps the pointer. */
static bough_message message;

/* Loads the model and finds the outputs; NULL if there is an error, which is then set. */
static Block *load(SimStruct *S) {
  static char file[MAX_TEXT], names[MAX_TEXT], unknown[MAX_TEXT + 32];
  Block *block = calloc(1, sizeof *block);
  if (!block) {
    ssSetErrorStatus(S, "out of memory");
    return NULL;
  }
  if (mxGetString(ssGetSFcnParam(S, FILE_PARAMETER), file, sizeof file) != 0 ||
      mxGetString(ssGetSFcnParam(S, OUTPUTS_PARAMETER), names, sizeof names) != 0) {
    ssSetErrorStatus(S, "system file and outputs must be character arrays");
    free(block);
    return NULL;
  }
  if (bough_load(file, NULL, &block->model, &message) != BOUGH_OK) {
    ssSetErrorStatus(S, message.text);
    free(block);
    return NULL;
  }
  block->num_inputs = bough_count(block->model, BOUGH_INPUTS);
  for (char *name = strtok(names, " "); name && block->num_outputs < MAX_OUTPUTS; name = strtok(NULL, " ")) {
    const int index = bough_find(block->model, BOUGH_OUTPUTS, name);
    if (index < 0) {
      strcpy(unknown, "no output has the name ");
      ssSetErrorStatus(S, strcat(unknown, name));
      bough_unload(block->model);
      free(block);
      return NULL;
    }
    block->outputs[block->num_outputs++] = index;
  }
  return block;
}

static void mdlInitializeSizes(SimStruct *S) {
  ssSetNumSFcnParams(S, NUM_PARAMETERS);
  if (ssGetNumSFcnParams(S) != ssGetSFcnParamsCount(S)) return; /* Simulink reports it */
  Block *block = load(S); /* for the widths of the ports */
  if (!block) return;
  if (!ssSetNumInputPorts(S, block->num_inputs > 0 ? 1 : 0) || !ssSetNumOutputPorts(S, 1)) return;
  if (block->num_inputs > 0) {
    ssSetInputPortWidth(S, 0, block->num_inputs);
    ssSetInputPortDirectFeedThrough(S, 0, 0); /* outputs at t do not depend on inputs set at t */
  }
  ssSetOutputPortWidth(S, 0, block->num_outputs);
  ssSetNumSampleTimes(S, 1);
  ssSetNumPWork(S, 1);
  bough_unload(block->model);
  free(block);
}

static void mdlInitializeSampleTimes(SimStruct *S) {
  ssSetSampleTime(S, 0, mxGetScalar(ssGetSFcnParam(S, SAMPLE_TIME_PARAMETER)));
  ssSetOffsetTime(S, 0, 0.0);
}

#define MDL_START
static void mdlStart(SimStruct *S) {
  Block *block = load(S);
  ssSetPWorkValue(S, 0, block);
  if (block && bough_start(block->model, NULL, &block->simulation, &message) != BOUGH_OK)
    ssSetErrorStatus(S, message.text);
}

/* Outputs at the present time. */
static void mdlOutputs(SimStruct *S, int_T tid) {
  Block *block = ssGetPWorkValue(S, 0);
  real_T *y = ssGetOutputPortRealSignal(S, 0);
  (void)tid;
  for (int i = 0; i < block->num_outputs; ++i)
    if (bough_get_outputs(block->simulation, block->outputs[i], 1, &y[i]) != BOUGH_OK)
      ssSetErrorStatus(S, bough_last_message(block->simulation));
}

/* Sets the inputs of the present time and advances to the next sample. */
#define MDL_UPDATE
static void mdlUpdate(SimStruct *S, int_T tid) {
  Block *block = ssGetPWorkValue(S, 0);
  (void)tid;
  for (int i = 0; i < block->num_inputs; ++i) {
    const double u = *ssGetInputPortRealSignalPtrs(S, 0)[i];
    if (bough_set_inputs(block->simulation, i, 1, &u) != BOUGH_OK)
      ssSetErrorStatus(S, bough_last_message(block->simulation));
  }
  const bough_status status = bough_advance(block->simulation, ssGetT(S) + ssGetSampleTime(S, 0), NULL);
  if (status == BOUGH_TERMINATED)
    ssSetStopRequested(S, 1);
  else if (status != BOUGH_OK)
    ssSetErrorStatus(S, bough_last_message(block->simulation));
}

static void mdlTerminate(SimStruct *S) {
  Block *block = ssGetPWorkValue(S, 0);
  if (!block) return;
  bough_stop(block->simulation);
  bough_unload(block->model);
  free(block);
  ssSetPWorkValue(S, 0, NULL);
}

#ifdef MATLAB_MEX_FILE
#include "simulink.c"
#else
#include "cg_sfun.h"
#endif
