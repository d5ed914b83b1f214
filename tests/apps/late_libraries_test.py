"""late_libraries_test.py VMECH EXAMPLES LATE_LIBRARIES [--installed]

What the command loads and when: a package is loaded by the runs that ask for it, and by no other.
LATE_LIBRARIES is the folder of what vmech loads late; with --installed it belongs to VMECH alone.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

VMECH = ""
EXAMPLES = pathlib.Path()
LATE_LIBRARIES = pathlib.Path()
INSTALLED = False

# A library by which each package is known. SUNDIALS is within ours.
PACKAGES = {"ceres": "libglog", "ipopt": "libipopt", "kinsol": "libvmech_kinsol",
            "nlopt": "libnlopt", "mpi": "libmpi", "cad": "libTKernel", "sdformat": "libsdformat"}
# What `vmech --version` calls them, of those that are in a library of their own.
NAMES = {"ceres": "Ceres", "ipopt": "Ipopt", "kinsol": "SUNDIALS", "nlopt": "NLopt", "mpi": "MPI"}
SOLVERS = ["penalty", "augmented_lagrangian", "nullspace", "ceres_weighted", "ceres_exact", "ipopt",
           "nlopt_slsqp", "nlopt_auglag_lbfgs", "kinsol"]


def package_of(solver):
    return next((name for name in PACKAGES if solver.startswith(name)), None)


def built(package):
    return (LATE_LIBRARIES / f"libvmech_{package}.so").exists()


class LateLibraries(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_vmech(self, *arguments, program=None, **variables):
        return subprocess.run([program or VMECH, *map(str, arguments)], cwd=self.folder,
                              capture_output=True, text=True, timeout=120, check=False,
                              env={**os.environ, **variables})

    def loaded(self, *arguments):
        """The packages that a run loads, and what it prints."""
        log = self.folder / "linker"
        result = self.run_vmech(*arguments, LD_DEBUG="files", LD_DEBUG_OUTPUT=log)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        text = "".join(path.read_text() for path in self.folder.glob("linker.*"))
        for path in self.folder.glob("linker.*"):
            path.unlink()
        opened = set(re.findall(r"file=(\S+) \[0\];  generating link map", text))
        self.assertTrue(any("libc.so" in name for name in opened), "LD_DEBUG says nothing")
        return {package for package, library in PACKAGES.items()
                if any(library in name for name in opened)}, result.stdout

    def ik(self, solver):
        return ["ik", EXAMPLES / "four-bar.yaml", "--target", "0.9 0.6 0", "--json", "--solver",
                solver]

    def test_what_solves_nothing_loads_no_package(self):
        study = EXAMPLES / "slider-crank-study.yaml"
        for arguments in (["--version"], ["--help"], ["check", EXAMPLES / "four-bar.yaml"],
                          ["loads", study], self.ik("nullspace")):
            with self.subTest(arguments=arguments):
                self.assertEqual(self.loaded(*arguments)[0], set())

    def test_a_solver_loads_its_own_package(self):
        for solver in SOLVERS:
            package = package_of(solver)
            if package is None or not built(package):
                continue
            with self.subTest(solver=solver):
                loaded, output = self.loaded(*self.ik(solver))
                self.assertEqual(loaded, {package})
                self.assertNotIn("unavailable", output)

    def test_version_names_the_packages_that_are_built_in_and_those_that_are_not(self):
        lines = dict(line.split(maxsplit=1)
                     for line in self.run_vmech("--version").stdout.splitlines())
        for package, name in NAMES.items():
            with self.subTest(package=package):
                pattern = rf"\b{name} (?:\d+\.\d+|\(lib)"
                self.assertEqual(bool(re.search(pattern, lines["with"])), built(package))
                self.assertEqual(bool(re.search(pattern, lines["without"])), not built(package))

    def test_a_missing_library_is_named(self):
        if not INSTALLED:
            self.skipTest("the libraries of a build are found from everywhere")
        (self.folder / "bin").mkdir()
        alone = shutil.copy(VMECH, self.folder / "bin")
        libraries = pathlib.Path(VMECH).parent.parent / LATE_LIBRARIES.parent
        for solver in SOLVERS:
            package = package_of(solver)
            if package is None:
                continue
            with self.subTest(solver=solver):
                result = self.run_vmech(*self.ik(solver), program=alone, LD_LIBRARY_PATH=libraries)
                self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
                self.assertIn(f"libvmech_{package}.so: cannot open shared object file",
                              result.stdout)
                self.assertIn("is installed", result.stdout)


if __name__ == "__main__":
    INSTALLED = "--installed" in sys.argv
    VMECH = str(pathlib.Path(sys.argv[1]).resolve())
    EXAMPLES = pathlib.Path(sys.argv[2]).resolve()
    LATE_LIBRARIES = pathlib.Path(sys.argv[3]).resolve()
    unittest.main(argv=sys.argv[:1])
