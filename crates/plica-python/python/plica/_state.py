"""Accepted states: numbers, unknowns, walls and fields."""

from __future__ import annotations

from collections.abc import Iterator, KeysView, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._names import WORDS, Method, Shape
from ._optional import require

if TYPE_CHECKING:
    import pyvista

Array = NDArray[np.float64]

_PREFERRED = ("von_mises_stress",)


def number(text: str) -> float | int:
    """Return the number that a cell of a history holds."""
    try:
        return int(text)
    except ValueError:
        return float(text)


@dataclass(frozen=True)
class Reaction:
    """Force and moment of the support of an end on the tube, in the units of the case."""

    axial_force: float
    """Force along the axis, positive if it pulls the tube."""
    shear_force: float
    """Magnitude of the force across the axis."""
    bending_moment: float
    """Magnitude of the moment about axes across the tube's."""
    torque: float
    """Moment about the axis."""


def material_grid(size: tuple[float, float, float, str], face: str, points: tuple[int, int], start: float = 0.0) -> list[Array]:
    """Return z, radius and angle at rest of a grid of points on a face, along and around the tube."""
    inner, outer, length, _ = size
    if face not in ("inner", "outer"):
        raise ValueError(f"a face is 'inner' or 'outer', not {face!r}")
    z = np.linspace(0.0, length, points[0])[:, None]
    angle = start + np.linspace(0.0, 2.0 * np.pi, points[1])[None, :]
    return list(np.broadcast_arrays(z, inner if face == "inner" else outer, angle))


def check_points(size: tuple[float, float, float, str], z: Array, radius: Array) -> None:
    """Raise ValueError if a point is not in the wall at rest."""
    inner, outer, length, unit = size
    slack = 1e-9 * outer
    for name, values, low, high in (("z", z, 0.0, length), ("radius", radius, inner, outer)):
        if not np.all((values >= low - slack) & (values <= high + slack)):
            raise ValueError(f"{name} must lie between {low:.6g} and {high:.6g} {unit}, in the wall at rest")


class State:
    """An equilibrium of a tube, in the units of its case (without units: diameters D and Young's moduli E).

    Every column of ``history.csv`` is an attribute and a member: ``state.energy`` is ``state["energy"]``.
    """

    __slots__ = ("_native", "_numbers", "_unknowns")

    def __init__(self, native: _native.State) -> None:
        self._native = native
        self._numbers: dict[str, Any] | None = None
        self._unknowns: Array | None = None

    def _read(self) -> dict[str, Any]:
        if self._numbers is None:
            numbers: dict[str, Any] = {}
            for name, _, text, is_text in self._native.cells:
                word = WORDS.get(name)
                numbers[name] = (text if word is None else word(text)) if is_text else number(text)
            self._numbers = numbers
        return self._numbers

    @property
    def numbers(self) -> dict[str, Any]:
        """The columns of ``history.csv`` by name: numbers, and texts such as ``shape``."""
        return dict(self._read())

    @property
    def units(self) -> dict[str, str | None]:
        """The unit of each column; None for numbers without unit and texts."""
        return {name: unit for name, unit, _, _ in self._native.cells}

    @property
    def shape(self) -> Shape:
        """The shape of the contracting region."""
        found: Shape = self._read()["shape"]
        return found

    @property
    def method(self) -> Method:
        """How the state was found."""
        found: Method = self._read()["method"]
        return found

    @property
    def reactions(self) -> dict[str, Reaction]:
        """Forces and moments of the supports, by the name of the end."""
        numbers = self._read()
        prefix = "axial_force_"
        ends = [name.removeprefix(prefix) for name in numbers if name.startswith(prefix)]
        names = ("axial_force", "shear_force", "bending_moment", "torque")
        return {end: Reaction(*(float(numbers[f"{name}_{end}"]) for name in names)) for end in ends}

    def __contains__(self, name: object) -> bool:
        """Return whether there is a column of that name."""
        return name in self._read()

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the columns."""
        return iter(self._read())

    def keys(self) -> KeysView[str]:
        """Return the names of the columns, so that ``dict(state)`` has all of them."""
        return self._read().keys()

    def __getitem__(self, name: str) -> Any:
        """Return a column of ``history.csv``."""
        numbers = self._read()
        if name not in numbers:
            raise KeyError(f"{name}; the columns are {', '.join(numbers)}")
        return numbers[name]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):  # Copying and pickling ask for these before there is a state.
            raise AttributeError(name)
        numbers = self._read()
        if name in numbers:
            return numbers[name]
        raise AttributeError(f"a state has no {name}; the columns are in state.numbers")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._read()]

    @property
    def unknowns(self) -> Array:
        """Displacements of the control points of the cyclic sector in diameters D, read-only.

        The shape is (rows along, points through the wall, 3, rings); the components are axial, radial and circumferential.
        The array is made once, and stays valid without the state.
        """
        if self._unknowns is None:
            raw, shape = self._native.unknowns
            self._unknowns = np.frombuffer(raw).reshape(shape)
        return self._unknowns

    @overload
    def fields(  # type: ignore[overload-overlap]  # a text is a sequence of texts, too
        self, names: str, z: ArrayLike, radius: ArrayLike, angle: ArrayLike = 0.0
    ) -> Array: ...
    @overload
    def fields(self, names: Sequence[str], z: ArrayLike, radius: ArrayLike, angle: ArrayLike = 0.0) -> dict[str, Array]: ...

    def fields(
        self, names: str | Sequence[str], z: ArrayLike, radius: ArrayLike, angle: ArrayLike = 0.0
    ) -> Array | dict[str, Array]:
        """Evaluate fields at material points, given by their place in the tube at rest.

        ``z``, ``radius`` and ``angle`` (radians) are broadcast against each other. Returns an array of their common shape for
        one name, and a dictionary of arrays for several names. A last axis holds the components of ``position`` and
        ``displacement`` (x, y, z) and ``elastic_stretch`` (three, largest first), two last axes those of ``cauchy_stress``
        (3 by 3: along the axis, outwards, around). :attr:`field_units` has all names. Raises ValueError for points that are
        not in the wall at rest.
        """
        z, radius, angle = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (z, radius, angle)))
        points = np.stack([z, radius, angle], axis=-1)
        check_points(self._native.size, z, radius)
        several = [names] if isinstance(names, str) else list(names)
        found = self._native.fields(points.tobytes(), several)
        shaped: dict[str, Array] = {}
        for name, (raw, components) in found.items():
            last = {1: (), 9: (3, 3)}.get(components, (components,))
            shaped[name] = np.frombuffer(raw).reshape((*z.shape, *last)).copy()
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
        position = self.fields("position", *material_grid(self._native.size, face, points, start))
        return position[..., 0], position[..., 1], position[..., 2]

    @property
    def grid_fields(self) -> list[str]:
        """The names of the fields of :meth:`walls`, :meth:`meridian` and :meth:`volume`: those of VTK files."""
        return self._native.grid_fields

    def walls(self, fields: Sequence[str] = _PREFERRED) -> pyvista.PolyData:
        """Return the surface of the wall, with fields at its points: the inner and the outer face and the ends.

        The array ``face`` of the cells is 0 on the inner face, 1 on the outer one, and 2 and 3 at the ends. The tensor
        ``cauchy_stress`` has the components xx, yy, zz, xy, yz, xz.
        """
        return self._surface("walls", fields)

    def meridian(self, fields: Sequence[str] = _PREFERRED) -> pyvista.PolyData:
        """Return the section of the wall at angle zero, with fields at its points; of an axisymmetric state.

        Raises ValueError for a state that is not axisymmetric.
        """
        if self._native.rings != 1:
            raise ValueError("only an axisymmetric state has a meridian; volume() and walls() are for the others")
        return self._surface("meridian", fields)

    def volume(self, fields: Sequence[str] = _PREFERRED, *, linear: bool = False) -> pyvista.UnstructuredGrid:
        """Return the wall as Lagrange hexahedra of the degree of the splines, which represent it exactly, with fields.

        ``linear`` divides them into hexahedra of eight points, which every filter of VTK understands and is quick with.
        """
        points, cells, per_cell, kind, _, arrays = self._grid("linear" if linear else "volume", fields)
        grid = require("pyvista").UnstructuredGrid(_with_counts(cells, per_cell), np.full(len(cells), kind, dtype=np.uint8), points)
        for name, values in arrays.items():
            grid.point_data[name] = values
        return grid

    def _surface(self, geometry: str, fields: Sequence[str]) -> Any:
        points, cells, per_cell, _, faces, arrays = self._grid(geometry, fields)
        surface = require("pyvista").PolyData(points, _with_counts(cells, per_cell))
        for name, values in arrays.items():
            surface.point_data[name] = values
        if faces is not None:
            surface.cell_data["face"] = faces
        return surface

    def _grid(self, geometry: str, fields: Sequence[str]) -> tuple[Array, NDArray[np.int64], int, int, Any, dict[str, Any]]:
        """Return points, cells, points per cell, their type in VTK, the face of each cell, and fields."""
        require("pyvista")  # before the work
        names = [fields] if isinstance(fields, str) else list(fields)
        points, cells, per_cell, kind, faces, found = self._native.grid(geometry, names)
        arrays: dict[str, Any] = {}
        for name in names:
            raw, components = found[name]
            values = np.frombuffer(raw, dtype=np.float32).copy()
            arrays[name] = values if components == 1 else values.reshape(-1, components)
        shaped = np.frombuffer(cells, dtype=np.int64).reshape(-1, per_cell)
        kept = None if faces is None else np.frombuffer(faces, dtype=np.uint8)
        return np.frombuffer(points).reshape(-1, 3).copy(), shaped, per_cell, kind, kept, arrays

    def pressed(self) -> tuple[Array, Array, Array]:
        """Return the points at which the wall touches itself: positions along the axis, areas and pressures.

        The points are those of the quadrature of contact on both faces; an area is that around the whole tube.
        """
        z, area, pressure = np.frombuffer(self._native.pressed()).reshape(-1, 3).T.copy()
        return z, area, pressure

    def __repr__(self) -> str:
        n = self._read()
        return f"<State {n['step']} of stage {n['stage']}: {n['shape']}, energy {n['energy']:.6g} {self.units['energy']}>"

    def _repr_html_(self) -> str:
        units = self.units

        def row(name: str, value: Any) -> str:
            text = f"{value:.6g}" if isinstance(value, float) else str(value)
            return f"<tr><td>{escape(name)}</td><td>{escape(text)}</td><td>{escape(units[name] or '')}</td></tr>"

        numbers = self._read()
        first = ("step", "stage", "shape", "energy", "length_ratio", "diameter_ratio", "max_wall_angle_deg", "overhang")
        head = "".join(row(name, numbers[name]) for name in first)
        rest = "".join(row(name, value) for name, value in numbers.items() if name not in first)
        return f"<table>{head}</table><details><summary>all columns</summary><table>{rest}</table></details>"


def _with_counts(cells: NDArray[np.int64], per_cell: int) -> NDArray[np.int64]:
    """Return cells as PyVista takes them: the number of points before the points of each."""
    return np.insert(cells, 0, per_cell, axis=1).ravel()
