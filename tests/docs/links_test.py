"""Every link of a page to a file, a folder or an anchor of the project leads there:
links_test.py SOURCE"""

import pathlib
import sys
import urllib.parse

import pages


def problem(page, target):
    """What is wrong with a link of the page; nothing if it leads somewhere."""
    path, _, anchor = urllib.parse.unquote(target).partition("#")
    linked = (page.parent / path).resolve() if path else page
    if not linked.exists():
        return "there is no such file"
    if anchor and linked.suffix == ".md" and anchor not in pages.anchors(linked):
        return f"{linked.name} has no heading for this anchor"
    return None


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    checked, problems = 0, []
    for page in pages.all_pages(source):
        for line, target in pages.links(page):
            if urllib.parse.urlparse(target).scheme:
                continue
            checked += 1
            what = problem(page, target)
            if what:
                problems.append(f"{page.relative_to(source)}:{line}: '{target}': {what}")
    print("\n".join(problems) or f"{checked} links within the project lead where they say")
    return 1 if problems or checked < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
