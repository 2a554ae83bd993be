"""Plots of runs and states in matplotlib, on axes of the user's or new ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ._run import Run
    from ._state import State


def _axes(axes: Any) -> Any:
    if axes is not None:
        return axes
    import matplotlib.pyplot as pyplot

    return pyplot.subplots()[1]


def _label(run: Run, column: str) -> str:
    unit = run.units[column]
    name = column.replace("_", " ")
    return name if unit is None else f"{name} ({unit})"


def walls(state: State, axes: Any = None, **style: Any) -> Any:
    """Draw the wall of a state in the plane through the axis, both halves, and return the axes."""
    axes = _axes(axes)
    style.setdefault("color", "tab:red")
    for angle, sign in ((0.0, 1.0), (np.pi, -1.0)):
        for face in ("inner", "outer"):
            z, radius = state.wall(face, 401, angle)
            axes.plot(z, sign * radius, **style)
    axes.set_aspect("equal")
    unit = state.units["z_at_min"]
    axes.set_xlabel(f"z ({unit})")
    axes.set_ylabel(f"radius ({unit})")
    return axes


class RunPlots:
    """Plots of one run."""

    def __init__(self, run: Run) -> None:
        self._run = run

    def columns(self, x: str, y: str | Sequence[str], axes: Any = None, **style: Any) -> Any:
        """Draw columns of the history against another one, and return the axes."""
        axes = _axes(axes)
        names = [y] if isinstance(y, str) else list(y)
        for name in names:
            axes.plot(self._run[x], self._run[name], **{"label": name, **style})
        axes.set_xlabel(_label(self._run, x))
        axes.set_ylabel(_label(self._run, names[0]) if len(names) == 1 else "")
        if len(names) > 1:
            axes.legend()
        return axes

    def energy(self, axes: Any = None, **style: Any) -> Any:
        """Draw the strain energy over the number of the state, and return the axes."""
        return self.columns("step", "energy", axes, **style)

    def walls(self, states: Sequence[int] = (0, -1), axes: Any = None) -> Any:
        """Draw the walls of some saved states over each other, and return the axes."""
        axes = _axes(axes)
        for i, which in enumerate(states):
            walls(self._run[which], axes, color=f"C{i}")
        return axes
