"""Plots of runs and states in Matplotlib, on axes of the user's or new ones.

They show the measures of the pictures that the program draws, and use its units. Every function returns the axes.
"""

from __future__ import annotations

import io
import os
import re
from base64 import b64encode
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ._optional import require
from ._progress import reporter
from ._state import Array, State, material_grid

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._run import Run

VIEWS = {
    "oblique": [0.42, 1.0, -0.35],
    "front": [0.0, 1.0, 0.0],
    "above": [1.0, 0.35, 0.0],
    "colon": [0.3, 0.5, -1.0],
    "ileum": [0.3, 0.5, 1.0],
}
"""Directions towards the viewer: up, to the front, along the tube."""

INTERVALS = 200
"""Intervals along the length of the tube at rest in :meth:`RunPlots.pressure_map`, as in the program's record."""

Quantity = Literal["contact_pressure", "contact_force", "lumen_radius"]


def _axes(axes: Axes | None) -> Axes:
    if axes is not None:
        return axes
    found: Axes = require("matplotlib.pyplot").subplots()[1]
    return found


def _mathtext(label: str) -> str:
    """Return a label of the program, with *italics*, _{lower} and ^{upper} parts, as Matplotlib reads it."""
    label = re.sub(r"([_^])\{([^}]*)\}", r"$\1{\\mathrm{\2}}$", label)
    return re.sub(r"\*([^*]*)\*", r"$\1$", label)


def _unit(unit: str) -> str:
    """Return a unit as Matplotlib reads it."""
    return "$\\mathrm{" + unit.replace(" ", r"\,").replace("um", "\N{MICRO SIGN}m") + "}$"


def _label(run: Run, column: str) -> str:
    unit = run.units[column]
    name = column.replace("_", " ")
    return name if unit is None else f"{name} ({_unit(unit)})"


def walls(state: State, axes: Axes | None = None, **style: Any) -> Axes:
    """Draw the wall of a state in the plane through the axis, both halves."""
    axes = _axes(axes)
    style.setdefault("color", "tab:red")
    label = style.pop("label", None)
    for angle, sign in ((0.0, 1.0), (np.pi, -1.0)):
        for face in ("inner", "outer"):
            z, radius = state.wall(face, 401, angle)
            axes.plot(z, sign * radius, label=label, **style)
            label = None
    axes.set_aspect("equal")
    unit = _unit(state.units["z_at_min"] or "D")
    axes.set_xlabel(f"z ({unit})")
    axes.set_ylabel(f"radius ({unit})")
    return axes


class Animation:
    """An animated PNG, which a notebook plays and every browser opens."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        """The bytes of the file."""

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the file; its name should end in ``.apng`` or ``.png``."""
        Path(path).write_bytes(self.data)

    def _repr_html_(self) -> str:
        data = b64encode(self.data).decode("ascii")
        return f'<img alt="the states one after another" style="max-width: 100%" src="data:image/apng;base64,{data}">'


class RunPlots:
    """Plots of one run: ``run.plot``."""

    def __init__(self, run: Run) -> None:
        self._run = run

    def columns(self, x: str, y: str | Sequence[str], axes: Axes | None = None, **style: Any) -> Axes:
        """Draw columns of the history against another one."""
        axes = _axes(axes)
        names = [y] if isinstance(y, str) else list(y)
        for name in names:
            axes.plot(self._run[x], self._run[name], **{"label": name, **style})
        axes.set_xlabel(_label(self._run, x))
        if len(names) == 1:
            axes.set_ylabel(_label(self._run, names[0]))
        else:
            axes.legend()
        return axes

    def energy(self, axes: Axes | None = None, **style: Any) -> Axes:
        """Draw the strain energy along the path, over the quantity that changes in its last part, with the energy minima and the
        first square and overhanging walls marked, as ``energy.png`` does.
        """
        axes = _axes(axes)
        label, states, _ = self._run._native.excerpt()
        energies = dict(zip(self._run["step"], self._run["energy"], strict=True))
        place = dict(states)
        axes.plot(list(place.values()), [energies[step] for step in place], **{"marker": ".", **style})
        axes.set_xlabel(_mathtext(label))
        axes.set_ylabel(f"strain energy $W$ ({_unit(self._run.units['energy'] or '')})")
        findings = self._run.findings
        for extreme in findings["extremes"]:
            step = extreme["at"]["state"]
            if extreme["is_minimum"] and step in place:
                axes.plot(place[step], energies[step], "o", color="tab:red", fillstyle="none")
                axes.annotate("minimum", (place[step], energies[step]), (0, 8), textcoords="offset points", ha="center")
        for name, what in (("square", "square"), ("overhanging", "overhang")):
            first = [found["first"]["state"] for found in findings[name][:1]]
            for step in first:
                if step in place:
                    axes.axvline(place[step], color="gray", linewidth=0.8, linestyle="--")
                    end = axes.get_xaxis_transform()
                    axes.text(place[step], 0.98, f" {what}", transform=end, va="top", rotation=90, fontsize="small")
        return axes

    def _saved(self) -> list[int]:
        """Return the numbers of the saved states; at least one."""
        if not (saved := self._run.state_numbers):
            raise ValueError(f"{self._run.path} has no saved states; output.states_every = 1 saves all")
        return saved

    def _chosen(self, states: Sequence[int] | None) -> list[int]:
        """Return the numbers of saved states, given by their places, or of those that the program draws."""
        saved = self._saved()
        if states is not None:
            return [saved[place] for place in states]
        chosen = [number for number in self._run._native.excerpt()[2] if number in saved]
        return chosen or saved[-1:]

    def walls(self, states: Sequence[int] | None = None, axes: Axes | None = None, **style: Any) -> Axes:
        """Draw the walls of saved states over each other, in the plane through the axis.

        ``states`` are places among the saved states, as in ``run[-1]``; without them, the states of ``walls.png``.
        """
        axes = _axes(axes)
        for i, number in enumerate(self._chosen(states)):
            walls(self._run.state(number), axes, **{"color": f"C{i}", "label": f"state {number}", **style})
        axes.legend(fontsize="small")
        return axes

    def picture(
        self,
        states: Sequence[int] | None = None,
        *,
        field: str = "energy",
        cutaway: float = 180.0,
        see_through: bool = False,
        view: str | Sequence[float] = "oblique",
        width: int = 1200,
    ) -> bytes:
        """Return the picture of saved states, cut open, as PNG, as ``plica render`` draws it.

        ``field`` colours the wall: see :attr:`fields`. ``cutaway`` is the angle of the wall that is removed, in degrees, or
        shown as glass if ``see_through``. ``view`` is one of ``VIEWS`` or a direction (up, to the front, along the tube).
        """
        return self._run._native.render(self._chosen(states), _look(field, cutaway, see_through, view, width))

    @property
    def fields(self) -> list[str]:
        """The names of the fields that colour :meth:`tube`, :meth:`picture` and :meth:`animation`."""
        return self._run._native.picture_fields

    def tube(self, states: Sequence[int] | None = None, axes: Axes | None = None, **look: Any) -> Axes:
        """Show the picture of saved states, cut open, with a colour bar. Further arguments are those of :meth:`picture`."""
        image = require("matplotlib.image").imread(io.BytesIO(self.picture(states, **look)))
        if axes is None:
            pyplot = require("matplotlib.pyplot")
            height = 8.0 * image.shape[0] / image.shape[1]
            axes = pyplot.figure(figsize=(8.0, height)).add_axes((0.0, 0.0, 1.0, 1.0))
        found = _axes(axes)
        found.imshow(image, interpolation="antialiased")
        found.set_axis_off()
        return found

    def pressure_map(self, quantity: Quantity | None = None, axes: Axes | None = None, **style: Any) -> Axes:
        """Draw a map over the position along the axis and the number of the state, like a record of manometry.

        ``contact_pressure`` is the largest pressure at which the wall touches itself there, ``contact_force`` the force of
        contact per length (that of ``manometry.png``), ``lumen_radius`` the mean radius of the lumen, the smallest one where
        the wall is folded. Without ``quantity`` it is the pressure if the wall can touch itself, and else the radius.
        """
        run = self._run
        if quantity is None:
            quantity = "contact_pressure" if run._native.has_contact else "lumen_radius"
        if quantity not in ("contact_pressure", "contact_force", "lumen_radius"):
            raise ValueError(f"a map shows contact_pressure, contact_force or lumen_radius, not {quantity!r}")
        if quantity != "lumen_radius" and not run._native.has_contact:
            raise ValueError("the wall of this run cannot touch itself; set contact = true in its case, or map lumen_radius")
        z, values = self.pressures(quantity)
        axes = _axes(axes)
        numbers = np.asarray(self._saved(), dtype=float)
        mesh = axes.pcolormesh(z, numbers, values, **{"shading": "nearest", "cmap": "magma", **style})
        length, stress = run._native.size[3], run._native.stress_unit
        names = {
            "contact_pressure": f"pressure of contact ({_unit(stress)})",
            "contact_force": f"force of contact per length ({_unit(f'{stress} {length}')})",
            "lumen_radius": f"radius of the lumen ({_unit(length)})",
        }
        figure: Any = axes.figure
        figure.colorbar(mesh, ax=axes, label=names[quantity])
        axes.set_xlabel(f"z ({_unit(length)})")
        axes.set_ylabel("state")
        return axes

    def pressures(self, quantity: Quantity) -> tuple[Array, Array]:
        """Return the numbers of :meth:`pressure_map`: the middles of the intervals along the axis, and a row for each saved state.

        Where there is no contact, pressure and force are zero; where there is no wall, the radius is NaN.
        """
        run = self._run
        self._saved()
        step = run._native.size[2] / INTERVALS
        of_state = _radii if quantity == "lumen_radius" else _contact
        rows = [of_state(state, step, quantity) for state in run]
        low = min([0, *(min(row) for row in rows if row)])
        high = max([INTERVALS - 1, *(max(row) for row in rows if row)])
        missing = np.nan if quantity == "lumen_radius" else 0.0
        values: Array = np.full((len(rows), high - low + 1), missing)
        for i, row in enumerate(rows):
            for interval, value in row.items():
                values[i, interval - low] = value
        middles = np.asarray(step * (np.arange(low, high + 1) + 0.5), dtype=np.float64)
        return middles, values

    def animation(
        self,
        *,
        field: str = "energy",
        cutaway: float = 180.0,
        see_through: bool = False,
        view: str | Sequence[float] = "oblique",
        width: int = 800,
        fps: float = 8.0,
        progress: bool | Callable[[str, float], None] = True,
    ) -> Animation:
        """Draw all saved states one after another, above their energy, as ``plica animate`` does; a notebook plays it."""
        if not fps > 0:
            raise ValueError(f"fps must be positive, not {fps}")
        self._saved()
        with reporter(progress, "animation") as report:
            look = _look(field, cutaway, see_through, view, width)
            return Animation(self._run._native.animate(look, 1.0 / fps, report))


def _look(
    field: str, cutaway: float, see_through: bool, view: str | Sequence[float], width: int
) -> tuple[str, float, bool, list[float], int]:
    if isinstance(view, str):
        if view not in VIEWS:
            raise ValueError(f"there is no view {view!r}; there are {', '.join(VIEWS)}, and directions of three numbers")
        view = VIEWS[view]
    if not 0.0 <= cutaway <= 350.0:
        raise ValueError(f"cutaway must be from 0 to 350 degrees, not {cutaway}")
    return field, float(cutaway), see_through, [float(x) for x in view], int(width)


def _contact(state: State, step: float, quantity: Quantity) -> dict[int, float]:
    """Return the largest pressure of contact, or the force per length, by interval along the axis."""
    found: dict[int, float] = {}
    for z, area, pressure in zip(*state.pressed(), strict=True):
        interval = int(np.floor(z / step))
        if quantity == "contact_pressure":
            found[interval] = max(found.get(interval, 0.0), float(pressure))
        else:
            found[interval] = found.get(interval, 0.0) + float(pressure * area / step)
    return found


def _radii(state: State, step: float, _: Quantity) -> dict[int, float]:
    """Return the radius of the lumen by interval along the axis: the mean distance of a section from its centre."""
    around = 1 if state._native.rings == 1 else 25
    position = state.fields("position", *material_grid(state._native.size, "inner", (10 * INTERVALS + 1, around)))
    if around == 1:
        z, radius = position[:, 0, 2], np.hypot(position[:, 0, 0], position[:, 0, 1])
    else:
        ring = position[:, :-1]  # the last line is the first one
        across = ring[..., :2] - ring[..., :2].mean(axis=1, keepdims=True)
        z, radius = ring[..., 2].mean(axis=1), np.hypot(across[..., 0], across[..., 1]).mean(axis=1)
    found: dict[int, float] = {}
    for interval, value in zip(np.floor(z / step - 1e-9).astype(int).tolist(), radius.tolist(), strict=True):
        found[interval] = min(found.get(interval, np.inf), value)
    # A wall that is stretched along the axis may leave intervals out.
    known = np.array(sorted(found))
    every = np.arange(known[0], known[-1] + 1)
    filled = np.interp(every, known, [found[i] for i in known.tolist()])
    return dict(zip(every.tolist(), filled.tolist(), strict=True))
