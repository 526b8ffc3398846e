"""The Python module: its results, its arrays (which must be views), its errors, and the completeness of its stubs.

module_test.py WEFT SOURCES    PYTHONPATH names the folder of the module.
"""
import ast
import copy
import decimal
import enum
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

import numpy
import weft

PROGRAM, SOURCES = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
DRAPE = """
[time]
duration = 0.4
fps = 25
[[cloth]]
name = "sheet"
size = [0.5, 0.5]
particles = [16, 16]
position = [0, 0, 0.25]
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.15
segments = 16
"""


class Side(enum.IntEnum):
    SHORT = 9


def run(*words, folder):
    subprocess.run([PROGRAM, *map(str, words)], cwd=folder, check=True, capture_output=True)


class Module(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        (self.folder / "drape.toml").write_text(DRAPE)
        self.addCleanup(self.temporary.cleanup)

    def test_frames_have_the_bits_of_a_cache_of_the_program(self):
        run("simulate", "drape.toml", "--cache", "cache", folder=self.folder)
        cache = weft.Cache(self.folder / "cache")
        self.assertEqual(cache.frames, list(range(11)))
        self.assertEqual((cache.fps, cache.scene.frames, cache.scene.name), (25, 11, "drape"))
        simulation = weft.Simulation(weft.load(self.folder / "drape.toml"))
        for number in cache.frames[1:]:
            frame, cached = simulation.advance(), cache[number]
            self.assertEqual((frame.number, frame.time), (number, number / 25))
            for name in ("sheet", "ball"):
                numpy.testing.assert_array_equal(frame[name].positions, cached[name].positions)
                numpy.testing.assert_array_equal(frame[name].triangles, cached[name].triangles)
            self.assertEqual(frame.report.kinetic_energy, cached.report.kinetic_energy)
        (self.folder / "cache/frame_00007.weft").unlink()
        self.assertEqual([frame.number for frame in cache], [0, 1, 2, 3, 4, 5, 6, 8, 9, 10])

    def test_relative_paths_stay_those_of_the_folder_in_which_they_were_given(self):
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        run("simulate", "drape.toml", "--frames", "0:2", "--cache", "cache", folder=self.folder)
        os.chdir(self.folder)
        cache = weft.Cache("cache")
        os.chdir(before)
        self.assertEqual([frame.number for frame in cache], [0, 1])

    def test_model_of_arrays_has_the_bits_of_the_scene_that_says_the_same(self):
        scene = weft.parse(DRAPE, {"cloth.sheet.shape": "aligned_triangles", "cloth.sheet.material.fabric": "silk",
                                   "cloth.sheet.position": [0, 0, 0], "obstacle.ball.position": [0, 0, -0.25]})
        of_scene = weft.Simulation(scene)
        sheet, ball = of_scene.frame["sheet"], of_scene.frame["ball"]
        model = weft.Model()
        model.add_cloth("sheet", sheet.positions, sheet.triangles, material="silk")
        model.add_body("ball", ball.positions + [0, 0, 0.25], ball.triangles, position=[0, 0, -0.25])
        of_model = weft.Simulation(model)
        for _ in range(5):
            expected, got = of_scene.advance(), of_model.advance()
        # The ball's vertices are shifted back and forth, which rounds them. The sheet is not affected before they
        # touch.
        numpy.testing.assert_array_equal(got["sheet"].positions, expected["sheet"].positions)
        numpy.testing.assert_allclose(got["ball"].positions, expected["ball"].positions, atol=1e-15)
        self.assertEqual(got["ball"].kind, "obstacle")
        with self.assertRaisesRegex(ValueError, "looks"):
            weft.Renderer(scene).draw(got)

    def test_models_are_pinned_driven_and_refused_by_name(self):
        corners, triangles = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
        model = weft.Model()
        model.gravity = [0, 0, -1]
        model.method = weft.Method.bdf2
        cloth = weft.Material()
        cloth.density = 0.2
        model.add_cloth("sheet", corners, triangles, material=cloth, rest=[row[:2] for row in corners])
        model.add_body("hand", corners, triangles, position=[0, 0, 1], collide=False)
        model.add_body("gate", corners, triangles, keys=[(0, [9, 0, 0], [1, 0, 0, 0]), (1, [10, 0, 0], [1, 0, 0, 0])])
        model.pin("sheet", [0, 1], body="hand")
        model.pin("sheet", [2], release=0.04)
        simulation = weft.Simulation(model, driven=["hand"])
        simulation.move("hand", [0, 0, 1.1])
        frame = simulation.advance()
        numpy.testing.assert_allclose(frame["sheet"].positions[:2, 2], 0.1, atol=1e-12)
        self.assertEqual(frame["sheet"].positions[2, 2], 0)
        self.assertGreater(frame["gate"].positions[0, 0], 9)
        self.assertGreater(simulation.advance()["gate"].positions[0, 0], frame["gate"].positions[0, 0])
        with self.assertRaisesRegex(ValueError, r"positions: expected an array of n rows and 3 columns, got shape \(3\)"):
            model.add_cloth("flat", [0, 0, 0], triangles)
        with self.assertRaisesRegex(ValueError, "triangles: expected integers, got float64"):
            model.add_cloth("flat", corners, [[0.0, 1, 2]])
        with self.assertRaisesRegex(ValueError, "triangles: expected numbers of vertices, got 4294967296"):
            model.add_cloth("flat", corners, [[2**32, 1, 2]])
        with self.assertRaisesRegex(ValueError, "velvet"):
            model.add_cloth("flat", corners, triangles, material="velvet 2")
        with self.assertRaisesRegex(ValueError, "particles: expected integers, got bool"):
            model.pin("sheet", numpy.array([False, True, False, False]))
        with self.assertRaisesRegex(ValueError, "particles: expected numbers of particles, got 4294967296"):
            model.pin("sheet", [2**32])
        with self.assertRaises(TypeError):
            model.gravity[2] = 0
        self.assertEqual(model.gravity, (0, 0, -1))
        model.add_cloth("sheet", corners, triangles)
        with self.assertRaisesRegex(ValueError, "names differ"):
            weft.Simulation(model)

    def test_arrays_are_views_that_stay_valid_and_cannot_be_written_to(self):
        simulation = weft.Simulation(weft.parse(DRAPE))
        sheet = simulation.frame["sheet"]
        positions = sheet.positions
        self.assertEqual((positions.shape, positions.dtype), ((256, 3), numpy.float64))
        self.assertEqual((sheet.strains.shape, sheet.velocities.shape, sheet.rest.shape), ((256,), (256, 3), (256, 2)))
        self.assertEqual(positions.__array_interface__["data"], sheet.positions.__array_interface__["data"])
        before = positions.copy()
        for _ in range(5):
            simulation.advance()
        del simulation, sheet
        numpy.testing.assert_array_equal(positions, before)
        with self.assertRaises(ValueError):
            positions[0, 0] = 1

    def test_changes_take_python_values(self):
        scene = weft.parse(DRAPE).with_changes({
            "cloth.sheet.material.fabric": "silk", "time.step": 0.005, "contact.self": False,
            "cloth.sheet.particles": (numpy.int64(9), 11), "cloth.sheet.position": numpy.array([0, 0, 0.3]),
            "cloth.sheet.pin": [{"low": [0, 0], "high": [0, 1], "release": 0.2}]})
        start = weft.Simulation(scene).frame["sheet"].positions
        self.assertEqual(start.shape, (99, 3))
        self.assertTrue((start[:, 2] == 0.3).all())

    def test_changes_take_numbers_of_any_class_and_refuse_what_toml_lacks(self):
        scene = weft.parse(DRAPE)
        exact = scene.with_changes({"time.step": decimal.Decimal("0.005"), "cloth.sheet.particles": [Side.SHORT] * 2})
        self.assertEqual(weft.Simulation(exact).frame["sheet"].positions.shape, (81, 3))
        self.assertIn("step = 0.005", exact.text)
        for value in (None, {0, 1}, range(3), b"silk", [None]):
            with self.assertRaisesRegex(TypeError, "title: expected a number, "):
                scene.with_changes({"title": value})
        with self.assertRaisesRegex(TypeError, "texts as keys, got int"):
            scene.with_changes({1: 2})

    def test_caches_and_frames_know_what_they_contain(self):
        run("simulate", "drape.toml", "--frames", "0:2", "--cache", "cache", folder=self.folder)
        cache = weft.Cache(self.folder / "cache")
        self.assertEqual([1 in cache, 2 in cache], [True, False])
        for number in (-1, 2, 99):
            with self.assertRaisesRegex(KeyError, f"cache: holds no frame {number}"):
                cache[number]
        self.assertEqual(["ball" in cache[1], "bell" in cache[1]], [True, False])

    def test_scenes_materials_and_models_can_be_pickled_and_copied(self):
        (self.folder / "ball.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        (self.folder / "drape.toml").write_text(DRAPE.replace('"sphere"', '"mesh"\nfile = "ball.obj"').replace(
            "radius = 0.15\nsegments = 16\n", ""))
        scene = weft.load(self.folder / "drape.toml", {"time.fps": 50}).with_changes({"time.step": 0.005})
        self.assertEqual(pickle.loads(pickle.dumps(scene)).text, scene.text)
        exact = scene.with_changes({"time.tolerance": 1e-4})  # in place of time.step
        self.assertEqual(pickle.loads(pickle.dumps(exact)).text, exact.text)
        self.assertNotIn("\nstep = ", exact.text)
        silk = weft.fabric("silk")
        self.assertEqual(repr(copy.copy(silk)), repr(silk))
        corners, triangles = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
        model = weft.Model()
        model.gravity, model.method, model.self_contact = (0, 1, -2), weft.Method.bdf2, False
        model.add_cloth("sheet", corners, triangles, material=silk, rest=[row[:2] for row in corners])
        model.add_body("gate", corners, triangles, keys=[(0, [9, 0, 0], [1, 0, 0, 0]), (1, [10, 0, 0], [1, 0, 0, 0])])
        model.add_body("hand", corners, triangles, position=[0, 0, 1], collide=False)
        model.pin("sheet", [0, 1], body="hand", release=0.4)
        same = weft.Simulation(model).save()
        self.assertEqual(weft.Simulation(pickle.loads(pickle.dumps(model))).save(), same)
        changed = copy.deepcopy(model)
        changed.gravity = (0, 0, 0)
        self.assertNotEqual(weft.Simulation(changed).save(), same)
        self.assertEqual(weft.Simulation(model).save(), same)

    def test_materials_are_made_of_their_values(self):
        material = weft.Material(density=0.3, bend=1e-4)
        self.assertEqual((material.density, material.bend, material.shear), (0.3, 1e-4, 130))
        with self.assertRaisesRegex(AttributeError, "densty"):
            weft.Material(densty=0.3)

    def test_objects_show_what_they_have(self):
        scene = weft.parse(DRAPE)
        frame = weft.Simulation(scene).frame
        self.assertRegex(repr(scene), r"^weft.Scene\(name='scene', fps=25.0, frames=11, cloths=\['sheet'\], obst")
        self.assertRegex(repr(frame["sheet"]), r"^weft.Object\(name='sheet', kind='cloth', positions=\(256, 3\), ")
        self.assertRegex(repr(frame.report), r"^weft.Report\(.*, potential_energy=0.09.*warnings=\[\]\)$")
        self.assertEqual(weft.SceneError.__module__, "weft")
        run("simulate", "drape.toml", "--frames", "0:1", "--cache", "cache", folder=self.folder)
        self.assertEqual(repr(weft.Cache(self.folder / "cache")), f"weft.Cache({str(self.folder / 'cache')!r})")

    def test_weather_changes_between_frames(self):
        simulation = weft.Simulation(weft.parse(DRAPE, {"physics.air_density": 0}))
        simulation.set_weather([0, 0, 0], [0, 0, 0])
        before = simulation.frame["sheet"].positions
        numpy.testing.assert_allclose(simulation.advance()["sheet"].positions, before, atol=1e-12)

    def test_a_signal_ends_a_frame_that_can_be_computed_again(self):
        # One frame takes at least a tenth of a second. The signal arrives within it; its handler calls the simulation,
        # which is in use.
        scene = weft.parse(DRAPE, {"cloth.sheet.particles": [41, 41], "time.fps": 2, "time.duration": 1})
        simulation, refused = weft.Simulation(scene), []

        def handle(*_):
            try:
                simulation.advance()
            except RuntimeError as error:
                refused.append(str(error))
            raise KeyboardInterrupt

        self.addCleanup(signal.signal, signal.SIGALRM, signal.signal(signal.SIGALRM, handle))
        signal.setitimer(signal.ITIMER_REAL, 0.01)
        with self.assertRaises(KeyboardInterrupt):
            simulation.advance()
        self.assertEqual((simulation.frame.number, len(refused)), (0, 1))
        whole = weft.Simulation(scene)
        numpy.testing.assert_array_equal(simulation.advance()["sheet"].positions, whole.advance()["sheet"].positions)

    def test_mistakes_survive_the_way_from_another_process(self):
        with self.assertRaises(weft.SceneError) as caught:
            weft.parse(DRAPE, {"time.step": -1})
        error = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((type(error), str(error)), (weft.SceneError, str(caught.exception)))
        for field in ("file", "line", "column", "change", "key", "text"):
            self.assertEqual(getattr(error.mistakes[0], field), getattr(caught.exception.mistakes[0], field))

    def test_names_of_files_need_not_be_utf_8(self):
        folder = pathlib.Path(os.fsdecode(os.fsencode(self.folder) + b"/\xe9t\xe9"))
        folder.mkdir()
        (folder / "drape.toml").write_text(DRAPE)
        self.assertEqual(weft.load(folder / "drape.toml").name, "drape")
        wrong = folder / os.fsdecode(b"\xe9.toml")
        wrong.write_text(DRAPE.replace("radius", "raduis"))
        with self.assertRaises(weft.SceneError) as caught:
            weft.load(wrong)
        error = pickle.loads(pickle.dumps(caught.exception))
        self.assertTrue(str(error).startswith(f"{wrong}:13:1: obstacle.ball.raduis: "), ascii(str(error)))
        self.assertEqual(error.mistakes[0].file, str(wrong))
        with self.assertRaisesRegex(weft.FileError, "expected a frame cache"):
            weft.Cache(folder)
        self.assertIn("no such file", weft.compare(folder / "a.png", folder / "b.png").problem)

    def test_mistakes_have_their_place(self):
        with self.assertRaises(weft.SceneError) as caught:
            weft.parse(DRAPE.replace("radius", "raduis"), name="some/drape.toml")
        mistake, = caught.exception.mistakes
        self.assertEqual((mistake.file, mistake.line, mistake.column, mistake.key),
                         ("some/drape.toml", 13, 1, "obstacle.ball.raduis"))
        self.assertIn("did you mean radius?", str(caught.exception))
        self.assertIsInstance(caught.exception, ValueError)
        with self.assertRaisesRegex(weft.SceneError, "time.fps: expected a number"):
            weft.parse(DRAPE, {"time.fps": "\u00e4" * 60})  # messages cut the change at a letter
        with self.assertRaises(KeyError):
            weft.Simulation(weft.parse(DRAPE)).frame["shet"]

    def test_a_failed_simulation_raises_and_keeps_its_frame(self):
        scene = weft.parse(DRAPE, {"solver.newton_iterations": 1, "solver.halvings": 0, "time.step": 0.04,
                                   "solver.newton_tolerance": 1e-9})
        simulation = weft.Simulation(scene)
        with self.assertRaises(weft.SimulationError) as caught:
            for _ in range(10):
                simulation.advance()
        self.assertIn(f"frame {simulation.frame.number + 1}", str(caught.exception))

    def test_a_driven_ball_lifts_the_sheet_and_a_saved_state_continues(self):
        scene = weft.parse(DRAPE)
        simulation = weft.Simulation(scene, driven=["ball"])
        for number in range(1, 11):
            simulation.move("ball", [0, 0, 0.01 * number])
            frame = simulation.advance()
            if number == 5:
                state = simulation.save()
        self.assertGreater(frame["sheet"].positions[:, 2].max(), 0.25)
        other = weft.Simulation(scene, driven=["ball"], state=state)
        for number in range(6, 11):
            other.move("ball", [0, 0, 0.01 * number])
            other.advance()
        numpy.testing.assert_array_equal(other.frame["sheet"].positions, frame["sheet"].positions)

    def test_other_threads_go_on_while_a_frame_is_computed(self):
        scene = weft.parse(DRAPE, {"cloth.sheet.particles": [61, 61]})
        simulation, counted, done = weft.Simulation(scene), [], threading.Event()

        def count():
            while not done.is_set():
                counted.append(1)
                done.wait(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        simulation.advance()
        done.set()
        thread.join()
        self.assertGreater(len(counted), 3)

    def test_warnings_are_those_of_python(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            weft.Simulation(weft.parse(DRAPE, {"cloth.sheet.pin": [
                {"low": [0, 0], "high": [0, 1],
                 "keys": [{"time": t, "offset": [0.1, 0, 0]} for t in (0, 1)]}]}))
        self.assertIn("cloth.sheet.pin.0", str(caught[0].message))

    def test_the_error_of_a_run_has_its_sources(self):
        estimate = weft.estimate_error(weft.parse(DRAPE, {"time.duration": 0.16}))
        self.assertEqual(set(estimate.parts), {"time steps", "solver", "start"})
        self.assertGreater(estimate.all["position"], 0)
        self.assertFalse(estimate.chaotic)
        of_mesh = weft.estimate_error(weft.parse(DRAPE, {"time.duration": 0.04}), mesh=True)
        self.assertEqual((of_mesh.parts["mesh"], of_mesh.comparable), (None, False))  # 15 cells cannot be halved

    def test_contact_forces_carry_the_weight_of_a_sheet_at_rest(self):
        scene = weft.parse("""
[time]
duration = 2
[[cloth]]
name = "sheet"
size = [0.4, 0.4]
particles = [17, 17]
position = [0, 0, 0.3]
material = { density = 0.25, bend_viscosity = 1e-4 }
[[obstacle]]
name = "tray"
shape = "box"
size = [0.5, 0.5, 0.2]
position = [0, 0, 0.15]
rotation = [5, 0, 0]
friction = 0.8
""", {"cloth.sheet.material.friction": 0.8})
        simulation = weft.Simulation(scene)
        self.assertFalse(simulation.frame["sheet"].contact_forces.any())
        for _ in range(50):
            frame = simulation.advance()
        forces, weight = frame["sheet"].contact_forces, 0.25 * 0.4 * 0.4 * 9.81
        self.assertEqual((forces.shape, forces.flags.writeable), ((289, 3), False))
        # Residual of the solver: measured 3e-7 of the weight.
        numpy.testing.assert_allclose(forces.sum(axis=0), [0, 0, weight], atol=1e-4 * weight)
        self.assertEqual(frame["tray"].contact_forces.shape, (0, 3))

    def test_frames_are_drawn_as_the_program_does(self):
        camera = '\n[[camera]]\nname = "side"\nposition = [1, -1, 0.6]\ntarget = [0, 0, 0.2]\n'
        (self.folder / "seen.toml").write_text(DRAPE + camera)
        run("thumbnail", "seen.toml", "--frame", 4, "--size", "64x48", "-o", "seen.png", folder=self.folder)
        drawn = subprocess.run(["ffmpeg", "-v", "error", "-i", "seen.png", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                               cwd=self.folder, check=True, capture_output=True).stdout
        scene = weft.load(self.folder / "seen.toml", {"render.width": 64, "render.height": 48})
        simulation, renderer, errors = weft.Simulation(scene), weft.Renderer(scene), []
        for _ in range(4):
            frame = simulation.advance()
        picture = renderer.draw(frame)
        self.assertEqual((picture.shape, picture.dtype), ((48, 64, 3), numpy.uint8))
        numpy.testing.assert_array_equal(picture, numpy.frombuffer(drawn, numpy.uint8).reshape(48, 64, 3))
        self.assertRaises(ValueError, weft.Renderer, scene, quality="best")

        def draw_elsewhere():
            try:
                renderer.draw(frame)
            except RuntimeError as error:
                errors.append(str(error))

        thread = threading.Thread(target=draw_elsewhere)
        thread.start()
        thread.join()
        self.assertIn("from another", errors[0])

    def test_pictures_are_compared_as_the_program_does(self):
        for name, fabric in (("a", "cotton"), ("b", "cotton"), ("c", "leather")):
            run("thumbnail", "drape.toml", "--frame", 8, "--size", "64x64", "--quality", "draft", "-o", name + ".png",
                "--set", "cloth.sheet.material.fabric=" + fabric, folder=self.folder)
        a, b, c = (self.folder / (name + ".png") for name in "abc")
        self.assertEqual(weft.compare(a, b).outcome, "same")
        difference = weft.compare(a, c)
        self.assertEqual((difference.outcome, difference.good, difference.pixels), ("differs", False, 64 * 64))
        self.assertGreater(difference.flip, 0)
        self.assertTrue(weft.compare(a, c, pixel_budget=1, flip=1, spot=1).good)
        self.assertEqual(weft.compare(a, self.folder / "none.png").outcome, "no test")
        for limit, value in (("flip", float("nan")), ("spot", -1), ("pixel_budget", -1), ("pixel_tolerance", -1)):
            with self.assertRaisesRegex(ValueError, limit + ": expected 0 or more"):
                weft.compare(a, b, **{limit: value})

    def test_stubs_and_docstrings_are_of_what_is_there(self):
        stub = ast.parse((SOURCES / "src/api/python/weft/__init__.pyi").read_text())
        stub.body = [node for node in stub.body if not getattr(node, "name", "").startswith("_")]

        def names_in(body):
            return ({node.name for node in body if isinstance(node, (ast.ClassDef, ast.FunctionDef))} |
                    {node.target.id for node in body if isinstance(node, ast.AnnAssign) and node.target.id[0] != "_"})

        for node in ast.walk(stub):  # older type checkers use the getter's type for the setter
            self.assertFalse(isinstance(node, ast.Attribute) and node.attr == "setter")
        there = {name for name in dir(weft) if not name.startswith("_")} - {"annotations"}
        self.assertEqual(names_in(stub.body), there)
        for node in stub.body:
            if isinstance(node, ast.ClassDef) and node.name[-5:] != "Error":
                has = {name for name in vars(getattr(weft, node.name))
                       if not name.startswith("_") or name in ("__getitem__", "__iter__", "__contains__")}
                self.assertEqual(names_in(node.body) - {"__init__"}, has, node.name)
            if isinstance(node, ast.FunctionDef):
                self.assertIn("\n", getattr(weft, node.name).__doc__)
        for error in (weft.SceneError, weft.FileError, weft.SimulationError):
            self.assertTrue(error.__doc__)
        self.assertNotIn(" object at ", weft.Model.add_cloth.__doc__)
        self.assertIn("calling thread alone", weft.Report.cpu_s.__doc__)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
