"""Mechanisms: the loads of their joints, poses, simulations, and what a hand feels of them.

    study = vmech.Study.read("four-bar-study.yaml")
    loads = study.run()
    loads.wrenches[:, study.mechanism.joints.index("main"), :3]     # N, pose by pose

SI units and radians throughout. World axes are the drawing axes of the ground link. A wrench is
[fx fy fz mx my mz], [N] and [N m]; that of a joint is what its first link exerts on its second,
about the second anchor's origin, in the axes of the first anchor. Freedoms are those of all joints
in their order; a spherical joint has three, its rotation vector.

Arrays are views of the library's own numbers, read-only; they keep alive what they are part of.
Long calls let other threads of Python run, and end at Ctrl-C. What is wrong with a file raises
FileErrors, with an argument ValueError, what has no solution NoSolution.
"""

from __future__ import annotations

import os
from typing import (TYPE_CHECKING, Any, Callable, Mapping, NamedTuple, Optional, Sequence, Tuple,
                    Union)

from . import _vmech
from ._vmech import FileErrors, NoSolution
from ._vmech import version as __version__

if TYPE_CHECKING:
    import numpy
    import numpy.typing
    import pandas

    Array = numpy.typing.NDArray[numpy.float64]
    ArrayLike = numpy.typing.ArrayLike
    Path = Union[str, os.PathLike[str]]

__all__ = ["Bearing", "Bearings", "Computed", "Drive", "Event", "FileErrors", "Load", "Mechanism",
           "NoSolution", "Parameter", "Row", "Session", "Study", "Tick", "compare", "hold"]

COMPONENTS = ("fx", "fy", "fz", "mx", "my", "mz")
VERDICTS = ("certain", "not determined by statics", "singular at this pose")


def _index(names: Sequence[str], name: Union[str, int], what: str) -> int:
    """The place of a name among others; numbers are taken as they are."""
    if isinstance(name, int):
        return name
    if name in names:
        return names.index(name)
    raise ValueError(f"there is no {what} '{name}'; there are {', '.join(names) or 'none'}")


class Parameter(NamedTuple):
    """What a parameter of a file is, after all settings."""

    value: float  #: in the unit
    unit: str  #: "mm", or that of the setting; empty of a number


#: Values of parameters by name: numbers, which count in the units of the file, or texts, "60 mm".
Settings = Mapping[str, Union[float, str]]


def _words(settings: Optional[Settings]) -> list[str]:
    """Settings as the library reads them."""
    return [f"{name}={value if isinstance(value, str) else repr(float(value))}"
            for name, value in (settings or {}).items()]


def _stated(parameters: Sequence[tuple[str, float, str]]) -> dict[str, Parameter]:
    return {name: Parameter(value, unit) for name, value, unit in parameters}


class Mechanism:
    """What a mechanism is: links that meet in joints. Immutable.

    A program that builds one writes it as a text (docs/file-format.md) and gives that to `parse`.
    """

    def __init__(self, raw: _vmech.Mechanism,
                 parameters: Sequence[tuple[str, float, str]] = ()) -> None:
        self._raw = raw
        #: Of the file, by name.
        self.parameters: dict[str, Parameter] = _stated(parameters)
        self.name: str = raw.name
        self.links: list[str] = raw.links()
        self.joints: list[str] = raw.joints()
        self.joint_types: list[str] = raw.joint_types()
        self.grasps: list[str] = raw.grasps()
        #: "pin", or "ball.rx" of a joint with several.
        self.freedoms: list[str] = raw.freedoms()

    @staticmethod
    def read(path: Path, parameters: Optional[Settings] = None) -> Mechanism:
        """From a file, with values of its parameters that go before its own.

        Raises FileErrors with everything that is wrong with it or with `parameters`.
        """
        return Mechanism(*_vmech.Mechanism.read(os.fspath(path), _words(parameters)))

    @staticmethod
    def parse(text: str, name: str = "text", parameters: Optional[Settings] = None) -> Mechanism:
        """The same from a text; `name` stands for the file in messages."""
        return Mechanism(*_vmech.Mechanism.parse(text, name, _words(parameters)))

    def text(self) -> str:
        """As a file, in metres and radians: read back, it is the same to the last bit."""
        return self._raw.write()

    @property
    def start(self) -> list[float]:
        """[freedoms] where the assembly starts."""
        return self._raw.start()

    @property
    def masses(self) -> list[tuple[float, list[float]]]:
        """Per link its mass [kg] and its centre of gravity in its drawing frame [m]."""
        return self._raw.masses()

    @property
    def gravity(self) -> list[float]:
        """World axes [m/s^2]."""
        return self._raw.gravity

    def ik(self, position: ArrayLike, rotation: Optional[ArrayLike] = None, *,
           grasp: Union[str, int] = 0, stiffness: Optional[ArrayLike] = None, limits: bool = True,
           solver: str = "nullspace") -> Computed:
        """The pose nearest to a hand at `position` (3,) [m] with `rotation` (3, 3), loops closed.

        Of the result `positions` and `hand_errors` tell the pose and what it is off; there is one
        pose. `stiffness` (6,) weighs positions [N/m] against rotations [N m/rad]. Raises NoSolution
        where loops do not close.
        """
        weights = (0.0,) * 6 if stiffness is None else stiffness
        index = _index(self.grasps, grasp, "grasp")
        return Computed(self._raw.ik(index, position, rotation, weights, limits, solver), self)

    def assembly_modes(self, *, held: Sequence[Union[str, int]] = (),
                       grasp: Optional[Union[str, int]] = None,
                       position: Optional[ArrayLike] = None,
                       rotation: Optional[ArrayLike] = None, limits: bool = True,
                       max_starts: int = 20000, patience: int = 2000, seed: int = 1) -> Computed:
        """All closed poses with the freedoms `held` as they start, or a grasp at a pose, or both.

        The result has a pose for each. What is not certain about their number is among its
        `warnings`.
        """
        freedoms = [_index(self.freedoms, name, "freedom") for name in held]
        if (grasp is None) != (position is None):
            raise ValueError("grasp and position go together: give both or none")
        index = -1 if grasp is None else _index(self.grasps, grasp, "grasp")
        place = (0.0,) * 3 if position is None else position
        return Computed(self._raw.modes(freedoms, index, place, rotation, limits, max_starts,
                                        patience, seed), self)

    def svg(self) -> str:
        """The drawing that `vmech check --draw` makes, with its loops closed if they close."""
        return self._raw.svg()

    def _repr_svg_(self) -> str:
        return self.svg()

    def _repr_html_(self) -> str:
        return f'<div class="vmech-mechanism">{self.svg()}</div>'

    def __repr__(self) -> str:
        return (f"<vmech.Mechanism '{self.name}': {len(self.links)} links, "
                f"{len(self.joints)} joints>")


class Drive(NamedTuple):
    """A motor: a freedom that moves as prescribed, whatever force that takes.

    By start + speed t + acceleration t^2 / 2, or by the cubic spline through `values` at `times`.
    """

    joint: Union[str, int]
    start: float = 0.0  #: [m] or [rad]
    speed: float = 0.0
    acceleration: float = 0.0
    freedom: int = 0  #: of the joint's
    times: Sequence[float] = ()  #: [s], increasing
    values: Sequence[float] = ()


class Load(NamedTuple):
    """A constant wrench (6,) on a link about a point (3,) of it, in its drawing frame [m]."""

    link: Union[str, int]
    point: ArrayLike
    wrench: ArrayLike
    in_link_axes: bool = False


class Study:
    """What is to be computed: a mechanism, its motion, and what acts on it."""

    def __init__(self, mechanism: Mechanism, drives: Sequence[Drive] = (),
                 times: Sequence[float] = (0.0,), *, cycle: float = 0.0,
                 loads: Sequence[Load] = ()) -> None:
        """A study in memory. `times` [s] of the poses, increasing; the motion repeats after `cycle`
        [s] if that is not 0."""
        given = [(_index(mechanism.joints, d.joint, "joint"), d.freedom, d.start, d.speed,
                  d.acceleration, list(d.times), list(d.values)) for d in drives]
        wrenches = [(_index(mechanism.links, load.link, "link"), load.point, load.wrench,
                     load.in_link_axes) for load in loads]
        self._raw = _vmech.Study.of(mechanism._raw, given, list(times), cycle, wrenches)
        self.mechanism = mechanism

    @staticmethod
    def read(path: Path, parameters: Optional[Settings] = None) -> Study:
        """From a file (docs/study-format.md) and those that it names. Raises FileErrors.

        `parameters` of the mechanism or the study go before those of the files.
        """
        study = Study.__new__(Study)
        study._raw = _vmech.Study.read(os.fspath(path), _words(parameters))
        study.mechanism = Mechanism(study._raw.mechanism(), study._raw.parameters())
        return study

    @property
    def parameters(self) -> dict[str, Parameter]:
        """Of the mechanism, then of the study, by name."""
        return _stated(self._raw.parameters())

    @property
    def name(self) -> str:
        return self._raw.name

    @property
    def simulates(self) -> bool:
        """Is the motion to be found (docs/simulate.md), rather than given?"""
        return self._raw.simulates

    @property
    def drives(self) -> list[tuple[str, int]]:
        """Joint and freedom of every drive."""
        return [(self.mechanism.joints[joint], freedom) for joint, freedom in self._raw.drives()]

    def run(self, threads: int = 1, progress: Optional[Callable[[int], bool]] = None) -> Computed:
        """The loads of every pose, or the simulation, and the bearings that the study asks for.

        `progress` hears how many poses are done, and stops the run by returning False. Raises
        ValueError for a study that contradicts itself, NoSolution with pose and time where the
        motion cannot be followed or was stopped.
        """
        return Computed(self._raw.run(threads, progress), self.mechanism)

    def __repr__(self) -> str:
        return f"<vmech.Study '{self.name}' of '{self.mechanism.name}'>"


class Bearing(NamedTuple):
    """The bearing of one position: chosen, or what came closest."""

    designation: str
    life_hours: float  #: at the required reliability [h]
    static_safety: float  #: C0 / P0


class Bearings(NamedTuple):
    """The bearings of one joint."""

    joint: str
    met: bool  #: every position has one, and they live as long as is asked
    certain: bool  #: statics determines what loads them
    life_hours: float  #: of all together [h]
    positions: list[Bearing]
    report: str  #: a line


class Event(NamedTuple):
    """What happened at once in a simulation."""

    time: float  #: [s]
    kind: str
    joint: str
    freedom: int
    value: float
    rate: float


class Computed:
    """What came of a study, of `ik` or of `assembly_modes`: arrays with the pose as first index.

    An array that a computation has not is None, such as the wrenches of `ik`.
    """

    def __init__(self, raw: _vmech.Computed, mechanism: Mechanism) -> None:
        self._raw = raw
        self.mechanism = mechanism

    def __len__(self) -> int:
        """Poses."""
        return self._raw.poses()

    def array(self, name: str) -> Optional[Array]:
        """An array by the name that it has here; None if there is none."""
        return self._raw.array(name)

    def _required(self, name: str) -> Array:
        array = self._raw.array(name)
        if array is None:
            raise AttributeError(f"this computation has no {name}; array('{name}') is None then")
        return array

    @property
    def times(self) -> Array:
        """(poses,) [s]"""
        return self._required("times")

    @property
    def wrenches(self) -> Array:
        """(poses, joints, 6) [N], [N m]"""
        return self._required("wrenches")

    @property
    def positions(self) -> Array:
        """(poses, freedoms) coordinates [m] or [rad]"""
        return self._required("positions")

    @property
    def rates(self) -> Array:
        """(poses, freedoms); of a spherical joint its angular velocity"""
        return self._required("rates")

    @property
    def accelerations(self) -> Array:
        """(poses, freedoms)"""
        return self._required("accelerations")

    @property
    def drive_motions(self) -> Array:
        """(poses, drives, 3) position, velocity, acceleration"""
        return self._required("drive_motions")

    @property
    def drive_forces(self) -> Array:
        """(poses, drives) [N] or [N m]"""
        return self._required("drive_forces")

    @property
    def powers(self) -> Array:
        """(poses,) of the drives and the hand [W]"""
        return self._required("powers")

    @property
    def power_errors(self) -> Array:
        """(poses,) power in, less energy gained and lost, relative"""
        return self._required("power_errors")

    @property
    def closures(self) -> Array:
        """(poses,) loop error that is left, dimensionless"""
        return self._required("closures")

    @property
    def link_positions(self) -> Array:
        """(poses, links, 3) of the links' drawing frames in the world [m]"""
        return self._required("link_positions")

    @property
    def link_rotations(self) -> Array:
        """(poses, links, 3, 3) their axes in the world, as columns"""
        return self._required("link_rotations")

    @property
    def link_twists(self) -> Array:
        """(poses, links, 6) velocity [m/s] and angular velocity [rad/s], world axes"""
        return self._required("link_twists")

    @property
    def hand_wrenches(self) -> Array:
        """(poses, 6) of the hand on the mechanism, about the grasp, world axes"""
        return self._required("hand_wrenches")

    @property
    def hand_errors(self) -> Array:
        """(poses, 6) from the grasp to the hand [m], [rad], world axes"""
        return self._required("hand_errors")

    @property
    def energies(self) -> Array:
        """(poses, 6) kinetic, weight, springs, supplied, dissipated, error [J]"""
        return self._required("energies")

    @property
    def motor_forces(self) -> Array:
        """(poses, motors) [N] or [N m]"""
        return self._required("motor_forces")

    @property
    def peaks(self) -> Array:
        """(joints, 6) the largest size of every component"""
        return self._required("peaks")

    @property
    def certainty(self) -> list[list[str]]:
        """[joints][6] what statics says of every component: one of VERDICTS."""
        return [[VERDICTS[code] for code in joint] for joint in self._raw.certainty()]

    @property
    def certain(self) -> numpy.typing.NDArray[numpy.bool_]:
        """(joints, 6) does statics determine it?"""
        import numpy
        return numpy.array([[code == 0 for code in joint] for joint in self._raw.certainty()],
                           dtype=bool)

    def wrench(self, joint: Union[str, int]) -> Array:
        """(poses, 6) of one joint, a view."""
        return self.wrenches[:, _index(self.mechanism.joints, joint, "joint")]

    def position(self, freedom: Union[str, int]) -> Array:
        """(poses,) of one freedom, a view."""
        return self.positions[:, _index(self.mechanism.freedoms, freedom, "freedom")]

    @property
    def bearings(self) -> list[Bearings]:
        """Those that the study asks for."""
        return [Bearings(self.mechanism.joints[joint], met, certain, hours,
                         [Bearing(*position) for position in positions], report)
                for joint, met, certain, hours, positions, report in self._raw.bearings()]

    @property
    def status(self) -> str:
        """Of a simulation: "finished", "reached", "interrupted" or "failed"; else ""."""
        simulation = self._raw.simulation()
        return "" if simulation is None else simulation[0]

    @property
    def message(self) -> str:
        """Why a simulation stopped."""
        simulation = self._raw.simulation()
        return "" if simulation is None else simulation[1]

    @property
    def events(self) -> list[Event]:
        """Of a simulation: rebounds, sticking and slipping, coordinates looked out for."""
        simulation = self._raw.simulation()
        return [] if simulation is None else [
            Event(time, kind, self.mechanism.joints[joint] if joint >= 0 else "", freedom, value,
                  rate)
            for time, kind, joint, freedom, value, rate in simulation[2]]

    @property
    def warnings(self) -> list[str]:
        """What a user should know, a sentence each."""
        return self._raw.warnings

    def wrench_frame(self) -> pandas.DataFrame:
        """The joints' wrenches as a pandas.DataFrame: a row for each time, columns (joint,
        component). Needs pandas."""
        import pandas
        columns = pandas.MultiIndex.from_product([self.mechanism.joints, COMPONENTS],
                                                 names=["joint", "component"])
        return pandas.DataFrame(self.wrenches.reshape(len(self), -1), columns=columns,
                                index=pandas.Index(self.times, name="time"))

    def position_frame(self) -> pandas.DataFrame:
        """The freedoms' positions likewise; poses are counted where they have no time."""
        import pandas
        times = self.array("times")
        index = pandas.RangeIndex(len(self), name="pose") if times is None else (
            pandas.Index(times, name="time"))
        return pandas.DataFrame(self.positions, columns=self.mechanism.freedoms, index=index)

    def __repr__(self) -> str:
        return f"<vmech.Computed: {len(self)} poses of '{self.mechanism.name}'>"


class Row(NamedTuple):
    """One problem of a comparison in the hands of one solver (docs/compare.md)."""

    mechanism: str
    targets: str
    problem: int  #: of these targets, from 0
    solver: str
    verdict: str
    branch: str
    iterations: int
    seconds: float
    e1_position: float  #: from the grasp to the hand [m]
    e1_rotation: float  #: [rad]
    e2: float  #: largest loop error, dimensionless
    message: str


def compare(suite: Path, solvers: Sequence[str] = (),
            progress: Optional[Callable[[int], bool]] = None) -> list[Row]:
    """Every problem of a suite (docs/suite-format.md) by every solver, or by those named.

    In this process, one after the other; `vmech compare` does it in several, and survives a solver
    that takes its process down. `progress` hears how many problems are done.
    """
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        rows = _vmech.compare(os.fspath(suite), list(solvers), folder, progress)
    return [Row(*row) for row in rows]


class Tick:
    """A mechanism in a hand, a period at a time: it moves by its own dynamics, and the hand holds
    its grasp by a spring and a damper.

    `period` [s]; `stiffness` (6,) [N/m], [N m/rad]; `damping` (6,) [N s/m], [N m s/rad]. The spring
    slips beyond `max_force` [N] and `max_moment` [N m]. `scale`: force at the hand over force at
    the mechanism. It starts assembled, at rest.
    """

    def __init__(self, mechanism: Mechanism, grasp: Union[str, int] = 0, *, period: float = 1e-3,
                 stiffness: ArrayLike, damping: ArrayLike, max_force: float = float("inf"),
                 max_moment: float = float("inf"), scale: float = 1.0) -> None:
        index = _index(mechanism.grasps, grasp, "grasp")
        self._raw = _vmech.Tick(mechanism._raw, index, period, stiffness, damping, max_force,
                                max_moment, scale)
        #: step(position (3,), rotation (3, 3) or None) with the hand in the world [m]: what it is
        #: to feel (6,) [N], [N m], about its origin, world axes. Raises NoSolution where there is
        #: no sound wrench.
        self.step: Callable[[ArrayLike, Optional[ArrayLike]], Array] = self._raw.step

    @property
    def grasp(self) -> Tuple[Array, Array]:
        """Position (3,) and rotation (3, 3) of the grasp frame now, in the world."""
        return self._raw.grasp()

    @property
    def wrenches(self) -> Array:
        """(joints, 6) at the last step."""
        return self._raw.wrenches()


class Session(NamedTuple):
    """What came of `hold`."""

    report: str  #: a page
    ticks: int
    skipped: int  #: slots that passed while Python was late
    peak_force: float  #: sent [N]
    fault: str  #: why the force was switched off; "" if it was not
    times: Array  #: (ticks,) [s]
    positions: Array  #: (ticks, 3) of the hand in the world [m]
    wrenches: Array  #: (ticks, 6) sent to the device, its axes


Hand = Callable[[float], Any]


def hold(mechanism: Mechanism, hand: Hand, felt: Optional[Callable[[Array], Any]] = None, *,
         grasp: Union[str, int] = 0, seconds: float, period: float = 1e-3, mass: float = 0.2,
         inertia: float = 1e-3, damping: float = 1.0, angular_damping: float = 1e-3,
         resolution: float = 1e-5, angular_resolution: float = 1e-4, peak_force: float = 10.0,
         peak_moment: float = 1.0, coupling: str = "virtual", real_time: bool = True) -> Session:
    """Holds a mechanism by a device of Python's, through the loop and the safety filter of
    `vmech haptic`.

    `hand(t)` gives the handle's position (3,) [m], or (position, rotation (3, 3)), in axes along
    the world's; wherever it is at first, there it takes hold of the grasp. `felt(wrench)` gets what
    the device is to exert (6,), zero at the end. Both are called in every period: soft real time,
    as Python lets it (`skipped`); with `real_time` False time passes as fast as they compute. What
    they raise ends the session and is raised here.

    The gains follow from what the handle is: `mass` [kg], `inertia` [kg m^2], `damping` [N s/m],
    `resolution` [m], `peak_force` [N], and the same about its axes. `coupling` is "virtual" or
    "paper" (docs/haptic.md).
    """
    if coupling not in ("virtual", "paper"):
        raise ValueError(f"coupling: 'virtual' or 'paper' is meant, not '{coupling}'")
    unlimited = float("inf")
    linear = (mass, damping, 0.0, resolution, peak_force, unlimited)
    angular = (inertia, angular_damping, 0.0, angular_resolution, peak_moment, unlimited)
    return Session(*_vmech.hold(mechanism._raw, _index(mechanism.grasps, grasp, "grasp"), hand,
                                felt, seconds, period, linear, angular, coupling == "paper",
                                real_time))
