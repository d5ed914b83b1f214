"""A hand of Python's turns a crank for two seconds, and hears what it feels of it."""

import math
import sys
from typing import Tuple

import vmech

crank = vmech.Mechanism.read(sys.argv[1] if len(sys.argv) > 1 else "crank.yaml")
forces = []


def hand(time: float) -> Tuple[float, float, float]:
    """Where the handle is [m]: to and fro by 5 mm, from rest."""
    way = 5e-3 * (1 - math.cos(3 * time))
    return (0.0, way, 0.0)


session = vmech.hold(crank, hand, lambda wrench: forces.append(abs(wrench[:3]).max()), seconds=2,
                     real_time=False)
print(f"{session.ticks} ticks, at most {session.peak_force:.2f} N, {session.fault or 'no fault'}")
print(f"what was heard: at most {max(forces):.2f} N along an axis")
