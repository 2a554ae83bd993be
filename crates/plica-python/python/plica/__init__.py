"""Plica simulates soft, active tubes: gut, oesophagus, ureter, arteries.

A :class:`Case` describes a tube, its muscles and its loads. :meth:`Case.states` follows it in memory, :meth:`Case.run` in a
directory on disk, and :class:`Run` opens such a directory. A :class:`State` has the numbers, walls and fields of one
equilibrium.

>>> import plica
>>> case = plica.Case.starter()
>>> case.title
'Invagination of an intestine'
"""

from . import plot
from ._case import Case, CaseError, Problem, evaluate
from ._names import Method, Shape, Verdict
from ._native import __version__
from ._run import Run
from ._stability import Change, Mode, Stability
from ._state import Reaction, State

__all__ = [
    "Case",
    "CaseError",
    "Change",
    "Method",
    "Mode",
    "Problem",
    "Reaction",
    "Run",
    "Shape",
    "Stability",
    "State",
    "Verdict",
    "__version__",
    "evaluate",
    "plot",
]
