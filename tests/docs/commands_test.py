"""The commands of README.md and docs run, in a copy of the examples, and print what stands there;
files that a page shows whole are read: commands_test.py VMECH SOURCE [PAGE...]

A page is gone through from above. A block below "Save this as `NAME`" is written to that file.
Programs in Python are run, with the package of the build, if there is one.
Lines with `$ ` in front are run, and what stands below them is what they print, to the last figure
but for what rounding leaves and for times. Other lines that begin with `vmech` are run and have to
succeed. A line of the output that is `...` stands for any number of lines.
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile

import yaml

import pages

SAVED = re.compile(r"\b(?:[Ss]ave [^`]*|this )as `([\w./-]+)`")
USAGE = re.compile(r"\[-|\[[A-Z]|\b(?!README|TMPDIR)[A-Z]{3,}\b(?!=)|\.\.\.,")
# What pages take as given, and the command that makes it.
GIVEN = {
    "study.yaml": "cp slider-crank-study.yaml study.yaml",
    "crank.csv": "vmech haptic crank.yaml --free --seconds 1 --quiet --record crank.csv",
    "hand.csv": "vmech haptic crank.yaml --free --seconds 1 --quiet --record r.csv && "
                "vmech replay r.csv --quiet --motion hand.csv",
    "slider-crank-study-loads": "vmech loads slider-crank-study.yaml --quiet",
    "pump.yaml": "vmech import pump.step --out pump.yaml --density 7800",
}
# Pages whose commands another test runs.
ELSEWHERE = {"device-plugin.md": "apps.device"}
WRITTEN = re.compile(r"(?:--\w+|>) ?\S+")


def commands_of(text):
    """(command, lines that it prints) of a block; None where nothing is said of what it prints."""
    found = []
    for line in re.sub(r"\\\n\s*", "", text).splitlines():
        if line.startswith("$ "):
            found.append((line[2:], []))
        elif found and found[-1][1] is not None:
            found[-1][1].append(line)
        elif line.startswith("vmech ") and not USAGE.search(line):
            found.append((re.sub(r"\s+(#|//).*", "", line), None))
    return found


def shortened(command):
    """A session as long as a test may take; one without a picture goes as fast as it computes."""
    if not re.match(r"vmech haptic\b", command):
        return command
    command = re.sub(r" --seconds \S+", "", command)
    return command + " --seconds 1" + ("" if re.search("--(view|free)", command) else " --free")


def comparable(line):
    """Without what rounding leaves and without times."""
    line = re.sub(r"\b\d(\.\d+)?e-(0[89]|[1-9]\d)", "0.0e+00", line)
    return re.sub(r"\b[\d.]+ (ms|s)\b", r"TIME \1", line).rstrip()


def prints(shown, printed):
    """Whether the shown lines are those that are printed; blank lines are not looked at."""
    pattern = "".join(r"(?:.*\n)*" if line.strip() == "..." else re.escape(comparable(line)) + "\n"
                      for line in shown if line.strip())
    text = "".join(comparable(line) + "\n" for line in printed.splitlines() if line.strip())
    return re.fullmatch(pattern, text) is not None


class Desk:
    """A folder with the examples, where the commands of one page are run."""

    def __init__(self, folder, vmech, source):
        self.folder = pathlib.Path(folder)
        for files in "mechanisms/cad/samples", "mechanisms/examples":
            shutil.copytree(source / files, self.folder / files)
            shutil.copytree(source / files, self.folder, dirs_exist_ok=True)
        self.environment = dict(os.environ, PATH=f"{vmech.parent}:{os.environ['PATH']}")

    def run(self, command):
        """Exit code and what is printed."""
        if re.match(r"vmech view\b", command):
            return self.look(command)
        done = subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=self.folder,
                              env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=300)
        return done.returncode, done.stdout

    def look(self, command):
        """A page in the browser is served until it is interrupted: its address is enough."""
        served = subprocess.Popen(["bash", "-c", "exec " + command], cwd=self.folder,
                                  env=self.environment, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True)
        lines = []
        for line in served.stdout:
            lines.append(line)
            if "http://127.0.0.1" in line:
                served.send_signal(signal.SIGINT)
                break
        code = served.wait(timeout=60)
        return 0 if code == -signal.SIGINT else code, "".join(lines)

    def run_python(self, text):
        """What is wrong with a program; None also where it needs a package that is not built."""
        python = os.environ.get("VMECH_GUIDES_PYTHON")
        if python is None:
            return None
        self.provide(text)
        done = subprocess.run([python, "-B", "-c", text], cwd=self.folder, env=self.environment,
                              capture_output=True, text=True, timeout=120, check=False)
        return None if done.returncode == 0 else f"this program fails:\n{done.stderr}"

    def provide(self, command):
        named = WRITTEN.sub("", command) if "--motion" not in command else command
        for name, how in GIVEN.items():
            if re.search(rf"(?<![\w./-]){re.escape(name)}(?![\w./-])", named) and \
                    not (self.folder / name).exists():
                self.run(how)

    def save(self, name, text):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text, encoding="utf-8")

    def problem(self, command, shown):
        self.provide(command)
        code, printed = self.run(shortened(command) if shown is None else command)
        if shown and not prints(shown, printed):
            return f"does not print what stands there, but:\n{printed}"
        if code < 0 or code == 5 or (code != 0 and not shown):
            return f"ends with exit code {code}:\n{printed}"
        return None


def page_problems(page, vmech, source, counts):
    with tempfile.TemporaryDirectory() as folder:
        desk = Desk(folder, vmech, source)
        for line, language, text, above in pages.code_blocks(page):
            counts["blocks"] += 1
            where = f"{page.relative_to(source)}:{line}"
            if language in ("yaml", "json"):
                counts["texts"] += 1
                try:
                    yaml.safe_load(text)
                except yaml.YAMLError as error:
                    yield f"{where}: {error}"
            saved = SAVED.search(above)
            if saved and (language or not text.startswith("$ ")):
                desk.save(saved[1], text)
                counts["files"] += 1
            elif language == "python":
                counts["programs"] += 1
                what = desk.run_python(text)
                if what:
                    yield f"{where}: {what}"
            elif not language and page.name not in ELSEWHERE:
                for command, shown in commands_of(text):
                    counts["commands"] += 1
                    what = desk.problem(command, shown)
                    if what:
                        yield f"{where}: '{command}' {what}"


def main():
    vmech, source = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    chosen = [source / page for page in sys.argv[3:]] or pages.guides(source)
    counts = dict.fromkeys(("blocks", "texts", "files", "programs", "commands"), 0)
    problems = [problem for page in chosen
                for problem in page_problems(page, vmech, source, counts)]
    print("\n".join(problems) or "hold: " +
          ", ".join(f"{count} {name}" for name, count in counts.items()))
    return 1 if problems or counts["commands"] == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
