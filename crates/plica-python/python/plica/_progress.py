"""Progress of a run on a terminal or in a notebook."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Report = Callable[[str, float], None]


@contextmanager
def reporter(progress: bool | Report, title: str) -> Iterator[Report | None]:
    """Yield the function that receives the progress, or None."""
    if callable(progress):
        yield progress
        return
    if not progress or not sys.stderr.isatty():
        yield None
        return

    def report(activity: str, fraction: float) -> None:
        sys.stderr.write(f"\r\x1b[K{title}: {100 * fraction:3.0f} %  {activity}"[:160])
        sys.stderr.flush()

    try:
        yield report
    finally:
        sys.stderr.write("\r\x1b[K")
        sys.stderr.flush()
