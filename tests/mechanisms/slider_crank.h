#pragma once

#include <string>

namespace vmech {

/// A slider-crank in millimetres and degrees: crank 50 mm, coupler 200 mm, the slider along world
/// x.
inline const std::string kSliderCrank = R"(vmech: "1.0"
name: slider-crank
units: {length: mm, angle: deg}
gravity: [0, -9.81, 0]
ground: frame
links:
  frame:
    anchors:
      main:  {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}
      guide: {origin: [0, 0, 0], z: [1, 0, 0], x: [0, 1, 0]}
  crank:
    mass: 0.4
    center_of_gravity: [25, 0, 0]
    inertia: {about: center_of_gravity, xx: 10, yy: 100, zz: 110}
    anchors:
      main: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}
      pin:  {origin: [50, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}
  coupler:
    mass: 0.9
    center_of_gravity: [100, 0, 0]
    inertia: {xx: 30, yy: 3000, zz: 3000}
    anchors:
      crank:  {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}
      slider: {origin: [200, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}
  slider:
    mass: 1.2
    anchors:
      pin:   {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}
      guide: {origin: [0, 0, 0], z: [1, 0, 0], x: [0, 1, 0]}
joints:
  main:  {type: revolute, connects: [frame/main, crank/main], start: 40, limits: [-720, 720]}
  crank: {type: revolute, connects: [crank/pin, coupler/crank], start: -49, viscous: 0.01}
  wrist: {type: revolute, connects: [coupler/slider, slider/pin], start: 9}
  guide: {type: prismatic, connects: [frame/guide, slider/guide], start: 235,
          spring: {stiffness: 800, rest: 200}, stiffness: [1e8, 1e8, 0, 1e4, 1e4, 1e4]}
grasps:
  handle: {link: coupler, origin: [100, 0, 0], z: [0, 0, 1], x: [1, 0, 0], kind: rigid}
cuts: [wrist]
)";

/// The same in SI units and radians, as JSON.
inline const std::string kSliderCrankInSi = R"({"vmech": "1.0", "name": "slider-crank",
"gravity": [0, -9.81, 0], "ground": "frame",
"links": {
  "frame": {"anchors": {"main": {"origin": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]},
                        "guide": {"origin": [0, 0, 0], "z": [1, 0, 0], "x": [0, 1, 0]}}},
  "crank": {"mass": 0.4, "center_of_gravity": [0.025, 0, 0],
            "inertia": {"about": "center_of_gravity", "xx": 10e-6, "yy": 100e-6, "zz": 110e-6},
            "anchors": {"main": {"origin": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]},
                        "pin": {"origin": [0.05, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]}}},
  "coupler": {"mass": 0.9, "center_of_gravity": [0.1, 0, 0],
              "inertia": {"xx": 30e-6, "yy": 3000e-6, "zz": 3000e-6},
              "anchors": {"crank": {"origin": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]},
                          "slider": {"origin": [0.2, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]}}},
  "slider": {"mass": 1.2,
             "anchors": {"pin": {"origin": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]},
                         "guide": {"origin": [0, 0, 0], "z": [1, 0, 0], "x": [0, 1, 0]}}}},
"joints": {
  "main": {"type": "revolute", "connects": ["frame/main", "crank/main"],
           "start": 0.6981317007977318, "limits": [-12.566370614359172, 12.566370614359172]},
  "crank": {"type": "revolute", "connects": ["crank/pin", "coupler/crank"],
            "start": -0.8552113334772214, "viscous": 0.01},
  "wrist": {"type": "revolute", "connects": ["coupler/slider", "slider/pin"],
            "start": 0.15707963267948966},
  "guide": {"type": "prismatic", "connects": ["frame/guide", "slider/guide"], "start": 0.235,
            "spring": {"stiffness": 800, "rest": 0.2},
            "stiffness": [1e8, 1e8, 0, 1e4, 1e4, 1e4]}},
"grasps": {"handle": {"link": "coupler", "origin": [0.1, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0],
                      "kind": "rigid"}},
"cuts": ["wrist"]})";

}  // namespace vmech
