"""Tests of the module by the habits of its users."""

from __future__ import annotations

import io
import json
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from contextlib import redirect_stderr
from pathlib import Path

import numpy as np

import plica
from examples import DOCUMENTS, PAGES, of_page
from small import RING, energy_at


class Cases(unittest.TestCase):
    def test_keywords_and_text_describe_the_same_case(self) -> None:
        case = plica.Case(**RING)
        self.assertEqual(plica.Case.parse(case.text), case)
        self.assertEqual((case.title, len(case)), ("A ring contracts", 4))
        self.assertEqual(case.unknowns, 24 * 4 * 3)
        self.assertIn("A ring contracts", repr(case))
        self.assertIn("<pre>", case._repr_html_())

    def test_all_problems_are_reported_with_their_place(self) -> None:
        text = "[tube]\nlenght = 2.0\n[mesh]\ndegree = 9\n[[stages]]\ndrive.colon.displacement = 0.1\n"
        with self.assertRaises(plica.CaseError) as raised:
            plica.Case.parse(text, "tube")
        problems = raised.exception.problems
        self.assertEqual([(p.key, p.line) for p in problems], [("tube.lenght", 2), ("mesh.degree", 4)])
        self.assertIn("length", str(problems[0].help))
        self.assertIn("tube, line 4: mesh.degree = 9: must be at most 5", str(raised.exception))
        copy = pickle.loads(pickle.dumps(raised.exception))
        self.assertEqual(copy.problems, problems)

    def test_a_changed_case_is_another_one(self) -> None:
        case = plica.Case(**RING)
        thin = case.with_({"tube.thickness": np.float64(0.05), "stages[1].steps": 2})
        self.assertEqual((len(thin), len(case)), (3, 4))
        with self.assertRaises(plica.CaseError):
            case.with_({"tube.thickness": 0.7})
        for wrong in ({"title.x": 1}, {"stages[3].steps": 2}):
            with self.assertRaises(plica.CaseError):
                case.with_(wrong)
        with self.assertRaises(TypeError):
            case.with_({"title": object()})
        with self.assertRaises(AttributeError):
            case.text = ""  # type: ignore[misc]
        self.assertEqual(pickle.loads(pickle.dumps(thin)), thin)
        self.assertEqual(len({case, thin, plica.Case(**RING)}), 2)

    def test_the_starter_is_the_tube_that_invaginates(self) -> None:
        self.assertIn("nvaginat", plica.Case.starter().title)


class States(unittest.TestCase):
    def test_states_are_streamed_with_numbers_and_unknowns(self) -> None:
        seen: list[tuple[str, float]] = []
        states = list(plica.Case(**RING).states(threads=1, progress=lambda *report: seen.append(report)))
        self.assertEqual([state["step"] for state in states], [0, 1, 2, 3])
        self.assertEqual((states[0]["stage"], states[0]["shape"]), ("rest", "straight"))
        self.assertAlmostEqual(states[3].target_ring, 0.7)
        self.assertGreater(states[3].energy, states[1].energy)
        self.assertEqual(states[3].unknowns.shape, (24, 4, 3, 1))
        self.assertFalse(states[3].unknowns.flags.writeable)
        self.assertTrue(all(0.0 <= fraction <= 1.0 for _, fraction in seen))
        self.assertEqual(states[3].units["energy"], "E D^3")
        with self.assertRaises(KeyError):
            states[0]["nothing"]
        with self.assertRaises(AttributeError):
            states[0].nothing

    def test_fields_and_walls_have_the_shape_of_the_points(self) -> None:
        *_, last = plica.Case(**RING).states()
        z = np.linspace(0.0, 2.0, 41)
        found = last.fields(["hoop_stress", "cauchy_stress", "position"], z[:, None], [0.4, 0.5])
        self.assertEqual([found[n].shape for n in found], [(41, 2), (41, 2, 3, 3), (41, 2, 3)])
        np.testing.assert_allclose(found["cauchy_stress"], found["cauchy_stress"].swapaxes(2, 3), atol=1e-12)
        # At the middle of a symmetric tube the wall is normal to the radius: hoop stress is the last component.
        np.testing.assert_allclose(found["hoop_stress"][20], found["cauchy_stress"][20, :, 2, 2], rtol=1e-9)
        axis, radius = last.wall("outer", 41)
        self.assertAlmostEqual(radius.min(), last.outer_radius_min, places=6)
        np.testing.assert_allclose(axis, found["position"][:, 1, 2], atol=1e-12)
        x, y, _ = last.surface("inner", (5, 9))
        # Twelve control points make a circle to 2e-4.
        np.testing.assert_allclose(np.hypot(x, y), np.hypot(x, y)[:, :1].repeat(9, 1), rtol=1e-3)
        for wrong in (lambda: last.fields("colour", 0.0, 0.5), lambda: last.wall("middle")):
            with self.assertRaises(ValueError):
                wrong()

    def test_units_are_those_of_the_case(self) -> None:
        case = plica.Case(**RING).with_({"units": {"length": "mm", "stress": "kPa"}, "tube.diameter": 10.0, "tube.length": 20.0,
                                         "tube.thickness": 1.0, "muscles.ring.zone": [5.0, 15.0]})
        *_, last = case.states()
        *_, plain = plica.Case(**RING).states()
        self.assertEqual(last.units["outer_radius_min"], "mm")
        self.assertAlmostEqual(last.outer_radius_min, 10.0 * plain.outer_radius_min, places=9)
        self.assertEqual(last.field_units["hoop_stress"], "kPa")

    def test_a_function_chooses_the_next_targets(self) -> None:
        def choose(state: plica.State) -> dict[str, float] | None:
            return {"ring.stretch": state["target_ring"] - 0.05} if state["outer_radius_min"] > 0.4 else None

        states = list(plica.Case(**RING).follow(choose))
        self.assertLessEqual(states[-1]["outer_radius_min"], 0.4)
        self.assertGreater(states[-2]["outer_radius_min"], 0.4)
        self.assertEqual([s["step"] for s in states], list(range(len(states))))

    def test_an_optimiser_finds_a_radius(self) -> None:
        low, high = 0.5, 1.0
        case = plica.Case(**RING)
        for _ in range(12):
            middle = 0.5 * (low + high)
            radius = plica.evaluate(case, {"stages[1].drive.ring.stretch": middle})["outer_radius_min"]
            low, high = (middle, high) if radius < 0.4 else (low, middle)
        self.assertAlmostEqual(plica.evaluate(case, {"stages[1].drive.ring.stretch": low})["outer_radius_min"], 0.4, places=3)


class Runs(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = Path(self.folder.name) / "run"

    def test_a_run_is_written_and_opened(self) -> None:
        case = plica.Case(**RING)
        run = case.run(self.path, progress=False)
        self.assertEqual((run.verdict, len(run), run.title), ("complete", 4, "A ring contracts"))
        streamed = [state.energy for state in case.states()]
        np.testing.assert_array_equal(run["energy"], streamed)
        self.assertEqual([state.energy for state in run], streamed)
        self.assertEqual(run[-1].unknowns.shape, (24, 4, 3, 1))
        self.assertEqual(run.case.text, case.text)
        self.assertIn("stages", run.findings)
        self.assertIn("stage contract", run.table)
        self.assertEqual(list(run["stage"]), ["rest"] + 3 * ["contract"])
        self.assertEqual(len(run["energy"][run["stage"] == "contract"]), 3)
        self.assertEqual(run.state(run["step"][-1]).energy, run["energy"][-1])
        self.assertEqual(("energy" in run, "colour" in run), (True, False))
        self.assertEqual([state.step for state in run[1:3]], [1, 2])
        last = dict(run[-1])
        self.assertEqual((last["step"], "shape" in run[-1], "colour" in run[-1]), (3, True, False))
        stress = run[-1].fields("hoop_stress", [1.0], 0.45)
        stress *= 2.0
        self.assertEqual(run[-1].fields("tension", 1.0, 0.45), 0.0)
        for z, radius in ((2.1, 0.45), (1.0, 0.39), (np.nan, 0.45)):
            with self.assertRaisesRegex(ValueError, "in the wall at rest"):
                run[-1].fields("hoop_stress", z, radius)
        energy = run["energy"]
        energy -= energy[-1]
        self.assertGreater(run["energy"][-1], 0.0)
        with self.assertRaisesRegex(IndexError, "4 saved states"):
            run[100]
        with self.assertRaises(FileExistsError):
            case.run(self.path, progress=False)
        longer = case.with_({"stages[1].steps": 3}).text + "\n[[stages]]\nsteps = 1\ndrive.ring.stretch = 0.6\n"
        more = plica.Case.parse(longer).run(self.path, resume=True, progress=False)
        self.assertEqual(len(more), 5)
        with self.assertRaises(ValueError):
            case.with_({"tube.thickness": 0.2}).run(self.path, resume=True, progress=False)
        with self.assertRaises(OSError):
            plica.Run(self.path / "nothing")

    def test_a_run_that_is_lost_says_why(self) -> None:
        impatient = {"solver.max_step_halvings": 0, "solver.relaxation_steps": 1, "stages[1].steps": 1}
        case = plica.Case(**RING).with_({**impatient, "stages[1].drive.ring.stretch": 0.2})
        with self.assertWarns(RuntimeWarning) as warned:
            run = case.run(self.path, progress=False)
        self.assertIs(run.verdict, plica.Verdict.LOST)
        self.assertEqual(len(run), 1)
        why = str(warned.warning)
        with self.assertRaises(RuntimeError) as raised:
            list(case.states())
        self.assertEqual(str(raised.exception), why)
        found = plica.evaluate(case)
        self.assertEqual(found["lost"], why)
        self.assertTrue(np.isnan(found["energy"]))

    def test_a_history_is_a_data_frame(self) -> None:
        import pandas

        frame = plica.Case(**RING).run(self.path, progress=False).history
        self.assertIsInstance(frame, pandas.DataFrame)
        self.assertEqual(list(frame.step), [0, 1, 2, 3])
        self.assertEqual(frame.attrs["units"]["energy"], "E D^3")

    def test_plots_use_axes_of_the_user(self) -> None:
        import matplotlib

        matplotlib.use("agg")
        import matplotlib.pyplot as pyplot

        run = plica.Case(**RING).run(self.path, progress=False)
        figure, axes = pyplot.subplots(1, 2)
        self.assertIs(run.plot.energy(axes[0]), axes[0])
        self.assertEqual(len(run.plot.walls((0, -1), axes[1]).lines), 8)
        bare = plica.Case(**RING).with_({"output.states_every": 0}).run(f"{self.path}-bare", progress=False)
        self.assertTrue(bare.plot.energy(axes[0]).has_data())
        for draw in (bare.plot.walls, bare.plot.tube, bare.plot.pressure_map, bare.plot.animation):
            with self.assertRaisesRegex(ValueError, "no saved states"):
                draw()
        pyplot.close("all")

    def test_ctrl_c_stops_cleanly_and_the_run_goes_on(self) -> None:
        fine = plica.Case(**RING).with_({"stages[1].steps": 400})
        # Where the tests run in the background of a shell, Ctrl-C is ignored, and Python inherits that.
        script = (
            "import plica, signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
            f"plica.Case.load({str(self.path) + '.toml'!r}).run({str(self.path)!r}, progress=False)"
        )
        Path(f"{self.path}.toml").write_text(fine.text, encoding="utf-8")
        process = subprocess.Popen([sys.executable, "-c", script], stderr=subprocess.PIPE, text=True)
        history = self.path / "history.csv"
        while not (history.exists() and history.read_text().count("\n") > 3) and process.poll() is None:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", errors)
        stopped = plica.Run(self.path)
        self.assertEqual(stopped.verdict, "stopped")
        self.assertLess(len(stopped["step"]), 401)

    def test_a_thread_of_python_goes_on_while_the_tube_is_followed(self) -> None:
        ticks = []
        done = threading.Event()

        def tick() -> None:
            while not done.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.001)

        thread = threading.Thread(target=tick)
        thread.start()
        list(plica.Case(**RING).with_({"stages[1].steps": 20}).states(threads=1))
        done.set()
        thread.join()
        self.assertGreater(len(ticks), 20)


class Processes(unittest.TestCase):
    @unittest.skipUnless(hasattr(os, "fork"), "needs fork")
    def test_a_forked_process_computes(self) -> None:
        here = energy_at(0.8)  # uses threads before the fork
        with multiprocessing.get_context("fork").Pool(2) as pool:
            self.assertEqual(pool.map(energy_at, [0.8, 0.9])[0], here)

    @unittest.skipUnless(sys.platform == "linux", "reads /proc")
    def test_a_hundred_runs_leave_no_memory_behind(self) -> None:
        case = plica.Case(**RING)

        def memory() -> int:
            """Return the memory of this process in kilobytes."""
            pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
            return pages * os.sysconf("SC_PAGE_SIZE") // 1024

        def use() -> None:
            *_, last = case.states(threads=1)
            last.fields("hoop_stress", [0.5, 1.0], 0.45)
            last.unknowns.sum()
            with tempfile.TemporaryDirectory() as folder:
                case.run(Path(folder) / "run", threads=1, progress=False)[-1].numbers

        # At first the allocator keeps memory of every thread.
        for _ in range(30):
            use()
        before = memory()
        for _ in range(100):
            use()
        self.assertLess(memory() - before, 4000, "kilobytes")

    def test_nothing_is_printed(self) -> None:
        with redirect_stderr(io.StringIO()) as errors:
            list(plica.Case(**RING).states(progress=True))
        self.assertEqual(errors.getvalue(), "")

    def test_the_examples_of_the_pages_run(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            tutorial = (DOCUMENTS / "tutorial.md").read_text(encoding="utf-8")
            case = tutorial.split("```toml\n")[1].split("```")[0]
            Path(folder, "tube.toml").write_text(case, encoding="utf-8")  # the case of the home page
            for page in PAGES:  # in this order: later pages read runs of earlier ones
                code = "import matplotlib\nmatplotlib.use('agg')\n" + of_page(DOCUMENTS / page)
                with self.subTest(page):
                    subprocess.run([sys.executable, "-"], input=code, cwd=folder, check=True, text=True, stdout=subprocess.DEVNULL)

    def test_the_program_is_installed_with_the_module(self) -> None:
        program = Path(sys.executable).parent / "plica"
        schema = subprocess.run([program, "schema"], check=True, capture_output=True, text=True)
        self.assertIn("stages", json.loads(schema.stdout)["properties"])


if __name__ == "__main__":
    unittest.main()
