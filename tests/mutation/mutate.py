"""Seeds faults in a module, one at a time, and tells which of them its tests do not catch.

    mutate.py MODULE [--count N] [--seed S] [--jobs J]

A fault is a small slip in one line of one source: a sign, a comparison, a factor, an index. Which
ones is drawn by SEED, so that a run can be repeated. For every fault the module's test programs are
built and run in a copy of the project, build/mutation, with `ninja` and the preset `dev`. Faults
that do not compile, or that the compiler cannot tell from the original (the object file is the
same), are drawn again.

The answer is a line per fault, "caught by dynamics_test", "caught: does not end" or "NOT CAUGHT
dynamics/...:63: '+' for '-'", and the share that was caught. Exit status 1 if that is below 95 %.
"""

import argparse
import pathlib
import random
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LEAST_SHARE = 0.95
TESTS = {
    "base": ["kinematics_test", "solvers_test"],
    "mechanisms": ["mechanisms_test", "exchange_test"],
    "solvers": ["solvers_test", "kinematics_test"],
    "kinematics": ["kinematics_test", "dynamics_test"],
    "dynamics": ["dynamics_test", "reference_test", "hw_interface_test"],
    "dynamics/bearings": ["dynamics_bearings_test"],
    "dynamics/simulation": ["simulation_test"],
    "hw_interface": ["hw_interface_test"],
    "comparison": ["comparison_test"],
    "studies": ["apps_test"],
}
# (what, pattern, replacement); the group is replaced.
FAULTS = [
    ("sign", re.compile(r"[\w\])] (\+|-) [\w(]"), {"+": "-", "-": "+"}),
    ("assigned sign", re.compile(r" (\+=|-=) "), {"+=": "-=", "-=": "+="}),
    ("comparison", re.compile(r"[\w\])] (<|>|<=|>=|==|!=) [\w(-]"),
     {"<": ">", ">": "<", "<=": ">", ">=": "<", "==": "!=", "!=": "=="}),
    ("factor", re.compile(r"[ (](0\.5|2|3|1) [*/] "), {"0.5": "1", "2": "1", "3": "2", "1": "2"}),
    ("operation", re.compile(r"[\w\])] (\*|/) [\w(]"), {"*": "/", "/": "*"}),
    ("index", re.compile(r"\w[\[(](0|1|2)[\]),]"), {"0": "1", "1": "0", "2": "1"}),
    ("condition", re.compile(r"[\w\])] (&&|\|\|) [\w(!]"), {"&&": "||", "||": "&&"}),
]
COMMENT_OR_TEXT = re.compile(r'//.*|"(?:\\.|[^"\\])*"|<[\w:, ]+>|^\s*(#|template|static_assert).*')


class Fault:
    def __init__(self, path, line, what, begin, end, new):
        self.path, self.line, self.what = path, line, what
        self.begin, self.end, self.new = begin, end, new

    def apply(self, text):
        lines = text.split("\n")
        old = lines[self.line]
        lines[self.line] = old[:self.begin] + self.new + old[self.end:]
        return "\n".join(lines)

    def describe(self, text):
        old = text.split("\n")[self.line][self.begin:self.end]
        return f"{self.path}:{self.line + 1}: {self.what}, '{self.new}' for '{old}'"


def sources_of(module):
    listing = subprocess.run(["git", "-C", str(ROOT), "ls-files", f"{module}/*.cc"],
                             capture_output=True, text=True, check=True).stdout.split()
    inner = [m for m in TESTS if m != module and m.startswith(module + "/")]
    skipped = tuple(f"{m}/" for m in inner + ["mechanisms/cad", "mechanisms/examples"])
    return [path for path in listing if not path.startswith(skipped)]


def faults_in(path):
    found = []
    for number, line in enumerate((ROOT / path).read_text().split("\n")):
        blanked = COMMENT_OR_TEXT.sub(lambda m: " " * len(m.group(0)), line)
        for what, pattern, replacements in FAULTS:
            for match in pattern.finditer(blanked):
                old = match.group(1)
                found.append(Fault(path, number, what, match.start(1), match.end(1),
                                   replacements[old]))
    return found


def run(command, cwd, seconds=None):
    try:
        return subprocess.run(command, cwd=cwd, capture_output=True, timeout=seconds).returncode
    except subprocess.TimeoutExpired:
        return None


def copy_project(target):
    """Files that are the same already keep their times, so that nothing is built twice."""
    listing = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], capture_output=True,
                             text=True, check=True).stdout
    for name in filter(None, listing.split("\0")):
        source, place = ROOT / name, target / name
        if not place.exists() or source.read_bytes() != place.read_bytes():
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, place)


class Copy:
    """A copy of the project with a build of the module's tests."""

    def __init__(self, module, jobs):
        self.root = ROOT / "build" / "mutation"
        self.build = self.root / "build" / "dev"
        self.tests = TESTS[module]
        self.jobs = jobs
        copy_project(self.root)
        subprocess.run(["cmake", "--preset", "dev", "-DVMECH_LINT=OFF",
                        "-DVMECH_WARNINGS_AS_ERRORS=OFF"], cwd=self.root, check=True,
                       stdout=subprocess.DEVNULL)
        if not self.compiles():
            sys.exit("mutate.py: the tests do not build as they are")
        for test in self.tests:
            if run(self.command(test), self.root, 1800) != 0:
                sys.exit(f"mutate.py: {test} does not pass as it is")

    def compiles(self):
        return run(["ninja", f"-j{self.jobs}", *self.tests], self.build) == 0

    def command(self, test):
        program = next(self.build.glob(f"tests/**/{test}"))
        return [str(program), "--gtest_fail_fast", "--gtest_brief=1"]

    def object_of(self, path):
        return next(self.build.glob(f"{path.split('/')[0]}/**/{pathlib.Path(path).name}.o"), None)

    def verdict(self, fault):
        """Which test caught it; "" if none did; None if it is no fault."""
        original = (ROOT / fault.path).read_text()
        place = self.root / fault.path
        before = self.object_of(fault.path)
        before = before and before.read_bytes()
        place.write_text(fault.apply(original))
        try:
            if not self.compiles() or self.object_of(fault.path).read_bytes() == before:
                return None
            for test in self.tests:
                status = run(self.command(test), self.root, 600)
                if status != 0:
                    return "does not end" if status is None else test
            return ""
        finally:
            place.write_text(original)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("module", choices=sorted(TESTS))
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    faults = [fault for path in sources_of(arguments.module) for fault in faults_in(path)]
    random.Random(arguments.seed).shuffle(faults)
    copy = Copy(arguments.module, arguments.jobs)
    caught = judged = 0
    for fault in faults:
        if judged == arguments.count:
            break
        verdict = copy.verdict(fault)
        if verdict is None:
            continue
        judged += 1
        caught += verdict != ""
        answer = f"caught ({verdict})" if verdict else "NOT CAUGHT"
        print(f"{answer}  {fault.describe((ROOT / fault.path).read_text())}", flush=True)
    print(f"{caught} of {judged} faults in {arguments.module} were caught")
    return 0 if judged and caught >= LEAST_SHARE * judged else 1


if __name__ == "__main__":
    sys.exit(main())
