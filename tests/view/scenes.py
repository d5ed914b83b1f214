"""Scenes for tests of the page, with motions in closed form."""

import array
import base64
import math
import struct

IDENTITY = [0, 0, 0, 1, 0, 0, 0]
UNITS = {"length": "mm", "metres": 0.001, "angle": "deg", "radians": math.pi / 180}


def base64_of(code, values):
    return base64.b64encode(array.array(code, values).tobytes()).decode()


def about_z(x, y, angle, z=0.0):
    return [x, y, z, math.cos(angle / 2), 0, 0, math.sin(angle / 2)]


def along(origin, direction):
    """A pose whose z axis has a direction."""
    size = math.sqrt(sum(v * v for v in direction))
    x, y, z = (v / size for v in direction)
    if z < -0.999999:
        return [*origin, 0, 1, 0, 0]
    w = math.sqrt((1 + z) / 2)
    return [*origin, w, -y / (2 * w), x / (2 * w), 0]


def turned(pose, point):
    """A point of a link in the world."""
    w, x, y, z = pose[3:]
    tx = 2 * (y * point[2] - z * point[1])
    ty = 2 * (z * point[0] - x * point[2])
    tz = 2 * (x * point[1] - y * point[0])
    return [pose[0] + point[0] + w * tx + y * tz - z * ty,
            pose[1] + point[1] + w * ty + z * tx - x * tz,
            pose[2] + point[2] + w * tz + x * ty - y * tx]


def link(name, anchors, mass=0.5, centre=None):
    """`anchors`: names with a pose, or a point that takes the axes of the link."""
    poses = [{"name": key, "pose": list(value) if len(value) == 7 else [*value, 1, 0, 0, 0]}
             for key, value in anchors.items()]
    middle = [sum(a["pose"][k] for a in poses) / max(1, len(poses)) for k in range(3)]
    return {"name": name, "mass": mass, "centre": centre or middle, "anchors": poses}


def joint(name, kind, first, second, rotations=(True,), cut=False, limits=(None, None)):
    return {"name": name, "type": kind, "cut": cut,
            "first": {"link": first[0], "anchor": first[1]},
            "second": {"link": second[0], "anchor": second[1]},
            "freedoms": [{"name": name if len(rotations) == 1 else f"{name} {k + 1}",
                          "rotation": rotation, "lower": limits[0], "upper": limits[1]}
                         for k, rotation in enumerate(rotations)]}


def scene_of(title, length, gravity, links, joints, poses, coordinates, **more):
    return {"format": "vmech-view/1", "title": title, "version": "0.1.0", "length": length,
            "units": UNITS, "gravity": gravity, "ground": 0, "links": links, "joints": joints,
            "grasps": [], "start": {"poses": poses, "coordinates": coordinates}, **more}


def motion_of(times, cycle, axis, poses, coordinates, wrenches, certainty, **more):
    flat = [value for row in poses for pose in row for value in pose]
    rates = [0.0] * (len(coordinates) * len(coordinates[0]))
    return {"times": base64_of("d", times), "cycle": cycle,
            "axis": {**axis, "values": base64_of("d", axis["values"])},
            "poses": base64_of("f", flat),
            "coordinates": base64_of("f", [v for row in coordinates for v in row]),
            "rates": base64_of("f", rates),
            "wrenches": base64_of("f", [v for row in wrenches for w in row for v in w]),
            "certainty": certainty, "drives": [], "loads": [], "dead_centres": [], **more}


class FourBar:
    """Crank, coupler and rocker on the ground; the coupler's point is beside its bar."""

    crank, coupler, rocker, ground = 0.05, 0.16, 0.12, 0.15
    point = [0.09, 0.07, 0.0]

    def angles(self, theta):
        """Of the coupler and the rocker, by the law of cosines."""
        x, y = self.crank * math.cos(theta), self.crank * math.sin(theta)
        dx, dy = self.ground - x, -y
        far = math.hypot(dx, dy)
        cosine = (self.coupler ** 2 + far ** 2 - self.rocker ** 2) / (2 * self.coupler * far)
        coupler = math.atan2(dy, dx) + math.acos(cosine)
        tip = (x + self.coupler * math.cos(coupler), y + self.coupler * math.sin(coupler))
        return coupler, math.atan2(tip[1], tip[0] - self.ground)

    def poses(self, theta):
        coupler, rocker = self.angles(theta)
        return [IDENTITY, about_z(0, 0, theta),
                about_z(self.crank * math.cos(theta), self.crank * math.sin(theta), coupler),
                about_z(self.ground, 0, rocker)]

    def coordinates(self, theta):
        coupler, rocker = self.angles(theta)
        return [theta, coupler - theta, rocker - coupler, rocker]

    def curve(self, theta):
        """The coupler's point in the world."""
        return turned(self.poses(theta)[2], self.point)

    def scene(self, count=720, crank_name="crank", **more):
        links = [link("ground", {"a": (0, 0, 0), "d": (self.ground, 0, 0)}),
                 link(crank_name, {"a": (0, 0, 0), "b": (self.crank, 0, 0)}, 0.2),
                 link("coupler", {"b": (0, 0, 0), "c": (self.coupler, 0, 0)}, 0.7,
                      [0.08, 0.02, 0]),
                 link("rocker", {"d": (0, 0, 0), "c": (self.rocker, 0, 0)}, 0.5)]
        joints = [joint("A", "revolute", (0, 0), (1, 0)), joint("B", "revolute", (1, 1), (2, 0)),
                  joint("C", "revolute", (2, 1), (3, 1), cut=True),
                  joint("D", "revolute", (0, 1), (3, 0), limits=(1.0, 2.6))]
        scene = scene_of("Four-bar", 0.16, [0, -9.81, 0], links, joints, self.poses(0.6),
                         self.coordinates(0.6), **more)
        scene["grasps"] = [{"name": "coupler point", "link": 2, "point": True,
                            "pose": [*self.point, 1, 0, 0, 0]}]
        if count:
            scene["motion"] = self.motion(count)
        return scene

    def motion(self, count):
        turns = [2 * math.pi * i / count for i in range(count)]
        times = [0.5 * i / count for i in range(count)]
        wrenches = [[[40 * math.cos(t + j) + 10, 25 * math.sin(2 * t + j), 6, 0.2, 0.1,
                      0.4 * math.sin(t)] for j in range(4)] for t in turns]
        words = [["certain"] * 6, ["certain"] * 6, ["certain", "certain"] + ["not determined"] * 4,
                 ["not determined"] * 6]
        axis = {"label": "crank", "unit": "deg", "values": [math.degrees(t) for t in turns]}
        load = {"link": 2, "point": self.point,
                "wrenches": base64_of("f", [v for t in turns for v in (0, -30, 0, 0, 0, 0)])}
        return motion_of(
            times, 0.5, axis, [self.poses(t) for t in turns],
            [self.coordinates(t) for t in turns], wrenches, words, loads=[load],
            drives=[{"name": "crank", "unit": "N m",
                     "forces": base64_of("f", [2 * math.sin(t) for t in turns])}],
            dead_centres=[{"axis": 97.0, "pose": 97.0 * count / 360, "label": "rocker at rest"},
                          {"axis": 291.0, "pose": 291.0 * count / 360, "label": "rocker at rest"}])


def slider_crank(count=360):
    """A crank of 40 mm and a rod of 130 mm; the slider goes along x."""
    crank, rod = 0.04, 0.13
    sideways = along([0, 0, 0], [1, 0, 0])
    links = [link("frame", {"shaft": (0, 0, 0), "guide": sideways}),
             link("crank", {"shaft": (0, 0, 0), "pin": (crank, 0, 0)}),
             link("rod", {"big end": (0, 0, 0), "small end": (rod, 0, 0)}),
             link("piston", {"pin": (0, 0, 0), "guide": sideways}, 0.6)]
    joints = [joint("main", "revolute", (0, 0), (1, 0)),
              joint("big end", "revolute", (1, 1), (2, 0)),
              joint("small end", "revolute", (2, 1), (3, 0)),
              joint("guide", "prismatic", (0, 1), (3, 1), (False,), cut=True)]

    def at(t):
        lean = -math.asin(crank * math.sin(t) / rod)
        x = crank * math.cos(t) + rod * math.cos(lean)
        return ([IDENTITY, about_z(0, 0, t),
                 about_z(crank * math.cos(t), crank * math.sin(t), lean), about_z(x, 0, 0)],
                [t, lean - t, -lean, x])

    turns = [2 * math.pi * i / count for i in range(count + 1)]
    wrenches = [[[300 * math.cos(t), 200 * math.sin(t), 0, 0, 0, 3 * math.sin(t)],
                 [250 * math.cos(t), 120 * math.sin(t), 0, 0, 0, 0],
                 [200 * math.cos(t), 80 * math.sin(t), 0, 0, 0, 0],
                 [0, 90 * math.sin(t), 0, 0, 0.5, 0.4]] for t in turns]
    scene = scene_of("Slider-crank", 0.17, [0, -9.81, 0], links, joints, *at(0.9))
    scene["motion"] = motion_of(
        [0.02 * i / count for i in range(count + 1)], 0.02,
        {"label": "crank", "unit": "deg", "values": [math.degrees(t) for t in turns]},
        [at(t)[0] for t in turns], [at(t)[1] for t in turns], wrenches,
        [["certain"] * 6] * 4,
        dead_centres=[{"axis": 0, "pose": 0, "label": "outer dead centre"},
                      {"axis": 180, "pose": count / 2, "label": "inner dead centre"}])
    return scene


def hexapod(count=180, legs=6):
    """A platform on legs of universal, prismatic and spherical joints."""
    def ring(radius, spread):
        return [[radius * math.cos(a), radius * math.sin(a), 0.0]
                for k in range(legs)
                for a in [2 * math.pi * (k // 2) / (legs / 2) + (spread if k % 2 else -spread)]]
    feet, heads = ring(0.3, 0.2), ring(0.2, 0.82)
    links = [link("base", {f"foot {k}": p for k, p in enumerate(feet)}, 5),
             link("platform", {**{f"head {k}": p for k, p in enumerate(heads)}}, 3)]
    joints = []
    for k in range(legs):
        lower = len(links)
        links.append(link(f"cylinder {k + 1}", {"foot": IDENTITY, "bore": IDENTITY}, 0.4,
                          [0, 0, 0.1]))
        links.append(link(f"piston {k + 1}", {"rod": IDENTITY, "head": (0, 0, 0)}, 0.3,
                          [0, 0, -0.1]))
        joints += [joint(f"U{k + 1}", "universal", (0, k), (lower, 0), (True, True)),
                   joint(f"P{k + 1}", "prismatic", (lower, 1), (lower + 1, 0), (False,),
                         limits=(0.25, 0.55)),
                   joint(f"S{k + 1}", "spherical", (1, k), (lower + 1, 1), (True,) * 3,
                         cut=k > 0)]

    def at(t):
        tilt = 0.18 * math.sin(t)
        plate = [0.05 * math.cos(t), 0.05 * math.sin(t), 0.36 + 0.03 * math.sin(2 * t),
                 math.cos(tilt / 2), math.sin(tilt / 2) * 0.8, math.sin(tilt / 2) * 0.6, 0]
        poses, values = [IDENTITY, plate], []
        for foot, head in zip(feet, heads):
            tip = turned(plate, head)
            way = [b - a for a, b in zip(foot, tip)]
            poses += [along(foot, way), along(tip, way)]
            values += [0.1, 0.1, math.sqrt(sum(v * v for v in way)), 0, 0, 0]
        return poses, values

    turns = [2 * math.pi * i / count for i in range(count)]
    wrenches = [[[5 * math.cos(t + j), 4 * math.sin(t), 20 + 8 * math.sin(t + j), 0, 0, 0.5]
                 for j in range(len(joints))] for t in turns]
    scene = scene_of("Hexapod", 0.5, [0, 0, -9.81], links, joints, *at(0))
    scene["grasps"] = [{"name": "tool", "link": 1, "point": False,
                        "pose": [0, 0, 0.06, 1, 0, 0, 0]}]
    scene["motion"] = motion_of(
        [2 * i / count for i in range(count)], 2.0,
        {"label": "time", "unit": "s", "values": [2 * i / count for i in range(count)]},
        [at(t)[0] for t in turns], [at(t)[1] for t in turns], wrenches,
        [["certain"] * 6 for _ in joints])
    return scene


def every_joint():
    """One link on the ground by each type of joint, side by side."""
    kinds = {"revolute": (True,), "prismatic": (False,), "cylindrical": (False, True),
             "screw": (True,), "universal": (True, True), "spherical": (True,) * 3,
             "planar": (False, False, True), "fixed": ()}
    links, joints, poses = [link("ground", {})], [], [IDENTITY]
    for k, (kind, rotations) in enumerate(kinds.items()):
        x = 0.12 * (k - 3.5)
        links[0]["anchors"].append({"name": kind, "pose": [x, 0, 0, 1, 0, 0, 0]})
        links.append(link(f"on {kind}", {"foot": (0, 0, 0), "top": (0, 0.05, 0.11)}))
        joints.append(joint(kind, kind, (0, k), (k + 1, 0), rotations))
        poses.append([x, 0, 0, 1, 0, 0, 0])
    coordinates = [0.0] * sum(len(j["freedoms"]) for j in joints)
    scene = scene_of("Every joint", 0.4, [0, 0, -9.81], links, joints, poses, coordinates)
    scene["grasps"] = [{"name": f"top {k}", "link": k, "point": True,
                        "pose": [0, 0.05, 0.11, 1, 0, 0, 0]} for k in range(1, len(links))]
    return scene


def torus_stl(triangles, large=0.05, small=0.02):
    """A torus of about so many triangles as binary STL."""
    rows = int(math.sqrt(triangles / 4))
    columns = triangles // (2 * rows)

    def point(i, j):
        a, b = 2 * math.pi * i / columns, 2 * math.pi * j / rows
        r = large + small * math.cos(b)
        return r * math.cos(a), r * math.sin(a), small * math.sin(b)

    grid = [[point(i % columns, j % rows) for j in range(rows + 1)] for i in range(columns + 1)]
    out = bytearray(80) + struct.pack("<I", 2 * rows * columns)
    for i in range(columns):
        for j in range(rows):
            a, b, c, d = grid[i][j], grid[i + 1][j], grid[i + 1][j + 1], grid[i][j + 1]
            for three in ((a, b, c), (a, c, d)):
                out += struct.pack("<12fH", 0, 0, 0, *three[0], *three[1], *three[2], 0)
    return bytes(out)


def with_mesh(triangles, link=3, large=0.05):
    """The four-bar with a link, the rocker or another, as a mesh."""
    scene = FourBar().scene(90)
    scene["title"] = "Mesh"
    scene["links"][link]["mesh"] = base64.b64encode(torus_stl(triangles, large)).decode()
    return scene


def hostile():
    """Names that try to become markup or script."""
    name = "</script><script>window.stolen = 1</script><img src=x onerror='window.stolen = 2'>"
    scene = FourBar().scene(36, crank_name=name)
    scene["title"] = name
    for item in scene["joints"] + scene["grasps"] + scene["links"][0]["anchors"]:
        item["name"] = name + item["name"]
    for freedom in (f for j in scene["joints"] for f in j["freedoms"]):
        freedom["name"] = name
    scene["motion"]["axis"]["label"] = name
    scene["motion"]["drives"][0]["name"] = name
    scene["motion"]["dead_centres"][0]["label"] = name
    return scene
