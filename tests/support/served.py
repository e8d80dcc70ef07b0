"""Calls of a program that is loaded once (tests/support/served.c); each call is a fork of it before main().

BOUGH_SERVED is the path of served.c as a library; without it, and for a call that changes what is read while the
libraries are loaded, `run` is subprocess.run.
"""
import array
import atexit
import os
import resource
import select
import signal
import socket
import struct
import subprocess
import threading

LIBRARY = os.environ.get("BOUGH_SERVED")
# Variables for the loader, the memory and the threads of libraries.
AT_LOAD = ("LD_", "OMP_", "OPENBLAS_", "GOTO_", "MALLOC_", "GLIBC_", "ASAN_", "POINT_")


class Server:
    """A program that waits before main(), and the socket to it. One call at a time."""

    def __init__(self, path):
        self.path, self.lock = path, threading.Lock()
        self.to, there = socket.socketpair()
        preload = " ".join(filter(None, [LIBRARY, os.environ.get("LD_PRELOAD")]))
        self.process = subprocess.Popen([path], pass_fds=[there.fileno()], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        env={**os.environ, "SERVED_SOCKET": str(there.fileno()), "LD_PRELOAD": preload})
        there.close()

    def close(self):
        self.to.close()
        self.process.wait()

    def call(self, words, cwd, environment, limit, streams, timeout):
        """Exit code as subprocess gives it; None after `timeout`."""
        texts = [os.fsencode(part) for part in (cwd, *words, *(f"{name}={value}" for name, value in environment.items()))]
        if any(b"\0" in part for part in texts):
            raise ValueError("embedded null byte")
        body = b"\0".join([*texts, b""])
        head = struct.pack("=IIIiQ", len(body), len(words), len(environment), *(limit or (-1, 0)))
        rights = array.array("i", [stream.fileno() for stream in streams])
        sent = self.to.sendmsg([head], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, rights)])
        self.to.sendall(head[sent:] + body)
        process = self.receive()
        in_time = select.select([self.to], [], [], timeout)[0]
        if not in_time:
            os.kill(process, signal.SIGKILL)
        code = os.waitstatus_to_exitcode(self.receive())
        return code if in_time else None

    def receive(self):
        data = self.to.recv(4, socket.MSG_WAITALL)
        if len(data) < 4:
            raise RuntimeError(f"{self.path}: the program that waits before main() is gone: {self.process.wait()}")
        return struct.unpack("=i", data)[0]


SERVERS = {}


@atexit.register
def close():
    for (owner, _), server in SERVERS.items():
        if owner == os.getpid():
            server.close()


def get_server(path):
    """Server of this process; a fork of the process starts another."""
    key = (os.getpid(), path)
    if key not in SERVERS:
        SERVERS[key] = Server(path)
    return SERVERS[key]


def start(words, *, text=True, errors="strict", limit=None, **more):
    """subprocess.run with captured streams; `limit` is a pair for setrlimit."""
    apply = limit and (lambda: resource.setrlimit(limit[0], (limit[1], limit[1])))
    return subprocess.run(words, text=text, errors=errors if text else None, capture_output=True, preexec_fn=apply, **more)


def run(command, *, cwd=None, env=None, timeout=None, stdin=None, input=None, text=True, errors="strict", check=False,
        limit=None):
    """Does what `start` does; the streams are files here."""
    words, environment = [os.fspath(word) for word in command], os.environ if env is None else env
    changed = {name for name in {*environment, *os.environ} if environment.get(name) != os.environ.get(name)}
    server = LIBRARY and not any(name.startswith(AT_LOAD) for name in changed) and get_server(os.path.abspath(words[0]))
    if not server or not server.lock.acquire(blocking=False):
        given = {"stdin": stdin} if input is None else {"input": input}
        return start(words, cwd=cwd, env=env, timeout=timeout, text=text, errors=errors, check=check, limit=limit, **given)
    try:
        with open(os.memfd_create("in"), "w+b") as given, open(os.memfd_create("out"), "w+b") as out, \
                open(os.memfd_create("err"), "w+b") as err:
            given.write((input or "").encode() if text else input or b"")
            given.seek(0)
            code = server.call(words, os.path.abspath(cwd or "."), environment, limit, (stdin or given, out, err), timeout)
            captured = []
            for file in (out, err):
                file.seek(0)
                content = file.read()
                captured.append(content.decode(errors=errors).replace("\r\n", "\n").replace("\r", "\n") if text else content)
    finally:
        server.lock.release()
    if code is None:
        raise subprocess.TimeoutExpired(words, timeout, *captured)
    ran = subprocess.CompletedProcess(words, code, *captured)
    if check:
        ran.check_returncode()
    return ran
