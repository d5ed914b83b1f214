"""Makes the documentation site: make_site.py SOURCE CHAPTERS DOXYFILE SITE

SOURCE is the project, CHAPTERS the folder of the built programs chapter-NN-name, which are run
where their results are older than they are. Of SITE, html/ is what is shown; source/ is what Sphinx
reads, the project by links and beside it the chapters as pages. A warning of Sphinx fails it, and
so does one of Doxygen.
"""

import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "notebooks_cpp"))
import chapter  # noqa: E402

# Beside the build, which has any name, and what belongs to a version control or an editor.
PARTS = ("apps", "base", "bindings", "comparison", "docs", "dynamics", "hw_interface", "kinematics",
         "mechanisms", "solvers", "studies", "tests")


def link_project(source, tree):
    shutil.rmtree(tree, ignore_errors=True)
    (tree / "notebooks_cpp").mkdir(parents=True)
    linked = [source / part for part in PARTS]
    linked += [file for pattern in ("*", "notebooks_cpp/*")
               for file in source.glob(pattern) if file.is_file()]
    for path in linked:
        (tree / path.relative_to(source)).symlink_to(path)


def write_chapters(source, programs, tree):
    for text in sorted((source / "notebooks_cpp").glob("[0-9]*.cc")):
        program = programs / f"chapter-{text.stem}"
        results = programs / f"{text.stem}.results"
        if not results.exists() or results.stat().st_mtime < program.stat().st_mtime:
            subprocess.run([program, results], cwd=source, check=True)
        chapter.write_pages(text, results, tree / "notebooks_cpp")


def write_reference(doxyfile, site):
    """By Doxygen. What it found undocumented stays in doxygen.log, for tests/docs to judge."""
    subprocess.run(["doxygen", doxyfile], cwd=site, check=True)
    problems = [line for line in (site / "doxygen.log").read_text().splitlines()
                if not line.endswith("is not documented.")]
    if problems:
        sys.exit("\n".join(problems))


def main():
    source, programs, doxyfile, site = (pathlib.Path(path).resolve() for path in sys.argv[1:])
    link_project(source, site / "source")
    write_chapters(source, programs, site / "source")
    shutil.rmtree(site / "html", ignore_errors=True)
    (site / "html").mkdir()
    write_reference(doxyfile, site)
    subprocess.run([sys.executable, "-m", "sphinx", "-qEW", "--keep-going", "-b", "html", "-d",
                    site / "doctrees", "-c", source / "docs/site", site / "source", site / "html"],
                   check=True)
    print(f"The documentation is {site}/html/index.html")


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as error:
        sys.exit(f"make_site.py: {' '.join(map(str, error.cmd))} failed")
