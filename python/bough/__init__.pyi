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
from ._bough import verbs as verbs

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
           matrices: _Path | Sequence[_Path] = ..., strain_energy: bool = ..., solver: str = ...,
           progress: Callable[[str], object] | None = ...) -> FlexBody: ...
def modes(deck: _Path, number: int | None = None, *, min_hz: float | None = None, max_hz: float | None = None,
          buckling: bool = False, no_check: bool = False, solver: str = "", energies: bool = False, meffmass: int = 0,
          subcase: int = 0, free: bool = False, mass: str = "deck", ignore: str | Sequence[str] = (),
          progress: Callable[[str], object] | None = None) -> Modes: ...
def static(deck: _Path, *, subcase: int = 0, free: bool = False, mass: str = "deck", ignore: str | Sequence[str] = (),
           grid_forces: str | int | Sequence[str | int] = (), linear: bool = False, nonlinear: bool = False,
           increments: int = 10, strains: bool = False, extremes: bool = False,
           progress: Callable[[str], object] | None = None) -> reader.File: ...
def select(body: FlexBody | _Path, system: _Path | Sequence[_Path] | None = None, *,
           inputs: str | int | Sequence[str | int] = (), outputs: str | int | Sequence[str | int] = (),
           weight: str | Sequence[str] = (), spectrum: _Path = "", number: int = 0, tolerance: float | None = None,
           below: float = 0.0, keep: int | Sequence[int] = (), damping: float = 0.01,
           at: float | Sequence[float] = (), equilibrium: bool = False, open: bool = False,
           set: str | Sequence[str] = (),
           progress: Callable[[str], object] | None = None) -> tuple[FlexBody, dict[str, Any]]: ...

class System:
    def __init__(self, file: _Path, *, controllers: dict[str, _Controller] | None = None,
                 bodies: dict[str, FlexBody] | None = None, parameters: Mapping[str, float] | None = None,
                 start_from: _Path = "") -> None: ...
    @classmethod
    def from_text(cls, text: str, folder: _Path = ".", *, name: str = "<text>",
                  controllers: dict[str, _Controller] | None = None, bodies: dict[str, FlexBody] | None = None,
                  parameters: Mapping[str, float] | None = None, start_from: _Path = "") -> System: ...
    @property
    def bodies(self) -> list[str]: ...
    @property
    def messages(self) -> list[Message]: ...
    def run(self, output: _Path | None = None,
            progress: Callable[[float, float], bool | None] | None = None) -> Results: ...
    def linearize(self, *, at: float | None = None, equilibrium: bool = False, open: bool = False,
                  inputs: Sequence[str] = (), outputs: Sequence[str] = ()) -> LinearModel: ...

class Simulation:
    def __init__(self, system: System, *, integrator: str = "", step: float = 0.0, relative_tolerance: float = 0.0,
                 absolute_tolerance: float = 0.0, duration: float = 0.0) -> None: ...
    @property
    def inputs(self) -> list[str]: ...
    @property
    def output_names(self) -> list[str]: ...
    @property
    def time(self) -> float: ...
    @property
    def reason(self) -> str: ...
    @property
    def messages(self) -> list[Message]: ...
    def set(self, name: int | str, value: float) -> None: ...
    def advance_to(self, t: float) -> bool: ...
    def output(self, name: int | str) -> float: ...
    def outputs(self, names: str | Sequence[str] | None = None) -> _Array: ...
    def save(self) -> bytes: ...
    def restore(self, state: bytes) -> None: ...
