"""schema_test.py SCHEMA FOLDER: the schema of mechanisms accepts every mechanism in the folder."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from schema_check import REMOVED, load, run  # noqa: E402

AXES = {"z": [0, 0, 1], "x": [1, 0, 0]}
BASE = {
    "vmech": "1.0",
    "units": {"length": "mm", "angle": "deg", "torque": "N mm", "stiffness": "N/mm"},
    "gravity": [0, -9.81, 0],
    "ground": "frame",
    "parameters": {"a": 50, "b": "3*a + 5 mm"},
    "mechanisms": {"left": {"use": "leg.yaml", "on": "arm", "origin": [0, "a", 0],
                            "parameters": {"shin": "b/2"}}},
    "links": {
        "frame": {"anchors": {"a": {}, "b": {"origin": [1, 2, 3], **AXES}}},
        "arm": {"mass": 1, "center_of_gravity": [1, 0, 0],
                "inertia": {"about": "origin", "xx": 1, "yy": 2, "zz": 2, "xy": -0.1},
                "anchors": {"a": {}, "b": {}}},
        "hand": {"mass": 1, "inertia": {"principal": [1, 2, 2], "axes": AXES},
                 "anchors": {"a": {}, "row": {"dh": {"theta": 1, "d": 2}}}, "x-colour": "red"},
        "tool": {"mass": 1, "anchors": {}},
        "made": {"bodies": [{"shape": "box", "size": [1, "2*a", 3], "mass": 1},
                            {"shape": "tube", "radius": 2, "inner_radius": 1, "length": "b",
                             "density": 7850, "relative": "a", "origin": [1, 0, 0]}],
                 "anchors": {"a": {}, "b": {"relative": "a", "origin": ["a", "max(a, b)", 0]}}},
    },
    "joints": {
        "pin": {"type": "revolute", "connects": ["frame/a", "arm/a"], "start": 40,
                "limits": [None, 90], "friction": {"coefficient": 0.1, "radius": 3,
                                                      "thrust_radius": 5, "length": 20},
                "stiffness": [1, 1, 1, 1, 1, 0]},
        "tube": {"type": "cylindrical", "connects": ["arm/b", "hand/a"], "start": [1, 2],
                 "limits": [[0, 5], None], "viscous": [1, 2],
                 "spring": {"stiffness": [1, 0], "rest": [1, 0]}},
        "rod": {"type": "cylindrical", "connects": ["arm/b", "hand/a"], "start": {"rz": 2},
                "limits": {"z": [0, 5]}, "viscous": {"z": 1, "rz": 2},
                "spring": {"stiffness": {"z": 1}, "rest": {"z": 1}}},
        "ball": {"type": "spherical", "connects": ["arm/b", "hand/a"], "start": [1, 0, 0, 0]},
        "row": {"type": "revolute", "connects": ["hand", "tool"],
                "dh": [{"theta": 90, "d": 1, "a": 2, "alpha": -90, "beta": 0}]},
        "lead": {"type": "screw", "connects": ["arm/b", "hand/a"], "pitch": 2,
                 "friction": {"coefficient": 0.1, "radius": 3, "length": 20}},
        "guide": {"type": "prismatic", "connects": ["arm/b", "hand/a"],
                  "friction": {"coefficient": 0.1, "length": 20, "width": 8}},
    },
    "grasps": {"tip": {"link": "hand", "kind": "point"},
               "palm": {"link": "tool", "dh": [{"a": 1}, {"theta": 3}]}},
    "cuts": ["ball"],
}

MALFORMED = [
    ("vmech", REMOVED), ("vmech", 1.0), ("vmech", "2.0"), ("gravity", REMOVED),
    ("gravity", [0, -9.81]), ("gravity", [0, "-9.81", 0]), ("ground", REMOVED), ("ground", 3),
    ("links", []), ("joints", []), ("colour", "red"), ("units.length", "furlong"),
    ("units.length", 1), ("units.angel", "deg"), ("links.a/b", {"anchors": {}}),
    ("links. a", {"anchors": {}}), ("links.arm.mass", -1),
    ("links.arm.mass", "heavy!"), ("links.arm.mass", "3"), ("parameters", [3]),
    ("parameters.2a", 3), ("mechanisms.left.use", REMOVED), ("mechanisms.left.from", "x"),
    ("links.made.mass", 3), ("links.made.bodies.0.size", REMOVED),
    ("links.made.bodies.0.radius", 3), ("links.made.bodies.0.density", 3),
    ("links.made.bodies.1.inner_radius", 0), ("links.made.bodies.1.shape", "torus"),
    ("links.arm.mass", None), ("links.arm.mas", 1), ("links.arm.anchors", REMOVED),
    ("links.arm.inertia.yy", REMOVED), ("links.arm.inertia.about", "center_of_mass"),
    ("links.arm.inertia.principal", [1, 2, 3]), ("links.arm.inertia.axes", AXES),
    ("links.hand.inertia.off_diagonal", "matrix_elements"),
    ("links.frame.anchors.b.z", [0, 0, 0]), ("links.frame.anchors.b.z", REMOVED),
    ("links.frame.anchors.b.origin", [1, 2, 3, 4]), ("joints.pin.type", "revolut"),
    ("joints.pin.type", REMOVED), ("joints.pin.connects", ["frame/a"]),
    ("joints.pin.connects", ["frame", "arm/a"]), ("joints.pin.start", [1, 2]),
    ("joints.rod.start", {"third": 1}), ("joints.rod.viscous", {"z": -1}),
    ("joints.rod.limits", {"z": 5}), ("joints.rod.start.rz", "far?"),
    ("joints.pin.limits", [90]), ("joints.pin.pitch", 2), ("joints.pin.viscous", -1),
    ("joints.pin.friction.radius", REMOVED), ("joints.pin.friction.radius", 0),
    ("joints.pin.friction.width", 3), ("joints.pin.friction.length", 0),
    ("joints.guide.friction.radius", 3), ("joints.guide.friction.thrust_radius", 3),
    ("joints.lead.friction.thrust_radius", 3), ("joints.guide.friction.width", -1),
    ("joints.pin.stiffness", [1, 1, 1, 1, 1]), ("joints.tube.start", 40),
    ("joints.tube.limits", [0, 5]), ("joints.tube.spring.stiffness", REMOVED),
    ("joints.tube.spring.stiffness", 3), ("joints.ball.start", [1, 0]),
    ("joints.ball.limits", [[0, 1], [0, 1], [0, 1]]), ("joints.ball.spring", {"stiffness": 1}),
    ("joints.row.dh", REMOVED), ("joints.row.dh", 3), ("joints.row.dh", {"tehta": 1}),
    ("joints.row.connects", ["hand", "tool/a"]), ("grasps.palm.origin", [0, 0, 0]),
    ("links.hand.anchors.row.z", [0, 0, 1]), ("links.hand.anchors.row.dh", [1, 2, 3, 4]),
    ("joints.lead.pitch", REMOVED), ("joints.lead.pitch", 0), ("grasps.tip.kind", "firm"),
    ("grasps.tip.link", REMOVED), ("cuts", "ball"), ("cuts", ["ball", "ball"]),
]


def main():
    schema, folder = map(pathlib.Path, sys.argv[1:])
    files = [path for path in sorted(folder.glob("*.yaml")) if "vmech" in load(path)]
    return run(schema, files, BASE, MALFORMED)


if __name__ == "__main__":
    sys.exit(main())
