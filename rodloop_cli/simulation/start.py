"""From a case to the loop at t = 0, on a mesh that resolves it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import ceil, sqrt

import numpy as np

from rodloop_cli.case import Case, ModePerturbation
from rodloop_cli.march.loop import Departure
from rodloop_cli.march.radau import started
from rodloop_cli.march.refine import SHARE, unresolved
from rodloop_cli.march.state import State, Step
from rodloop_cli.numerics.gauss import GaussRule, gauss_rule, lagrange_derivative
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import NODAL, Load
from rodloop_cli.physics.rod import Mesh, Rod, Segment, cells_by_length
from rodloop_cli.physics.shapes import Wave, circle, displacement, perturbed, random_waves
from rodloop_cli.statics import as_shape, laid_on, unloaded

STARTING_TIME = 1e-4
"""Length of the backward Euler step that gives the forces at t = 0+, in units of the fastest time of the motion."""

LEAST_SCALE = 1e-3
"""Size of the motion of a loop that is neither disturbed nor pushed out of shape, to which its tolerance refers."""

LEAST_POINTS, POINTS_PER_WAVE = 24, 6
MOST_LARGE = 4
"""Segments up to which cells are large: a cell never spans two, and small ones need few points."""

FEWEST_POINTS, FEW_POINTS, MANY_POINTS = 12, 16, 20
"""In a large cell: the more the tighter the tolerance. A mesh that is graded towards junctions of stiffness never gets
many.

A cell's own equations, with the values at its left end given, have a condition that depends on h (ρ/b)^¼ / √Δt alone.
Its largest value grows almost fourfold from point to point, to 1e12 with 16 and 5e14 with 20, where Newton's correction
is good to a hundredth and stalls at 1e-10. A graded mesh always has a cell that meets it."""

SHORT_WAVES = 64
"""Points round the loop above which the waves of the mode that buckles fastest are short, POINTS_PER_WAVE to each: from
eleven waves on. Not a sharp limit: at the beginning of motions with p = 60 to 320, stiffness ratio 5 and tol = 1e-6,
cells of 16 and of 20 points take the same number of steps to 2 %."""

MOST_START_CELLS = 2048

KINK_ERROR = 0.003
"""Of h² ΔM/b, see `_kinked`; as small as lets perturbed loops of stiffness ratio 5 run to tol = 1e-5."""

ROUND_OFF = 1e-12
"""The smallest uncertainty of the shape that cells can be asked for."""


@dataclass(frozen=True, eq=False)
class Start:
    """The loop just after the load is switched on; ``step`` is the negligible one that gave its forces, ``waves`` are
    those of the perturbation.
    """

    rod: Rod
    load: Load
    waves: tuple[Wave, ...]
    state: State
    step: Step
    departure: Departure


def start(case: Case) -> Start:
    """Build the initial state of a case. Raises ConvergenceError where the equilibrium or its forces cannot be
    found.
    """
    rod, load = rod_of(case), load_of(case)
    waves = waves_of(case)
    rule = gauss_rule(points_per_cell(case, rod, load, waves))
    mesh, unknowns = _resolved(case, rod, load, rule, waves)
    state = State.at_rest(BoxEquations(mesh, rule, load), unknowns)
    state, step = started(state, STARTING_TIME * fastest_time(load, rod))
    amplitude = float(np.abs(displacement(waves, np.linspace(0, 2 * np.pi, 1024))).max())
    # Forces, not accelerations: what is lighter is faster, but gets no further before it swings back.
    push = float(np.abs(mesh.density[:, None] * state.acceleration).max()) * _unit_time(load) ** 2
    scale = max(amplitude or LEAST_SCALE, push)
    return Start(rod, load, waves, state, step, Departure(min(1.0, scale)))


def rod_of(case: Case) -> Rod:
    """The rod of a case."""
    return Rod(tuple(Segment(s.fraction, s.stiffness, s.density) for s in case.segments))


def load_of(case: Case) -> Load:
    """The load of a case."""
    return Load(case.p, case.zeta_perp, case.gamma, case.rotary_inertia)


def waves_of(case: Case) -> tuple[Wave, ...]:
    """The perturbation of a case, its random parts drawn; waves of no height are none."""
    waves: list[Wave] = []
    for item in case.perturbation:
        if isinstance(item, ModePerturbation):
            waves.append(Wave(item.mode, item.amplitude, item.phase))
        elif item.random.amplitude > 0:
            waves.extend(random_waves(item.random.amplitude, item.random.modes, item.random.seed))
    return tuple(wave for wave in waves if wave.amplitude)


def points_per_cell(case: Case, rod: Rod, load: Load, waves: tuple[Wave, ...]) -> int:
    """Gauss points in a cell: the paper's box has one; few large cells need the fewest points in all."""
    if case.scheme == "bdf2":
        return 1
    assert case.tol is not None
    if case.N is not None or len(case.segments) > MOST_LARGE:
        return 6 if case.tol > 3e-5 else 8 if case.tol > 3e-7 else 10
    if case.tol > (1e-3 if rod.has_stiffness_contrast else 3e-4):
        return FEWEST_POINTS
    if case.tol > 1e-5 or _sends_short_waves(rod, load, waves):
        return FEW_POINTS
    return MANY_POINTS


def _sends_short_waves(rod: Rod, load: Load, waves: tuple[Wave, ...]) -> bool:
    """Whether junctions of stiffness send out waves that are short compared with the loop."""
    if not rod.has_stiffness_contrast:
        return False
    return bool(waves) or POINTS_PER_WAVE * max(_waves(s, load) for s in rod.segments) > SHORT_WAVES


def growth_time(load: Load, rod: Rod) -> float:
    """Time scale of the motion of the whole loop under this load."""
    return sqrt(max(s.density for s in rod.segments)) * _unit_time(load)


def fastest_time(load: Load, rod: Rod) -> float:
    """Time scale of the fastest motion that the load starts."""
    lightest = min(1.0, *(s.density for s in rod.segments)) if len(rod.segments) > 1 else 1.0
    stiffest = max(s.stiffness for s in rod.segments)
    return sqrt(lightest / stiffest) * _unit_time(load)


def _unit_time(load: Load) -> float:
    """Time scale of the motion of a rod of unit stiffness and density."""
    return float((1 + abs(load.p)) ** -0.75)


def _resolved(case: Case, rod: Rod, load: Load, rule: GaussRule, waves: tuple[Wave, ...]) -> tuple[Mesh, np.ndarray]:
    """A mesh on which the perturbed equilibrium is resolved to the tolerance, and the shape on it."""
    shape_on = _shapes(rod, rule, waves)
    if case.N is not None:
        mesh = Mesh.on(rod, cells_by_length(rod, case.N))
        return mesh, shape_on(mesh)
    assert case.tol is not None
    moving = [abs(w.amplitude) for w in waves]
    allowed = max(ROUND_OFF, SHARE * case.tol * min(1.0, max(moving, default=1.0)))
    mesh = Mesh.on(rod, tuple(_first_cells(s, load, len(rod.segments), rule.m) for s in rod.segments))
    while True:
        unknowns = shape_on(mesh)
        equations = BoxEquations(mesh, rule, load)
        flagged = np.maximum(unresolved(equations, unknowns), _kinked(equations, unknowns)) > allowed
        if not flagged.any() or mesh.cells + flagged.sum() > MOST_START_CELLS:
            return mesh, unknowns
        mesh = mesh.bisected(flagged)


def _kinked(equations: BoxEquations, unknowns: np.ndarray) -> np.ndarray:
    """(n,): how far the rod moves in a cell, while a jump of the moment ΔM at one of its ends is smoothed: h² ΔM/b.

    A perturbation of a loop with kinks of curvature leaves such jumps on the junctions of stiffness, which the motion
    takes away at once, in bending waves as short as the cells.
    """
    mesh = equations.mesh
    junctions = mesh.stiffness != np.roll(mesh.stiffness, 1)
    if not junctions.any():
        return np.zeros(mesh.cells)
    slopes = unknowns[:, NODAL:] @ _end_slopes(equations.rule.m)
    moment = slopes * (mesh.stiffness / mesh.lengths)[:, None]
    jump = np.abs(moment[:, 0] - np.roll(moment[:, 1], 1)) * junctions
    kinked: np.ndarray = np.maximum(jump, np.roll(jump, -1)) * mesh.lengths**2 / mesh.stiffness
    return KINK_ERROR * kinked


@cache
def _end_slopes(m: int) -> np.ndarray:
    """(m, 2): derivatives at both ends of the unit cell, from values at its Gauss points."""
    return lagrange_derivative(gauss_rule(m).points, np.array([0.0, 1.0])).T


def _first_cells(segment: Segment, load: Load, segments: int, points: int) -> int:
    """As many points to a wave of the mode that buckles fastest as POINTS_PER_WAVE."""
    cells = segment.fraction * max(LEAST_POINTS, POINTS_PER_WAVE * _waves(segment, load)) / points
    return max(1 if segments > 1 else 2, ceil(cells))


def _waves(segment: Segment, load: Load) -> float:
    """Around a loop made of this segment alone, of the mode that buckles fastest."""
    return sqrt((1 + abs(load.p) / segment.stiffness) / 2)


def _shapes(rod: Rod, rule: GaussRule, waves: tuple[Wave, ...]) -> Callable[[Mesh], np.ndarray]:
    """The perturbed equilibrium on any mesh."""
    if not rod.has_stiffness_contrast:
        shape = perturbed(circle(), waves, rod)
        return lambda mesh: laid_on(shape, mesh, rule)

    def on(mesh: Mesh) -> np.ndarray:
        unknowns = unloaded(mesh, rule)
        return laid_on(perturbed(as_shape(mesh, rule, unknowns), waves, rod), mesh, rule) if waves else unknowns

    return on
