"""The Markdown of the project: its pages, their blocks of code, links and anchors."""

import pathlib
import re

from markdown_it import MarkdownIt

PARSER = MarkdownIt().enable("table")


def all_pages(source):
    """docs, the README of each folder and what lies at the top; nothing of a build."""
    folders = [path for path in source.iterdir()
               if path.is_dir() and path.name not in ("build", "out") and path.name[0] != "."]
    below = [page for folder in folders for page in folder.rglob("*.md")]
    return sorted([*source.glob("*.md"), *below])


def guides(source):
    """The pages that users read: the README at the top and docs."""
    return [source / "README.md", *sorted((source / "docs").glob("*.md"))]


def tokens(page):
    return PARSER.parse(page.read_text(encoding="utf-8"))


def plain_text(inline):
    return "".join(child.content for child in inline.children
                   if child.type in ("text", "code_inline"))


def slug(heading, taken):
    """The anchor of a heading as GitHub and MyST make it."""
    name = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
    unique, number = name, 0
    while unique in taken:
        number += 1
        unique = f"{name}-{number}"
    return unique


def anchors(page):
    found, all_tokens = set(), tokens(page)
    for opening, inline in zip(all_tokens, all_tokens[1:]):
        if opening.type == "heading_open":
            found.add(slug(plain_text(inline), found))
    return found


def links(page):
    """(line, target) of each link and picture."""
    for token in tokens(page):
        for child in token.children or ():
            target = child.attrs.get("href" if child.type == "link_open" else "src")
            if target:
                yield token.map[0] + 1, target


def code_blocks(page):
    """(line, language, text, paragraph above) of each block of code, fenced or indented."""
    paragraph = ""
    for token in tokens(page):
        if token.type == "inline":
            paragraph = token.content
        elif token.type in ("fence", "code_block"):
            yield token.map[0] + 1, token.info.strip(), token.content, paragraph
