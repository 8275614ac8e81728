"""What happens between the stored times: the first self-crossing, extrema of the area, coming to rest.

All are located on the dense output of the step they fall into, to round-off of the time; no step is shortened for them.
"""

from dataclasses import dataclass, field

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.march.dense import shapes_at
from rodloop_cli.march.state import State, Step
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.numerics.roots import bracketed_root
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.clearance import crossing_indicator
from rodloop_cli.physics.closure import Closure
from rodloop_cli.physics.crossing import crosses_itself
from rodloop_cli.physics.energies import Quadrature
from rodloop_cli.physics.rod import LENGTH
from rodloop_cli.physics.sampling import Sampler
from rodloop_cli.statics import relax

TIME_PRECISION = 1e-9
"""Of the step in which an event is located."""

WATCHED_POINTS, LOCATED_POINTS = 128, 400
"""Points of the polygons on which a crossing is noticed and located; their sides leave the curve by 3e-4 κ and 3e-5
κ."""

MOST_POINTS = 800
"""On a mesh with more points than this the clearance is that of the polygon of LOCATED_POINTS: every point is compared
with every other one, which took 1.3 s on 400 cells and no memory is enough for on 4000.
"""


class CrossingWatch:
    """Finds the first time at which the centreline crosses itself.

    A shape without concave parts cannot cross, and one that is a distance d from crossing cannot cross before some
    point has moved by d/2. Otherwise the shapes at the stages of a step are tested, so that a crossing that comes and
    goes within a step is seen if it lasts as long as the gap between two stages.
    """

    def __init__(self) -> None:
        self._equations: BoxEquations | None = None
        self._watched: Sampler
        self._located: Sampler
        self._reference: Array
        self._safe = 0.0

    def first_in(self, step: Step) -> float | None:
        """Time of the first crossing in the step, None if there is none."""
        if (step.fields.moment >= 0).all():
            self._safe = 0.0
            return None
        self._use(step.start.equations)
        before = 0.0
        for stage, node in enumerate(step.nodes):
            if self._may_have_crossed(step, stage):
                if crosses_itself(*self._watched(step.fields.position[:, stage])):
                    return self._locate(step, before, float(node))
                self._keep(step, stage)
            before = float(node)
        return None

    def _may_have_crossed(self, step: Step, stage: int) -> bool:
        """Whether some point has moved too far since the shape was last found simple."""
        return self._safe <= 0 or np.abs(step.fields.position[:, stage] - self._reference).max() >= self._safe

    def _keep(self, step: Step, stage: int) -> None:
        """Remember a simple shape and how far its points can move before it may cross.

        The clearance is that of a polygon through the points of the cells, whose sides lie inside the bends by κ h²/8.
        Strands that are not opposed now may come to be in a bend that closes, whose radius is 1/κ.
        """
        position = self._reference = step.fields.position[:, stage]
        mesh = step.start.equations.mesh
        sharpest = float(np.abs(step.fields.moment[stage] / mesh.stiffness[:, None]).max())
        if position[0].size <= MOST_POINTS:
            polygon, spacing = position.reshape(2, -1), float(mesh.lengths.max()) / position.shape[-1] * 2
        else:
            polygon, spacing = self._located(position), LENGTH / LOCATED_POINTS
        clearance = crossing_indicator(*polygon) - sharpest * spacing**2 / 4
        # Both strands of a clearance move; over √2, as components are compared.
        self._safe = max(0.0, min(clearance / 2, 1 / sharpest)) / np.sqrt(2)

    def _locate(self, step: Step, before: float, after: float) -> float:
        def clearance(fraction: float) -> float:
            position = shapes_at(step, np.array([step.start.time + fraction * step.size])).position
            return crossing_indicator(*self._located(position)[:, 0])

        # The polygons, and the dense output and the stages, differ a little, and so may their verdicts.
        if clearance(before) <= 0:
            before = 0.0
        if clearance(after) > 0:
            after = 1.0
        if clearance(before) <= 0:
            return step.start.time
        if clearance(after) > 0:
            return step.start.time + step.size
        crossed = bracketed_root(lambda f: -clearance(f), before, after, TIME_PRECISION)
        return step.start.time + step.size * crossed

    def _use(self, equations: BoxEquations) -> None:
        if equations is not self._equations:
            self._equations, self._safe = equations, 0.0
            self._watched, self._located = (
                Sampler(equations.mesh, equations.rule, np.linspace(0.0, LENGTH, points, endpoint=False))
                for points in (WATCHED_POINTS, LOCATED_POINTS)
            )


@dataclass
class AreaExtrema:
    """Minima and maxima of the enclosed area: (time, area) each, in order."""

    minima: list[tuple[float, float]] = field(default_factory=list)
    maxima: list[tuple[float, float]] = field(default_factory=list)
    sign: float = 0.0
    _equations: BoxEquations | None = None
    _quadrature: Quadrature | None = None

    def watch(self, step: Step, until: float | None = None) -> None:
        """Look for changes of sign of dA/dt between the stages of the step, those before ``until``."""
        quadrature = self._quadrature_on(step.start.equations)
        rates = quadrature.area_rate(step.fields.velocity[..., :-1], (step.fields.cosine, step.fields.sine))
        before = 0.0
        for node, rate in zip(step.nodes, rates, strict=True):
            sign = float(np.sign(rate))
            if self.sign * sign < 0:
                self._locate(step, quadrature, (before, float(node)), np.inf if until is None else until)
            self.sign = sign or self.sign
            before = float(node)

    def _quadrature_on(self, equations: BoxEquations) -> Quadrature:
        if self._quadrature is None or equations is not self._equations:
            self._equations, self._quadrature = equations, Quadrature(equations.mesh, equations.rule)
        return self._quadrature

    def _locate(self, step: Step, quadrature: Quadrature, between: tuple[float, float], until: float) -> None:
        def at(fraction: float) -> tuple[float, float]:
            shapes = shapes_at(step, np.array([step.start.time + fraction * step.size]))
            area = quadrature.area(shapes.position[..., :-1], shapes.tangent)[0]
            return float(quadrature.area_rate(shapes.velocity[..., :-1], shapes.tangent)[0]), float(area)

        before, after = between
        falling = self.sign < 0
        if at(before)[0] * at(after)[0] > 0:
            return
        fraction = bracketed_root(lambda f: at(f)[0], before, after, TIME_PRECISION)
        time = step.start.time + fraction * step.size
        if time <= until:
            (self.minima if falling else self.maxima).append((time, at(fraction)[1]))

    @property
    def period(self) -> float | None:
        """Time from the first minimum of the area to the second, or twice the time to it if the motion ended before."""
        if len(self.minima) >= 2:
            return self.minima[1][0] - self.minima[0][0]
        return None


class RestWatch:
    """Tells when a damped loop has come to rest at an equilibrium.

    Slowness alone is no proof: a strongly damped loop creeps. Once it is slow, the equilibrium nearest to its shape
    is found by the static solver; at rest means within ``tol`` of it. Asked again only after the loop has slowed down
    tenfold.
    """

    def __init__(self, tol: float) -> None:
        self._tol = tol
        self._slow = tol

    def settled(self, state: State) -> bool:
        """Whether this state is at rest."""
        speed = float(np.abs(state.velocity).max())
        if speed > self._slow:
            return False
        self._slow = speed / 10
        try:
            equilibrium = relax(state.equations, state.unknowns)
        except ConvergenceError:
            return False
        return distance(state, equilibrium) < self._tol


def distance(state: State, unknowns: Array) -> float:
    """Largest distance between two positions of the loop on one mesh, their centres together."""
    position = state.equations.shape(unknowns[None])[1][:, 0]
    closure = Closure(state.equations)
    shift = closure.centre(position) - closure.centre(state.position)
    return float(np.abs(position - shift[:, None, None] - state.position).max())
