"""Tests of the module together with the packages that its users have."""

from __future__ import annotations

import copy
import io
import os
import sys
import tempfile
import unittest
from collections.abc import Callable
from contextlib import redirect_stderr
from pathlib import Path
from typing import Any
from unittest import mock

import matplotlib
import numpy as np

import plica
from small import FOLD, INVAGINATION, RING, energy_at

matplotlib.use("agg")
import matplotlib.pyplot as pyplot  # noqa: E402


LENGTH_RATIO = "stages[1].drive.longitudinal.length_ratio"


class OneRun(unittest.TestCase):
    """Tests of one run of a tube that is about to invaginate."""

    folder: tempfile.TemporaryDirectory[str]
    run_: plica.Run

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.run_ = plica.Case(**INVAGINATION).run(Path(cls.folder.name) / "run", progress=False)

    def tearDown(self) -> None:
        pyplot.close("all")


class Optimisers(OneRun):
    def relaxed(self, number: int) -> plica.Case:
        """Return a case that goes on from a saved state."""
        text = self.run_.case.text
        text = text[: text.index("[[stages]]")] + "\n[[stages]]\nsteps = 1\ndrive.longitudinal.length_ratio = 1.19\n"
        text += f"[start]\nstate = 'states/state-{number:04}.safetensors'\n"
        return plica.Case.parse(text, "relaxed", self.run_.path)

    def test_scipy_finds_where_the_wall_is_upright(self) -> None:
        from scipy.optimize import brentq

        case = self.relaxed(33)  # Lmax/L = 1.18

        def above_upright(length_ratio: float) -> float:
            return float(plica.evaluate(case, {LENGTH_RATIO: length_ratio})["max_wall_angle_deg"]) - 90.0

        found = brentq(above_upright, 1.185, 1.1905, xtol=1e-6)
        # Small steps along the same path come to the same place.
        steps = list(case.with_({"stages[1].steps": 20, LENGTH_RATIO: 1.1905}).states())
        ratios = [state.length_ratio for state in steps]
        angles = [state.max_wall_angle_deg for state in steps]
        self.assertAlmostEqual(found, float(np.interp(90.0, angles, ratios)), places=5)
        self.assertAlmostEqual(found, 1.19, delta=1e-3)

    def test_scipy_finds_the_least_energy(self) -> None:
        from scipy.optimize import minimize_scalar

        case = self.relaxed(26).with_({"stages[1].steps": 2})  # Lmax/L = 1.11

        def energy(length_ratio: float) -> float:
            return float(plica.evaluate(case, {LENGTH_RATIO: length_ratio})["energy"])

        least = minimize_scalar(energy, bracket=(1.12, 1.13, 1.14), tol=1e-3)
        self.assertAlmostEqual(least.x, 1.13, delta=0.005)
        energies = self.run_["energy"][20:]
        self.assertLessEqual(least.fun, energies.min())
        self.assertGreater(least.fun, 0.999 * energies.min())

    def test_joblib_evaluates_in_two_processes(self) -> None:
        from joblib import Parallel, delayed

        stretches = [0.9, 0.8, 0.7]
        found = Parallel(n_jobs=2)(delayed(energy_at)(stretch) for stretch in stretches)
        self.assertEqual(found, [energy_at(stretch) for stretch in stretches])

    @unittest.skipUnless(sys.platform == "linux" and len(os.sched_getaffinity(0)) > 1, "counts the threads of Linux")
    def test_threads_are_as_many_as_asked_for_or_as_the_environment_says(self) -> None:
        case = plica.Case(**RING).with_({"stages[1].steps": 60})

        def most(threads: int | None) -> int:
            """Return the largest number of threads of this process while a run reports."""
            seen = []
            path = Path(self.folder.name) / "threads"
            case.run(path, overwrite=True, threads=threads, progress=lambda *_: seen.append(len(os.listdir("/proc/self/task"))))
            return max(seen)

        one, two = most(1), most(2)
        self.assertEqual(two, one + 1)
        with mock.patch.dict(os.environ, {"OMP_NUM_THREADS": "1"}):
            self.assertEqual((most(None), most(2)), (one, two))
        self.assertEqual(most(1000), most(len(os.sched_getaffinity(0))))


class DataSets(OneRun):
    def test_pyvista_clips_and_samples_a_state(self) -> None:
        import pyvista

        state = self.run_[-1]
        fields = ["hoop_stress", "displacement", "cauchy_stress"]
        exact, linear = state.volume(fields), state.volume(fields, linear=True)
        self.assertEqual(set(exact.celltypes), {pyvista.CellType.LAGRANGE_HEXAHEDRON})
        self.assertEqual(exact.n_points, linear.n_points)
        # Lagrange cells are as large as the wall, straight ones a little smaller.
        volume = np.pi * (0.5**2 - 0.44**2) * 3.0
        rest = self.run_.state(0).volume([])
        self.assertAlmostEqual(rest.compute_cell_sizes(length=False, area=False)["Volume"].sum(), volume, delta=2e-3 * volume)
        # Values at points of the mesh are those of the state at the same material points.
        z = np.array([0.6, 0.75, 0.9])
        position = state.fields("position", z, 0.47)
        sampled = pyvista.PolyData(position).sample(linear)
        self.assertTrue(np.all(sampled["vtkValidPointMask"]))
        hoop = state.fields("hoop_stress", z, 0.47)
        np.testing.assert_allclose(sampled["hoop_stress"], hoop, atol=0.05 * np.abs(hoop).max())
        half = linear.clip("y")
        self.assertLess(half.n_cells, linear.n_cells)
        self.assertGreater(half.n_cells, 0.4 * linear.n_cells)
        self.assertEqual(half["cauchy_stress"].shape[1], 6)

    def test_walls_and_meridian_are_surfaces(self) -> None:
        state = self.run_[-1]
        walls = state.walls(["von_mises_stress"])
        self.assertTrue(walls.is_manifold)
        self.assertEqual(sorted(set(walls.cell_data["face"])), [0, 1, 2, 3])
        outer = walls.points[:, :2]
        self.assertAlmostEqual(np.hypot(outer[:, 0], outer[:, 1]).max(), state.outer_radius_max, places=3)
        meridian = state.meridian()
        self.assertAlmostEqual(float(np.abs(meridian.points[:, 1]).max()), 0.0, places=9)
        at_rest = self.run_.state(0).meridian().compute_cell_sizes(length=False, volume=False)
        self.assertAlmostEqual(at_rest["Area"].sum(), 3.0 * 0.06, places=5)
        with self.assertRaisesRegex(ValueError, "there is no field colour; there are displacement"):
            state.walls(["colour"])

    def test_the_history_is_an_xarray(self) -> None:
        dataset = self.run_.to_xarray()
        self.assertEqual(dataset["energy"].attrs["units"], "E D^3")
        upright = dataset.isel(step=int(dataset["max_wall_angle_deg"].argmax("step")))
        self.assertEqual(int(upright["step"]), 34)


class Stability(OneRun):
    def test_the_critical_load_and_its_mode(self) -> None:
        found = self.run_.stability(highest=2, tolerance=1e-3, progress=False)
        self.assertEqual(len(found.changes), 1)
        (change,) = found.changes
        self.assertTrue(change.is_lost)
        self.assertEqual((change.mode, change.quantity, change.negative), (1, "Lmax/L", (0, 1)))
        self.assertTrue(1.17 < change.critical < 1.19)
        self.assertTrue(change.between[0] <= change.critical <= change.between[1])
        self.assertIn("first loss", found.table)
        eigenvalues = found.eigenvalues
        self.assertEqual(int((eigenvalues["negative_1"] > 0).sum()), 3)
        (mode,) = found.modes
        self.assertEqual((mode.mode, mode.state), (1, 32))
        self.assertLess(abs(mode.eigenvalue), 0.1 * eigenvalues["lowest_1"].iloc[1])
        # A tilt moves opposite sides alike across the axis and contrarily along it.
        z = np.linspace(0.2, 2.8, 27)
        _, front = mode.evaluate(z, 0.5, 0.0)
        _, back = mode.evaluate(z, 0.5, np.pi)
        np.testing.assert_allclose(front[:, 0], back[:, 0], atol=1e-9)
        np.testing.assert_allclose(front[:, 2], -back[:, 2], atol=1e-9)
        grid = mode.wall(scale=0.05)
        self.assertAlmostEqual(float(np.linalg.norm(grid["mode"], axis=1).max()), 1.0, delta=0.02)
        position, _ = mode.evaluate(1.5, 0.5, 0.3)
        self.assertEqual(position.shape, (3,))
        self.assertTrue((self.run_.path / "stability.csv").exists())
        with self.assertRaisesRegex(ValueError, "three-dimensional"):
            self.run_.stability(modes=2, progress=False)


class Plots(OneRun):
    def test_every_plot_uses_axes_of_the_user(self) -> None:
        run = self.run_
        figure, axes = pyplot.subplots(2, 3)
        draws: list[Callable[[Any], Any]] = [
            run.plot.energy,
            lambda ax: run.plot.walls([0, -1], ax),
            lambda ax: run.plot.tube([-1], ax, width=400, field="von-mises", view="front"),
            lambda ax: run.plot.pressure_map("lumen_radius", ax),
            lambda ax: run.plot.columns("step", ["energy", "overhang"], ax),
            lambda ax: plica.plot.walls(run[-1], ax, color="k"),
        ]
        for ax, draw in zip(axes.ravel(), draws, strict=True):
            self.assertIs(draw(ax), ax)
            self.assertTrue(ax.has_data())
        figure.canvas.draw()
        self.assertIn("max", axes[0, 0].get_xlabel())
        self.assertEqual([text.get_text() for text in axes[0, 0].texts], ["minimum", " square"])
        legend = run.plot.walls().get_legend()
        assert legend is not None
        labels = [text.get_text() for text in legend.get_texts()]
        self.assertIn("state 34", labels)
        with self.assertRaisesRegex(ValueError, "contact = true"):
            run.plot.pressure_map("contact_pressure")
        with self.assertRaisesRegex(ValueError, "there is no view"):
            run.plot.picture(view="below")
        with self.assertRaisesRegex(ValueError, "there is no field"):
            run.plot.picture(field="colour")

    def test_a_map_of_the_lumen_has_its_radii(self) -> None:
        z, radius = self.run_.plot.pressures("lumen_radius")
        self.assertEqual(radius.shape, (35, len(z)))
        np.testing.assert_allclose(radius[0], 0.44, atol=1e-4)
        inner = self.run_[-1].wall("inner", 2001)[1].min()
        self.assertAlmostEqual(float(np.nanmin(radius[-1])), inner, places=3)

    def test_an_animation_plays_in_a_notebook(self) -> None:
        short = plica.Case(**RING).run(Path(self.folder.name) / "ring", progress=False)
        animation = short.plot.animation(width=300, progress=False)
        self.assertIn(b"acTL", animation.data)
        self.assertIn("data:image/apng;base64,", animation._repr_html_())
        animation.save(Path(self.folder.name) / "ring.apng")
        self.assertTrue((Path(self.folder.name) / "ring.apng").stat().st_size > 1000)

    def test_results_show_themselves_in_a_notebook(self) -> None:
        self.assertIn("data:image/png;base64", self.run_._repr_html_())
        self.assertIn("invagina", self.run_.case._repr_html_())
        self.assertIn("<td>max_wall_angle_deg</td>", self.run_[-1]._repr_html_())


class Words(OneRun):
    def test_words_equal_their_text(self) -> None:
        state = self.run_[-1]
        self.assertIs(state.shape, plica.Shape.SQUARE)
        self.assertEqual(state.shape, "square")
        self.assertEqual(f"{state.shape:>8}", "  square")
        self.assertIs(state.method, plica.Method.NEWTON)
        self.assertIs(self.run_.verdict, plica.Verdict.COMPLETE)
        self.assertEqual([shape.value for shape in plica.Shape], plica._native.SHAPES)
        self.assertIs(self.run_[0].method, plica.Method.REST)

    def test_reactions_balance(self) -> None:
        reactions = self.run_[-1].reactions
        self.assertEqual(list(reactions), ["colon", "ileum"])
        forces = [reaction.axial_force for reaction in reactions.values()]
        self.assertGreater(abs(forces[0]), 1e-5)
        self.assertAlmostEqual(forces[0], forces[1], delta=1e-6 * abs(forces[0]) + 1e-9)

    def test_unknowns_are_made_once_and_outlive_their_state(self) -> None:
        state = self.run_[-1]
        unknowns = state.unknowns
        self.assertIs(state.unknowns, unknowns)
        total = float(unknowns.sum())
        del state
        self.assertEqual(float(unknowns.sum()), total)
        with self.assertRaises(AttributeError):
            copy.copy(self.run_[-1]).nothing


class Contact(unittest.TestCase):
    def test_a_map_of_contact_has_the_numbers_of_the_record(self) -> None:
        """Compares with the table of the program, manometry.csv."""
        import pandas

        with tempfile.TemporaryDirectory() as folder:
            run = plica.Case(**FOLD).run(Path(folder) / "run", progress=False)
            record = pandas.read_csv(run.path / "manometry.csv")
            z, force = run.plot.pressures("contact_force")
            _, pressure = run.plot.pressures("contact_pressure")
            touched = sorted(set(record["state"]))
            self.assertGreater(len(touched), 1)
            for number in touched:
                row = run.state_numbers.index(number)
                own = record[record["state"] == number]
                expected, largest = own["force_per_length"].sum(), own["pressure"].max()
                self.assertAlmostEqual(force[row].sum(), expected, delta=1e-5 * expected)
                self.assertAlmostEqual(pressure[row].max(), largest, delta=1e-5 * largest)
            self.assertTrue(run.plot.pressure_map().has_data())
            pyplot.close("all")


class Notebooks(unittest.TestCase):
    def test_the_notebooks_run(self) -> None:
        import nbformat
        from nbclient import NotebookClient

        from examples import notebooks

        paths = notebooks()
        self.assertTrue(paths)
        for path in paths:
            notebook: Any = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
            with tempfile.TemporaryDirectory() as folder, redirect_stderr(io.StringIO()):
                client = NotebookClient(notebook, timeout=120, resources={"metadata": {"path": folder}})
                client.execute()
            html = "".join(
                str(output.get("data", {}).get("text/html", "")) for cell in notebook.cells for output in cell.get("outputs", [])
            )
            self.assertIn("data:image/png;base64", html)
            self.assertIn("data:image/apng;base64", html)


if __name__ == "__main__":
    unittest.main()
