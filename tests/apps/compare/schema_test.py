"""schema_test.py SCHEMA FOLDER: the schema of suites accepts every suite in the folder."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from schema_check import REMOVED, load, run  # noqa: E402

BASE = {
    "vmech_suite": "1.0",
    "units": {"length": "mm"},
    "seed": 5,
    "repetitions": 3,
    "stopping": {"constraint_tolerance": 1e-9, "max_iterations": 40},
    "reach_tolerance": 1e-5,
    "targets": {
        "near": {"kind": "reachable", "count": 7, "start": "near", "start_distance": 0.3},
        "far": {"kind": "reachable", "count": 7, "start": "far"},
        "off": {"kind": "unreachable", "count": 3, "offset": 0.2},
        "bad": {"kind": "singular", "count": 3, "closeness": 0.01},
        "path": {"kind": "tracking", "count": 2, "steps": 30, "step": 0.01},
    },
    "mechanisms": {
        "by-rod": {"file": "slider-crank.yaml", "grasp": "handle"},
        "by-slider": {"file": "slider-crank.yaml", "targets": ["near", "path"],
                      "grasp": {"link": "slider", "origin": [10, 0, 0], "kind": "point"}},
    },
}

MALFORMED = [
    ("vmech_suite", REMOVED), ("vmech_suite", "2.0"), ("targets", REMOVED), ("targets", {}),
    ("mechanisms", REMOVED), ("mechanisms", []), ("seed", -1), ("seed", 1.5), ("repetitions", 0),
    ("stopping.max_iterations", 0), ("stopping.constraint_tolerance", 0),
    ("stopping.max_iteration", 5), ("reach_tolerance", 0), ("colour", "red"),
    ("targets.near.kind", REMOVED), ("targets.near.kind", "reachible"),
    ("targets.near.count", REMOVED), ("targets.near.count", 0), ("targets.near.start", "nearby"),
    ("targets.near.offset", 0.1), ("targets.near.steps", 5), ("targets.far.start_distance", 0.1),
    ("targets.off.closeness", 0.1), ("targets.bad.offset", 0.1), ("targets.path.start", "near"),
    ("targets.path.steps", 1), ("targets.path.step", 0), ("mechanisms.by-rod.file", REMOVED),
    ("mechanisms.by-rod.grasp", REMOVED), ("mechanisms.by-rod.grasp", 3),
    ("mechanisms.by-rod.file", ""), ("mechanisms.by-slider.targets", ["near", "near"]),
    ("mechanisms.by-slider.grasp.link", REMOVED), ("mechanisms.by-slider.grasp.kind", "firm"),
    ("mechanisms.by-slider.grasp.origin", [1, 2]),
]


def main():
    schema, folder = map(pathlib.Path, sys.argv[1:])
    files = [path for path in sorted(folder.glob("*.yaml")) if "vmech_suite" in load(path)]
    return run(schema, files, BASE, MALFORMED)


if __name__ == "__main__":
    sys.exit(main())
