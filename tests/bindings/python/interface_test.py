"""What the package promises, against numpy and closed forms: interface_test.py EXAMPLES"""

import gc
import pathlib
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xml.etree.ElementTree

import numpy

import vmech

EXAMPLES = pathlib.Path(sys.argv.pop(1)).resolve()
ARM = """
vmech: "1.0"
name: arm
units: {length: m, angle: rad}
gravity: [0, 0, 0]
ground: base
links:
  base:  {anchors: {shoulder: {origin: [0, 0, 0]}}}
  upper: {anchors: {shoulder: {origin: [0, 0, 0]}, elbow: {origin: [0.3, 0, 0]}}}
  lower: {anchors: {elbow: {origin: [0, 0, 0]}}}
joints:
  shoulder: {type: revolute, connects: [base/shoulder, upper/shoulder], start: 0.1}
  elbow:    {type: revolute, connects: [upper/elbow, lower/elbow], start: 0.5}
grasps:
  hand: {link: lower, origin: [0.2, 0, 0], kind: point}
"""
SUITE = """
vmech_suite: "1.0"
units: {length: m}
targets:
  near: {kind: reachable, start: near, start_distance: 0.2, count: 2}
mechanisms:
  four-bar: {file: EXAMPLES/four-bar.yaml, grasp: handle}
"""
SWING = """
vmech_study: "1.0"
mechanism: EXAMPLES/crank.yaml
simulation: {duration: 1, steps: 100}
"""


def matrix(rotation, vectors):
    """R v of every pose, or of every pose and link."""
    return numpy.einsum("...ij,...j->...i", rotation, vectors)


class Parameters(unittest.TestCase):
    """Values that go before those of a file."""

    FILE = EXAMPLES / "four-bar-by-lengths.yaml"

    def test_of_a_mechanism_are_stated_and_set(self):
        plain = vmech.Mechanism.read(self.FILE)
        self.assertEqual(plain.parameters["crank"], (0.5, "m"))
        self.assertEqual(list(plain.parameters)[:4], ["ground", "crank", "coupler", "rocker"])
        for crank in (0.4, "40 cm", "2*200 mm"):
            mechanism = vmech.Mechanism.read(self.FILE, {"crank": crank})
            if not isinstance(crank, str):
                self.assertEqual(mechanism.parameters["crank"], (0.4, "m"))
            # The bar weighs a kilogram a metre.
            self.assertAlmostEqual(mechanism.masses[mechanism.links.index("crank")][0], 0.4,
                                   delta=1e-15)
        text = self.FILE.read_text(encoding="utf-8")
        parsed = vmech.Mechanism.parse(text, parameters={"crank": 0.4})
        self.assertEqual(parsed.text(), vmech.Mechanism.read(self.FILE, {"crank": 0.4}).text())

    def test_of_a_study_reach_its_mechanism(self):
        file = EXAMPLES.parents[1] / "studies" / "examples" / "crank-rocker-study.yaml"
        study = vmech.Study.read(file, {"coupler": 0.8, "turn": "20 deg"})
        self.assertEqual(study.parameters["coupler"], (0.8, "m"))
        self.assertAlmostEqual(study.parameters["crank"].value, 6 ** -0.5, delta=1e-15)
        self.assertEqual(study.mechanism.parameters, study.parameters)
        main = study.mechanism.freedoms.index("main")
        self.assertAlmostEqual(study.run().positions[0, main], numpy.radians(20), delta=1e-15)

    def test_that_are_wrong_are_named(self):
        for parameters, hint in (({"crnak": 1}, "did you mean 'crank'"),
                                 ({"crank": "1 kg"}, "a mass"),
                                 ({"crank": ""}, "'crank=' is not of the form NAME=VALUE")):
            with self.assertRaisesRegex(ValueError, hint):
                vmech.Mechanism.read(self.FILE, parameters)


class FourBar(unittest.TestCase):
    """Equilibrium and power, from the drawing and the masses of four-bar.yaml alone."""

    LOAD_AT, LOAD = numpy.array([0.6, 0, 0]), numpy.array([0, -40.0, 0])
    INERTIA = numpy.array([0, 0.333, 0.537, 0.4])  # about z
    ROCKER_PIN = numpy.array([0.75, 0, 0])  # on the rocker; other second anchors are at origins

    @classmethod
    def setUpClass(cls):
        cls.mechanism = vmech.Mechanism.read(EXAMPLES / "four-bar.yaml")
        cls.masses = numpy.array([mass for mass, _ in cls.mechanism.masses])
        cls.centres = numpy.array([centre for _, centre in cls.mechanism.masses])
        cls.load = vmech.Load("coupler", cls.LOAD_AT, [*cls.LOAD, 0, 0, 0])

    def test_links_are_in_equilibrium(self):
        """Sum of forces, and of moments about the world's origin, of every link at rest."""
        links = self.mechanism.links
        ends = {"main": ("frame", "crank"), "crank_pin": ("crank", "coupler"),
                "rocker_pin": ("coupler", "rocker"), "rocker_pivot": ("frame", "rocker")}
        for angle in (0.3, 1.0, 2.5, 4.0):
            drive = vmech.Drive("main", start=angle)
            loads = vmech.Study(self.mechanism, [drive], loads=[self.load]).run()
            R, p = loads.link_rotations[0], loads.link_positions[0]
            balance = numpy.zeros((len(links), 6))

            def exert(link, point, force, moment=numpy.zeros(3)):
                balance[links.index(link)] += [*force, *(moment + numpy.cross(point, force))]

            for link, mass, centre in zip(range(len(links)), self.masses, self.centres):
                exert(links[link], p[link] + R[link] @ centre,
                      mass * numpy.array(self.mechanism.gravity))
            coupler = links.index("coupler")
            exert("coupler", p[coupler] + R[coupler] @ self.LOAD_AT, self.LOAD)
            for joint, (first, second) in ends.items():
                axes, j = R[links.index(first)], links.index(second)
                at = self.ROCKER_PIN if joint == "rocker_pin" else numpy.zeros(3)
                force, moment = loads.wrench(joint)[0].reshape(2, 3) @ axes.T
                exert(second, p[j] + R[j] @ at, force, moment)
                exert(first, p[j] + R[j] @ at, -force, -moment)
            numpy.testing.assert_allclose(balance[1:], 0, atol=1e-11, err_msg=f"at {angle} rad")

    def test_power_of_the_drive_is_the_rate_of_energy(self):
        """Over a whole turn energy is periodic: its derivative is that of its Fourier series."""
        poses, speed = 180, 2 * numpy.pi
        times = numpy.arange(poses) / poses
        study = vmech.Study(self.mechanism, [vmech.Drive("main", speed=speed)], times, cycle=1,
                            loads=[self.load])
        loads = study.run(threads=2)
        R, p, V = loads.link_rotations, loads.link_positions, loads.link_twists
        arm = matrix(R, self.centres)
        velocity = V[..., :3] + numpy.cross(V[..., 3:], arm)
        energy = (0.5 * self.masses * (velocity ** 2).sum(-1)
                  + 0.5 * self.INERTIA * V[..., 5] ** 2
                  - self.masses * ((p + arm) @ self.mechanism.gravity)).sum(-1)
        orders = numpy.fft.rfftfreq(poses, 1 / poses)
        rate = numpy.fft.irfft(2j * numpy.pi * orders * numpy.fft.rfft(energy), poses)
        coupler = self.mechanism.links.index("coupler")
        at = matrix(R[:, coupler], self.LOAD_AT)
        outside = (V[:, coupler, :3] + numpy.cross(V[:, coupler, 3:], at)) @ self.LOAD
        drive = loads.drive_forces[:, 0] * speed
        self.assertGreater(abs(drive).max(), 10)
        numpy.testing.assert_allclose(drive + outside, rate, atol=1e-7)
        numpy.testing.assert_allclose(loads.powers, drive, atol=1e-12)
        numpy.testing.assert_allclose(loads.peaks, abs(loads.wrenches).max(0))

    def test_verdicts_and_bearings(self):
        study = vmech.Study.read(EXAMPLES / "four-bar-study.yaml")
        loads = study.run()
        self.assertEqual(loads.certain.shape, (4, 6))
        self.assertEqual(loads.certainty[0][2], "not determined by statics")  # across the plane
        self.assertTrue(loads.certain[:, [0, 1, 5]].all())
        pair = loads.bearings[0]
        self.assertEqual((pair.joint, pair.met, len(pair.positions)), ("main", True, 2))
        self.assertLess(pair.life_hours, min(b.life_hours for b in pair.positions))
        self.assertEqual(study.drives, [("main", 0)])


class Arrays(unittest.TestCase):
    def setUp(self):
        self.study = vmech.Study.read(EXAMPLES / "four-bar-study.yaml")

    def test_are_views_that_outlive_their_owner(self):
        loads = self.study.run()
        wrenches, again = loads.wrenches, loads.wrenches
        self.assertTrue(numpy.shares_memory(wrenches, again))
        self.assertEqual(wrenches.shape, (len(loads), 4, 6))
        before = wrenches.copy()
        del loads, again
        gc.collect()
        others = [self.study.run() for _ in range(3)]
        numpy.testing.assert_array_equal(wrenches, before)
        self.assertEqual(len(others), 3)
        with self.assertRaises(ValueError):
            wrenches[0, 0, 0] = 1

    def test_rotations_are_rotations_and_carry_the_links(self):
        loads = self.study.run()
        R, p = loads.link_rotations, loads.link_positions
        numpy.testing.assert_allclose(matrix(R.swapaxes(-1, -2)[..., None, :, :],
                                             R.swapaxes(-1, -2)),
                                      numpy.broadcast_to(numpy.eye(3), R.shape), atol=1e-14)
        numpy.testing.assert_allclose(numpy.linalg.det(R), 1)
        crank = self.study.mechanism.links.index("crank")
        pin = p[:, crank] + matrix(R[:, crank], numpy.array([0.5, 0, 0]))
        numpy.testing.assert_allclose(pin, p[:, self.study.mechanism.links.index("coupler")],
                                      atol=1e-12)

    def test_what_is_not_there(self):
        loads = self.study.run()
        self.assertIsNone(loads.array("energies"))
        with self.assertRaisesRegex(AttributeError, "no energies"):
            loads.energies
        with self.assertRaisesRegex(ValueError, "energy"):
            loads.array("energy")

    def test_data_frames(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("python3-pandas is not installed")
        loads = self.study.run()
        frame = loads.wrench_frame()
        numpy.testing.assert_array_equal(frame["crank_pin", "fy"], loads.wrench("crank_pin")[:, 1])
        numpy.testing.assert_array_equal(frame.index, loads.times)
        numpy.testing.assert_array_equal(loads.position_frame()["main"], loads.position("main"))


class Poses(unittest.TestCase):
    """An arm of 0.3 m and 0.2 m reaches r by cos(elbow) = (r^2 - a^2 - b^2) / 2ab."""

    ELBOW = numpy.arccos((0.4 ** 2 - 0.3 ** 2 - 0.2 ** 2) / (2 * 0.3 * 0.2))

    def setUp(self):
        self.arm = vmech.Mechanism.parse(ARM)

    def test_inverse_kinematics(self):
        pose = self.arm.ik([0.4, 0, 0])
        self.assertEqual(len(pose), 1)
        self.assertAlmostEqual(pose.position("elbow")[0], self.ELBOW, 7)
        far = self.arm.ik((0.7, 0, 0), grasp="hand")
        numpy.testing.assert_allclose(far.hand_errors, [[0.2, 0, 0, 0, 0, 0]], atol=1e-6)
        self.assertIsNone(far.array("wrenches"))

    def test_assembly_modes(self):
        modes = self.arm.assembly_modes(grasp="hand", position=[0.4, 0, 0], patience=50)
        self.assertEqual(len(modes), 2)
        numpy.testing.assert_allclose(numpy.sort(modes.position("elbow")),
                                      [-self.ELBOW, self.ELBOW], atol=1e-9)
        four_bar = vmech.Mechanism.read(EXAMPLES / "four-bar.yaml")
        self.assertEqual(len(four_bar.assembly_modes(held=["main"], patience=50)), 2)

    def test_a_text_comes_back(self):
        again = vmech.Mechanism.parse(self.arm.text())
        self.assertEqual(again.text(), self.arm.text())
        self.assertEqual(self.arm.freedoms, ["shoulder", "elbow"])
        self.assertEqual(self.arm.start, [0.1, 0.5])


class Errors(unittest.TestCase):
    def test_of_files(self):
        with self.assertRaisesRegex(vmech.FileErrors, r"typed:2:\d+: links") as caught:
            vmech.Mechanism.parse('vmech: "1.0"\nlinks: 3\n', "typed")
        [message] = [message for file, line, _, path, message in caught.exception.errors
                     if (file, line, path) == ("typed", 2, "links")]
        self.assertIn(message, str(caught.exception))
        with self.assertRaisesRegex(vmech.FileErrors, "no such.yaml"):
            vmech.Study.read("no such.yaml")

    def test_of_arguments(self):
        arm = vmech.Mechanism.parse(ARM)
        with self.assertRaisesRegex(ValueError, "position has 2 numbers, must have 3"):
            arm.ik([0.4, 0])
        with self.assertRaisesRegex(ValueError, "no grasp 'foot'; there are hand"):
            arm.ik([0.4, 0, 0], grasp="foot")
        with self.assertRaisesRegex(ValueError, "not finite"):
            arm.ik([0.4, 0, float("nan")])
        with self.assertRaisesRegex(ValueError, "rotation of the hand"):
            arm.ik([0.4, 0, 0], numpy.ones((3, 3)))
        with self.assertRaisesRegex(ValueError, r"solver: there is no .magic"):
            arm.ik([0.4, 0, 0], solver="magic")
        with self.assertRaises(ValueError):
            vmech.Study(arm, [vmech.Drive(7)]).run()

    def test_of_runs(self):
        study = vmech.Study.read(EXAMPLES / "four-bar-study.yaml")
        done = []
        with self.assertRaisesRegex(vmech.NoSolution, "stopped"):
            study.run(progress=done.append)  # which returns None
        self.assertEqual(len(done), 1)
        with self.assertRaises(ZeroDivisionError):
            study.run(progress=lambda poses: 1 / 0)
        self.assertGreater(len(study.run(progress=lambda poses: True)), 0)

    def test_other_threads_go_on(self):
        crank = vmech.Mechanism.read(EXAMPLES / "crank.yaml")
        times = numpy.linspace(0, 1, 200_000)
        study = vmech.Study(crank, [vmech.Drive("main", speed=1)], times)
        started = threading.Event()

        def run():
            started.set()
            study.run()

        thread = threading.Thread(target=run)
        thread.start()
        started.wait()
        steps = 0
        while thread.is_alive():
            time.sleep(0)  # gives the interpreter away, and waits until it is free again
            steps += 1
        self.assertGreater(steps, 20)


class Simulations(unittest.TestCase):
    def test_a_falling_crank_keeps_its_energy(self):
        """1/2 (I + m c^2) w^2 is what its centre of gravity has fallen, m = 0.8, c = 0.15."""
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write(SWING.replace("EXAMPLES", str(EXAMPLES)))
            file.flush()
            study = vmech.Study.read(file.name)
        self.assertTrue(study.simulates)
        swing = study.run()
        self.assertEqual((swing.status, swing.events), ("finished", []))
        q, w = swing.positions[:, 0], swing.rates[:, 0]
        fallen = 0.8 * 9.81 * 0.15 * (numpy.sin(numpy.radians(40)) - numpy.sin(q))
        kinetic = 0.5 * (0.006 + 0.8 * 0.15 ** 2) * w ** 2
        self.assertGreater(kinetic.max(), 1)
        numpy.testing.assert_allclose(kinetic, fallen, atol=1e-7)
        numpy.testing.assert_allclose(swing.energies[:, 0], kinetic, atol=1e-12)


class InAHand(unittest.TestCase):
    """A crank at 40 degrees, carried by its tip at 0.3 m: a force across it of m g c cos(q) / r."""

    def setUp(self):
        self.crank = vmech.Mechanism.read(EXAMPLES / "crank.yaml")

    def test_tick_carries_the_weight(self):
        tick = vmech.Tick(self.crank, "tip", stiffness=[1e5] * 3 + [0] * 3,
                          damping=[300] * 3 + [0] * 3)
        position, rotation = tick.grasp
        for _ in range(2000):
            wrench = tick.step(position, rotation)
        q = numpy.radians(40)
        across = numpy.array([-numpy.sin(q), numpy.cos(q), 0])
        weight = 0.8 * 9.81 * 0.15 * numpy.cos(q) / 0.3
        numpy.testing.assert_allclose(wrench[:3], -weight * across, atol=2e-3)
        self.assertEqual(tick.wrenches.shape, (1, 6))
        with self.assertRaises(vmech.NoSolution):
            tick.step([float("nan")] * 3, None)

    def test_session_with_a_master_of_pythons(self):
        felt = []
        session = vmech.hold(self.crank, lambda t: (0.0, 0.0, 0.0), felt.append, seconds=2,
                             real_time=False)
        self.assertEqual((session.fault, session.ticks), ("", 2000))
        self.assertEqual(session.wrenches.shape, (2000, 6))
        numpy.testing.assert_array_equal(felt[-2], session.wrenches[-1])
        numpy.testing.assert_array_equal(felt[-1], numpy.zeros(6))  # the motors are switched off
        weight = 0.8 * 9.81 * 0.15 * numpy.cos(numpy.radians(40)) / 0.3
        self.assertAlmostEqual(numpy.linalg.norm(session.wrenches[-1, :3]), weight,
                               delta=0.02 * weight)

    def test_what_its_hand_raises_ends_the_session(self):
        def hand(t):
            if t > 0.1:
                raise KeyError("lost")
            return (0.0, 0.0, 0.0), numpy.eye(3)

        with self.assertRaisesRegex(KeyError, "lost"):
            vmech.hold(self.crank, hand, seconds=10, real_time=False)
        with self.assertRaisesRegex(ValueError, "coupling"):
            vmech.hold(self.crank, hand, seconds=1, coupling="none")


class Comparison(unittest.TestCase):
    def test_solves_every_problem_by_every_solver_named(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write(SUITE.replace("EXAMPLES", str(EXAMPLES)))
            file.flush()
            rows = vmech.compare(file.name, ["nullspace", "penalty"])
        self.assertEqual([(row.solver, row.problem) for row in rows],
                         [("penalty", 0), ("nullspace", 0), ("penalty", 1), ("nullspace", 1)])
        for row in rows:
            if row.solver == "nullspace":
                self.assertEqual(row.verdict, "solved")
                self.assertLess(row.e1_position, 1e-6)


class Notebook(unittest.TestCase):
    def test_shows_the_drawn_mechanism(self):
        mechanism = vmech.Mechanism.read(EXAMPLES / "four-bar.yaml")
        drawing = xml.etree.ElementTree.fromstring(mechanism._repr_svg_())
        pivots = [e for e in drawing.iter() if "pivot" in e.get("class", "").split()]
        self.assertEqual(len(pivots), len(mechanism.joints))
        self.assertIn(mechanism.svg(), mechanism._repr_html_())
        self.assertIn("four-bar", repr(mechanism))

    def test_import_is_cheap(self):
        """Less than 0.1 s: nothing heavy is imported, and little at all beside what Python has."""
        code = ("import sys; before = set(sys.modules); import vmech; "
                "print(*sorted(set(sys.modules) - before))")
        new = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                             check=True).stdout.split()
        for heavy in ("numpy", "pandas", "matplotlib", "tempfile", "inspect"):
            self.assertNotIn(heavy, new)
        self.assertLess(len(new), 20, new)


unittest.main()
