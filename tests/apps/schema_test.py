"""schema_test.py SCHEMA FOLDER: the schema of studies accepts every study in the folder."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from schema_check import REMOVED, load, run  # noqa: E402

BASE = {
    "vmech_study": "1.0",
    "mechanism": "slider-crank.yaml",
    "units": {"length": "mm"},
    "motion": [{"joint": "main", "rpm": 1500, "turns": 2, "steps": 720},
               {"joint": "other", "table": "other.csv"}],
    "external": [{"link": "slider", "at": [1, 0, 0], "force": [1, 0, 0], "axes": "world"},
                 {"link": "slider", "table": "gas.csv", "period": 360}],
    "rule": "stiffness",
    "bearings": {"main": {"positions": [-15, 15], "locating": 0, "shaft": [15, 30], "housing": 60,
                          "life_hours": 10000, "pair_life_hours": 6000, "reliability": 90,
                          "static_safety": 1.5}},
    "paths": {"handle": "wanted.csv", "point": [[0, 1, 2], ["crank", 0, "2*crank"]]},
}

MALFORMED = [
    ("vmech_study", REMOVED), ("vmech_study", 1.0), ("mechanism", REMOVED), ("mechanism", ""),
    ("motion", REMOVED), ("motion", []), ("motion", {"grasp": "handle"}),
    ("motion", {"joint": "main", "rpm": 1500, "speed": 3, "turns": 2, "steps": 720}),
    ("motion.0.joint", REMOVED), ("motion.0.rpm", "fast!"), ("motion.0.rpm", REMOVED),
    ("motion.0.turns", 0), ("motion.0.duration", 1), ("motion.0.steps", 0),
    ("motion.0.steps", 7.5), ("motion.0.steps", REMOVED), ("motion.0.repeats", True),
    ("motion.0.speeed", 1), ("motion.1.steps", 720), ("external", {}), ("external.0.link", REMOVED),
    ("external.0.force", [1, 0]), ("external.0.force", REMOVED), ("external.0.axes", "ground"),
    ("external.0.period", 360), ("external.1.force", [1, 0, 0]), ("external.1.period", 0),
    ("rule", "guess"), ("colour", "red"), ("bearings.main.positions", []),
    ("bearings.main.positions", [1, 2, 3]), ("bearings.main.locating", 2),
    ("bearings.main.shaft", 15), ("bearings.main.housing", 0), ("bearings.main.reliability", 50),
    ("bearings.main.static_safety", 0), ("bearings.main.pair_life_hours", -1),
    ("motion.0.freedom", 0), ("motion.0.freedom", "rw"), ("bearings.main.lubrication", "water"),
    ("paths", []), ("paths.handle", 3), ("paths.point", []), ("paths.point.0", [1, 2]),
]


def main():
    schema, folder = map(pathlib.Path, sys.argv[1:])
    files = [path for path in sorted(folder.glob("*.yaml")) if "vmech_study" in load(path)]
    return run(schema, files, BASE, MALFORMED)


if __name__ == "__main__":
    sys.exit(main())
