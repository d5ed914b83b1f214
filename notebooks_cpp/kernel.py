"""A Jupyter kernel that runs C++ cells, those of the chapters or one's own.

    kernel.py BUILD        makes Jupyter know it, as "C++ with vmech"

A cell is compiled together with the cells that ran before it, as one program, and shows what it
wrote itself. Cells that begin with an #include stand in front of main, all others in it, where
`notebook` is (notebook.h). A cell that does not compile or throws is forgotten.
"""

import contextlib
import fcntl
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# What ipykernel carries to debug Python would warn, of Python.
os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")
from ipykernel.kernelapp import IPKernelApp  # noqa: E402
from ipykernel.kernelbase import Kernel  # noqa: E402

import chapter  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[1]
TARGET = "notebook_cells"
MARK = "\x1e"  # on standard output, in front of what a cell prints


class CellError(Exception):
    """What a cell died of."""


def is_front(code):
    return code.lstrip().startswith("#include")


def program_of(cells):
    """The source, and in which line of it each cell begins, counted from 1."""
    lines, begins = ['#include "notebook.h"'], [0] * len(cells)

    def add(chosen):
        for number, code in enumerate(cells):
            if is_front(code) == chosen:
                if not chosen:
                    lines.append(f'std::fputs("\\x{ord(MARK):02x}", stdout);')
                begins[number] = len(lines) + 1
                lines.extend(code.splitlines())

    add(True)
    lines += ["int main(int argc, char** argv) {", "vmech::Notebook notebook(argc, argv);"]
    add(False)
    lines += ["return notebook.ExitCode();", "}", ""]
    return "\n".join(lines), begins


def in_cells(message, cells, begins):
    """Of the compiler, with the cells' own line numbers."""
    def place(match):
        line = int(match[1])
        for number, (code, begin) in enumerate(zip(cells, begins), start=1):
            if begin <= line < begin + len(code.splitlines()):
                return f"cell {number}, line {line - begin + 1}"
        return match[0]
    message = re.sub(rf"[^\s:]*{TARGET}\.cc:(\d+)(?=:)", place, message)
    return "\n".join(line for line in message.splitlines()
                     if not re.match(r"\[\d+/\d+\]|FAILED:|ninja:|.*/c\+\+ |gmake|make", line))


class Workshop:
    """Where cells become programs: a build folder, which several kernels may share."""

    def __init__(self, build):
        self.build = pathlib.Path(build)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-cells-"))

    def close(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def compile(self, cells):
        """@returns the line in which each cell begins."""
        source, begins = program_of(cells)
        place = self.build / "notebooks_cpp"
        with open(place / f"{TARGET}.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            (place / f"{TARGET}.cc").write_text(source, encoding="utf-8")
            made = subprocess.run(["cmake", "--build", self.build, "--target", TARGET],
                                  capture_output=True, text=True)
            if made.returncode != 0:
                raise CellError(in_cells(made.stdout + made.stderr, cells, begins))
            shutil.copy2(place / TARGET, self.folder / TARGET)
        return begins

    def run(self, cells):
        """@returns what the last cell printed, and what it gave to `notebook`."""
        begins = self.compile(cells)
        results = self.folder / "results"
        results.unlink(missing_ok=True)
        ran = subprocess.run([self.folder / TARGET, results], cwd=ROOT, capture_output=True,
                             text=True, errors="replace")
        if not results.exists():
            raise CellError(ran.stdout.rpartition(MARK)[2] + ran.stderr)
        printed = "" if is_front(cells[-1]) else ran.stdout.rpartition(MARK)[2]
        return printed, [
            output for output in chapter.parse_outputs(results.read_bytes())
            if begins[-1] <= output.line < begins[-1] + len(cells[-1].splitlines())]


class CellKernel(Kernel):
    implementation = "vmech"
    implementation_version = "1"
    banner = "C++ with vmech: each cell is compiled with the cells that ran before it"
    language_info = {"name": "C++", "file_extension": ".cc", "mimetype": "text/x-c++src",
                     "codemirror_mode": "text/x-c++src", "pygments_lexer": "cpp"}
    build = None

    def __init__(self, **settings):
        super().__init__(**settings)
        self.workshop = Workshop(self.build)
        self.cells = []

    def do_shutdown(self, restart):
        self.workshop.close()
        return super().do_shutdown(restart)

    def do_execute(self, code, silent, store_history=True, user_expressions=None,
                   allow_stdin=False):
        try:
            printed, outputs = self.workshop.run(self.cells + [code]) if code.strip() else ("", [])
        except (CellError, OSError, KeyboardInterrupt) as error:
            return self.report(type(error).__name__, str(error) or "interrupted")
        self.cells.append(code)
        if not silent:
            self.tell("stream", {"name": "stdout", "text": printed}, printed)
            for output in outputs:
                shown = chapter.output_as_json(output)
                self.tell(shown.pop("output_type"), {"metadata": {}, **shown})
        return {"status": "ok", "execution_count": self.execution_count, "payload": [],
                "user_expressions": {}}

    def report(self, name, text):
        error = {"ename": name, "evalue": text, "traceback": text.splitlines()}
        self.tell("error", error)
        return {"status": "error", "execution_count": self.execution_count, **error}

    def tell(self, kind, content, when=True):
        if when:
            self.send_response(self.iopub_socket, kind, content)


def spec(build):
    return {"argv": [sys.executable, "-B", str(pathlib.Path(__file__).resolve()), str(build), "-f",
                     "{connection_file}"],
            "display_name": chapter.KERNEL["display_name"],
            "language": chapter.KERNEL["language"]}


def make_known(build):
    """To this user's Jupyter."""
    from jupyter_client.kernelspec import KernelSpecManager
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "kernel.json").write_text(json.dumps(spec(build)))
        place = KernelSpecManager().install_kernel_spec(folder, chapter.KERNEL["name"], user=True)
    print(f"Jupyter knows '{chapter.KERNEL['display_name']}' ({place})")


def main():
    if len(sys.argv) < 2 or not (pathlib.Path(sys.argv[1]) / "notebooks_cpp").is_dir():
        sys.exit("usage: kernel.py BUILD, a build folder of vmech with its chapters")
    build = pathlib.Path(sys.argv.pop(1)).resolve()
    if len(sys.argv) == 1:
        return make_known(build)
    CellKernel.build = build
    with contextlib.suppress(KeyboardInterrupt):
        IPKernelApp.launch_instance(kernel_class=CellKernel)


if __name__ == "__main__":
    main()
