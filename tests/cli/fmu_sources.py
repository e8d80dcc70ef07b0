"""A controller as FMU, FMI 2.0 and 3.0, and the same law as a shared library of bough_controller.h: written in C, compiled
by the tests. It filters the angle, multiplies, counts its steps, and does what the parameter `fault` tells it to."""
import os
import subprocess
import zipfile

from support import SOURCE

# One step of the law; the library and both FMUs compile these lines.
LAW = r"""
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "hold.h"
static double law(double *x, double h, double kp, double kd, double angle, double rate) {
  *x += h / 0.05 * (angle - *x);
  return -(kp * *x + kd * rate);
}
"""

LIBRARY = LAW + r"""
#include "bough_controller.h"
static double own[3];
int bough_controller_version(void) { return BOUGH_CONTROLLER_VERSION; }
int bough_controller_open(struct bough_controller *c) {
  own[0] = c->parameters[0], own[1] = c->parameters[1], own[2] = c->sample_time;
  c->outputs = 2, c->memory = 3, c->has_feedthrough = 0;
  return 0;
}
int bough_controller_outputs(void *i, double t, const double *u, const double *z, const double *d, double *y) {
  y[0] = d[1], y[1] = d[2];
  return 0;
}
int bough_controller_update(void *i, double t, const double *u, const double *z, const double *d, double *next) {
  next[0] = d[0];
  next[1] = u[2] != 0 ? law(&next[0], own[2], own[0], own[1], u[0], u[1]) : 0;
  next[2] = d[2] + 1;
  return 0;
}
"""

COMMON = LAW + r"""
typedef struct { double x, kp, kd, angle, rate, torque; int enable, count, fault; } State;
enum { ANGLE, RATE, ENABLE, TORQUE, COUNT, KP, KD, FAULT };
static int get_number(State *s, unsigned vr, double *to) {
  *to = vr == TORQUE ? s->torque : vr == KP ? s->kp : vr == KD ? s->kd : vr == ANGLE ? s->angle : s->rate;
  return vr == TORQUE && s->fault == 4 && s->count == 3 ? (*to = NAN, 0) : 0;
}
static int set_number(State *s, unsigned vr, double x) {
  double *to = vr == ANGLE ? &s->angle : vr == RATE ? &s->rate : vr == KP ? &s->kp : vr == KD ? &s->kd : 0;
  if (!to) return 3;
  *to = x;
  return 0;
}
/* 0 to 4 are statuses, 5 is the end of the simulation */
static int advance(State *s, double t, double h, int no_past) {
  if (s->fault == 8 && no_past) return 3;
  if (s->count == 3 && s->fault == 1) return 3;
  if (s->count == 3 && s->fault == 2) return 2;
  if (s->count == 3 && s->fault == 3) return 5;
  if (s->count == 3 && s->fault == 6) *(volatile int *)0 = 1;
  if (s->count == 3 && s->fault == 7) return 4;
  if (s->count == 3 && s->fault == 9) {
    for (;;) hold(getenv("ASTRAY_PIPE"));
  }
  s->torque = s->enable ? law(&s->x, h, s->kp, s->kd, s->angle, s->rate) : 0;
  if (fabs(t - s->count * h) > 1e-9) return 3;
  s->count++;
  return 0;
}
"""

# Functions of the state, whose names differ between FMI 2 and 3.
SAVED = r"""
int FMIGetSTATE(void *i, void **to) { if (!*to) *to = malloc(sizeof(State)); return memcpy(*to, i, sizeof(State)), 0; }
int FMISetSTATE(void *i, void *from) { return memcpy(i, from, sizeof(State)), 0; }
int FMIFreeSTATE(void *i, void **s) { return free(*s), *s = 0, 0; }
int FMISerializedSTATESize(void *i, void *s, size_t *n) { return *n = sizeof(State), 0; }
int FMISerializeSTATE(void *i, void *s, char *to, size_t n) { return memcpy(to, s, n), 0; }
int FMIDESERIALIZESTATE(void *i, const char *from, size_t n, void **s) {
  if (!*s) *s = malloc(sizeof(State));
  return memcpy(*s, from, n), 0;
}
"""

FMI2 = COMMON + r"""
typedef struct { State s; void (*log)(void *, const char *, int, const char *, const char *, ...); void *env; } Slave;
typedef struct { void (*log)(void *, const char *, int, const char *, const char *, ...); void *a, *f, *s, *env; } Callbacks;
void *fmi2Instantiate(const char *name, int type, const char *guid, const char *uri, const Callbacks *c, int visible, int logging) {
  char resource[1000];
  FILE *file;
  if (strcmp(guid, "{token}") != 0) {
    c->log(c->env, name, 3, "logStatusError", "the guid is %s", guid);
    return 0;
  }
  snprintf(resource, sizeof resource, "%s/note.txt", uri + 7);
  if (strncmp(uri, "file:///", 8) != 0 || !(file = fopen(resource, "r"))) return 0;
  fclose(file);
  Slave *s = calloc(1, sizeof(Slave));
  s->s.kp = 1, s->s.enable = 1, s->log = c->log, s->env = c->env;
  return s;
}
void fmi2FreeInstance(void *i) { free(i); }
int fmi2SetupExperiment(void *i, int a, double b, double t, int c, double d) { return 0; }
int fmi2EnterInitializationMode(void *i) { return 0; }
int fmi2ExitInitializationMode(void *i) { return 0; }
int fmi2Terminate(void *i) { return 0; }
int fmi2DoStep(void *i, double t, double h, int n) {
  Slave *s = i;
  const int status = advance(&s->s, t, h, n);
  if (status == 3) s->log(s->env, "controller", 3, "logStatusError", "tank %d is empty", 7);
  return status == 5 ? 2 : status;
}
int fmi2GetBooleanStatus(void *i, int kind, int *to) { return *to = kind == 3 && ((Slave *)i)->s.fault == 3, 0; }
int fmi2SetReal(void *i, const unsigned *vr, size_t n, const double *x) { return set_number(i, *vr, *x); }
int fmi2GetReal(void *i, const unsigned *vr, size_t n, double *x) { return get_number(i, *vr, x); }
int fmi2SetInteger(void *i, const unsigned *vr, size_t n, const int *x) { return *vr == FAULT ? (((State *)i)->fault = *x, 0) : 3; }
int fmi2GetInteger(void *i, const unsigned *vr, size_t n, int *x) { return *x = ((State *)i)->count, 0; }
int fmi2SetBoolean(void *i, const unsigned *vr, size_t n, const int *x) { return ((State *)i)->enable = *x, 0; }
int fmi2GetBoolean(void *i, const unsigned *vr, size_t n, int *x) { return *x = ((State *)i)->enable, 0; }
int fmi2SetString(void *i, const unsigned *vr, size_t n, const char *const *x) { return *vr == 8 && !strcmp(*x, "a = b") ? 0 : 3; }
"""
FMI2 += SAVED.replace("FMI", "fmi2").replace("STATE", "FMUstate").replace("DESERIALIZE", "DeSerialize")

FMI3 = COMMON + r"""
#include <stdbool.h>
#include <stdint.h>
typedef struct { State s; void (*log)(void *, int, const char *, const char *); void *env; } Slave;
void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *path, bool v, bool l, bool e, bool r,
                                  const uint32_t *q, size_t n, void *env, void *log, void *update) {
  char resource[1000];
  FILE *file;
  if (strcmp(token, "{token}") != 0) {
    ((void (*)(void *, int, const char *, const char *))log)(env, 3, "logStatusError", "the token is wrong");
    return 0;
  }
  snprintf(resource, sizeof resource, "%snote.txt", path);
  if (!(file = fopen(resource, "r"))) return 0;
  fclose(file);
  Slave *s = calloc(1, sizeof(Slave));
  s->s.kp = 1, s->s.enable = 1, s->log = log, s->env = env;
  return s;
}
void fmi3FreeInstance(void *i) { free(i); }
int fmi3EnterInitializationMode(void *i, bool a, double b, double t, bool c, double d) { return 0; }
int fmi3ExitInitializationMode(void *i) { return 0; }
int fmi3Terminate(void *i) { return 0; }
int fmi3DoStep(void *i, double t, double h, bool n, bool *event, bool *end, bool *early, double *reached) {
  Slave *s = i;
  const int status = advance(&s->s, t, h, n);
  if (status == 3) s->log(s->env, 3, "logStatusError", "tank 7 is empty");
  *event = *early = false, *end = status == 5, *reached = t + h;
  return status == 5 ? 0 : status;
}
/* angle and rate are one array here */
int fmi3SetFloat64(void *i, const uint32_t *vr, size_t n, const double *x, size_t m) {
  if (*vr == ANGLE && m == 2) set_number(i, RATE, x[1]);
  return set_number(i, *vr, *x);
}
int fmi3GetFloat64(void *i, const uint32_t *vr, size_t n, double *x, size_t m) { return get_number(i, *vr, x); }
int fmi3SetUInt8(void *i, const uint32_t *vr, size_t n, const uint8_t *x, size_t m) { return *vr == FAULT ? (((State *)i)->fault = *x, 0) : 3; }
int fmi3GetInt64(void *i, const uint32_t *vr, size_t n, int64_t *x, size_t m) { return *x = ((State *)i)->count, 0; }
int fmi3SetBoolean(void *i, const uint32_t *vr, size_t n, const bool *x, size_t m) { return ((State *)i)->enable = *x, 0; }
int fmi3SetString(void *i, const uint32_t *vr, size_t n, const char *const *x, size_t m) { return *vr == 8 && m == 1 && !strcmp(*x, "a = b") ? 0 : 3; }
"""
FMI3 += SAVED.replace("FMI", "fmi3").replace("STATE", "FMUState").replace("DESERIALIZE", "Deserialize")

XML2 = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="law" guid="{{token}}">
<CoSimulation modelIdentifier="law" canHandleVariableCommunicationStepSize="true" {state}/>
<DefaultExperiment stepSize="0.01"/>
<ModelVariables>
<ScalarVariable name="angle" valueReference="0" causality="input"><Real start="0"/></ScalarVariable>
<ScalarVariable name="rate" valueReference="1" causality="input"><Real start="0"/></ScalarVariable>
<ScalarVariable name="enable" valueReference="2" causality="input"><Boolean start="true"/></ScalarVariable>
<ScalarVariable name="torque" valueReference="3" causality="output"><Real/></ScalarVariable>
<ScalarVariable name="count" valueReference="4" causality="output"><Annotations/><Integer/></ScalarVariable>
<ScalarVariable name="kp" valueReference="5" causality="parameter"><Real start="1"/></ScalarVariable>
<ScalarVariable name="kd" valueReference="6" causality="parameter"><Real start="0"/></ScalarVariable>
<ScalarVariable name="fault" valueReference="7" causality="parameter"><Integer start="0"/></ScalarVariable>
<ScalarVariable name="title" valueReference="8" causality="parameter"><String start=""/></ScalarVariable>
</ModelVariables><ModelStructure/></fmiModelDescription>
"""

XML3 = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="law" instantiationToken="{{token}}">
<CoSimulation modelIdentifier="law" {state}/>
<ModelVariables>
<Float64 name="angle" valueReference="0" causality="input" start="0 0"><Dimension start="2"/></Float64>
<Boolean name="enable" valueReference="2" causality="input" start="true"/>
<Float64 name="torque" valueReference="3" causality="output"/>
<Int64 name="count" valueReference="4" causality="output"/>
<Float64 name="kp" valueReference="5" causality="parameter" start="1"/>
<Float64 name="kd" valueReference="6" causality="parameter" start="0"/>
<UInt8 name="fault" valueReference="7" causality="parameter" start="0"/>
<String name="title" valueReference="8" causality="parameter"><Start value=""/></String>
</ModelVariables><ModelStructure/></fmiModelDescription>
"""


def compile_library(path, text, *options):
    source = path + ".c"
    with open(source, "w") as f:
        f.write(text)
    subprocess.run(["cc", "-O1", "-w", "-shared", "-fPIC", "-ffp-contract=off", f"-I{SOURCE}/tests/support", "-o", path, source, "-lm", *options], check=True)


def make_fmu(path, version, saves=True, change=lambda xml: xml, platform=None, files=(), without=None):
    """An FMU at `path`; `change` edits its modelDescription.xml, `without` names a function that its binary lacks."""
    state = "state" if version == 2 else "State"
    attributes = f'canGetAndSetFMU{state}="true" canSerializeFMU{state}="true"' if saves else ""
    binary = f"{path}.{version}.{without}.so"
    if not os.path.exists(binary):
        compile_library(binary, FMI2 if version == 2 else FMI3, *([f"-D{without}=lacking"] if without else []))
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("modelDescription.xml", change((XML2 if version == 2 else XML3).format(state=attributes)))
        archive.write(binary, f"binaries/{platform or ('linux64' if version == 2 else 'x86_64-linux')}/law.so")
        archive.writestr("resources/note.txt", "found")
        for name, content in files:
            archive.writestr(name, content)
