"""Puts a page together from its parts, as the vmech program does."""

import json
import pathlib

PAGE = pathlib.Path(__file__).resolve().parents[2] / "apps" / "view" / "page"


def script_element(path):
    return "<script>//<![CDATA[\n" + path.read_text(encoding="utf-8") + "\n//]]></script>"


def scene_element(scene):
    text = json.dumps(scene, ensure_ascii=False).replace("<", "\\u003c")
    return f'<script type="application/json" id="vmech-scene">{text}</script>'


def page_html(scene, scripts):
    """`scripts`: the folder of the build that holds three.js and page.js."""
    parts = {
        "style": "<style>\n" + (PAGE / "style.css").read_text(encoding="utf-8") + "</style>",
        "three": script_element(scripts / "three.js"),
        "script": script_element(scripts / "page.js"),
        "scene": scene_element(scene),
    }
    text = (PAGE / "page.html").read_text(encoding="utf-8")
    for name, part in parts.items():
        text = text.replace(f"<!--vmech:{name}-->", part)
    return text
