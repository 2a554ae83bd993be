"""Cases: what a user describes, and how it is run."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _native, _toml
from ._progress import reporter
from ._state import State

if TYPE_CHECKING:
    from ._run import Run


@dataclass(frozen=True)
class Problem:
    """One problem of a case."""

    key: str
    """The dotted key, members of lists counted from one; empty for an error of syntax."""
    value: str | None
    """The value as written, if that is wrong, and short."""
    rule: str
    """The rule that is broken."""
    help: str | None
    """A suggestion of what to write instead."""
    line: int
    """The line of the text, from 1."""
    column: int
    """The column, from 1."""

    def __str__(self) -> str:
        """Return key, value, rule and help in one line."""
        where = "" if not self.key else self.key + ("" if self.value is None else f" = {self.value}") + ": "
        return where + self.rule + ("" if self.help is None else f"; {self.help}")


class CaseError(ValueError):
    """A case that cannot be run, with every problem that was found."""

    def __init__(self, name: str, problems: list[Problem]) -> None:
        self.name = name
        self.problems = problems
        lines = [f"{name}, line {p.line}: {p}" if p.line else str(p) for p in problems]
        super().__init__("\n".join(lines))

    def __reduce__(self) -> tuple[Any, ...]:
        return (CaseError, (self.name, self.problems))


class Case:
    """A checked case. It never changes; :meth:`with_` returns another one.

    The keywords are the tables of a case file, as nested dictionaries and lists (see the reference of the case file):

    >>> case = Case(
    ...     title="A ring contracts",
    ...     tube={"length": 2.0, "thickness": 0.1},
    ...     muscles={"ring": {"direction": "circular", "zone": [0.5, 1.5]}},
    ...     mesh={"control_points": {"axial": 40, "thickness": 5}},
    ...     stages=[{"steps": 4, "drive": {"ring": {"stretch": 0.6}}}],
    ... )

    Raises :class:`CaseError` with all problems at once if it cannot be run.
    """

    __slots__ = ("_folder", "_name", "_text")

    _text: str
    _name: str
    _folder: str

    def __init__(self, **tables: Any) -> None:
        self._set(_toml.document(tables), "case", ".")

    def _set(self, text: str, name: str, folder: str) -> None:
        problems = [Problem(*p) for p in _native.problems(text, name, folder)]
        if problems:
            raise CaseError(name, problems)
        object.__setattr__(self, "_text", text)
        object.__setattr__(self, "_name", name)
        object.__setattr__(self, "_folder", folder)

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("a case never changes; with_() returns another one")

    @classmethod
    def parse(cls, text: str, name: str = "case", folder: str | os.PathLike[str] = ".") -> Case:
        """Read a case from the text of a case file. Files that it names lie in ``folder``."""
        case = cls.__new__(cls)
        case._set(text, name, os.fspath(folder))
        return case

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Case:
        """Read a case file."""
        path = Path(path)
        return cls.parse(path.read_text(encoding="utf-8"), path.stem, path.parent)

    @classmethod
    def starter(cls) -> Case:
        """Return the case that ``plica new`` writes: the tube of Okino et al. (2025), which invaginates."""
        return cls.parse(_native.STARTER, "starter")

    def with_(self, changes: Mapping[str, Any] | None = None, /, **more: Any) -> Case:
        """Return the case with keys changed or added.

        Keys are dotted as in messages, members of lists counted from one: ``case.with_({"tube.thickness": 0.05,
        "stages[1].steps": 40})``. Keys without dots may be keywords.
        """
        changes = {**(changes or {}), **more}
        written = [(key, _toml.value(value)) for key, value in changes.items()]
        try:
            text = _native.edited(self._text, written)
        except ValueError as error:
            raise CaseError(self._name, [Problem("", None, str(error), None, 0, 0)]) from None
        return Case.parse(text, self._name, self._folder)

    @property
    def text(self) -> str:
        """The text of the case file."""
        return self._text

    @property
    def title(self) -> str:
        """The title."""
        return _native.about(self._text, self._name, self._folder)[0]

    @property
    def advice(self) -> list[str]:
        """What is allowed but perhaps not meant, a sentence each."""
        return _native.about(self._text, self._name, self._folder)[1]

    @property
    def unknowns(self) -> int:
        """The number of unknowns of a state."""
        return _native.about(self._text, self._name, self._folder)[2]

    def __len__(self) -> int:
        """Return the number of states of a complete run."""
        return _native.about(self._text, self._name, self._folder)[3]

    def __bool__(self) -> bool:
        return True

    def states(self, *, threads: int | None = None, progress: bool | Callable[[str, float], None] = False) -> Iterator[State]:
        """Follow the tube through its stages and yield one equilibrium after another, with nothing on disk.

        ``threads`` limits the threads; without it there is one per processor, or as many as ``OMP_NUM_THREADS`` says.
        ``progress`` is True for a bar, or a function of (activity, fraction from 0 to 1). Ctrl-C stops at once. Raises
        RuntimeError with place and reason where the tube cannot be followed further.
        """
        with reporter(progress, self.title) as report:
            for state in _native.Study(self._text, self._name, self._folder, threads, report):
                yield State(state)

    def follow(
        self, choose: Callable[[State], Mapping[str, float] | None], *, threads: int | None = None
    ) -> Iterator[State]:
        """Follow the tube while a function chooses the targets of each next step.

        After the stages of the case, ``choose(state)`` returns the next targets as dotted keys of ``drive``, for example
        ``{"ring.stretch": 0.9}``, or None to end. It is a controller, a measured trace, or an optimiser. Yields the states.
        """
        study = _native.Study(self._text, self._name, self._folder, threads, None)
        text, state = self._text, None
        while True:
            for native in study:
                state = State(native)
                yield state
            targets = None if state is None else choose(state)
            if targets is None:
                return
            lines = "".join(f"drive.{key} = {_toml.value(value)}\n" for key, value in targets.items())
            text = f"{text}\n[[stages]]\nsteps = 1\n{lines}"
            problems = [Problem(*p) for p in _native.problems(text, self._name, self._folder)]
            if problems:
                raise CaseError(self._name, problems)
            study.extend(text, self._name, self._folder)

    def run(
        self,
        directory: str | os.PathLike[str],
        *,
        overwrite: bool = False,
        resume: bool = False,
        threads: int | None = None,
        progress: bool | Callable[[str, float], None] = True,
    ) -> Run:
        """Run the case in a directory, as ``plica run`` does, and return the run.

        ``overwrite`` replaces a run that is there; ``resume`` resumes it. Ctrl-C stops the run cleanly, and raises
        KeyboardInterrupt; ``resume=True`` then continues it, with the same results to the bit. Where the tube cannot be
        followed further, the run ends with the verdict ``lost``, and a RuntimeWarning says why.
        """
        from ._run import Run

        with reporter(progress, self.title) as report:
            lost = _native.run(
                self._text, self._name, self._folder, os.fspath(directory), overwrite, resume, threads, report
            )
        if lost is not None:
            warnings.warn(lost, RuntimeWarning, stacklevel=2)
        return Run(directory)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Case):
            return NotImplemented
        return (self._text, self._folder) == (other._text, other._folder)

    def __hash__(self) -> int:
        return hash((self._text, self._folder))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Case.parse, (self._text, self._name, self._folder))

    def __repr__(self) -> str:
        return f"<Case {self.title!r}: {len(self)} states of {self.unknowns} unknowns>"

    def _repr_html_(self) -> str:
        from html import escape

        about = f"{len(self)} states of {self.unknowns} unknowns"
        advice = "".join(f"<p>{escape(sentence)}</p>" for sentence in self.advice)
        return f"<b>{escape(self.title)}</b>, {about}{advice}<pre>{escape(self._text)}</pre>"


def evaluate(case: Case, parameters: Mapping[str, Any] | None = None, *, threads: int = 1) -> dict[str, Any]:
    """Return the numbers of the last state of a case with keys changed: a function for optimisers and samplers.

    The result has the columns of ``history.csv`` by name, and ``lost``: why the tube could not be followed to the end, or
    None. If it could not, numbers with a decimal point are NaN, so that an optimiser does not settle there. The result can
    be pickled. One thread is used unless told otherwise.
    """
    changed = case.with_(parameters) if parameters else case
    numbers: dict[str, Any] = {}
    lost = None
    try:
        for state in changed.states(threads=threads):
            numbers = state.numbers
    except RuntimeError as error:
        lost = str(error)
        numbers = {name: math.nan if isinstance(value, float) else value for name, value in numbers.items()}
    return {**numbers, "lost": lost}
