"""libbough.so by ctypes, for tests."""
import ctypes
import os

import numpy as np

INPUTS, OUTPUTS, PARAMETERS, STATES, EVENTS = range(5)


class Message(ctypes.Structure):
    _fields_ = [("text", ctypes.c_char * 4096), ("id", ctypes.c_char * 64), ("file", ctypes.c_char * 1024),
                ("line", ctypes.c_int), ("what", ctypes.c_char * 2048), ("advice", ctypes.c_char * 1024)]


class Options(ctypes.Structure):
    _fields_ = [("size", ctypes.c_size_t), ("integrator", ctypes.c_char_p), ("step", ctypes.c_double),
                ("relative_tolerance", ctypes.c_double), ("absolute_tolerance", ctypes.c_double),
                ("duration", ctypes.c_double)]


def open_library():
    library = ctypes.CDLL(os.environ["BOUGH_LIBRARY"])
    pointer, number = ctypes.c_void_p, ctypes.c_double
    for name, result, arguments in (
            ("bough_name", ctypes.c_char_p, [pointer, ctypes.c_int, ctypes.c_int]),
            ("bough_dims", ctypes.c_char_p, [pointer, ctypes.c_int, ctypes.c_int]),
            ("bough_count", ctypes.c_int, [pointer, ctypes.c_int]),
            ("bough_time", number, [pointer]),
            ("bough_last_message", ctypes.c_char_p, [pointer]),
            ("bough_advance", ctypes.c_int, [pointer, number, pointer]),
            ("bough_state_size", ctypes.c_size_t, [pointer]),
            ("bough_save", ctypes.c_int, [pointer, pointer, ctypes.c_size_t]),
            ("bough_restore", ctypes.c_int, [pointer, pointer, ctypes.c_size_t]),
            ("bough_set_inputs", ctypes.c_int, [pointer, ctypes.c_int, ctypes.c_int, pointer]),
            ("bough_get_outputs", ctypes.c_int, [pointer, ctypes.c_int, ctypes.c_int, pointer])):
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


LIBRARY = open_library() if "BOUGH_LIBRARY" in os.environ else None


class Model:
    def __init__(self, path, settings=()):
        self.handle, message = ctypes.c_void_p(), Message()
        texts = (ctypes.c_char_p * (len(settings) + 1))(*[s.encode() for s in settings], None)
        status = LIBRARY.bough_load(path.encode(), texts, ctypes.byref(self.handle), ctypes.byref(message))
        if status:
            raise RuntimeError(f"status {status}: {message.text.decode()}")

    def names(self, kind):
        return [LIBRARY.bough_name(self.handle, kind, i).decode() for i in range(LIBRARY.bough_count(self.handle, kind))]

    def close(self):
        LIBRARY.bough_unload(self.handle)


class Simulation:
    def __init__(self, model, integrator="", step=0.0):
        self.handle, message = ctypes.c_void_p(), Message()
        options = Options(ctypes.sizeof(Options), integrator.encode(), step, 0, 0, 0)
        status = LIBRARY.bough_start(model.handle, ctypes.byref(options), ctypes.byref(self.handle), ctypes.byref(message))
        if status:
            raise RuntimeError(f"status {status}: {message.text.decode()}")
        self.size = LIBRARY.bough_count(model.handle, OUTPUTS)

    def check(self, status):
        if status > 1:
            raise RuntimeError(f"status {status}: {self.message()}")
        return status

    def message(self):
        return LIBRARY.bough_last_message(self.handle).decode()

    def time(self):
        return LIBRARY.bough_time(self.handle)

    def advance(self, t):
        """Returns true if the run goes on."""
        return self.check(LIBRARY.bough_advance(self.handle, t, None)) == 0

    def set_inputs(self, first, *values):
        self.check(LIBRARY.bough_set_inputs(self.handle, first, len(values), (ctypes.c_double * len(values))(*values)))

    def outputs(self):
        values = np.zeros(self.size)
        self.check(LIBRARY.bough_get_outputs(self.handle, 0, self.size, values.ctypes.data))
        return values

    def save(self):
        size = LIBRARY.bough_state_size(self.handle)
        state = ctypes.create_string_buffer(size)
        self.check(LIBRARY.bough_save(self.handle, state, size))
        return state.raw

    def restore(self, state):
        self.check(LIBRARY.bough_restore(self.handle, state, len(state)))

    def close(self):
        LIBRARY.bough_stop(self.handle)
