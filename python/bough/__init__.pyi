# Types of the package; what each does is said in __init__.py and docs/python.md.
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from . import reader as reader
from ._bough import ComputationError as ComputationError
from ._bough import Event as Event
from ._bough import Failure as Failure
from ._bough import FlexBody as FlexBody
from ._bough import InputError as InputError
from ._bough import LinearModel as LinearModel
from ._bough import Locator as Locator
from ._bough import MassIntegrals as MassIntegrals
from ._bough import Message as Message
from ._bough import Modes as Modes
from ._bough import Results as Results
from ._bough import Warning as Warning
from ._bough import read_flex_body as read_flex_body
from ._bough import read_linear_model as read_linear_model
from ._bough import read_modes as read_modes
from ._bough import read_results as read_results
from ._bough import _Read, verbs as verbs

__version__: str

_Path = str | PathLike[str]
_Array = NDArray[np.float64]
_Numbers = float | Sequence[float] | _Array

class _Law(Protocol):
    """A controller with states or memory; only outputs must be there."""
    def outputs(self, t: float, u: _Array, z: _Array, d: _Array) -> _Numbers: ...

_Controller = Callable[[float, _Array], _Numbers] | _Law

def call(*words: object) -> int: ...
def reduce(file: _Path = "", *, modes: int | None = ..., max_hz: float | None = ...,
           interface: Sequence[int] | None = ..., free: bool | None = ..., full: bool | None = ...,
           name: str | None = ..., mass: str | None = ..., integrals: str | None = ...,
           origin: Sequence[float] | None = ..., damping: float | None = ..., subcase: int | None = ...,
           loads: str | Sequence[str] = ..., recover: str | Sequence[str] = ..., ignore: str | Sequence[str] = ...,
           matrices: _Path | Sequence[_Path] = ..., strain_energy: bool = ...,
           loads_deck: _Path = ..., loads_set: int = ..., solver: str = ...,
           progress: Callable[[str], object] | None = ...) -> FlexBody: ...
def modes(deck: _Path, number: int | None = None, *, min_hz: float | None = None, max_hz: float | None = None,
          buckling: bool = False, no_check: bool = False, solver: str = "", energies: bool = False, meffmass: int = 0,
          subcase: int = 0, free: bool = False, mass: str = "deck", ignore: str | Sequence[str] = (),
          f06: _Path = "", op2: _Path = "", progress: Callable[[str], object] | None = None) -> Modes: ...
def static(deck: _Path, *, subcase: int = 0, free: bool = False, mass: str = "deck", ignore: str | Sequence[str] = (),
           grid_forces: str | int | Sequence[str | int] = (), linear: bool = False, nonlinear: bool = False,
           increments: int = 10, arc_length: bool = False, strains: bool = False, extremes: bool = False, f06: _Path = "",
           op2: _Path = "", progress: Callable[[str], object] | None = None) -> reader.File: ...
def matrices(deck: _Path, *, loads: int | Sequence[int] = (), no_kg: bool = False, subcase: int = 0,
             free: bool = False, mass: str = "deck", ignore: str | Sequence[str] = (),
             progress: Callable[[str], object] | None = None) -> reader.File: ...
def frequency(deck: _Path, *, grids: int | Sequence[int] = ..., direct: bool = ..., modal: bool = ...,
              number: int = ..., max_hz: float | None = ..., no_residuals: bool = ..., subcase: int = ...,
              free: bool = ..., mass: str = ..., ignore: str | Sequence[str] = ..., csv: _Path = ...,
              punch: _Path = ..., f06: _Path = ..., op2: _Path = ...,
              progress: Callable[[str], object] | None = ...) -> reader.File: ...
def transient(deck: _Path, *, grids: int | Sequence[int] = ..., direct: bool = ..., modal: bool = ...,
              number: int = ..., max_hz: float | None = ..., no_residuals: bool = ..., subcase: int = ...,
              free: bool = ..., mass: str = ..., ignore: str | Sequence[str] = ..., linear: bool = ...,
              csv: _Path = ..., punch: _Path = ..., f06: _Path = ..., op2: _Path = ...,
              progress: Callable[[str], object] | None = ...) -> reader.File: ...
def split(deck: _Path, *, parts: int = 0, along: str = "path", planes: str | Sequence[str] = (),
          elements: str | Sequence[str] = (), grids: int | Sequence[int] = (), interface: str = "rigid",
          name: str = "", modes: int = 10, check: bool = True, subcase: int = 0, ignore: str | Sequence[str] = (),
          progress: Callable[[str], object] | None = None) -> dict[str, Any]: ...
def init(deck: _Path, folder: _Path = "", *, hinge: int = 0) -> dict[str, str]: ...
def select(body: FlexBody | _Path, system: _Path | Sequence[_Path] | None = None, *,
           inputs: str | int | Sequence[str | int] = (), outputs: str | int | Sequence[str | int] = (),
           weight: str | Sequence[str] = (), spectrum: _Path = "", number: int = 0, tolerance: float | None = None,
           below: float = 0.0, keep: int | str | Sequence[int | str] = (), damping: float = 0.01,
           at: float | Sequence[float] = (), equilibrium: bool = False, open: bool = False, exchange: bool = False,
           set: str | Sequence[str] = (), parameters: Mapping[str, float] | None = None,
           progress: Callable[[str], object] | None = None) -> tuple[Any, dict[str, Any]]: ...
def check(file: _Path, *, parameters: Mapping[str, float] | None = None, subcase: int = 0, free: bool = False,
          mass: str = "deck", ignore: str | Sequence[str] = ()) -> dict[str, Any]: ...
def compare(*files: _Path | FlexBody, mass: _Path = "", refinement: bool = False, test: _Path = "", deck: _Path = "",
            tam: str = "serep", sensors: int = 0, progress: Callable[[str], object] | None = None) -> dict[str, Any]: ...
def edit(file: _Path, commands: str | Sequence[str], output: _Path = "") -> dict[str, Any]: ...
def info(file: _Path) -> dict[str, Any]: ...
def export(file: _Path, to: str, output: _Path = "", *, channels: str | Sequence[str] = (), ascii: bool = False,
           moving: bool = False, fields: str = "large", ignore: str | Sequence[str] = (), every: int = 1,
           window: Sequence[float] = (), scale: float = 1.0, follow: str = "", bodies: _Path | Sequence[_Path] = (),
           parameters: Mapping[str, float] | None = None, units: str = "", fmi: int = 3,
           id: int = 0, inertia: str = "6x1", ge_order: str = "mode", digits: int = 17, unit: int = 0,
           vendor: str = "nx", first_point: int = 0) -> str | bytes: ...
def plot(files: _Path | Sequence[_Path], sensors: str | Sequence[str] = (), *, labels: str | Sequence[str] = (),
         points: _Path | Sequence[_Path] = (), title: str = "", x_label: str = "", y_label: str = "", kind: str = "",
         x: str = "", psd: bool = False, spectrum: bool = False, difference: bool = False, subplots: bool = False,
         srs: str = "", output: _Path = "", inputs: str | Sequence[str] = (), outputs: str | Sequence[str] = (),
         per_rev: int = 0, window: Sequence[float] = (), segment: int = 256, srs_part: str = "maximax",
         srs_range: Sequence[float] = (), q: float = 10.0, log_x: bool = False, log_y: bool = False,
         y_min: float | None = None, y_max: float | None = None) -> dict[str, Any]: ...
def report(files: _Path | Sequence[_Path], output: _Path = "", *, channels: str | Sequence[str] = (), title: str = "",
           progress: Callable[[str], object] | None = None) -> str: ...
def flx(bodies: _Path | Sequence[_Path], output: _Path = "", *, body_ids: int | Sequence[int] = 1,
        integrals: str = "", modopt: int = 0, digits: int = 9, special_nodes: bool = False,
        stiffening: bool = False) -> str: ...
def read_flx(file: _Path) -> list[dict[str, Any]]: ...
def integrals(model: _Path, matrices: _Path, *, integrals: str = "momentum", digits: int = 9,
              inertial_loads: bool = False) -> dict[str, Any]: ...
def convert(file: _Path, output: _Path, units: str = "", *, radians: bool = False) -> dict[str, str] | FlexBody: ...
def run(file: _Path, output: _Path = "", *, parameters: Mapping[str, float] | None = None, start_from: _Path = "",
        resume: bool = False, progress: Callable[[float, float], bool | None] | None = None) -> dict[str, Any]: ...
def batch(campaign: _Path, output: _Path = "", *, jobs: int = 0, shard: str = "", time_limit: float = 0.0,
          retry: bool = False, restart: bool = False,
          progress: Callable[[int, int], object] | None = None) -> dict[str, Any]: ...
def response(file: _Path, *, inputs: str | Sequence[str] = (), outputs: str | Sequence[str] = (), from_hz: float = 0.0,
             to_hz: float = 0.0, points: int = 0, loop: bool = False,
             psd: str | float | Sequence[str | float] = (), budget: _Path | None = None) -> dict[str, Any]: ...
def equilibrium(file: _Path, *, parameters: Mapping[str, float] | None = None) -> dict[str, Any]: ...

class System:
    def __init__(self, file: _Path, *, controllers: dict[str, _Controller] | None = None,
                 bodies: dict[str, FlexBody] | None = None, parameters: Mapping[str, float] | None = None,
                 start_from: _Path = "") -> None: ...
    @classmethod
    def from_text(cls, text: str, folder: _Path = ".", *, name: str = "<text>",
                  controllers: dict[str, _Controller] | None = None, bodies: dict[str, FlexBody] | None = None,
                  parameters: Mapping[str, float] | None = None, start_from: _Path = "") -> System: ...
    bodies: _Read[list[str]]
    messages: _Read[list[Message]]
    def run(self, output: _Path | None = None,
            progress: Callable[[float, float], bool | None] | None = None) -> Results: ...
    def linearize(self, *, at: float | None = None, equilibrium: bool = False, open: bool = False,
                  inputs: str | Sequence[str] = (), outputs: str | Sequence[str] = (),
                  uncertain: Mapping[str, tuple[float, float]] | None = None) -> LinearModel: ...

class Simulation:
    def __init__(self, system: System, *, integrator: str = "", step: float = 0.0, relative_tolerance: float = 0.0,
                 absolute_tolerance: float = 0.0, duration: float = 0.0) -> None: ...
    inputs: _Read[list[str]]
    output_names: _Read[list[str]]
    time: _Read[float]
    reason: _Read[str]
    messages: _Read[list[Message]]
    def set(self, name: int | str, value: float) -> None: ...
    def advance_to(self, t: float) -> bool: ...
    def output(self, name: int | str) -> float: ...
    def outputs(self, names: str | Sequence[str] | None = None) -> _Array: ...
    def save(self) -> bytes: ...
    def restore(self, state: bytes) -> None: ...
