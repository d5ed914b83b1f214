"""Puts a page together from its parts, as the vmech program does."""

import base64
import gzip
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


def packed_elements(three, page=PAGE):
    """All code as one packed element, and the script that unpacks it."""
    code = three.read_text(encoding="utf-8") + "\n" + page_script(page)
    packed = base64.b64encode(gzip.compress(code.encode(), 9, mtime=0)).decode()
    element = f'<script type="application/octet-stream" id="vmech-code">{packed}</script>'
    return element, script_element((page / "unpack.js").read_text(encoding="utf-8"))


def page_html(scene, packed=False, page=PAGE, three=THREE):
    if packed:
        library, script = packed_elements(three, page)
    else:
        library = script_element(three.read_text(encoding="utf-8"))
        script = script_element(page_script(page))
    parts = {
        "style": "<style>\n" + (page / "style.css").read_text(encoding="utf-8") + "</style>",
        "three": library,
        "script": script,
        "scene": scene_element(scene),
    }
    text = (page / "page.html").read_text(encoding="utf-8")
    for name, part in parts.items():
        text = text.replace(f"<!--vmech:{name}-->", part)
    return text
