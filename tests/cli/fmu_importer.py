"""An importer of FMUs in ctypes, for tests: unpacks, checks and runs FMI 2.0 and 3.0, both kinds."""
import ctypes
import os
import re
import xml.etree.ElementTree as ElementTree
import zipfile

import numpy as np

OK, WARNING, DISCARD, ERROR, FATAL = range(5)
REAL, SIZE, POINTER, TEXT = ctypes.c_double, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_char_p
LOG2 = ctypes.CFUNCTYPE(None, POINTER, TEXT, ctypes.c_int, TEXT, TEXT)
LOG3 = ctypes.CFUNCTYPE(None, POINTER, ctypes.c_int, TEXT, TEXT)


class Callbacks2(ctypes.Structure):
    _fields_ = [("logger", LOG2), ("allocate", POINTER), ("free", POINTER), ("finished", POINTER), ("environment", POINTER)]


class EventInfo2(ctypes.Structure):
    _fields_ = [("need_update", ctypes.c_int), ("terminate", ctypes.c_int), ("nominals", ctypes.c_int),
                ("values", ctypes.c_int), ("has_next", ctypes.c_int), ("next", REAL)]


# Attributes that the schemas of the standards allow, by element.
COMMON2 = {"modelIdentifier", "needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess",
           "canNotUseMemoryManagementFunctions", "canGetAndSetFMUstate", "canSerializeFMUstate",
           "providesDirectionalDerivative"}
ALLOWED2 = {
    "fmiModelDescription": {"fmiVersion", "modelName", "guid", "description", "author", "version", "copyright", "license",
                            "generationTool", "generationDateAndTime", "variableNamingConvention", "numberOfEventIndicators"},
    "ModelExchange": COMMON2 | {"completedIntegratorStepNotNeeded"},
    "CoSimulation": COMMON2 | {"canHandleVariableCommunicationStepSize", "canInterpolateInputs", "maxOutputDerivativeOrder",
                               "canRunAsynchronuously"},
    "UnitDefinitions": set(), "Unit": {"name"}, "BaseUnit": {"kg", "m", "s", "A", "K", "mol", "cd", "rad", "factor", "offset"},
    "LogCategories": set(), "Category": {"name", "description"},
    "DefaultExperiment": {"startTime", "stopTime", "tolerance", "stepSize"},
    "ModelVariables": set(),
    "ScalarVariable": {"name", "valueReference", "description", "causality", "variability", "initial",
                       "canHandleMultipleSetPerTimeInstant"},
    "Real": {"declaredType", "quantity", "unit", "displayUnit", "relativeQuantity", "min", "max", "nominal", "unbounded",
             "start", "derivative", "reinit"},
    "ModelStructure": set(), "Outputs": set(), "Derivatives": set(), "InitialUnknowns": set(),
    "Unknown": {"index", "dependencies", "dependenciesKind"}}
COMMON3 = {"modelIdentifier", "needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess", "canGetAndSetFMUState",
           "canSerializeFMUState", "providesDirectionalDerivatives", "providesAdjointDerivatives",
           "providesPerElementDependencies"}
UNKNOWN3 = {"valueReference", "dependencies", "dependenciesKind"}
ALLOWED3 = {
    "fmiModelDescription": {"fmiVersion", "modelName", "instantiationToken", "description", "author", "version",
                            "copyright", "license", "generationTool", "generationDateAndTime", "variableNamingConvention"},
    "ModelExchange": COMMON3 | {"needsCompletedIntegratorStep", "providesEvaluateDiscreteStates"},
    "CoSimulation": COMMON3 | {"canHandleVariableCommunicationStepSize", "fixedInternalStepSize",
                               "maxOutputDerivativeOrder", "recommendedIntermediateInputSmoothness",
                               "providesIntermediateUpdate", "mightReturnEarlyFromDoStep",
                               "canReturnEarlyAfterIntermediateUpdate", "hasEventMode", "providesEvaluateDiscreteStates"},
    "UnitDefinitions": set(), "Unit": {"name"}, "BaseUnit": {"kg", "m", "s", "A", "K", "mol", "cd", "rad", "factor", "offset"},
    "LogCategories": set(), "Category": {"name", "description"},
    "DefaultExperiment": {"startTime", "stopTime", "tolerance", "stepSize"},
    "ModelVariables": set(),
    "Float64": {"name", "valueReference", "description", "causality", "variability", "canHandleMultipleSetPerTimeInstant",
                "clocks", "previous", "intermediateUpdate", "declaredType", "initial", "quantity", "unit", "displayUnit",
                "relativeQuantity", "unbounded", "min", "max", "nominal", "start", "derivative", "reinit"},
    "ModelStructure": set(), "Output": UNKNOWN3, "ContinuousStateDerivative": UNKNOWN3, "InitialUnknown": UNKNOWN3,
    "EventIndicator": UNKNOWN3}
ORDER = ["ModelExchange", "CoSimulation", "UnitDefinitions", "LogCategories", "DefaultExperiment", "ModelVariables", "ModelStructure"]


class Fmu:
    """An unpacked FMU. Raises ValueError where modelDescription.xml breaks a rule of the standard."""

    def __init__(self, path, folder):
        with zipfile.ZipFile(path) as archive:
            self.names = archive.namelist()
            for name in self.names:
                if name.startswith("/") or ".." in name or "\\" in name:
                    raise ValueError(f"entry {name}")
            archive.extractall(folder)    # checks the checksums
        self.folder = folder = os.path.abspath(folder)
        self.resources = os.path.join(folder, "resources")
        with open(os.path.join(folder, "modelDescription.xml"), "rb") as f:
            self.xml = f.read()
        self.root = ElementTree.fromstring(self.xml)
        self.version = int(self.root.get("fmiVersion")[0])
        self.variables = {}  # name: (reference, causality, start)
        self.units, self.unit_of = {}, {}
        self.dependencies = {}  # name of an unknown: names of its knowns
        self.check()
        self.token = self.root.get("guid" if self.version == 2 else "instantiationToken")
        self.identifier = self.root.find("CoSimulation").get("modelIdentifier")
        self.binary = os.path.join(folder, "binaries", "linux64" if self.version == 2 else "x86_64-linux",
                                   self.identifier + ".so")

    def demand(self, condition, what):
        if not condition:
            raise ValueError(what)

    def check(self):
        allowed = ALLOWED2 if self.version == 2 else ALLOWED3
        for element in self.root.iter():
            self.demand(element.tag in allowed, f"element {element.tag}")
            unknown = set(element.keys()) - allowed[element.tag]
            self.demand(not unknown, f"attributes {unknown} of {element.tag}")
        self.demand([child.tag for child in self.root] in (ORDER, [tag for tag in ORDER if tag != "UnitDefinitions"]),
                    "order of the elements")
        for unit in self.root.iter("Unit"):
            self.demand(unit.get("name") not in self.units and len(unit) == 1, f"unit {unit.get('name')}")
            self.units[unit.get("name")] = {key: float(value) for key, value in unit[0].items()}
        for kind in ("ModelExchange", "CoSimulation"):
            self.demand(re.fullmatch(r"[A-Za-z_]\w*", self.root.find(kind).get("modelIdentifier")), "modelIdentifier")
        (self.check2 if self.version == 2 else self.check3)()
        self.demand(len(set(self.variables)) == len(self.variables), "names are unique")

    def add(self, element, start):
        name, reference = element.get("name"), int(element.get("valueReference"))
        causality, variability, initial = (element.get(key) for key in ("causality", "variability", "initial"))
        self.demand(name and name not in self.variables, f"name {name}")
        if causality == "parameter":
            self.demand(variability == "fixed" and initial == "exact" and start is not None, f"parameter {name}")
        elif causality == "input":
            self.demand(variability == "continuous" and initial is None and start is not None, f"input {name}")
        elif causality == "independent":
            self.demand(variability == "continuous" and initial is None and start is None, f"independent {name}")
        else:
            self.demand(causality in ("output", "local") and variability == "continuous" and initial == "calculated" and
                        start is None, f"variable {name}")
        if start is not None:
            float(start)
        self.variables[name] = (reference, causality, start)
        unit = (element if self.version == 3 else element[0]).get("unit")
        self.demand(unit is None or unit in self.units, f"unit {unit}")
        self.unit_of[name] = unit
        return reference, causality

    def add_dependencies(self, element, name, get_name, is_initial):
        """Keeps those of outputs, derivatives and event indicators; None: all."""
        listed, kinds = element.get("dependencies"), element.get("dependenciesKind")
        numbers = None if listed is None else [int(i) for i in listed.split()]
        self.demand(kinds is None or len(kinds.split()) == len(numbers), "dependenciesKind")
        if numbers is not None:
            self.demand(numbers == sorted(set(numbers)), "order of dependencies")
            for known in map(get_name, numbers):
                of = self.variables[known][1]
                self.demand(of in ("input", "independent") or known in self.variables and "der(" + known + ")" in self.variables,
                            f"{name} depends on {known}")
        if not is_initial:
            self.dependencies[name] = None if numbers is None else {get_name(i) for i in numbers}

    def check2(self):
        order, derivatives, outputs, states = [], [], [], []
        for i, element in enumerate(self.root.find("ModelVariables"), 1):
            self.demand(len(element) == 1, "one type")
            _, causality = self.add(element, element[0].get("start"))
            order.append(element.get("name"))
            if causality == "output":
                outputs.append(i)
            if element[0].get("derivative"):
                derivatives.append(i)
                states.append(int(element[0].get("derivative")))
        structure = {part.tag: [int(u.get("index")) for u in part] for part in self.root.find("ModelStructure")}
        for part in self.root.find("ModelStructure"):
            for element in part:
                self.add_dependencies(element, order[int(element.get("index")) - 1], lambda i: order[i - 1], part.tag == "InitialUnknowns")
        self.demand(structure.get("Outputs", []) == outputs, "Outputs")
        self.demand(structure.get("Derivatives", []) == derivatives, "Derivatives")
        self.demand(structure.get("InitialUnknowns", []) == sorted(outputs + states + derivatives), "InitialUnknowns")
        self.states = [order[i - 1] for i in states]
        self.derivatives = [order[i - 1] for i in derivatives]
        self.num_indicators = int(self.root.get("numberOfEventIndicators"))

    def check3(self):
        by_reference, states, derivatives = {}, [], []
        for element in self.root.find("ModelVariables"):
            reference, _ = self.add(element, element.get("start"))
            self.demand(reference not in by_reference, f"reference {reference} is unique")
            by_reference[reference] = element
            if element.get("derivative"):
                derivatives.append(reference)
                states.append(int(element.get("derivative")))
        lists = {}
        for part in self.root.find("ModelStructure"):
            lists.setdefault(part.tag, []).append(int(part.get("valueReference")))
            self.add_dependencies(part, by_reference[int(part.get("valueReference"))].get("name"),
                                  lambda r: by_reference[r].get("name"), part.tag == "InitialUnknown")
        outputs = [r for r, e in by_reference.items() if e.get("causality") == "output"]
        self.demand(lists.get("Output", []) == outputs, "Output")
        self.demand(lists.get("ContinuousStateDerivative", []) == derivatives, "ContinuousStateDerivative")
        self.demand(sorted(lists.get("InitialUnknown", [])) == sorted(outputs + states + derivatives), "InitialUnknown")
        self.demand(all(r in by_reference for r in states + lists.get("EventIndicator", [])), "references exist")
        self.demand([e.get("name") for e in by_reference.values() if e.get("causality") == "independent"] == ["time"], "time")
        tags = [part.tag for part in self.root.find("ModelStructure")]
        rank = ["Output", "ContinuousStateDerivative", "InitialUnknown", "EventIndicator"]
        self.demand(tags == sorted(tags, key=rank.index), "order of ModelStructure")
        self.states = [by_reference[r].get("name") for r in states]
        self.derivatives = [by_reference[r].get("name") for r in derivatives]
        self.indicators = [by_reference[r].get("name") for r in lists.get("EventIndicator", [])]
        self.num_indicators = len(self.indicators)

    def list(self, causality):
        return [name for name, (_, of, _) in self.variables.items() if of == causality]


def reals(values):
    """The array as a C function takes it; it must live as long as the call."""
    return (REAL * len(values)).from_buffer(values) if len(values) else None


class Failed(Exception):
    def __init__(self, status, text):
        super().__init__(f"status {status}: {text}")
        self.status = status


class Instance:
    """One instance; methods have the names of Bough, not of a version of the standard."""

    def __init__(self, fmu, kind, token=None, resources=None, event_mode=False, early_return=True, logs=False):
        self.fmu, self.kind, self.messages = fmu, kind, []
        self.library = ctypes.CDLL(fmu.binary)
        self.prefix = f"fmi{fmu.version}"
        token = (fmu.token if token is None else token).encode()
        resources = fmu.resources if resources is None else resources
        if fmu.version == 2:
            self.log = LOG2(lambda env, name, status, category, text: self.messages.append((status, category, text.decode())))
            self.callbacks = Callbacks2(self.log, None, None, None, None)
            instantiate = self.library.fmi2Instantiate
            instantiate.restype = POINTER
            self.handle = instantiate(b"one", ctypes.c_int(kind == "cs"), token, b"file://" + resources.encode().replace(b" ", b"%20"),
                                      ctypes.byref(self.callbacks), 0, ctypes.c_int(logs))
        else:
            self.log = LOG3(lambda env, status, category, text: self.messages.append((status, category, text.decode())))
            name = "CoSimulation" if kind == "cs" else "ModelExchange"
            instantiate = getattr(self.library, "fmi3Instantiate" + name)
            instantiate.restype = POINTER
            flags = [ctypes.c_bool(event_mode), ctypes.c_bool(early_return), None, SIZE(0)] if kind == "cs" else []
            self.handle = instantiate(b"one", token, resources.encode() + b"/", ctypes.c_bool(False), ctypes.c_bool(logs), *flags,
                                      None, self.log, *([None] if kind == "cs" else []))
        if not self.handle:
            raise Failed(ERROR, "; ".join(text for _, _, text in self.messages) or "no message")

    def call(self, name, *arguments, accept=(OK,)):
        status = getattr(self.library, self.prefix + name)(POINTER(self.handle), *arguments)
        if status not in accept:
            raise Failed(status, self.messages[-1][2] if self.messages else "no message")
        return status

    def close(self):
        free = getattr(self.library, self.prefix + "FreeInstance")
        free.restype = None
        free(POINTER(self.handle))

    def initialize(self, start=0.0, stop=None, tolerance=None):
        self.enter_initialization(start, stop, tolerance)
        self.call("ExitInitializationMode")

    def enter_initialization(self, start=0.0, stop=None, tolerance=None):
        if self.fmu.version == 2:
            self.call("SetupExperiment", ctypes.c_int(tolerance is not None), REAL(tolerance or 0), REAL(start),
                      ctypes.c_int(stop is not None), REAL(stop or 0))
            self.call("EnterInitializationMode")
        else:
            self.call("EnterInitializationMode", ctypes.c_bool(tolerance is not None), REAL(tolerance or 0), REAL(start),
                      ctypes.c_bool(stop is not None), REAL(stop or 0))

    def references(self, names):
        return (ctypes.c_uint32 * len(names))(*[self.fmu.variables[n][0] if isinstance(n, str) else n for n in names])

    def get(self, names):
        values = np.full(len(names), np.nan)
        more = [] if self.fmu.version == 2 else [SIZE(len(names))]
        self.call("GetReal" if self.fmu.version == 2 else "GetFloat64", self.references(names), SIZE(len(names)),
                  reals(values), *more)
        return values

    def set(self, names, values):
        values = np.array(values, float)
        more = [] if self.fmu.version == 2 else [SIZE(len(names))]
        self.call("SetReal" if self.fmu.version == 2 else "SetFloat64", self.references(names), SIZE(len(names)),
                  reals(values), *more)

    def step(self, t, h):
        """Returns (is terminated, time reached)."""
        if self.fmu.version == 2:
            status = self.call("DoStep", REAL(t), REAL(h), ctypes.c_int(1), accept=(OK, DISCARD))
            terminated, reached = ctypes.c_int(0), REAL(t + h)
            if status == DISCARD:
                self.call("GetBooleanStatus", ctypes.c_int(3), ctypes.byref(terminated))
                self.call("GetRealStatus", ctypes.c_int(2), ctypes.byref(reached))
            return bool(terminated.value), reached.value
        needs, terminate, early = (ctypes.c_bool() for _ in range(3))
        reached = REAL()
        self.call("DoStep", REAL(t), REAL(h), ctypes.c_bool(True), ctypes.byref(needs), ctypes.byref(terminate),
                  ctypes.byref(early), ctypes.byref(reached))
        return terminate.value, reached.value

    # Model Exchange
    def update_discrete(self):
        """Returns (terminate, states have changed, next time event or infinity)."""
        if self.fmu.version == 2:
            info = EventInfo2(1)
            while info.need_update and not info.terminate:
                self.call("NewDiscreteStates", ctypes.byref(info))
            return bool(info.terminate), bool(info.values), info.next if info.has_next else np.inf
        need, terminate, nominals, values, has_next = (ctypes.c_bool(True) for _ in range(5))
        following = REAL()
        while need.value:
            self.call("UpdateDiscreteStates", *(ctypes.byref(x) for x in (need, terminate, nominals, values, has_next, following)))
        return terminate.value, values.value, following.value if has_next.value else np.inf

    def vector(self, name, n):
        values = np.zeros(n)
        self.call(name, reals(values), SIZE(n))
        return values

    def states(self):
        return self.vector("GetContinuousStates", len(self.fmu.states))

    def indicators(self):
        return self.vector("GetEventIndicators", self.fmu.num_indicators)

    def derivatives(self, t, x):
        self.put(t, x)
        return self.vector("GetDerivatives" if self.fmu.version == 2 else "GetContinuousStateDerivatives", len(x))

    def put(self, t, x):
        self.call("SetTime", REAL(t))
        self.call("SetContinuousStates", reals(x), SIZE(len(x)))

    def completed_step(self):
        kind = ctypes.c_int if self.fmu.version == 2 else ctypes.c_bool
        enter, terminate = kind(), kind()
        self.call("CompletedIntegratorStep", kind(1), ctypes.byref(enter), ctypes.byref(terminate))
        return bool(enter.value)

    def directional(self, unknowns, knowns, seed):
        """Derivatives of the unknowns along the seed of the knowns."""
        seed, found = np.array(seed, float), np.full(len(unknowns), np.nan)
        sizes = (lambda n: []) if self.fmu.version == 2 else (lambda n: [SIZE(n)])
        self.call("GetDirectionalDerivative", self.references(unknowns), SIZE(len(unknowns)), self.references(knowns),
                  SIZE(len(knowns)), reals(seed), *sizes(len(knowns)), reals(found),
                  *sizes(len(unknowns)))
        return found

    def jacobian(self, unknowns, knowns):
        return np.column_stack([self.directional(unknowns, [known], [1.0]) for known in knowns])

    # FMU states
    def save(self):
        state = POINTER()
        self.call("GetFMUstate" if self.fmu.version == 2 else "GetFMUState", ctypes.byref(state))
        return state

    def restore(self, state):
        self.call("SetFMUstate" if self.fmu.version == 2 else "SetFMUState", state)

    def free_state(self, state):
        self.call("FreeFMUstate" if self.fmu.version == 2 else "FreeFMUState", ctypes.byref(state))

    def serialize(self, state):
        word = "state" if self.fmu.version == 2 else "State"
        size = SIZE()
        self.call(f"SerializedFMU{word}Size", state, ctypes.byref(size))
        buffer = ctypes.create_string_buffer(size.value)
        self.call(f"SerializeFMU{word}", state, buffer, size)
        return buffer.raw

    def deserialize(self, raw):
        state = POINTER()
        self.call("DeSerializeFMUstate" if self.fmu.version == 2 else "DeserializeFMUState", raw, SIZE(len(raw)), ctypes.byref(state))
        return state


# Dormand and Prince, order 5 with an error of order 4.
C = [0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1]
A = [np.array(row) for row in (
    [], [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9], [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
    [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656])]
B = np.array([35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84])
E = np.array([71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])


class MeRun:
    """Model Exchange with its own integrator, location of state events by bisection, and event mode."""

    def __init__(self, instance, tolerance=1e-10, start=0.0):
        self.i, self.tolerance, self.h = instance, tolerance, 1e-4
        self.num_state_events = self.num_time_events = self.num_step_events = 0
        self.t, self.terminated = start, False
        self.enter_event(first=True)

    def enter_event(self, first=False):
        self.first = None
        if not first:
            self.i.call("EnterEventMode")
        self.terminated, _, self.next = self.i.update_discrete()
        if self.terminated:
            return
        self.x = self.i.states()
        self.i.call("EnterContinuousTimeMode")
        self.g = self.i.indicators()

    def take(self, h):
        """The state after a step of h, and the derivatives that it is made of; the first is that of the steps before it
        from the same place."""
        k = np.empty((len(C), len(self.x)))
        k[0] = self.first = self.i.derivatives(self.t, self.x) if self.first is None else self.first
        for i in range(1, len(C)):
            k[i] = self.i.derivatives(self.t + C[i] * h, self.x + h * (A[i] @ k[:i]))
        return self.x + h * (B @ k), k

    def calc_error(self, h, x, k):
        error = h * (E[:-1] @ k + E[-1] * self.i.derivatives(self.t + h, x))
        return np.max(np.abs(error) / (self.tolerance * (1 + np.abs(x))), initial=0)

    def crosses(self, h):
        self.i.put(self.t + h, self.take(h)[0])
        return np.any((self.i.indicators() > 0) != (self.g > 0))

    def advance(self, until):
        self.first = None    # inputs may be others
        while self.t < until - 1e-12 and not self.terminated:
            end = min(until, self.next)
            h = min(self.h, end - self.t)
            x, k = self.take(h)
            error = self.calc_error(h, x, k)
            if error > 1 and h > 1e-10:
                self.h = 0.9 * h * max(0.2, error ** -0.2)
                continue
            at_end = self.t + h >= end - 1e-13
            if h == self.h or error > 0:
                self.h = max(h if not at_end else self.h, 0.9 * h * min(5, max(error, 1e-8) ** -0.2))
            self.i.put(self.t + h, x)
            if np.any((self.i.indicators() > 0) != (self.g > 0)):
                low, high = 0.0, h
                while high - low > 1e-14 * max(1, abs(self.t)) and low < (low + high) / 2 < high:
                    middle = (low + high) / 2
                    if self.crosses(middle):
                        high = middle
                    else:
                        low = middle
                x, _ = self.take(high)
                self.t += high
                self.i.put(self.t, x)
                self.i.completed_step()
                self.num_state_events += 1
                self.enter_event()
                continue
            self.t, self.x, self.first = (end if at_end else self.t + h), x, None
            self.i.put(self.t, self.x)
            enter = self.i.completed_step()
            if self.t >= self.next - 1e-13:
                self.num_time_events += 1
                self.enter_event()
            elif enter:
                self.num_step_events += 1
                self.enter_event()
            else:
                self.g = self.i.indicators()
        return not self.terminated
