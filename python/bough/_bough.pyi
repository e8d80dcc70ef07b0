# Types of the compiled module. Arrays are views of the object's own numbers (docs/python.md).
from collections.abc import Callable, Iterator, Sequence
from os import PathLike
from typing import Any, Generic, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int32]
Complex = NDArray[np.complex128]

__version__: str

_T_co = TypeVar("_T_co", covariant=True)

class _Read(Generic[_T_co]):
    """Type of a property that can only be read."""
    @overload
    def __get__(self, owner: None, kind: type, /) -> _Read[_T_co]: ...
    @overload
    def __get__(self, owner: object, kind: type | None = None, /) -> _T_co: ...

class Message:
    """What went wrong, where, and what to do about it."""
    severity: _Read[str]
    id: _Read[str]
    file: _Read[str]
    line: _Read[int]
    column: _Read[int]
    what: _Read[str]
    advice: _Read[str]

class Failure(RuntimeError):
    """What Bough raises; .messages has every one."""
    messages: list[Message]
    exit_code: int

class InputError(Failure):
    """The input is wrong."""

class ComputationError(Failure):
    """The computation failed: singular, diverged, not converged."""

class Exclusive:
    """with Exclusive(): no other thread is within MPI, PETSc or HDF5."""
    def __init__(self) -> None: ...
    def __enter__(self) -> Exclusive: ...
    def __exit__(self, *args: Any) -> None: ...

class Warning(UserWarning):
    """A warning of Bough."""

class MassIntegrals:
    """The five mass integrals; column j belongs to mode j."""
    gamma0: _Read[Array]
    gamma1: _Read[Array]
    gamma2: _Read[list[Array]]
    gamma3: _Read[list[Array]]
    gamma4: _Read[list[list[Array]]]
    def __bool__(self) -> bool: ...

class Locator:
    """A unit load whose geometric stiffness the body has."""
    name: _Read[str]
    node: _Read[int]
    direction: _Read[int]

class FlexBody:
    """A reduced flexible body; its arrays are views, nothing is copied."""
    name: str
    mass: float
    source: _Read[list[tuple[str, str]]]
    cg: _Read[Array]
    inertia: _Read[Array]
    node_id: _Read[list[int]]
    node_xyz: _Read[Array]
    interface_nodes: _Read[list[int]]
    is_free_free: _Read[bool]
    frequency_hz: _Read[Array]
    eigenvalue: _Read[Array]
    kind: _Read[list[str]]
    phi: _Read[list[Array]]
    modal_mass: _Read[Array]
    modal_stiffness: _Read[Array]
    modal_damping: _Read[Array]
    effective_mass: _Read[Array]
    lumped: _Read[MassIntegrals]
    consistent: _Read[MassIntegrals]
    exact: _Read[MassIntegrals]
    integrals_method: _Read[str]
    integrals: _Read[MassIntegrals]
    inertial_loads: _Read[Array]
    dof_map: _Read[Integers]
    kg_inertial: _Read[list[Array]]
    kg_inertial_computed: _Read[list[bool]]
    locators: _Read[list[Locator]]
    kg_external: _Read[list[Array]]
    external_load: _Read[Array]
    preload: _Read[str]
    kg_preload: _Read[Array]
    full_phi: _Read[Array]
    num_modes: _Read[int]
    num_nodes: _Read[int]
    def copy(self) -> FlexBody: ...
    def save(self, path: str | PathLike[str]) -> None:
        """Write the flexible-body HDF5 file."""

class Modes:
    """Normal modes or load factors of a deck."""
    subcase: _Read[int]
    node_id: _Read[list[int]]
    node_xyz: _Read[Array]
    eigenvalue: _Read[Array]
    frequency_hz: _Read[Array]
    load_factor: _Read[Array]
    residual: _Read[Array]
    phi: _Read[list[Array]]
    modal_mass: _Read[Array]
    effective_mass: _Read[Array]
    mass: _Read[float]
    cg: _Read[Array]
    inertia: _Read[Array]
    num_rigid_modes: _Read[int]

class LinearModel:
    """x' = A x + B u, y = C x + D u about an operating point."""
    A: _Read[Array]
    B: _Read[Array]
    C: _Read[Array]
    D: _Read[Array]
    second_order: _Read[tuple[Array, Array, Array, Array, Array] | None]
    states: _Read[list[str]]
    inputs: _Read[list[str]]
    outputs: _Read[list[str]]
    uncertainty: _Read[list[tuple[str, float, float, int]]]
    """(name, value at delta -1, value at delta 1, number of inputs w and outputs z), which come first."""
    def close(self, delta: Sequence[float]) -> LinearModel:
        """The model with w = delta z closed, one value in [-1, 1] per parameter; UserWarning outside."""
    time: _Read[float]
    q: _Read[Array]
    u: _Read[Array]
    residual: _Read[float]
    error: _Read[float]
    poles: _Read[Complex]
    pole_frequency_hz: _Read[Array]
    pole_damping: _Read[Array]
    pole_mode: _Read[list[str]]
    zeros: _Read[Complex | None]
    def save(self, path: str | PathLike[str]) -> None:
        """Write the linear-model HDF5 file."""

class Event:
    """A line of /events: what happened, and when."""
    time: _Read[float]
    what: _Read[str]

class Results:
    """Samples of a run: results["/sensors/tip"] or results["tip"]: nt of one component, nt x components of
    several."""
    def __getitem__(self, name: str, /) -> Array: ...
    def __contains__(self, name: str, /) -> bool: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def keys(self) -> list[str]: ...
    def describe(self, name: str, /) -> str: ...
    time: _Read[Array]
    events: _Read[list[Event]]
    completed: _Read[bool]
    reason: _Read[str]
    energy_error: _Read[float]
    messages: _Read[list[Message]]

class Simulation:
    """A system that is advanced from Python."""
    def set(self, name: int | str, value: float) -> None: ...
    def advance_to(self, t: float) -> bool: ...
    def outputs(self, names: Sequence[str] | None) -> Array: ...
    def output(self, name: int | str) -> float: ...
    inputs: _Read[list[str]]
    output_names: _Read[list[str]]
    time: _Read[float]
    reason: _Read[str]
    messages: _Read[list[Message]]
    def save(self) -> bytes: ...
    def restore(self, state: bytes) -> None: ...

class System:
    def __init__(self, file: str, controllers: dict[str, Any], bodies: dict[str, FlexBody], set: Sequence[str],
                 start_from: str, text: str | None) -> None: ...
    bodies: _Read[list[str]]
    messages: _Read[list[Message]]
    def run(self, output: str, progress: Callable[[float, float], bool | None] | None) -> Results: ...
    def start(self, integrator: str, step: float, relative_tolerance: float, absolute_tolerance: float,
              duration: float) -> Simulation: ...
    def linearize(self, at: float | None, equilibrium: bool, open: bool, inputs: Sequence[str],
                  outputs: Sequence[str], uncertain: Sequence[str]) -> tuple[LinearModel, list[Message]]: ...

def read_flex_body(path: str | PathLike[str]) -> FlexBody: ...
def read_modes(path: str | PathLike[str]) -> Modes: ...
def read_results(path: str | PathLike[str]) -> Results: ...
def read_linear_model(path: str | PathLike[str]) -> LinearModel: ...
def reduce(file: str = "", *, modes: int | None = None, max_hz: float | None = None,
           interface: Sequence[int] | None = None, free: bool | None = None, full: bool | None = None,
           name: str | None = None, mass: str | None = None, integrals: str | None = None,
           origin: Sequence[float] | None = None, damping: float | None = None, subcase: int | None = None,
           loads: Sequence[str] = [], recover: Sequence[str] = [], ignore: Sequence[str] = [],
           matrices: Sequence[str] = [], strain_energy: bool = False, loads_deck: str = "",
           loads_set: int = 101, solver: str = "",
           progress: Callable[[str], object] | None = None) -> tuple[FlexBody, list[Message]]: ...
def modes(deck: str, number: int | None = None, *, min_hz: float | None = None, max_hz: float | None = None,
          buckling: bool = False, no_check: bool = False, solver: str = "", energies: bool = False, meffmass: int = 0,
          subcase: int = 0, free: bool = False, mass: str = "deck", ignore: Sequence[str] = [], f06: str = "",
          op2: str = "", progress: Callable[[str], object] | None = None) -> tuple[Modes, list[Message]]: ...
def static(deck: str, *, subcase: int = 0, free: bool = False, mass: str = "deck", ignore: Sequence[str] = [],
           grid_forces: Sequence[str] = [], linear: bool = False, nonlinear: bool = False, increments: int = 10,
           arc_length: bool = False, strains: bool = False, extremes: bool = False, f06: str = "", op2: str = "",
           progress: Callable[[str], object] | None = None) -> tuple[bytes, list[Message]]: ...
def matrices(deck: str, *, loads: Sequence[int] = [], no_kg: bool = False, subcase: int = 0, free: bool = False,
             mass: str = "deck", ignore: Sequence[str] = [],
             progress: Callable[[str], object] | None = None) -> tuple[bytes, list[Message]]: ...
def solve_response(deck: str, is_over_time: bool, *, grids: Sequence[int] = [], direct: bool = False,
                   modal: bool = False, number: int = 0, max_hz: float | None = None, no_residuals: bool = False,
                   subcase: int = 0, free: bool = False, mass: str = "deck", ignore: Sequence[str] = [],
                   linear: bool = False, csv: str = "", punch: str = "", f06: str = "", op2: str = "",
                   progress: Callable[[str], object] | None = None) -> tuple[bytes, list[Message]]: ...
def split(deck: str, *, parts: int = 0, along: str = "path", planes: Sequence[str] = [], elements: Sequence[str] = [],
          grids: Sequence[int] = [], interface: str = "rigid", name: str = "", modes: int = 10, check: bool = True,
          subcase: int = 0, ignore: Sequence[str] = [],
          progress: Callable[[str], object] | None = None) -> tuple[dict[str, Any], list[Message]]: ...
def init(deck: str, *, folder: str = "", hinge: int = 0) -> tuple[dict[str, str], list[Message]]: ...
def select(file: str, body: FlexBody | None, *, systems: Sequence[str] = [], inputs: Sequence[str] = [],
           outputs: Sequence[str] = [], weight: Sequence[str] = [], spectrum: str = "", number: int = 0,
           tolerance: float | None = None, below: float = 0.0, keep: Sequence[str] = [], damping: float = 0.01,
           at: Sequence[float] = [], equilibrium: bool = False, open: bool = False, exchange: bool = False,
           set: Sequence[str] = [],
           progress: Callable[[str], object] | None = None) -> tuple[Any, dict[str, Any], list[Message]]: ...
def check(file: str, *, set: Sequence[str] = [], subcase: int = 0, free: bool = False, mass: str = "deck",
          ignore: Sequence[str] = []) -> tuple[dict[str, Any], list[Message]]: ...
def compare(files: Sequence[str], *, mass: str = "", refinement: bool = False, test: str = "", deck: str = "",
            tam: str = "serep", sensors: int = 0, progress: Callable[[str], object] | None = None) -> tuple[dict[str, Any], list[Message]]: ...
def compare_body(body: FlexBody) -> dict: ...
def edit(file: str, commands: Sequence[str],
         output: str = "") -> tuple[str, str, bool, list[Message]]: ...
def info(file: str) -> dict: ...
def export(file: str, to: str, output: str = "", *, channels: Sequence[str] = [], ascii: bool = False,
           moving: bool = False, fields: str = "large", ignore: Sequence[str] = [], every: int = 1,
           window: Sequence[float] = [], scale: float = 1.0, follow: str = "", bodies: Sequence[str] = [],
           set: Sequence[str] = [], units: str = "", fmi: int = 3,
           id: int = 0, inertia: str = "6x1", ge_order: str = "mode", digits: int = 17, unit: int = 0,
           vendor: str = "nx", first_point: int = 0) -> tuple[bytes, int, list[Message]]: ...
def plot(files: Sequence[str], sensors: Sequence[str] = [], *, labels: Sequence[str] = [], points: Sequence[str] = [],
         title: str = "", x_label: str = "", y_label: str = "", kind: str = "", x: str = "", psd: bool = False,
         spectrum: bool = False, difference: bool = False, subplots: bool = False,
         srs: str = "", output: str = "", inputs: Sequence[str] = [], outputs: Sequence[str] = [], per_rev: int = 0,
         window: Sequence[float] = [], segment: int = 256, srs_part: str = "maximax",
         srs_range: Sequence[float] = [], q: float = 10.0, log_x: bool = False, log_y: bool = False,
         y_min: float | None = None, y_max: float | None = None) -> tuple[list[dict[str, Any]], str, str, list[Message]]: ...
def report(files: Sequence[str], output: str = "", *, channels: Sequence[str] = [], title: str = "",
           progress: Callable[[str], object] | None = None) -> tuple[str, list[Message]]: ...
def flx(bodies: Sequence[str], output: str = "", *, body_ids: Sequence[int] = [1], integrals: str = "",
        modopt: int = 0, digits: int = 9, special_nodes: bool = False, stiffening: bool = False) -> tuple[str, list[dict[str, Any]]]: ...
def read_flx(file: str) -> list[dict[str, Any]]: ...
def integrals(model: str, matrices: str, *, integrals: str = "momentum", digits: int = 9,
              inertial_loads: bool = False) -> tuple[dict[str, Any], list[Message]]: ...
def convert(file: str, output: str, *, units: str = "",
            radians: bool = False) -> tuple[dict[str, str], FlexBody | None, int, list[Message]]: ...
def run(file: str, output: str = "", *, start_from: str = "", set: Sequence[str] = [], resume: bool = False,
        progress: Callable[[float, float], bool | None] | None = None) -> tuple[dict[str, Any], list[Message]]: ...
def batch(campaign: str, output: str = "", *, jobs: int = 0, shard: str = "", time_limit: float = 0.0,
          retry: bool = False, restart: bool = False,
          progress: Callable[[int, int], object] | None = None) -> tuple[dict[str, Any], list[Message]]: ...
def response(file: str, *, inputs: Sequence[str] = [], outputs: Sequence[str] = [], from_hz: float = 0.0,
             to_hz: float = 0.0, points: int = 0, loop: bool = False,
             psd: Sequence[str] = []) -> tuple[dict[str, Any], list[Message]]: ...
def budget(file: str, sources: str, *, outputs: Sequence[str] = [], from_hz: float = 0.0,
           to_hz: float = 0.0) -> tuple[dict[str, Any], list[Message]]: ...
def equilibrium(file: str, *, set: Sequence[str] = []) -> tuple[dict[str, Any], list[Message]]: ...
def call(words: Sequence[str]) -> int: ...
def verbs() -> list[str]: ...
