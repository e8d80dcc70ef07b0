"""Steps an arm from outside: a PD controller at 1 kHz. host.py [SYSTEM.toml]; libbough.so by ctypes alone."""
import ctypes
import os
import sys
from ctypes import POINTER, byref, c_char, c_char_p, c_double, c_int, c_void_p

INPUTS, OUTPUTS = 0, 1


class Message(ctypes.Structure):
    _fields_ = [("text", c_char * 4096), ("id", c_char * 64), ("file", c_char * 1024), ("line", c_int),
                ("what", c_char * 2048), ("advice", c_char * 1024)]


bough = ctypes.CDLL(os.environ.get("BOUGH_LIBRARY", "libbough.so.1"))
bough.bough_load.argtypes = [c_char_p, c_void_p, POINTER(c_void_p), POINTER(Message)]
bough.bough_start.argtypes = [c_void_p, c_void_p, POINTER(c_void_p), POINTER(Message)]
bough.bough_find.argtypes = [c_void_p, c_int, c_char_p]
bough.bough_time.argtypes, bough.bough_time.restype = [c_void_p], c_double
bough.bough_set_inputs.argtypes = [c_void_p, c_int, c_int, POINTER(c_double)]
bough.bough_get_outputs.argtypes = [c_void_p, c_int, c_int, POINTER(c_double)]
bough.bough_advance.argtypes = [c_void_p, c_double, POINTER(c_double)]
bough.bough_last_message.argtypes, bough.bough_last_message.restype = [c_void_p], c_char_p
bough.bough_stop.argtypes, bough.bough_stop.restype = [c_void_p], None
bough.bough_unload.argtypes, bough.bough_unload.restype = [c_void_p], None

file = sys.argv[1] if len(sys.argv) > 1 else "system.toml"
model, simulation, message = c_void_p(), c_void_p(), Message()
if bough.bough_abi_version() != 1:
    sys.exit("libbough.so has another ABI version than this program")
if bough.bough_load(file.encode(), None, byref(model), byref(message)) != 0 or \
        bough.bough_start(model, None, byref(simulation), byref(message)) != 0:
    sys.exit(message.text.decode())
torque = bough.bough_find(model, INPUTS, b"torque")
angle, rate = bough.bough_find(model, OUTPUTS, b"angle"), bough.bough_find(model, OUTPUTS, b"rate")
phi, omega, command = c_double(), c_double(), c_double()
for k in range(1001):
    bough.bough_get_outputs(simulation, angle, 1, byref(phi))
    bough.bough_get_outputs(simulation, rate, 1, byref(omega))
    if k % 200 == 0:
        print("%6.3f%15.10f%15.10f" % (bough.bough_time(simulation), phi.value, omega.value))
    command.value = 60.0 * (0.5 - phi.value) - 12.0 * omega.value
    bough.bough_set_inputs(simulation, torque, 1, byref(command))
    if bough.bough_advance(simulation, 0.001 * (k + 1), None) != 0:
        sys.exit(bough.bough_last_message(simulation).decode())
bough.bough_stop(simulation)
bough.bough_unload(model)
