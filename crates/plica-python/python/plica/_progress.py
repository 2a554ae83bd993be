"""Progress of a computation on a terminal or in a notebook."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape
from typing import Any

Report = Callable[[str, float], None]

WIDTH = 24
"""Characters of the bar on a terminal."""
INTERVAL = 0.25
"""Seconds between two updates in a notebook, which pass through a web server."""


def _display() -> Any:
    """Return the function that shows an object in a notebook, or None outside one."""
    shell = sys.modules.get("IPython")
    shell = None if shell is None else shell.get_ipython()
    if shell is None or not hasattr(shell, "kernel"):
        return None
    from IPython.display import display

    return display


class _Html:
    """Text that a notebook shows as HTML."""

    def __init__(self, html: str, plain: str) -> None:
        self.html = html
        self.plain = plain

    def _repr_html_(self) -> str:
        return self.html

    def __repr__(self) -> str:
        return self.plain


def _in_html(title: str, activity: str, fraction: float) -> _Html:
    plain = f"{title}: {100 * fraction:.0f} %, {activity}"
    bar = f'<progress value="{fraction:.4f}" max="1" style="width: 16em; vertical-align: middle"></progress>'
    return _Html(f"{escape(title)} {bar} {100 * fraction:.0f} % <small>{escape(activity)}</small>", plain)


def _on_terminal(title: str, activity: str, fraction: float) -> str:
    full = int(WIDTH * min(max(fraction, 0.0), 1.0))
    bar = "#" * full + "." * (WIDTH - full)
    return f"{title} [{bar}] {100 * fraction:3.0f} %  {activity}"[:160]


@contextmanager
def reporter(progress: bool | Report, title: str) -> Iterator[Report | None]:
    """Yield the function that receives the progress: the user's, one for the terminal or the notebook, or None."""
    if callable(progress):
        yield progress
        return
    if not progress:
        yield None
        return
    display = _display()
    if display is not None:
        handle = display(_in_html(title, "", 0.0), display_id=True)
        last = 0.0

        def show(activity: str, fraction: float) -> None:
            nonlocal last
            if time.monotonic() - last >= INTERVAL:
                last = time.monotonic()
                handle.update(_in_html(title, activity, fraction))

        try:
            yield show
        finally:
            handle.update(_Html("", ""))
        return
    if not sys.stderr.isatty():
        yield None
        return

    def write(activity: str, fraction: float) -> None:
        sys.stderr.write(f"\r\x1b[K{_on_terminal(title, activity, fraction)}")
        sys.stderr.flush()

    try:
        yield write
    finally:
        sys.stderr.write("\r\x1b[K")
        sys.stderr.flush()
