"""Stability of the states of a run: critical loads and modes."""

from __future__ import annotations

from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._optional import require
from ._state import Array, check_points, material_grid

if TYPE_CHECKING:
    import pandas
    import pyvista


@dataclass(frozen=True)
class Change:
    """A change of the stability of an axisymmetric path to one circumferential mode."""

    stage: str
    """The name of the stage."""
    mode: int
    """The circumferential mode: 0 keeps the tube round, 1 tilts it, 2 makes it oval."""
    effect: str
    """What the mode does to the tube."""
    is_lost: bool
    """Whether stability is lost; it is regained otherwise."""
    quantity: str
    """The quantity that is driven there, for example ``Lmax/L``."""
    critical: float
    """Its critical value."""
    between: tuple[float, float]
    """The values between which stability changes."""
    negative: tuple[int, int]
    """Numbers of negative eigenvalues before and after."""
    transition: str
    """``smooth``, ``snap`` (the path jumps there) or ``unfollowed``."""


class Mode:
    """A buckling mode, or one of the lowest modes of a state."""

    def __init__(self, native: _native.Mode) -> None:
        self._native = native

    @property
    def mode(self) -> int:
        """The circumferential mode, or in a three-dimensional state the one with the largest share."""
        return self._native.harmonic

    @property
    def eigenvalue(self) -> float:
        """The eigenvalue with a mass of unit density, in E/D^2: negative if the state is unstable to the mode."""
        return self._native.eigenvalue

    @property
    def state(self) -> int:
        """The number of the state; of a buckling mode, which lies between two states, that of the one before."""
        return self._native.state

    def evaluate(self, z: ArrayLike, radius: ArrayLike, angle: ArrayLike = 0.0) -> tuple[Array, Array]:
        """Return positions in the state and displacements of the mode at material points, given by their place at rest.

        Both have a last axis (x, y, z). The largest displacement on the outer face is one.
        """
        z, radius, angle = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (z, radius, angle)))
        check_points(self._native.size, z, radius)
        points = np.stack([z, radius, angle], axis=-1)
        position, displacement = self._native.evaluate(points.tobytes())
        shape = points.shape
        return np.frombuffer(position).reshape(shape).copy(), np.frombuffer(displacement).reshape(shape).copy()

    def wall(self, scale: float = 0.05, face: str = "outer", points: tuple[int, int] = (201, 73)) -> pyvista.StructuredGrid:
        """Return a face of the wall, displaced by the mode, with the displacement ``mode``.

        ``scale`` is the largest displacement, in outer diameters. ``points`` are along and around the tube.
        """
        pyvista = require("pyvista")
        size = self._native.size
        position, displacement = self.evaluate(*material_grid(size, face, points))
        moved = position + scale * 2.0 * size[1] * displacement
        grid = pyvista.StructuredGrid(*(moved[..., i] for i in range(3)))
        # The first index of a structured grid runs fastest.
        grid["mode"] = np.swapaxes(displacement, 0, 1).reshape(-1, 3)
        return grid

    def __repr__(self) -> str:
        return f"<Mode {self.mode} at state {self.state}, eigenvalue {self.eigenvalue:.3g} E/D^2>"


@dataclass(frozen=True)
class Stability:
    """The result of a stability analysis, which is also in files of the run (``stability.csv`` and others)."""

    table: str
    """The table that ``plica stability`` prints."""
    changes: list[Change]
    """Changes along an axisymmetric path, in its order."""
    modes: list[Mode]
    """Modes: of every loss of stability that is not a snap, or the lowest ones of three-dimensional states."""
    _eigenvalues: list[list[str]] = field(repr=False)

    @property
    def eigenvalues(self) -> pandas.DataFrame:
        """The lowest eigenvalues as a table: of every tested state by circumferential mode, or of every mode of a state."""
        package = require("pandas")
        head, *rows = self._eigenvalues
        frame: pandas.DataFrame = package.DataFrame(rows, columns=head)
        for name in head:
            try:
                frame[name] = package.to_numeric(frame[name])
            except ValueError:
                pass  # a text, such as the name of a stage
        return frame

    def __str__(self) -> str:
        return self.table

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self.table)}</pre>"


def read(native: _native.Run, table: str, modes: list[str]) -> Stability:
    """Read the files of an analysis."""
    import csv
    import io

    def rows(name: str) -> list[list[str]]:
        raw = native.file(name)
        return [] if raw is None else list(csv.reader(io.StringIO(raw.decode("utf-8"))))

    is_path = native.file("eigenvalues.csv") is not None and native.rings == 1
    changes: list[Change] = []
    if is_path:
        head, *lines = rows("stability.csv")
        for line in lines:
            of = dict(zip(head, line, strict=True))
            changes.append(
                Change(
                    stage=of["stage"],
                    mode=int(of["mode"]),
                    effect=of["effect"],
                    is_lost=of["change"] == "lost",
                    quantity=of["quantity"],
                    critical=float(of["critical"]),
                    between=(float(of["from"]), float(of["to"])),
                    negative=(int(of["negative_before"]), int(of["negative_after"])),
                    transition=of["how"],
                )
            )
    eigenvalues = rows("eigenvalues.csv" if is_path else "eigenpairs.csv")
    return Stability(table, changes, [Mode(native.mode(name)) for name in modes], eigenvalues)
