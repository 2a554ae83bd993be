"""Plica simulates soft, active tubes: gut, oesophagus, ureter, arteries.

A :class:`Case` describes a tube, its muscles and its loads. :meth:`Case.states` follows it in memory, :meth:`Case.run` in a
directory on disk, and :class:`Run` opens such a directory. A :class:`State` has the numbers, walls and fields of one
equilibrium.

>>> import plica
>>> case = plica.Case.starter()
>>> case.title
'Invagination of an intestine'
"""

from ._case import Case, CaseError, Problem, evaluate
from ._native import __version__
from ._run import Run
from ._state import State

__all__ = ["Case", "CaseError", "Problem", "Run", "State", "__version__", "evaluate"]
