"""Accepted states: numbers, unknowns, walls and fields."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native

Array = NDArray[np.float64]


def number(text: str) -> float | int:
    """Return the number that a cell of a history holds."""
    try:
        return int(text)
    except ValueError:
        return float(text)


class State:
    """An equilibrium of a tube, in the units of its case (without units: diameters D and Young's moduli E)."""

    __slots__ = ("_native", "_numbers")

    def __init__(self, native: _native.State) -> None:
        self._native = native
        self._numbers: dict[str, Any] | None = None

    @property
    def numbers(self) -> dict[str, Any]:
        """The columns of ``history.csv`` by name: numbers, and texts such as ``shape``."""
        if self._numbers is None:
            cells = self._native.cells
            self._numbers = {name: text if is_text else number(text) for name, _, text, is_text in cells}
        return dict(self._numbers)

    @property
    def units(self) -> dict[str, str | None]:
        """The unit of each column; None for numbers without unit and texts."""
        return {name: unit for name, unit, _, _ in self._native.cells}

    def __getitem__(self, name: str) -> Any:
        """Return a column of ``history.csv``."""
        numbers = self.numbers
        if name not in numbers:
            raise KeyError(f"{name}; the columns are {', '.join(numbers)}")
        return numbers[name]

    def __getattr__(self, name: str) -> Any:
        numbers = self.numbers
        if name in numbers:
            return numbers[name]
        raise AttributeError(f"a state has no {name}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.numbers]

    @property
    def unknowns(self) -> Array:
        """Displacements of the control points of the cyclic sector in diameters D, read-only.

        The shape is (rows along, points through the wall, 3, rings); the components are axial, radial and circumferential.
        """
        raw, shape = self._native.unknowns
        return np.frombuffer(raw).reshape(shape)

    def fields(self, names: str | Sequence[str], z: ArrayLike, radius: ArrayLike, angle: ArrayLike = 0.0) -> Any:
        """Evaluate fields at material points, given by their place in the tube at rest.

        ``z``, ``radius`` and ``angle`` (radians) are broadcast against each other. Returns an array of their common shape for
        one name, with a last axis for the components of ``position`` (x, y, z), ``elastic_stretches`` (3) and ``cauchy_stress``
        (3 by 3: z, outwards, around), and a dictionary of them for several names. :attr:`field_units` has all names.
        """
        z, radius, angle = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (z, radius, angle)))
        points = np.stack([z, radius, angle], axis=-1)
        several = [names] if isinstance(names, str) else list(names)
        found = self._native.fields(points.tobytes(), several)
        shaped: dict[str, Array] = {}
        for name, (raw, components) in found.items():
            last = {1: (), 9: (3, 3)}.get(components, (components,))
            shaped[name] = np.frombuffer(raw).reshape(*z.shape, *last)
        return shaped[names] if isinstance(names, str) else shaped

    @property
    def field_units(self) -> dict[str, str | None]:
        """The names and units of the fields that :meth:`fields` evaluates."""
        return dict(self._native.field_units)

    def wall(self, face: str = "outer", points: int = 201, angle: float = 0.0) -> tuple[Array, Array]:
        """Return the deformed meridian of a face at an angle at rest (radians): positions along the axis, and radii."""
        x, y, z = self.surface(face, (points, 1), start=angle)
        return z[:, 0], np.hypot(x[:, 0], y[:, 0])

    def surface(self, face: str = "outer", points: tuple[int, int] = (201, 73), start: float = 0.0) -> tuple[Array, Array, Array]:
        """Return x, y and z of the deformed inner or outer face, on a grid of ``points`` along and around the tube.

        The first and the last line of points along the tube are the same.
        """
        inner, outer, length, _ = self._native.size
        if face not in ("inner", "outer"):
            raise ValueError(f"a face is 'inner' or 'outer', not {face!r}")
        z = np.linspace(0.0, length, points[0])[:, None]
        angle = start + np.linspace(0.0, 2.0 * np.pi, points[1])[None, :]
        position = self.fields("position", z, inner if face == "inner" else outer, angle)
        return position[..., 0], position[..., 1], position[..., 2]

    def to_pyvista(self, face: str = "outer", points: tuple[int, int] = (201, 73), fields: Sequence[str] = ("von_mises_stress",)) -> Any:
        """Return a deformed face with fields as a ``pyvista.StructuredGrid``."""
        import pyvista

        inner, outer, length, _ = self._native.size
        grid = pyvista.StructuredGrid(*self.surface(face, points))
        z = np.linspace(0.0, length, points[0])[:, None]
        angle = np.linspace(0.0, 2.0 * np.pi, points[1])[None, :]
        found = self.fields(list(fields), z, inner if face == "inner" else outer, angle)
        for name, values in found.items():
            # The first index of a structured grid runs fastest.
            swapped = np.swapaxes(values, 0, 1)
            grid[name] = swapped.reshape(points[0] * points[1], -1).squeeze()
        return grid

    def __repr__(self) -> str:
        n = self.numbers
        return f"<State {n['step']} of stage {n['stage']}: {n['shape']}, energy {n['energy']:.6g} {self.units['energy']}>"
