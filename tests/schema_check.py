"""Checks files against a published JSON Schema, and that the schema refuses what is malformed.

A test gives the schema, the files it must accept, and malformed variants of one of them as pairs
of a path and a value (REMOVED to take the key out).
"""

import copy
import json
import re
import sys

SKIPPED = 77
REMOVED = object()

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}; install python3-jsonschema and python3-yaml")
    sys.exit(SKIPPED)


class Loader(yaml.SafeLoader):
    """YAML 1.2 as vmech reads it: 1e-3 is a number, yes and no are words."""


Loader.yaml_implicit_resolvers = {}
for tag, pattern, first in (
        ("null", r"~|null|Null|NULL|", ["~", "n", "N", ""]),
        ("bool", r"true|True|TRUE|false|False|FALSE", list("tTfF")),
        ("int", r"[-+]?(?:0|[1-9][0-9]*)", list("-+0123456789")),
        ("float", r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?",
         list("-+.0123456789"))):
    Loader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^(?:{pattern})$"), first)


def load(path):
    return yaml.load(path.read_text(encoding="utf-8"), Loader)


def variant(document, path, value):
    """The document with the value at a path such as "joints.main.start" changed."""
    changed = copy.deepcopy(document)
    *parents, last = path.split(".")
    place = changed
    for key in parents:
        place = place[int(key) if isinstance(place, list) else key]
    if value is REMOVED:
        del place[last]
    else:
        place[int(last) if isinstance(place, list) else last] = value
    return changed


def run(schema_path, files, base, malformed):
    schema = json.loads(schema_path.read_text(encoding="utf-8"))
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    problems = [f"{path.name}: {error.json_path}: {error.message}"
                for path in files for error in validator.iter_errors(load(path))]
    problems += [f"the base of the malformed files: {error.json_path}: {error.message}"
                 for error in validator.iter_errors(base)]
    problems += [f"accepted although malformed: {path}: {value}" for path, value in malformed
                 if validator.is_valid(variant(base, path, value))]
    if not files:
        problems.append("no file to check")
    print("\n".join(problems) or f"{len(files)} files accepted, {len(malformed)} malformed refused")
    return 1 if problems else 0
