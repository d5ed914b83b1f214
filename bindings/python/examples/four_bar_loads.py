"""Bearing loads of the four-bar linkage, turned once at 60 rpm."""

import sys

import vmech

study = vmech.Study.read(sys.argv[1] if len(sys.argv) > 1 else "four-bar-study.yaml")
loads = study.run()
for name, peak in zip(study.mechanism.joints, loads.peaks):
    print(f"{name:14} largest force {peak[0]:8.3f} N along x {peak[1]:8.3f} N along y")
for joint in loads.bearings:
    chosen = " and ".join(bearing.designation for bearing in joint.positions)
    print(f"{joint.joint:14} bearings {chosen} live {joint.life_hours:.0f} h")
