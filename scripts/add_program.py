"""Adds the program plica to a wheel of the Python module.

    python scripts/add_program.py WHEEL PROGRAM FOLDER

Requires the package wheel. Writes a wheel of the same name to the folder, and prints its path.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path


def main() -> None:
    """Unpack the wheel, copy the program to its scripts, and pack it."""
    wheel, program, folder = (Path(argument).resolve() for argument in sys.argv[1:])
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        run("unpack", "--dest", scratch, wheel)
        (tree,) = Path(scratch).iterdir()
        scripts = tree / f"{tree.name}.data" / "scripts"
        scripts.mkdir(parents=True)
        copied = scripts / ("plica.exe" if program.suffix == ".exe" else "plica")
        shutil.copyfile(program, copied)
        copied.chmod(0o755)
        run("pack", "--dest-dir", folder, tree)
    print(folder / wheel.name)


def run(*arguments: object) -> None:
    """Run a command of the package wheel."""
    command = [sys.executable, "-m", "wheel", *map(str, arguments)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main()
