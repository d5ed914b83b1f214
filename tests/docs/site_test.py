"""The documentation site is whole: every link and anchor of its pages leads somewhere in it, every
chapter is there with its results, nothing of its Markdown is left as it is written, and the browser
draws every formula of it:
site_test.py SITE SOURCE CHROMIUM"""

import html
import html.parser
import pathlib
import subprocess
import sys
import urllib.parse

FORMULAS = """<!DOCTYPE html><meta charset="utf-8">
<script src="{site}/_static/katex.min.js"></script>
<body>{formulas}</body><script src="{site}/_static/formulas.js"></script>
<script>
const left = document.querySelectorAll(".math:not(:has(.katex))");
const drawn = document.querySelectorAll(".math .katex-html").length;
document.body.innerHTML = `<pre>${{drawn}} drawn</pre>`;
for (const element of left) document.body.append(element);
</script>"""


class Page(html.parser.HTMLParser):
    """The links, the anchors and the formulas of a page, and its words beside code."""

    CODE = ("pre", "code", "script", "style", "svg")

    def __init__(self, path):
        super().__init__()
        self.links, self.from_network, self.anchors, self.formulas = [], [], set(), []
        self.in_formula, self.in_code, self.words = None, 0, ""
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        of = dict(attributes)
        self.anchors.update(of[key] for key in ("id", "name") if key in of)
        target = of.get("href") or of.get("src")
        if target:
            self.links.append(target)
            if tag in ("script", "img", "link") and urllib.parse.urlparse(target).netloc:
                self.from_network.append(target)
        self.in_code += tag in self.CODE
        if of.get("class") == "math":
            self.in_formula = tag
            self.formulas.append((tag, ""))

    def handle_data(self, data):
        if self.in_formula:
            tag, text = self.formulas[-1]
            self.formulas[-1] = (tag, text + data)
        elif not self.in_code:
            self.words += data

    def handle_endtag(self, tag):
        self.in_code -= tag in self.CODE
        if tag == self.in_formula:
            self.in_formula = None


def link_problems(path, page, pages, root):
    for target in page.from_network:
        yield f"{path.relative_to(root)}: '{target}' is fetched from the network"
    for target in page.links:
        if urllib.parse.urlparse(target).scheme:
            continue
        file, _, anchor = urllib.parse.unquote(target).partition("#")
        linked = (path.parent / file.split("?")[0]).resolve() if file else path
        if not linked.is_file():
            yield f"{path.relative_to(root)}: '{target}' leads nowhere"
        elif path.parent.name == "api":
            continue  # Doxygen names sections of a class that it then has no reason to write
        elif anchor and linked in pages and anchor not in pages[linked].anchors:
            yield f"{path.relative_to(root)}: '{target}' leads to no anchor"


def markdown_problems(path, page, root):
    """Marks of Markdown that are left as they are: a formula or bold words that it did not see."""
    for mark in ("$", "**"):
        at = page.words.find(mark)
        if at >= 0 and path.parent.name != "api":
            yield f"{path.relative_to(root)}: '{mark}' is left in '{page.words[at - 20:at + 30]}'"


def formula_problems(pages, root, chromium):
    formulas = [formula for page in pages.values() for formula in page.formulas]
    sheet = root.parent / "formulas.html"
    sheet.write_text(FORMULAS.format(site=root.as_uri(), formulas="".join(
        f'<{tag} class="math">{html.escape(text)}</{tag}>' for tag, text in formulas)))
    drawn = subprocess.run(
        [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files",
         "--virtual-time-budget=20000", "--dump-dom", sheet.as_uri()],
        capture_output=True, text=True, check=True, timeout=300).stdout
    if f"<pre>{len(formulas)} drawn</pre>" not in drawn:
        yield f"not all of {len(formulas)} formulas are drawn: {drawn[drawn.find('<pre>'):][:2000]}"


def chapter_problems(root, source):
    for chapter in sorted((source / "notebooks_cpp").glob("[0-9]*.cc")):
        page = root / "notebooks_cpp" / f"{chapter.stem}.html"
        text = page.read_text(encoding="utf-8") if page.exists() else ""
        if '<span class="badge good">holds</span>' not in text or "badge bad" in text:
            yield f"{page.name}: no page, no result or a claim that fails"


def main():
    root, source = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    pages = {path: Page(path) for path in root.rglob("*.html")}
    problems = [problem for path, page in pages.items()
                for problem in link_problems(path, page, pages, root)]
    problems += [problem for path, page in pages.items()
                 for problem in markdown_problems(path, page, root)]
    problems += formula_problems(pages, root, sys.argv[3])
    problems += chapter_problems(root, source)
    print("\n".join(problems) or
          f"{len(pages)} pages with {sum(len(page.links) for page in pages.values())} links and "
          f"{sum(len(page.formulas) for page in pages.values())} formulas are whole")
    return 1 if problems or not (root / "docs/index.html").exists() else 0


if __name__ == "__main__":
    sys.exit(main())
