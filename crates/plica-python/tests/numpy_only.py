"""Checks an installed wheel in an environment without pandas, Matplotlib and PyVista."""

import json
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

import numpy as np

import plica

OPTIONAL = ("pandas", "matplotlib", "pyvista", "xarray", "IPython")


def refused(what: object) -> str:
    """Return why a function cannot work without a package."""
    try:
        what()  # type: ignore[operator]
    except ImportError as error:
        return str(error)
    raise AssertionError("a package that is not installed was not missed")


def main() -> None:
    """Run a case, look at its results, and miss packages."""
    assert not any(map(find_spec, OPTIONAL)), "this environment has more than NumPy"
    case = plica.Case.parse(
        """
        tube = { length = 2.0, thickness = 0.1 }
        mesh.control_points = { axial = 24, around = 12, thickness = 4 }
        output = { pictures = true, stability_modes = 0 }
        [muscles.ring]
        direction = "circular"
        zone = [0.5, 1.5]
        [[stages]]
        steps = 3
        drive.ring.stretch = 0.7
        """
    )
    with tempfile.TemporaryDirectory() as folder:
        run = case.run(Path(folder) / "run", progress=True)
        assert run.verdict is plica.Verdict.COMPLETE
        assert np.all(np.diff(run["energy"]) > 0.0)
        assert run[-1].fields("hoop_stress", [1.0], 0.45).shape == (1,)
        assert run.plot.picture().startswith(b"\x89PNG")
        assert "<img" in run._repr_html_()
        for what, package in (
            (lambda: run.history, "pandas"),
            (run.to_xarray, "xarray"),
            (run.plot.energy, "matplotlib"),
            (run[-1].volume, "pyvista"),
        ):
            message = refused(what)
            assert package in message and "pip install 'plica[all]'" in message, message
    if "--without-program" in sys.argv:
        return  # installed from the source distribution
    program = Path(sys.executable).with_name("plica.exe" if sys.platform == "win32" else "plica")
    schema = subprocess.run([program, "schema"], check=True, capture_output=True, text=True)
    assert "stages" in json.loads(schema.stdout)["properties"]
    version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True)
    assert plica.__version__ in version.stdout


if __name__ == "__main__":
    main()
