/** \file A system of Bough stepped from outside, in C: load a system file, start a simulation, set inputs, advance, read
 * outputs, save and restore. bough.hpp is the same in C++. See docs/embedding.md.
 *
 * Every function returns a bough_status or a plain number. No function ends the program, prints, or lets an exception
 * out. A model is constant after its load: simulations in many threads may share it. A simulation belongs to one thread
 * at a time. Units are those of the system file.
 */
#ifndef BOUGH_H
#define BOUGH_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define BOUGH_API
#else
#define BOUGH_API __attribute__((visibility("default")))
#endif

/** Of this header; bough_abi_version() of the library must be the same. */
#define BOUGH_ABI_VERSION 1

typedef struct bough_model bough_model;
typedef struct bough_simulation bough_simulation;

typedef enum bough_status {
  BOUGH_OK = 0,
  BOUGH_TERMINATED = 1,    /* advance: an event has ended the run, or its end is reached; bough_last_message says which */
  BOUGH_BAD_ARGUMENT = 2,  /* a null pointer, an index that does not exist, a time that has passed, NaN, a dead handle */
  BOUGH_BAD_INPUT = 3,     /* a file or a setting is not good */
  BOUGH_FAILED = 4,        /* the computation: diverged, no energy balance, a user library; the simulation is over */
  BOUGH_OUT_OF_MEMORY = 5,
  BOUGH_INTERNAL_ERROR = 6
} bough_status;

typedef enum bough_kind {
  BOUGH_INPUTS = 0,     /* [[input]] */
  BOUGH_OUTPUTS = 1,    /* components of channels of the results: of sensors, controllers, actuators, inputs, hinges
                           first, then all others */
  BOUGH_PARAMETERS = 2, /* [parameters] */
  BOUGH_STATES = 3,     /* continuous states: coordinates, rates, states of controllers, work, dissipated */
  BOUGH_EVENTS = 4      /* event functions: an event is where one changes its sign */
} bough_kind;

/** What went wrong, or what there is to say. Texts end with a zero; those that are too long are cut. */
typedef struct bough_message {
  char text[4096];   /* all of it, a line for each: "file:line: error: what; what to do [id]" */
  char id[64];       /* of the first error, "toml.unknown-key" */
  char file[1024];   /* place of the first error; empty: none */
  int line;          /* 0: none */
  char what[2048];   /* of the first error */
  char advice[1024]; /* what to do about it */
} bough_message;

/** For bough_start. Start from bough_default_options(); zero or null: as in the system file. */
typedef struct bough_options {
  size_t size;            /* sizeof(bough_options) */
  const char *integrator; /* "rk4", "implicit", "rk", "radau", "adams", "bdf" */
  double step;            /* of rk4 and implicit; the largest one of the others */
  double relative_tolerance, absolute_tolerance;
  double duration; /* how long it may go on at most */
} bough_options;

/** BOUGH_ABI_VERSION of the library; a host compares it with that of the header it was compiled with. */
BOUGH_API int bough_abi_version(void);
/** "0.3.0", of the library. */
BOUGH_API const char *bough_library_version(void);
/** Options that leave everything as in the system file, with `size` set. */
BOUGH_API bough_options bough_default_options(void);

/** Reads a system file and all files that it names. `settings`: "name=value" of [parameters], ended by NULL; may be
 * NULL. `message` may be NULL; warnings are in it too. */
BOUGH_API bough_status bough_load(const char *file, const char *const *settings, bough_model **model,
                                  bough_message *message);
/** The same of a text; paths in it are relative to `folder`. */
BOUGH_API bough_status bough_load_text(const char *toml, const char *folder, const char *const *settings,
                                       bough_model **model, bough_message *message);
/** Simulations of the model go on. NULL is nothing to do. */
BOUGH_API void bough_unload(bough_model *model);

/** How many there are; -1: no such kind or no model. */
BOUGH_API int bough_count(const bough_model *model, bough_kind kind);
/** Index of a name, as "tip:x", "/hinges/root/q:1"; -1: there is none. */
BOUGH_API int bough_find(const bough_model *model, bough_kind kind, const char *name);
/** NULL: there is none. Valid until bough_unload. */
BOUGH_API const char *bough_name(const bough_model *model, bough_kind kind, int index);
/** Dimension, as "L/T"; empty: not known. */
BOUGH_API const char *bough_dims(const bough_model *model, bough_kind kind, int index);
/** Value at the start of an input or a parameter; NaN: there is none. */
BOUGH_API double bough_start_value(const bough_model *model, bough_kind kind, int index);

/** A simulation at its start: loops closed, samples of the start taken. `options` may be NULL. */
BOUGH_API bough_status bough_start(const bough_model *model, const bough_options *options,
                                   bough_simulation **simulation, bough_message *message);
/** Releases a simulation; NULL is nothing to do. */
BOUGH_API void bough_stop(bough_simulation *simulation);

/** Time reached; NaN: no simulation. */
BOUGH_API double bough_time(const bough_simulation *simulation);
/** Values of inputs first .. first + n - 1 from the present time on. */
BOUGH_API bough_status bough_set_inputs(bough_simulation *simulation, int first, int n, const double *values);
/** Goes on to t. BOUGH_TERMINATED: the run has ended at *reached, at most t. `reached` may be NULL. */
BOUGH_API bough_status bough_advance(bough_simulation *simulation, double t, double *reached);
/** Outputs first .. first + n - 1 at the present time. */
BOUGH_API bough_status bough_get_outputs(bough_simulation *simulation, int first, int n, double *values);

/** With an integrator of the host, in place of bough_advance: x are the BOUGH_STATES, g the BOUGH_EVENTS. Between events
 * the host sets (t, x) and reads derivatives and event functions; where one of those changes its sign, or at a time
 * event, it puts the simulation there and calls bough_update_discrete. Inputs count at once, whatever their hold. Behind an event
 * a function may be 0: its sign is that which it takes next. bough_advance may follow: it goes on from (t, x). */
typedef struct bough_event_info {
  int states_changed;     /* x has jumped: read it again */
  int terminated;         /* the run has ended */
  double next_event_time; /* where the host has to stop at the latest */
} bough_event_info;

/** Continuous states [bough_count(model, BOUGH_STATES)] at the present time. */
BOUGH_API bough_status bough_get_continuous(bough_simulation *simulation, double *x);
/** Sets time and continuous states. BOUGH_BAD_ARGUMENT: a value is not finite, or t is after the next time event. */
BOUGH_API bough_status bough_set_continuous(bough_simulation *simulation, double t, const double *x);
/** Time derivatives [bough_count(model, BOUGH_STATES)] of the continuous states at the present (t, x). */
BOUGH_API bough_status bough_derivatives(bough_simulation *simulation, double *x_dot);
/** Event functions [bough_count(model, BOUGH_EVENTS)] at the present (t, x); an event is where one changes its sign. */
BOUGH_API bough_status bough_event_functions(bough_simulation *simulation, double *g);
/** After each step of the host: whether event mode is called for, since constraints have drifted apart. */
BOUGH_API bough_status bough_completed_step(bough_simulation *simulation, int *enter_event_mode);
/** Event mode: what is due at t, what has crossed and what follows, until nothing changes. Call it once at the start. */
BOUGH_API bough_status bough_update_discrete(bough_simulation *simulation, bough_event_info *info);

/** Bytes that bough_save needs, the same for all states of one simulation; 0: no simulation. */
BOUGH_API size_t bough_state_size(const bough_simulation *simulation);
/** Everything that the simulation goes on from, also in another process with the same system, options and version. */
BOUGH_API bough_status bough_save(const bough_simulation *simulation, void *buffer, size_t size);
/** Continues from the bytes of bough_save; the state is unchanged if they do not belong to this simulation. */
BOUGH_API bough_status bough_restore(bough_simulation *simulation, const void *buffer, size_t size);

/** Of the last call that did not return BOUGH_OK; empty: none. Valid until the next call. */
BOUGH_API const char *bough_last_message(const bough_simulation *simulation);

#ifdef __cplusplus
}
#endif
#endif
