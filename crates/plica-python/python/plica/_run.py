"""Runs on disk."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from . import _native
from ._case import Case
from ._native import Run as NativeRun
from ._names import Verdict
from ._optional import require
from ._progress import reporter
from ._state import State

if TYPE_CHECKING:
    import pandas
    import xarray

    from ._stability import Stability
    from .plot import RunPlots

_WHOLE = ("step", "iterations", "cg_iterations", "asymmetry_mode")
"""Columns of whole numbers."""


def _array(name: str, raw: bytes | list[str]) -> Any:
    """Return a column as an array of its own."""
    if isinstance(raw, list):
        return np.asarray(raw, dtype=str)
    return np.frombuffer(raw).astype(np.int64 if name in _WHOLE else np.float64)


class Run:
    """A run directory, complete or not.

    ``run[-1]`` is its last saved state, ``for state in run`` goes through all of them, ``run["energy"]`` is a column of the
    history as an array, and ``run.history`` is the history as a data frame of pandas.
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.path = Path(directory)
        self._opened = _native.Run(os.fspath(directory))
        self._columns: dict[str, tuple[str | None, Any]] | None = None

    @property
    def _native(self) -> NativeRun:
        """The run; opened again while it is being written."""
        if self._opened.verdict == Verdict.RUNNING:
            self._opened = _native.Run(os.fspath(self.path))
            self._columns = None
        return self._opened

    @property
    def columns(self) -> dict[str, Any]:
        """The columns of ``history.csv`` as arrays: of numbers, whole numbers (``step``, ``iterations``, …) or texts."""
        return {name: values.copy() for name, (_, values) in self._read().items()}

    @property
    def units(self) -> dict[str, str | None]:
        """The unit of each column."""
        return {name: unit for name, (unit, _) in self._read().items()}

    def _read(self) -> dict[str, tuple[str | None, Any]]:
        native = self._native
        if self._columns is None:
            columns = native.columns().items()
            self._columns = {name: (unit, _array(name, raw)) for name, (unit, raw) in columns}
        return self._columns

    @property
    def history(self) -> pandas.DataFrame:
        """The history as a ``pandas.DataFrame``; ``history.attrs["units"]`` has the units."""
        frame: pandas.DataFrame = require("pandas").DataFrame(self.columns)
        frame.attrs["units"] = self.units
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """Return the history as an ``xarray.Dataset`` along ``step``; each variable has its unit in ``attrs["units"]``."""
        units = self.units
        variables = {name: ("step", values) for name, values in self.columns.items()}
        dataset: xarray.Dataset = require("xarray").Dataset(variables).set_coords("step")
        for name, unit in units.items():
            if unit is not None:
                dataset[name].attrs["units"] = unit
        dataset.attrs["title"] = self.title
        return dataset

    @property
    def title(self) -> str:
        """The title of the case."""
        return self._native.title

    @property
    def verdict(self) -> Verdict:
        """How the run ended."""
        return Verdict(self._native.verdict)

    @property
    def case(self) -> Case:
        """The case as it was run."""
        return Case.parse(self._native.case_text, self.path.name, self.path)

    @property
    def findings(self) -> dict[str, Any]:
        """Statements about the whole path, as ``plica table --json`` gives them."""
        found: dict[str, Any] = json.loads(self._native.findings()[0])
        return found

    @property
    def table(self) -> str:
        """The closing table of the run."""
        return "\n".join(f"{name:<22} {value}" for name, value in self._native.findings()[1])

    def stability(
        self,
        *,
        highest: int | None = None,
        tolerance: float | None = None,
        modes: int | None = None,
        states: Sequence[int] = (),
        threads: int | None = None,
        progress: bool | Callable[[str, float], None] = True,
    ) -> Stability:
        """Test the stability of the saved states as ``plica stability`` does, and write its files beside them.

        An axisymmetric run is tested against circumferential modes 0 to ``highest`` (as many as the case says); where
        stability changes, the critical value is found within ``tolerance`` (1e-4). Of a three-dimensional run, the lowest
        ``modes`` (3) eigenvalues of ``states`` are computed, given by their numbers, or of all.
        """
        from ._stability import read

        with reporter(progress, self.title) as report:
            table, files = _native.stability(
                os.fspath(self.path), highest, tolerance, modes, list(states), threads, report
            )
        return read(self._native, table, files)

    @property
    def state_numbers(self) -> list[int]:
        """The numbers of the saved states."""
        return self._native.state_numbers

    def __len__(self) -> int:
        return len(self.state_numbers)

    def __contains__(self, name: object) -> bool:
        """Return whether the history has a column of that name."""
        return name in self._read()

    @overload
    def __getitem__(self, which: int) -> State: ...
    @overload
    def __getitem__(self, which: slice) -> list[State]: ...
    @overload
    def __getitem__(self, which: str) -> Any: ...

    def __getitem__(self, which: int | slice | str) -> Any:
        """Return a saved state by its place, from the last one if negative, or a column of the history by its name.

        A slice is a list of saved states.
        """
        if isinstance(which, slice):
            return [self.state(number) for number in self.state_numbers[which]]
        if isinstance(which, str):
            columns = self._read()
            if which not in columns:
                raise KeyError(f"{which}; the columns are {', '.join(columns)}")
            return columns[which][1].copy()
        native = self._native
        numbers = native.state_numbers
        if not -len(numbers) <= which < len(numbers):
            raise IndexError(f"the run has {len(numbers)} saved states")
        return State(native.state(numbers[which]))

    def state(self, number: int) -> State:
        """Return a saved state by its number, the column ``step`` of the history."""
        return State(self._native.state(int(number)))

    def __iter__(self) -> Iterator[State]:
        native = self._native
        for number in native.state_numbers:
            yield State(native.state(number))

    @property
    def plot(self) -> RunPlots:
        """Plots in matplotlib."""
        from .plot import RunPlots

        return RunPlots(self)

    def __repr__(self) -> str:
        return f"<Run {self.title!r} in {self.path}: {len(self)} saved states, {self.verdict}>"

    def _repr_html_(self) -> str:
        from base64 import b64encode
        from html import escape

        picture = self._native.file("tube.png")
        shown = ""
        if picture is not None:
            data = b64encode(picture).decode("ascii")
            shown = f'<img alt="the tube cut open" style="max-width: 720px" src="data:image/png;base64,{data}">'
        return f"<b>{escape(self.title)}</b> ({self.verdict})<pre>{escape(self.table)}</pre>{shown}"

    def __reduce__(self) -> tuple[Any, ...]:
        return (Run, (os.fspath(self.path),))
