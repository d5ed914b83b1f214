"""The files of the project that the lint tests read."""

import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
CPP_SUFFIXES = {".cc", ".h"}


def project_files():
    """Every file that git tracks or would track; every file outside build folders without git."""
    command = ["git", "-C", str(ROOT), "ls-files", "--cached", "--others", "--exclude-standard"]
    try:
        listing = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        paths = [ROOT / line for line in listing.splitlines()]
    except (OSError, subprocess.CalledProcessError):
        generated = ("build", "out", ".git")
        paths = [path for path in ROOT.rglob("*")
                 if not path.relative_to(ROOT).parts[0].startswith(generated)]
    return sorted(path for path in set(paths) if path.is_file())


def cpp_files():
    return [path for path in project_files() if path.suffix in CPP_SUFFIXES]


def relative(path):
    return path.relative_to(ROOT).as_posix()
