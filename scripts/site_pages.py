"""Prepares the pages of the documentation site: site_pages.py DIRECTORY RUSTDOC

Copies docs/, and adds the pages that the repository holds elsewhere: changelog, architecture, contributing, and the help of
the program (from crates/plica-cli/tests/help.txt, which a test compares with the program). Notebooks become pages. Links that
leave docs/ lead to the page of the site that has their content, or else to the repository. RUSTDOC is the folder that
`cargo doc` writes to; if it has pages, the site has them in rust/. Files are only written if they change.
"""

import json
import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CODE = "https://github.com/plica/plica/blob/main/"
# Pages of the site by their file in the repository.
ELSEWHERE = {"CHANGELOG.md": "changelog.md", "ARCHITECTURE.md": "architecture.md", "CONTRIBUTING.md": "contributing.md"}
LINK = re.compile(r"\]\(([^)#\s:]+)((?:#[^)\s]*)?)\)")


def page_of(path: str) -> str:
    """Return the page of the site that shows a file of the repository, or its address."""
    if path.startswith("docs/"):
        return path.replace(".ipynb", ".md")
    case = re.fullmatch(r"cases/([\w-]+)\.toml", path)
    own = f"gallery/{case[1]}.md" if case else ELSEWHERE.get(path)
    if own and (case is None or (ROOT / "docs" / own).exists()):
        return f"docs/{own}"
    if not (ROOT / path).exists():
        raise SystemExit(f"a link to {path}, which does not exist")
    return CODE + path


def with_links(text: str, source: str, page: str) -> str:
    """Return a text with links that hold at its page of the site; `source` is its file in the repository."""

    def link(match: re.Match[str]) -> str:
        path = os.path.normpath(os.path.join(os.path.dirname(source), match[1]))
        target = page_of(path)
        if not target.startswith(CODE):
            target = os.path.relpath(target, os.path.dirname(f"docs/{page}"))
        return f"]({target}{match[2]})"

    top = os.path.relpath(".", os.path.dirname(source) or ".")
    parts = text.replace(f"]({CODE}", f"]({top}/").split("```")  # no links in code
    parts[::2] = [LINK.sub(link, part) for part in parts[::2]]
    return "```".join(parts)


def notebook(text: str) -> str:
    """Return the page of a notebook: its text and its code."""
    parts = ["---\norphan: true\n---"]  # pages link to it
    for cell in json.loads(text)["cells"]:
        source = "".join(cell["source"])
        parts.append(source if cell["cell_type"] == "markdown" else f"```python\n{source}\n```")
    return "\n\n".join(parts) + "\n"


def command_line() -> str:
    """Return the page with the help of every command."""
    text = (ROOT / "crates/plica-cli/tests/help.txt").read_text(encoding="utf-8")
    lines = ["# The command line", "", "The program prints these texts: `plica COMMAND --help`.", ""]
    for part in text.split("==== ")[1:]:
        head, _, body = part.partition("\n")
        lines += [f"## `{head.removesuffix(' --help')}`", "", "```text", body.strip("\n"), "```", ""]
    return "\n".join(lines)


def main() -> None:
    """Write every file of the source of the site, and remove files that belong to it no more."""
    out = Path(sys.argv[1])
    files: dict[str, bytes] = {"command-line.md": command_line().encode()}
    for path in sorted((ROOT / "docs").rglob("*")):
        name = path.relative_to(ROOT / "docs").as_posix()
        if path.is_file() and "__pycache__" not in name:
            content = path.read_bytes()
            if name.endswith(".ipynb"):
                name = name.replace(".ipynb", ".md")
                content = notebook(content.decode()).encode()
            files[name] = with_links(content.decode(), f"docs/{name}", name).encode() if name.endswith(".md") else content
    for source, page in ELSEWHERE.items():
        files[page] = with_links((ROOT / source).read_text(encoding="utf-8"), source, page).encode()
    if Path(sys.argv[2], "plica/index.html").exists():
        files["rust-api.md"] += b'\nThe pages that it makes are <a href="rust/plica/index.html">part of this site</a>.\n'
    for path in (ROOT / "cases").glob("*.toml"):
        files[f"cases/{path.name}"] = path.read_bytes()

    for path in [path for path in out.rglob("*") if path.is_file() and "vendor" not in path.parts]:
        if path.relative_to(out).as_posix() not in files:
            path.unlink()
    for name, content in files.items():
        path = out / name
        if not path.exists() or path.read_bytes() != content:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)


if __name__ == "__main__":
    main()
