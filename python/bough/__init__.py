"""Bough from Python: Nastran decks to modes and flexible bodies, multibody systems to time histories and linear models.

    import bough
    body = bough.reduce("boom.toml")            # FlexBody: its arrays are views
    system = bough.System("spinup.toml", bodies={"boom.h5": body})
    results = system.run()
    results.time, results["tip_deflection"]

What is wrong with an input is raised as bough.InputError, a computation that fails as bough.ComputationError; both have
`messages`, each with file, line, what is wrong and what to do. Warnings are Python warnings (bough.Warning).
"""
import contextlib as _contextlib
import io as _io
import os as _os
import sys as _sys

from . import reader

try:
    from ._bough import (ComputationError, Event, Failure, FlexBody, InputError, LinearModel, Locator, MassIntegrals,
                         Message, Modes, Results, Warning, __version__, read_flex_body, read_linear_model, read_modes,
                         read_results, verbs)
    from . import _bough
except ImportError as _missing:  # bough.reader does without
    class _Missing:
        """In place of the compiled module: every use of it is an ImportError."""

        def __init__(self, reason):
            self._reason = reason

        def __getattr__(self, name):
            raise ImportError(f"bough.{name} needs the compiled module bough._bough, which cannot be loaded "
                              f"({self._reason}); ./dev demo or ./dev build makes it, for this Python at "
                              "PYTHONPATH=build/python; bough.reader reads files without it", name="bough._bough")

    _bough = _Missing(str(_missing))

    def __getattr__(name):
        if name in __all__ or name == "__version__":
            return getattr(_bough, name)
        raise AttributeError(f"module 'bough' has no attribute {name!r}")

__all__ = ["ComputationError", "Event", "Failure", "FlexBody", "InputError", "LinearModel", "Locator", "MassIntegrals",
           "Message", "Modes", "Results", "Simulation", "System", "Warning", "batch", "call", "check", "compare",
           "convert", "edit", "equilibrium", "export", "flx", "frequency", "info", "init", "integrals", "matrices", "modes",
           "plot", "read_flex_body", "read_flx", "read_linear_model", "read_modes", "read_results", "reader", "reduce",
           "report", "response", "run", "select", "split", "static", "transient", "verbs"]


def call(*words):
    """One command line in this process, as from the shell; the exit code.

    call("modes", "boom.bdf", "-n", 3) prints its table. Messages go to stderr.
    """
    _sys.stdout.flush()
    with _bough.Exclusive(), _worker_launcher():
        return _bough.call([str(word) for word in words])


@_contextlib.contextmanager
def _worker_launcher():
    """Workers of `batch` are separate processes: how each comes into this module again, a word a line."""
    name, before = "BOUGH_WORKER_LAUNCHER", _os.environ.get("BOUGH_WORKER_LAUNCHER")
    code = "import sys; sys.path.insert(0, sys.argv[1]); import bough; sys.exit(bough.call(*sys.argv[2:]))"
    folder = _os.path.dirname(_os.path.dirname(_os.path.abspath(__file__)))
    _os.environ[name] = "\n".join([_sys.executable, "-c", code, folder])
    try:
        yield
    finally:
        if before is None:
            del _os.environ[name]
        else:
            _os.environ[name] = before


def _list(words):
    """The words of an option that may be repeated: a list, an array, or one alone."""
    if words is None:
        return []
    if hasattr(words, "tolist"):  # of NumPy: Python's own numbers
        words = words.tolist()
    is_alone = isinstance(words, (str, bytes, _os.PathLike)) or not hasattr(words, "__iter__")
    return [words] if is_alone else list(words)


def reduce(file="", **options):
    """A body file (.toml) or a Nastran deck becomes a FlexBody, with modes, mass integrals and geometric stiffness.

    Options, each instead of that of the file: modes, max_hz, interface=[node, ...], free, full, name, mass ("deck",
    "lumped", "consistent"), integrals ("exact", ...), origin, damping, subcase, solver; in addition to those of the
    file: loads=["41:2", "tip=41:123", "set:7", "temperature:8"], ignore=[card, ...], recover=[kind, ...],
    strain_energy, matrices=["model.op4", "K=k.mtx"] of another program, with which the file may be missing. Words that
    are alone need no list. loads_deck: file of the twelve inertial loads as cards for another FE program, in load sets
    from loads_set on; compare(body) is the report of the mass integrals. progress(stage) is called on the way.
    """
    if "loads_deck" in options:
        options["loads_deck"] = _os.fspath(options["loads_deck"])
    for name in ("loads", "recover", "ignore", "matrices"):
        if name in options:
            options[name] = [str(word) for word in _list(options[name])]
    for name in ("interface", "origin"):
        if options.get(name) is not None:
            options[name] = _list(options[name])
    body, _ = _bough.reduce(_os.fspath(file), **options)
    return body


def modes(deck, number=None, *, min_hz=None, max_hz=None, buckling=False, no_check=False, solver="", energies=False,
          meffmass=0, subcase=0, free=False, mass="deck", ignore=(), f06="", op2="", progress=None):
    """Normal modes (or with buckling=True load factors) of a deck as Modes; options as of `bough modes`.

    Of several subcases those of the first, or of `subcase`. f06, op2: files of the deck's output requests, in Nastran's
    order, of all subcases. progress(stage) is called on the way.
    """
    found, _ = _bough.modes(_os.fspath(deck), number, min_hz=min_hz, max_hz=max_hz, buckling=buckling,
                            no_check=no_check, solver=solver, energies=energies, meffmass=meffmass, subcase=subcase,
                            free=free, mass=mass, ignore=_list(ignore), f06=_os.fspath(f06), op2=_os.fspath(op2),
                            progress=progress)
    return found


def static(deck, *, subcase=0, free=False, mass="deck", ignore=(), grid_forces=(), linear=False, nonlinear=False,
           increments=10, arc_length=False, strains=False, extremes=False, f06="", op2="", progress=None):
    """Static solutions of a deck, as reader.File in memory: displacements, reactions, element forces by path.

    Options as of `bough static`; grid_forces="all" or ids; f06, op2: files of the deck's output requests.
    """
    image, _ = _bough.static(_os.fspath(deck), subcase=subcase, free=free, mass=mass, ignore=_list(ignore),
                             grid_forces=[str(word) for word in _list(grid_forces)], linear=linear,
                             nonlinear=nonlinear, increments=increments, arc_length=arc_length, strains=strains,
                             extremes=extremes, f06=_os.fspath(f06), op2=_os.fspath(op2), progress=progress)
    return _read_image(deck, image)


def _read_image(deck, image):
    """Arrays of the file, given as bytes, that a command would write for the deck."""
    with _bough.Exclusive():  # the reader uses the same HDF5
        return reader.File(_os.fspath(deck), _io.BytesIO(image))


def matrices(deck, *, loads=(), no_kg=False, subcase=0, free=False, mass="deck", ignore=(), progress=None):
    """Stiffness, mass, damping and geometric stiffness of a deck before constraints, as reader.File in memory.

    found["dof_map"] has a row (node, component) for each dof; found["K/data"], found["K/indices"], found["K/indptr"]
    are what scipy.sparse.csr_matrix takes; M, B, KG/LOAD_7 likewise. Options as of `bough matrices`.
    """
    image, _ = _bough.matrices(_os.fspath(deck), loads=_list(loads), no_kg=no_kg, subcase=subcase, free=free, mass=mass,
                               ignore=_list(ignore), progress=progress)
    return _read_image(deck, image)


def frequency(deck, **options):
    """Frequency and random response of a deck (SOL 108, 111) as reader.File in memory: curves by path.

    Options as of `bough frequency`: grids=[41, ...], direct, modal, number, max_hz, no_residuals, subcase, free, mass,
    ignore; csv, punch: files of the curves; f06, op2: files of the deck's output requests.
    found["subcases/1/displacement/real"] has a row per frequency and a column per row of its "dofs".
    """
    return _solve_response(deck, False, options)


def transient(deck, **options):
    """Transient response of a deck (SOL 109, 112) as reader.File in memory; options and paths as of `frequency`.

    linear: a deck of nonlinear transient response (SOL 129, 99, 159) is solved linearly.
    found["subcases/1/displacement/value"] has a row per time.
    """
    return _solve_response(deck, True, options)


def _solve_response(deck, is_over_time, options):
    for name in ("grids", "ignore"):
        if name in options:
            options[name] = _list(options[name])
    if "linear" in options and not is_over_time:
        raise TypeError("frequency() has no option linear; transient() has")
    for name in ("csv", "punch", "f06", "op2"):
        if name in options:
            options[name] = _os.fspath(options[name])
    image, _ = _bough.solve_response(_os.fspath(deck), is_over_time, **options)
    return _read_image(deck, image)


def split(deck, *, parts=0, along="path", planes=(), elements=(), grids=(), interface="rigid", name="", modes=10,
          check=True, subcase=0, ignore=(), progress=None):
    """A deck cut into several bodies: what `bough split` writes, as a dict; nothing is written.

    "files": {name: text} of a deck and a body file for each part, the system file last; "parts": a dict each with name,
    parent, node, joined_grids, elements, grids, mass and (with check) its reduced "body"; "frequencies": (of the deck,
    of the parts) in Hz; "deflections": (static load, largest deflection, error of the parts); "mass". Cut by one of parts, planes=["x=2.5"], elements=["property:3", "1-200"], grids=[11, 21].
    """
    found, _ = _bough.split(_os.fspath(deck), parts=parts, along=along, planes=_words(planes),
                            elements=_words(elements), grids=_list(grids), interface=interface, name=name, modes=modes,
                            check=check, subcase=subcase, ignore=_list(ignore), progress=progress)
    return found


def init(deck, folder="", *, hinge=0):
    """A body file and a system file to begin with, {name: text}, for a deck; nothing is written.

    folder: where they will be, from which they name the deck; empty: here. hinge: a grid that is to turn.
    """
    texts, _ = _bough.init(_os.fspath(deck), folder=_os.fspath(folder), hinge=hinge)
    return texts


def select(body, system=None, *, inputs=(), outputs=(), weight=(), spectrum="", number=0, tolerance=None, below=0.0,
           keep=(), damping=0.01, at=(), equilibrium=False, open=False, exchange=False, set=(), parameters=None,
           progress=None):
    """(FlexBody with the modes that count, ranking as a dict); options as of `bough select`.

    With a system file as `body` the modes of all its flexible bodies are ranked together, and a dict of the smaller
    bodies by name is the first of the two.

    parameters: {"kp": 4.0}, numbers of [parameters] of the systems; set: the same as words, "kp=4.0".
    body: FlexBody or file; with a system (a file, or a list of them) the file that the system names.
    """
    is_file = isinstance(body, (str, _os.PathLike))
    if not is_file and system:
        raise ValueError("a body of a system is selected by its file: save() it where the system has it")
    file, systems = _os.fspath(body) if is_file else body.name, [_os.fspath(file) for file in _list(system)]
    if is_file and file.lower().endswith(".toml"):
        file, systems = "", [file, *systems]
    small, ranking, _ = _bough.select(
        file, None if is_file else body, systems=systems, inputs=[str(word) for word in _list(inputs)],
        outputs=[str(word) for word in _list(outputs)], weight=_list(weight), spectrum=_os.fspath(spectrum),
        number=number, tolerance=tolerance, below=below, keep=[str(mode) for mode in _list(keep)], damping=damping,
        at=_list(at), equilibrium=equilibrium, open=open, exchange=exchange, set=_list(set) + _make_settings(parameters), progress=progress)
    return small, ranking


def _paths(files):
    return [_os.fspath(file) for file in _list(files)]


def _words(words):
    return [str(word) for word in _list(words)]


def check(file, *, parameters=None, subcase=0, free=False, mass="deck", ignore=()):
    """Content of a deck, body, system, HDF5 or .FLX file as a dict, with every message about it.

    "kind" and what `bough check --json` has of it; "messages" is a list of Message, errors too, "errors" and "warnings"
    are their numbers. Errors are raised only if the file cannot be read.
    """
    found, messages = _bough.check(_os.fspath(file), set=_make_settings(parameters), subcase=subcase, free=free,
                                   mass=mass, ignore=_list(ignore))
    severities = [message.severity for message in messages]
    return {**found, "messages": messages, "errors": severities.count("error"),
            "warnings": severities.count("warning")}


def compare(*files, mass="", refinement=False, test="", deck="", tam="serep", sensors=0, progress=None):
    """Two bodies or modes files, the integrals of one body, or with refinement=True three bodies of finer meshes.

    The one body may be a FlexBody: what `bough reduce --integrals-report` prints.
    test: a universal file; then the modes of the one file against its shapes at the measured DOFs, by the test-analysis
    model tam "serep", "guyan" or "irs" (the last two of `deck`), or its frequency response against measured functions.
    sensors: places for this number of sensors on the one model. Arrays and lists of names by path, as in the file of
    `bough compare -o`: found["mac"], found["cross_orthogonality"], found["functions/frac"], found["dofs"].
    """
    if len(files) == 1 and isinstance(files[0], _bough.FlexBody):
        if mass or refinement or test or deck or sensors:
            raise ValueError("a FlexBody is compared with no other file; save() it for these options")
        return _bough.compare_body(files[0])
    found, _ = _bough.compare(_paths(files), mass=_os.fspath(mass), refinement=refinement, test=_os.fspath(test),
                              deck=_os.fspath(deck), tam=tam, sensors=sensors, progress=progress)
    return found


def edit(file, commands, output=""):
    """A system or body file after the commands of `bough edit`: {"text", "printed", "changed"}.

    commands: a list of lines, or one text: ["set simulation.duration=5", "rename boom mast", "list"]. The first wrong
    line raises InputError, and nothing is written. "printed" is what list, show, diff and help print. The text is
    written where `output` is given, which may be the file itself, or where a line is "save".
    """
    lines = commands.split("\n") if isinstance(commands, str) else [str(line) for line in commands]
    text, printed, changed, _ = _bough.edit(_os.fspath(file), lines, _os.fspath(output))
    return {"text": text, "printed": printed, "changed": changed}


def info(file):
    """Content of a file: "attributes", "objects" with path, shape, type, description, dims, and "events" of a run."""
    return _bough.info(_os.fspath(file))


def export(file, to, output="", *, channels=(), ascii=False, moving=False, fields="large", ignore=(), every=1,
           window=(), scale=1.0, follow="", bodies=(), parameters=None, units="", fmi=3, id=0,
           inertia="6x1", ge_order="mode", digits=17, unit=0, vendor="nx", first_point=0):
    """A file in the format `to` of another program: "csv", "vtu", "bdf", "gltf", ...; options as of `bough export`.

    Gives its text (bytes of gltf, op4 and flat), and writes it where `output` is given. The formats pvd, mat, fmu and
    extseout need an output and give an empty text: they are several files or no text.
    """
    made, _, _ = _bough.export(_os.fspath(file), to, _os.fspath(output), channels=_words(channels), ascii=ascii,
                               moving=moving, fields=fields, ignore=_list(ignore), every=every, window=_list(window),
                               scale=scale, follow=follow, bodies=_paths(bodies), set=_make_settings(parameters),
                               units=units, fmi=fmi, id=id, inertia=inertia, ge_order=ge_order, digits=digits,
                               unit=unit, vendor=vendor, first_point=first_point)
    return made if to in ("gltf", "op4", "flat") else made.decode("utf-8")


def plot(files, sensors=(), *, labels=(), points=(), title="", x_label="", y_label="", kind="", x="", psd=False,
         spectrum=False, difference=False, subplots=False, srs="", output="", inputs=(), outputs=(), per_rev=0,
         window=(), segment=256, srs_part="maximax", srs_range=(), q=10.0, log_x=False, log_y=False, y_min=None,
         y_max=None):
    """Curves of results, campaigns, responses and linear models, as `bough plot` draws them: {"plots", "svg", "csv"}.

    Each of plots has title, x_label, y_label and curves with label, x, y. The SVG is written where `output` is given.
    """
    plots, svg, csv, _ = _bough.plot(_paths(files), _words(sensors), labels=_list(labels), points=_paths(points),
                                     title=title, x_label=x_label, y_label=y_label, kind=kind, x=x, psd=psd,
                                     spectrum=spectrum, difference=difference, subplots=subplots, srs=srs,
                                     output=_os.fspath(output), inputs=_words(inputs), outputs=_words(outputs),
                                     per_rev=per_rev, window=_list(window), segment=segment, srs_part=srs_part,
                                     srs_range=_list(srs_range), q=q, log_x=log_x, log_y=log_y, y_min=y_min,
                                     y_max=y_max)
    return {"plots": plots, "svg": svg, "csv": csv}


def report(files, output="", *, channels=(), title="", progress=None):
    """One HTML page of results, bodies, modes, responses and linear models; written where `output` is given."""
    page, _ = _bough.report(_paths(files), _os.fspath(output), channels=_words(channels), title=title,
                            progress=progress)
    return page


def flx(bodies, output="", *, body_ids=1, integrals="", modopt=0, digits=9, special_nodes=False, stiffening=False):
    """The text of a .FLX file of flexible-body files; written where `output` is given."""
    text, _ = _bough.flx(_paths(bodies), _os.fspath(output), body_ids=_list(body_ids), integrals=integrals,
                         modopt=modopt, digits=digits, special_nodes=special_nodes, stiffening=stiffening)
    return text


def read_flx(file):
    """The bodies of a .FLX file, a dict each: body_id, name, mass, M, K, D, alpha, integrals, node_id, gains, ..."""
    return _bough.read_flx(_os.fspath(file))


def integrals(model, matrices, *, integrals="momentum", digits=9, inertial_loads=False):
    """Mass integrals of given matrices and modes (NASA-CR-202063 4.2.3): as of read_flx(), its text "flx", "dof_map".

    inertial_loads: the twelve inertial loads too, an array num_dofs x 12.
    """
    found, _ = _bough.integrals(_os.fspath(model), _os.fspath(matrices), integrals=integrals, digits=digits,
                                inertial_loads=inertial_loads)
    return found


def convert(file, output, units="", *, radians=False):
    """A deck, system or body file in other units, as {path: text}: `output` and the INCLUDE files; or a FlexBody.

    units="mm-N-tonne:m-kg-s". Nothing is written.
    """
    texts, body, _, _ = _bough.convert(_os.fspath(file), _os.fspath(output), units=units, radians=radians)
    return texts if body is None else body


def run(file, output="", *, parameters=None, start_from="", resume=False, progress=None):
    """The time history of a system file into a results file; what `bough run --json` prints, as a dict.

    output: the system's name with .h5, here. progress(time, end) ends the run with a checkpoint when it returns False.
    System(file).run() keeps the results in memory instead.
    """
    found, _ = _bough.run(_os.fspath(file), _os.fspath(output), start_from=_os.fspath(start_from),
                          set=_make_settings(parameters), resume=resume, progress=progress)
    return found


def batch(campaign, output="", *, jobs=0, shard="", time_limit=0.0, retry=False, restart=False, progress=None):
    """A campaign; what `bough batch --json` prints, as a dict. Cases that fail are in "failed", and raise nothing.

    progress(done, open) is called after each case. Ctrl-C ends it; the same call goes on with the other cases.
    """
    with _worker_launcher():
        found, _ = _bough.batch(_os.fspath(campaign), _os.fspath(output), jobs=jobs, shard=shard,
                                time_limit=time_limit, retry=retry, restart=restart, progress=progress)
    return found


def response(file, *, inputs=(), outputs=(), from_hz=0.0, to_hz=0.0, points=0, loop=False, psd=(), budget=None):
    """Frequency response of a linear-model file: frequency_hz, value (a matrix each), singular_values, peak_gain.

    loop: gain_margins, phase_margins as (frequency, margin), distance, is_stable of negative feedback too.
    psd: spectral densities of the inputs, [1e-4, "motor=1e-3", "wind.csv", "noise.toml"]; then "random" has psd (a
    column for each output), rms, crossing_hz, cumulative_rms, band_rms, band_crossing_hz, total_rms, total_crossing_hz.
    budget: a file of sources; then a pointing budget in place of the response: outputs, sources, from_hz, to_hz,
    tables (weighting, exposure, rms and speed [source, output], total, over_speed[NAME] [speed, output]), speeds[NAME],
    curves of each source (frequency_hz, rms [point, output]: RMS up to each frequency). Speeds in radians.
    """
    if budget is not None:
        if _words(inputs) or points or loop or _words(psd):
            raise TypeError("a budget takes no inputs, points, loop and psd")
        found, _ = _bough.budget(_os.fspath(file), _os.fspath(budget), outputs=_words(outputs), from_hz=from_hz, to_hz=to_hz)
        return found
    found, _ = _bough.response(_os.fspath(file), inputs=_words(inputs), outputs=_words(outputs), from_hz=from_hz,
                               to_hz=to_hz, points=points, loop=loop, psd=_words(psd))
    return found


def equilibrium(file, *, parameters=None):
    """A state of rest, or of steady spin, of a system file: q, hinges by name, residual, iterations, unstable."""
    found, _ = _bough.equilibrium(_os.fspath(file), set=_make_settings(parameters))
    return found


def _make_settings(parameters):
    numbers = {name: value if isinstance(value, int) else float(value) for name, value in (parameters or {}).items()}
    return [f"{name}={value!r}" for name, value in numbers.items()]


def _place(bodies):
    return {_os.fspath(file): body for file, body in (bodies or {}).items()}


def _read_own(name, text):
    """A property of the compiled object, to read only."""
    return property(lambda self: getattr(self._own, name), doc=text)


class System:
    """A multibody system, of a system file or of its text.

    controllers: {"law": f} puts Python in the place of [[controller]] name = "law", which keeps its inputs and its
    sample_time. f(t, u) gives the output (num_outputs of them), or f has outputs(t, u, z, d), derivatives(...),
    update(...), start() with num_outputs, num_states, num_memory, has_feedthrough: see docs/python.md.
    bodies: {"boom.h5": FlexBody}, instead of reading that file. parameters: {"kp": 4.0}, numbers of [parameters].
    """

    def __init__(self, file, *, controllers=None, bodies=None, parameters=None, start_from=""):
        self._own = _bough.System(_os.fspath(file), controllers or {}, _place(bodies), _make_settings(parameters),
                                  _os.fspath(start_from), None)

    @classmethod
    def from_text(cls, text, folder=".", *, name="<text>", controllers=None, bodies=None, parameters=None,
                  start_from=""):
        """The TOML text of a system; files that it names are relative to the folder. Messages call it `name`."""
        folder = _os.fspath(folder)
        system = cls.__new__(cls)
        system._own = _bough.System(name if folder in ("", ".") else _os.path.join(folder, name), controllers or {},
                                    _place(bodies), _make_settings(parameters), _os.fspath(start_from), text)
        return system

    bodies = _read_own("bodies", "Names of the bodies.")
    messages = _read_own("messages", "Notes and warnings of reading it.")

    def run(self, output=None, progress=None):
        """The time history as Results, also written to the HDF5 file `output`.

        progress(time, end) is called at each sample; when it returns False the run stops there. Ctrl-C does too. Other
        Python threads go on meanwhile.
        """
        return self._own.run(_os.fspath(output) if output else "", progress)

    def linearize(self, *, at=None, equilibrium=False, open=False, inputs=(), outputs=(), uncertain=None):
        """A B C D, poles and zeros about the start, a time or the equilibrium, as LinearModel.

        uncertain: {"gain": (4, 6), "boom:eta1:frequency": (0.95, 1.05)}, ranges of parameters and factors on the
        stiffness, frequency or damping of modes; the model then has inputs w and outputs z for w = delta z.
        """
        ranges = [f"{name}={float(low)!r}:{float(high)!r}" for name, (low, high) in (uncertain or {}).items()]
        model, _ = self._own.linearize(at, equilibrium, open, _words(inputs), _words(outputs), ranges)
        return model


class Simulation:
    """A system that is advanced from outside: inputs set, outputs read, its state saved and restored.

    The numbers are those of System.run: bit for bit with rk4 and implicit, whatever times are advanced to. Options that
    are not given are those of the system file. It belongs to one thread at a time.

        simulation = bough.Simulation(bough.System("arm.toml"), step=1e-3)
        while simulation.advance_to(simulation.time + 1e-3):
            simulation.set("torque", -40 * simulation.output("angle"))
        simulation.reason
    """

    def __init__(self, system, *, integrator="", step=0.0, relative_tolerance=0.0, absolute_tolerance=0.0,
                 duration=0.0):
        if not isinstance(system, System):
            raise TypeError(f"expected a bough.System, got {type(system).__name__}; pass bough.System(FILE)")
        self._own = system._own.start(integrator, step, relative_tolerance, absolute_tolerance, duration)

    inputs = _read_own("inputs", "Names of the [[input]]s, in order.")
    output_names = _read_own("output_names", "Names of the components of all channels: sensors (tip:x), controllers, "
                             "actuators, inputs, hinges, others.")
    time = _read_own("time", "Time reached.")
    reason = _read_own("reason", "Why the run has ended; empty while it goes on.")
    messages = _read_own("messages", "Warnings and notes of its start.")

    def set(self, name, value):
        """The value of an input, by name or index, from the present time on; of hold = "linear" at the next time."""
        self._own.set(name, value)

    def advance_to(self, t):
        """Advances to t. False if an event or the duration has ended the run at `time`; `reason` is why."""
        return self._own.advance_to(t)

    def output(self, name):
        """One output at the present time, as a number: by index or as "angle", "tip:x"."""
        return self._own.output(name)

    def outputs(self, names=None):
        """Outputs at the present time as an array: all, or those of `names`, each with all its components.

        `names` is a list of names, or one name.
        """
        if isinstance(names, str):
            names = [names]
        return self._own.outputs(None if names is None else list(names))

    def save(self):
        """The whole state as bytes."""
        return self._own.save()

    def restore(self, state):
        """Goes back to a state that a simulation of an equal system and equal options has saved."""
        self._own.restore(state)
