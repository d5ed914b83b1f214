"""Makes the pictures of the documentation: drawings by `vmech check --draw`, the report and the
page in the browser, and the moving picture of the README.
make_pictures.py VMECH CHROMIUM CHROMEDRIVER"""

import io
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

IMAGES = pathlib.Path(__file__).resolve().parent
ROOT = IMAGES.parents[1]
EXAMPLES = ROOT / "mechanisms" / "examples"
sys.path.insert(0, str(ROOT / "tests" / "view"))

from browser import open_browser, resize  # noqa: E402

FRAMES = 36  # of the moving picture
COLOURS = 48
CROP = "100%x51%+0+190"  # of the canvas: where the mechanism moves


def run(folder, *words):
    """Runs the command in a folder; what it warns of is left to the pages that show it."""
    subprocess.run([str(word) for word in words], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)


def draw(folder, mechanism, name):
    run(folder, VMECH, "check", mechanism, "--draw", IMAGES / f"{name}.svg")


def saved_files(page):
    """The files that a page asks its reader to save, in its order: (name, text)."""
    pattern = r"[Ss]ave this as `([\w.-]+)`[^`]*?```yaml\n(.*?)```"
    return re.findall(pattern, page.read_text(encoding="utf-8"), re.DOTALL)


def write_small(png, name):
    """A picture with few colours, which is a third of its size."""
    subprocess.run(["convert", "png:-", "-strip", "+dither", "-colors", "128", "-define",
                    "png:compression-level=9", str(IMAGES / f"{name}.png")],
                   input=png, check=True)


def picture(browser, path, name, width, height):
    resize(browser, width, height)
    browser.get(path.as_uri())
    time.sleep(1.5)
    write_small(browser.get_screenshot_as_png(), name)


def plot(browser, page, title, name):
    """The first plot of a page that has this title."""
    resize(browser, 1000, 1200)
    browser.get(page.as_uri())
    time.sleep(1)
    plots = browser.find_elements("css selector", "svg.plot")
    titled = [found for found in plots if title in found.text]
    write_small(titled[0].screenshot_as_png, name)


def tutorial(browser, folder):
    files = saved_files(ROOT / "docs" / "tutorial.md")
    first = next(text for name, text in files if name == "shaker.yaml")
    (folder / "first.yaml").write_text(first.replace("vmech:", "name: shaker\nvmech:", 1))
    draw(folder, "first.yaml", "tutorial-crank")
    for name, text in files:
        (folder / name).write_text(text)
    draw(folder, "shaker.yaml", "tutorial-shaker")
    run(folder, VMECH, "check", "shaker.yaml", "--draw", "shaker.html")
    picture(browser, folder / "shaker.html", "tutorial-view", 1000, 560)
    run(folder, VMECH, "loads", "shaker-study.yaml", "--out", "shaker")
    report = folder / "shaker" / "report.html"
    picture(browser, report, "tutorial-report", 1000, 1240)
    plot(browser, report, "Load over the cycle", "tutorial-loads")
    run(folder, VMECH, "sensitivities", "shaker-study.yaml", "--of", "wrist.force,main.drive",
        "--out", "matters")
    plot(browser, folder / "matters" / "report.html", "wrist.force", "tutorial-sensitivities")


def gallery(browser, folder):
    for file in sorted(EXAMPLES.glob("*.yaml")):
        if re.search(r"^vmech:", file.read_text(encoding="utf-8"), re.MULTILINE):
            draw(EXAMPLES, file.name, f"gallery-{file.stem}")
    for name in ("stewart-gough", "flyball-governor", "puma-560"):
        run(EXAMPLES, VMECH, "check", f"{name}.yaml", "--draw", folder / f"{name}.html")
        picture(browser, folder / f"{name}.html", f"view-{name}", 900, 560)


MOVE = """
const slider = document.querySelector(arguments[0]);
slider.value = Number(slider.min) + arguments[1] * (Number(slider.max) - Number(slider.min));
slider.dispatchEvent(new Event('input', {bubbles: true}));
"""
ARROWS = "label input[type=range], input[type=range]:not(.vv-cycle)"


def moving_picture(browser, folder):
    """One turn of the slider-crank, with its joint forces, as in its report."""
    run(EXAMPLES, VMECH, "loads", "slider-crank-study.yaml", "--out", folder / "moving")
    resize(browser, 900, 1500)
    browser.get((folder / "moving" / "report.html").as_uri())
    time.sleep(1.5)
    browser.execute_script(MOVE, ARROWS, 0.85)
    stage = browser.find_element("css selector", "canvas")
    frames = []
    for k in range(FRAMES):
        browser.execute_script(MOVE, ".vv-cycle", 0.5 * k / FRAMES)  # one turn of two
        time.sleep(0.15)
        frame = folder / f"frame-{k:02}.png"
        frame.write_bytes(stage.screenshot_as_png)
        frames.append(str(frame))
    subprocess.run(["convert", "-delay", "6", "-loop", "0", *frames, "-crop", CROP, "+repage",
                    "+dither", "-colors", str(COLOURS), "-layers", "optimize",
                    str(IMAGES / "view.gif")], check=True)


def main():
    folder = pathlib.Path(tempfile.mkdtemp())
    browser = open_browser(sys.argv[2], sys.argv[3], folder)
    try:
        for make in (tutorial, gallery, moving_picture):
            make(browser, folder)
    finally:
        browser.quit()
        shutil.rmtree(folder)


if __name__ == "__main__":
    VMECH = pathlib.Path(sys.argv[1]).resolve()
    main()
