"""The vmech command on FreeCAD documents: export, check, loads."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile

import Import

from . import marks


class VmechError(RuntimeError):
    """What vmech wrote to its standard error."""


def program():
    """The vmech command: $VMECH, or the one on the path."""
    found = os.environ.get("VMECH") or shutil.which("vmech")
    if not found:
        raise VmechError("vmech was not found; put it on the PATH, or its place into $VMECH")
    return found


def run(*arguments, accepted=(0,)):
    """Standard output of vmech. Raises VmechError unless its exit code is accepted."""
    result = subprocess.run([program(), *map(str, arguments)], capture_output=True, text=True,
                            stdin=subprocess.DEVNULL, check=False)
    if result.returncode not in accepted:
        raise VmechError(result.stderr.strip() or result.stdout.strip())
    return result.stdout


def export(document, out, study=None, drives=(), rpm=60):
    """Writes the mechanism file `out` (.yaml), and a study if its path is given. Returns the report
    of `vmech import`, also if its loops do not close ("NOT ASSEMBLED"). The way leads through STEP
    files, which any CAD system can write."""
    links = marks.links(document)
    if not links:
        raise marks.MarkError("the document holds no link: put each part with its anchors into a "
                              "Std Part, or mark an anchor on it")
    document.recompute()
    arguments = ["--out", out]
    fixed = marks.ground(document)
    if fixed is not None:
        arguments += ["--ground", marks.file_name(fixed.Label),
                      "--gravity", " ".join(repr(value) for value in fixed.VmechGravity)]
    for link in links:
        if marks.is_container(link):
            arguments += ["--rigid", marks.file_name(link.Label)]
    for label, density in marks.densities(document):
        arguments += ["--density", f"{marks.file_name(label)}={density}"]
    if study is not None:
        arguments += ["--study", study, "--rpm", rpm]
        for joint in drives:
            arguments += ["--drive", joint]
    with tempfile.TemporaryDirectory() as folder:
        step = pathlib.Path(folder) / (document.Label.replace("/", "-") + ".step")
        with marks.emptied_folders(document):
            Import.export(marks.roots(document), str(step))
        return run("import", step, *arguments, accepted=(0, 3))


def check(mechanism):
    """What `vmech check` finds, as a dictionary (assembled, mobility, links, joints, loops...)."""
    return json.loads(run("check", mechanism, "--json", accepted=(0, 3)))


def loads(study, folder):
    """Runs a study; its results are in `folder`. That no bearing fits (4) is a result, too."""
    return run("loads", study, "--out", folder, "--quiet", accepted=(0, 4))
