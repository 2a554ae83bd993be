"""Writes the Python code of the pages and of the notebooks to files, one for each document.

    python examples.py FOLDER
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

DOCUMENTS = Path(__file__).parents[3] / "docs"
PAGES = ["python.md", "install.md", "tutorial.md", "how-to/results.md", "index.md"]


def of_page(path: Path) -> str:
    """Return the Python blocks of a Markdown page."""
    blocks = path.read_text(encoding="utf-8").split("```python\n")[1:]
    return "\n".join(block.split("```")[0] for block in blocks)


def of_notebook(path: Path) -> str:
    """Return the code cells of a notebook."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return "\n".join("".join(cell["source"]) + "\n" for cell in cells if cell["cell_type"] == "code")


def notebooks() -> list[Path]:
    """Return the notebooks of the documents."""
    return sorted((DOCUMENTS / "notebooks").glob("*.ipynb"))


def main() -> None:
    """Write the files."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True)
    for page in PAGES:
        name = page.replace(".md", "_page.py").replace("/", "_").replace("-", "_")
        (folder / name).write_text(of_page(DOCUMENTS / page), encoding="utf-8")
    for path in notebooks():
        (folder / f"{path.stem.replace('-', '_')}.py").write_text(of_notebook(path), encoding="utf-8")


if __name__ == "__main__":
    main()
