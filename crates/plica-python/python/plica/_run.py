"""Runs on disk."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from ._case import Case
from ._state import State

if TYPE_CHECKING:
    from .plot import RunPlots


class Run:
    """A run directory, complete or not.

    ``run[-1]`` is its last saved state, ``for state in run`` goes through all of them, ``run["energy"]`` is a column of the
    history as an array, and ``run.history`` is the history as a data frame of pandas.
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.path = Path(directory)
        self._native = _native.Run(os.fspath(directory))
        self._columns: dict[str, tuple[str | None, Any]] | None = None

    @property
    def columns(self) -> dict[str, Any]:
        """The columns of ``history.csv``: arrays of numbers, and lists of texts."""
        return {name: values for name, (_, values) in self._read().items()}

    @property
    def units(self) -> dict[str, str | None]:
        """The unit of each column."""
        return {name: unit for name, (unit, _) in self._read().items()}

    def _read(self) -> dict[str, tuple[str | None, Any]]:
        if self._columns is None:
            columns = self._native.columns().items()
            self._columns = {
                name: (unit, np.frombuffer(raw) if isinstance(raw, bytes) else raw) for name, (unit, raw) in columns
            }
        return self._columns

    @property
    def history(self) -> Any:
        """The history as a ``pandas.DataFrame``; ``history.attrs["units"]`` has the units."""
        import pandas

        frame = pandas.DataFrame(self.columns)
        whole = ("step", "iterations", "cg_iterations", "asymmetry_mode")
        frame = frame.astype({name: int for name in whole if name in frame})
        frame.attrs["units"] = self.units
        return frame

    @property
    def title(self) -> str:
        """The title of the case."""
        return self._native.title

    @property
    def verdict(self) -> str:
        """How the run ended: ``complete``, ``stopped``, ``lost`` or ``running``."""
        return self._native.verdict

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

    @property
    def state_numbers(self) -> list[int]:
        """The numbers of the saved states."""
        return self._native.state_numbers

    def __len__(self) -> int:
        return len(self.state_numbers)

    def __getitem__(self, which: int | str) -> Any:
        if isinstance(which, str):
            columns = self.columns
            if which not in columns:
                raise KeyError(f"{which}; the columns are {', '.join(columns)}")
            return columns[which]
        return State(self._native.state(self.state_numbers[which]))

    def __iter__(self) -> Iterator[State]:
        for number in self.state_numbers:
            yield State(self._native.state(number))

    @property
    def plot(self) -> RunPlots:
        """Plots in matplotlib."""
        from .plot import RunPlots

        return RunPlots(self)

    def __repr__(self) -> str:
        return f"<Run {self.title!r} in {self.path}: {len(self)} saved states, {self.verdict}>"

    def _repr_html_(self) -> str:
        from html import escape

        return f"<b>{escape(self.title)}</b> ({escape(self.verdict)})<pre>{escape(self.table)}</pre>"
