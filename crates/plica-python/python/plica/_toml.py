"""Writes values as in TOML."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def key(name: str) -> str:
    """Return a name as a key, in quotes where TOML needs them."""
    return name if _BARE.fullmatch(name) else json.dumps(name)


def value(x: Any) -> str:
    """Return a value as in TOML: a number, text, truth value, list or table.

    Numbers and arrays of NumPy are numbers and lists. Raises TypeError for anything else.
    """
    if hasattr(x, "tolist"):  # NumPy
        x = x.tolist()
    if isinstance(x, bool):
        return "true" if x else "false"
    if isinstance(x, int):
        return str(x)
    if isinstance(x, float):
        if math.isnan(x):
            return "nan"
        if math.isinf(x):
            return "inf" if x > 0 else "-inf"
        return repr(x)
    if isinstance(x, str):
        return json.dumps(x, ensure_ascii=False)
    if isinstance(x, Mapping):
        members = ", ".join(f"{key(str(k))} = {value(v)}" for k, v in x.items())
        return f"{{ {members} }}"
    if isinstance(x, (list, tuple)):
        return f"[{', '.join(value(v) for v in x)}]"
    raise TypeError(f"{x!r} is not a value of a case: numbers, texts, lists and dictionaries are")


def document(tables: Mapping[str, Any]) -> str:
    """Return the text of a case from its tables, as nested dictionaries and lists."""
    plain: list[str] = []
    headed: list[str] = []
    for name, content in tables.items():
        if content is None:
            continue
        if isinstance(content, Mapping) and content:
            lines = [f"{key(str(k))} = {value(v)}" for k, v in content.items()]
            headed.append("\n".join([f"[{key(name)}]", *lines]))
        elif isinstance(content, (list, tuple)) and content and all(isinstance(x, Mapping) for x in content):
            for member in content:
                lines = [f"{key(str(k))} = {value(v)}" for k, v in member.items()]
                headed.append("\n".join([f"[[{key(name)}]]", *lines]))
        else:
            plain.append(f"{key(name)} = {value(content)}")
    return "\n".join(plain) + "\n\n" + "\n\n".join(headed) + "\n"
