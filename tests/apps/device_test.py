"""device_test.py VMECH EXAMPLES PLUGIN: devices as their users meet them. PLUGIN is the device of
docs/device-plugin.md: three freedoms, 8 N."""

import csv
import math
import os
import pathlib
import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import unittest

from fake_inverse_service import FakeInverseService

VMECH, PLUGIN = "", ""
EXAMPLES = pathlib.Path()


def held_examples():
    """The mechanisms among the examples that have a grasp."""
    return sorted(path.stem for path in EXAMPLES.glob("*.yaml")
                  if re.search(r"^grasps:", text := path.read_text(encoding="utf-8"), re.M)
                  and re.search(r"^vmech:", text, re.M))


class Device(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_vmech(self, *arguments, code=0, env=None):
        result = subprocess.run([VMECH, *map(str, arguments)], cwd=self.folder, text=True,
                                capture_output=True, stdin=subprocess.DEVNULL, timeout=120,
                                env={**os.environ, **(env or {})})
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def hold(self, name, *options, code=0):
        return self.run_vmech("haptic", EXAMPLES / f"{name}.yaml", "--free", "--master",
                              f"plugin:{PLUGIN}", *options, code=code)

    def hold_in_real_time(self, name, master, seconds):
        """The report. A machine that is busy may keep the other side from answering in time."""
        result = subprocess.run([VMECH, "haptic", EXAMPLES / f"{name}.yaml", "--seconds",
                                 str(seconds), "--master", master], cwd=self.folder, text=True,
                                capture_output=True, stdin=subprocess.DEVNULL, timeout=120)
        outcome = {0: "finished", 3: "fault: link lost"}[result.returncode]
        self.assertIn(outcome, result.stdout, result.stderr)
        return result.stdout

    def recorded(self):
        """The rows of hand.csv as numbers, and the forces and moments sent."""
        with open(self.folder / "hand.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        names = [name for name in rows[0] if name.startswith("sent")]
        self.assertEqual(len(names), 6)
        return rows, [[float(row[name]) for name in names] for row in rows]

    def test_device_says_what_it_states_and_senses(self):
        report = self.run_vmech("device", f"plugin:{PLUGIN}", "--free").stdout
        self.assertIn("three freedoms", report)
        self.assertIn("mass 0.3 kg, damping 1 N s/m, dry friction unknown", report)
        self.assertIn("peak 8 N, trips above 2 m/s", report)
        self.assertIn("no moments: mechanisms are held at a point", report)
        self.assertIn("1000 samples, 0 periods without", report)
        report = self.run_vmech("device", "simulated", "--free").stdout
        self.assertIn("forces and moments, or joint torques", report)

    def test_identify_finds_what_the_device_was_made_of(self):
        report = self.run_vmech("device", f"plugin:{PLUGIN}:alone", "--identify", "--free",
                                "--peak-to", 6).stdout
        for word, truth, within in (("mass kg", 0.3, 0.03), ("damping N s/m", 1.0, 0.05)):
            found = [float(x) for x in
                     re.search(rf"{word} +(\S+) +(\S+) +(\S+)", report).groups()]
            for figure in found:
                self.assertLess(abs(figure / truth - 1), within, report)
        self.assertIn("peak at least 6 N", report)

    def test_identify_of_a_held_handle_is_refused_or_doubted(self):
        report = self.run_vmech("device", "simulated", "--identify", "--free", "--force", 0.01,
                                code=3)
        self.assertIn("--force", report.stderr)

    def test_every_example_is_played_on_three_freedoms(self):
        names = held_examples()
        self.assertGreater(len(names), 15)
        names.remove("beam-on-three-supports")  # has no freedom
        for name in names:
            with self.subTest(name=name):
                report = self.hold(name, "--seconds", 2, "--scale", 0.02, "--record",
                                   "hand.csv", "--force").stdout
                self.assertIn("finished after 2000 ticks", report)
                _, sent = self.recorded()
                self.assertEqual(max(abs(m) for row in sent for m in row[3:]), 0)
                self.assertLessEqual(max(math.hypot(*row[:3]) for row in sent), 8 + 1e-9)
                # Where it takes hold nothing jumps.
                jumps = [math.dist(a[:3], b[:3]) for a, b in zip(sent[:100], sent[1:])]
                self.assertLessEqual(max(jumps), 0.25)
                self.assertGreater(max(math.hypot(*row[:3]) for row in sent), 0)

    def test_motion_scale_moves_the_mechanism_further(self):
        ways = []
        for scale in (1, 3):
            self.hold("crank", "--seconds", 1, "--motion-scale", scale, "--record", "hand.csv")
            rows, _ = self.recorded()
            columns = ("p_x", "p_y", "p_z")
            ways.append(math.dist(*([float(row[c]) for c in columns]
                                    for row in (rows[0], rows[400]))))
            (self.folder / "hand.csv").unlink()
        self.assertGreater(ways[1] / ways[0], 2)

    def test_home_is_reached_or_said_to_be_far(self):
        report = self.run_vmech("haptic", EXAMPLES / "crank.yaml", "--free", "--seconds", 1,
                                "--master", f"plugin:{PLUGIN}:alone", "--home", "0.05,0,0.02")
        self.assertIn("finished", report.stdout)
        held = self.hold("crank", "--home", "0.5,0,0", code=3)
        self.assertIn("from there", held.stderr)

    def test_inverse3_holds_a_mechanism(self):
        service = FakeInverseService()
        self.addCleanup(service.stop)
        report = self.hold_in_real_time("four-bar", f"haply:{service.port}", 1)
        self.assertIn("Haply Inverse3 049D exerts forces and no moments", report)
        self.assertGreater(len(service.forces), 10)
        if "finished" in report:
            self.assertGreater(max(math.hypot(*force) for force in service.forces), 0)
        self.assertLessEqual(max(math.hypot(*force) for force in service.forces), 8 + 1e-9)
        self.assertEqual(service.forces[-1], [0, 0, 0])

    def test_served_device_holds_a_mechanism_from_afar(self):
        server = subprocess.Popen([VMECH, "device", f"plugin:{PLUGIN}", "--serve", "0"],
                                  stdout=subprocess.PIPE, text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        while not (found := re.search(r"served at (\S+) until", server.stdout.readline())):
            self.assertIsNone(server.poll())
        report = self.hold_in_real_time("four-bar", f"udp:{found[1]}", 0.5)
        self.assertIn("three freedoms exerts forces and no moments", report)
        server.terminate()
        self.assertEqual(server.wait(timeout=20), 0)
        self.assertIn("packets", server.stdout.read())

    def test_mouse_without_force_moves_a_mechanism(self):
        path = str(self.folder / "spnav.sock")
        daemon = socket.socket(socket.AF_UNIX)
        daemon.bind(path)
        daemon.listen(1)
        self.addCleanup(daemon.close)

        def deflect():
            mouse, _ = daemon.accept()
            mouse.sendall(struct.pack("8i", 0, 50, 0, 0, 0, 0, 0, 16))
            mouse.recv(1)  # until it hangs up

        threading.Thread(target=deflect, daemon=True).start()
        report = self.run_vmech("haptic", EXAMPLES / "crank.yaml", "--seconds", 0.5, "--master",
                                "spacenav", env={"SPNAV_SOCKET": path}).stdout
        self.assertIn("finished", report)

    def test_devices_that_are_not_there_are_named(self):
        error = self.run_vmech("device", "haply:1", code=3).stderr
        self.assertIn("127.0.0.1:1", error)
        self.assertIn("Inverse Service", error)
        self.assertIn("haply:PORT", self.run_vmech("device", "haply:x", code=1).stderr)
        self.assertIn("not one of", self.run_vmech("device", "falcon", code=1).stderr)


if __name__ == "__main__":
    VMECH, EXAMPLES, PLUGIN = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    unittest.main(argv=sys.argv[:1])
