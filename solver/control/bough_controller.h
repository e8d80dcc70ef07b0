/** \file Controllers of your own, in C, C++, Fortran or anything that makes a shared library with C functions.
 *
 *     [[controller]]
 *     name = "law"
 *     type = "library"
 *     file = "liblaw.so"
 *     inputs = ["angle", "rate"]
 *     parameters = [40.0, 12.0]
 *
 * The library exports the functions below by these names. Bough owns all numbers: the library reads and writes arrays
 * by pointer, nothing is copied, and it keeps nothing between calls but what `open` made. Continuous states z and
 * memory d (what changes at samples only) belong to Bough, which may take a step back, store them in a checkpoint, or
 * ask for outputs at any state: equal arguments must give equal results. That is also how a run is saved and resumed.
 *
 * All functions return 0, or another number for a failure: the run then ends with the name of the controller, the time
 * and that number, as it does after a value that is not finite or a C++ exception. A crash, exit() and abort() end the
 * program by the name of the controller too, but samples that were not flushed are lost. Arrays count from 0 in C, from 1 in
 * Fortran (bind(C), value for scalars). Times are absolute.
 */
#ifndef BOUGH_CONTROLLER_H
#define BOUGH_CONTROLLER_H

#define BOUGH_CONTROLLER_VERSION 1

#ifdef __cplusplus
extern "C" {
#endif

struct bough_controller {
  int inputs;               /* given: numbers in u */
  int num_parameters;       /* given */
  const double* parameters; /* given: as in the system file; valid during open only */
  int outputs;              /* to be set: numbers in y, 1 to 1000000 */
  int states;               /* to be set: numbers in z, at most 10000; 0 on entry; none with sample_time */
  int memory;               /* to be set: numbers in d, at most 1000000; 0 on entry; needs sample_time in the system file */
  int has_feedthrough;      /* to be set to 0 where y does not depend on u at the same moment; 1 on entry */
  double sample_time;       /* given: of the system file; 0: continuous */
  void* instance;           /* yours: the first argument of all other functions */
};

/** Returns BOUGH_CONTROLLER_VERSION, as it was when the library was made. */
int bough_controller_version(void);
/** Sets the sizes. */
int bough_controller_open(struct bough_controller* controller);
/** y at (t, u, z, d). */
int bough_controller_outputs(void* instance, double t, const double* u, const double* z, const double* d, double* y);

/* The others may be left out. */

/** Initial z and d, zero on entry. */
int bough_controller_start(void* instance, double* z, double* d);
/** z_dot at (t, u, z, d); needed where there are states. */
int bough_controller_derivatives(void* instance, double t, const double* u, const double* z, const double* d,
                                 double* z_dot);
/** The memory after the sample at t; needed where there is memory. d_next holds d on entry. */
int bough_controller_update(void* instance, double t, const double* u, const double* z, const double* d,
                            double* d_next);
/** The end of the instance. A run is marked as completed after it only. */
void bough_controller_close(void* instance);

#ifdef __cplusplus
}
#endif
#endif
