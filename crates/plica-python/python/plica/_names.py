"""Words of the results. Each one is equal to its text: ``Shape.SQUARE == "square"``."""

from __future__ import annotations

from enum import Enum


class _Word(str, Enum):
    """A text with a name."""

    def __str__(self) -> str:
        return str(self.value)

    def __format__(self, spec: str) -> str:
        return format(str(self.value), spec)


class Shape(_Word):
    """Shape of the contracting region, as in Okino et al. (2025), Fig. 4."""

    STRAIGHT = "straight"
    """The outer face stays within 2 % of D of the cylinder."""
    V = "V"
    """Narrowed, with the profile of a raised cosine or a sharper one."""
    U = "U"
    """Narrowed, with a flatter bottom."""
    SQUARE = "square"
    """Narrowed, with a wall angle of 78 degrees or more."""
    INVAGINATED = "invaginated"
    """Narrowed, with a wall angle of 90 degrees or more: the wall overhangs."""
    SWOLLEN = "swollen"
    """Wider than the cylinder in one bulge."""
    COLLAPSED = "collapsed"
    """Buckled without contraction, or with a closed lumen."""


class Verdict(_Word):
    """How a run ended."""

    RUNNING = "running"
    """It has not ended, or its process was killed."""
    COMPLETE = "complete"
    """Every stage is complete, or its condition to stop was met."""
    STOPPED = "stopped"
    """It was interrupted, and can be resumed."""
    LOST = "lost"
    """The tube could not be followed further."""


class Method(_Word):
    """How a state was found."""

    REST = "rest"
    """The state that the path starts from."""
    NEWTON = "newton"
    """Newton's method along the path."""
    RELAXATION = "relaxation"
    """Relaxation, after a step that Newton's method could not take."""
    PSEUDO_TIME = "pseudo-time"
    """The pseudo-time scheme of the paper."""


WORDS: dict[str, type[_Word]] = {"shape": Shape, "method": Method}
"""The columns of the history that hold such words."""
