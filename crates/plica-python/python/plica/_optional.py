"""Packages that are used where they are installed."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def require(name: str) -> Any:
    """Import a package, or raise ImportError that says how to install it."""
    try:
        return import_module(name)
    except ImportError as error:
        package = name.split(".")[0]
        message = f"this needs {package}, which is not installed: pip install 'plica[all]' (or pip install {package})"
        raise ImportError(message, name=package) from error
