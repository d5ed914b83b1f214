"""Puts a page together from its parts, as the vmech program does."""

import json
import pathlib

PAGE = pathlib.Path(__file__).resolve().parents[2] / "apps" / "view" / "page"
THREE = pathlib.Path("/usr/share/javascript/three/three.min.js")


def page_script(page=PAGE):
    """The page's own scripts, one after the other, in one function."""
    names = (page / "order.txt").read_text(encoding="utf-8").split()
    parts = [(page / name).read_text(encoding="utf-8") for name in names]
    return '(function () {\n"use strict";\n' + "".join(parts) + "})();\n"


def script_element(text):
    return "<script>//<![CDATA[\n" + text + "\n//]]></script>"


def scene_element(scene):
    text = json.dumps(scene, ensure_ascii=False).replace("<", "\\u003c")
    return f'<script type="application/json" id="vmech-scene">{text}</script>'


def page_html(scene, page=PAGE, three=THREE):
    parts = {
        "style": "<style>\n" + (page / "style.css").read_text(encoding="utf-8") + "</style>",
        "three": script_element(three.read_text(encoding="utf-8")),
        "script": script_element(page_script(page)),
        "scene": scene_element(scene),
    }
    text = (page / "page.html").read_text(encoding="utf-8")
    for name, part in parts.items():
        text = text.replace(f"<!--vmech:{name}-->", part)
    return text
