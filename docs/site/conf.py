"""Sphinx's settings of the documentation site; docs/site/README.md says how it is made."""

import html
import pathlib
import re

from docutils import nodes

project = "vmech"
author = "the vmech authors"
extensions = ["myst_parser"]
root_doc = "docs/index"
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
html_theme = "furo"
html_title = "vmech"
html_static_path = ["static", "/usr/share/javascript/katex"]
html_css_files = ["site.css"]
html_extra_path = ["extra"]
html_show_copyright = False
html_copy_source = False
html_math_renderer = "katex"

REFERENCE = """
## Reference

<ul><li><a href="../api/index.html">The C++ and C interfaces</a>: every class and function of the
installed headers</li></ul>
"""
CHAPTER = re.compile(r"notebooks_cpp/\d\d-[\w-]+")
LINK = re.compile(r"\]\(([^)#:]+\.md)(?:#[^)]*)?\)")


def toctree(entries, caption=None):
    option = f":caption: {caption}\n" if caption else ""
    return "\n```{toctree}\n:hidden:\n" + option + "\n" + "\n".join(entries) + "\n```\n"


def trees_of_index(text, pages):
    """The side bar: the links of docs/index.md below their headings, then chapters and folders."""
    listed = set()
    for section in re.split(r"^## ", text, flags=re.M)[1:]:
        links = [link for link in dict.fromkeys(LINK.findall(section)) if link not in listed]
        listed.update(links)
        if links:
            yield toctree(links, section.splitlines()[0])
    yield toctree([f"/{page}" for page in sorted(pages) if CHAPTER.fullmatch(page)], "Chapters")
    yield toctree(["/README"], "Folder by folder")


def folders_below(readme, pages):
    """The READMEs of the folders below that of a README, without those further down."""
    folder = pathlib.PurePath(readme).parent
    below = {pathlib.PurePath(page).parent for page in pages
             if page.endswith("/README") and folder in pathlib.PurePath(page).parents}
    nearest = [path for path in below - {folder} if not below & set(path.parents) - {folder}]
    return [f"/{path}/README" for path in sorted(nearest)]


def complete_source(app, page, source):
    """What the Markdown, which is read elsewhere as well, does not say to Sphinx."""
    text = re.sub(r"(\]\([\w./-]*notebooks_cpp/\d\d-[\w-]+)\.cc\)", r"\1.md)", source[0])
    if page == root_doc:
        text += "".join(trees_of_index(text, app.env.found_docs)) + REFERENCE
    elif page.split("/")[-1] == "README":
        below = folders_below(page, app.env.found_docs)
        text += toctree(below) if below else ""
    source[0] = text


def write_formula(tag):
    def visit(writer, node):
        writer.body.append(f'<{tag} class="math">{html.escape(node.astext())}</{tag}>')
        raise nodes.SkipNode
    return visit, None


def load_katex(app, page, template, context, tree):
    if tree and any(tree.findall(lambda node: isinstance(node, (nodes.math, nodes.math_block)))):
        for script in "katex.min.js", "formulas.js":
            app.add_js_file(script, loading_method="defer")
        app.add_css_file("katex.min.css")


def setup(app):
    app.add_html_math_renderer("katex", write_formula("span"), write_formula("div"))
    app.connect("source-read", complete_source)
    app.connect("html-page-context", load_katex)
