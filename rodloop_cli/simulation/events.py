"""What happens between the stored times: the first self-crossing, extrema of the area, coming to rest.

All are located on the dense output of the step they fall into, to round-off of the time; no step is shortened for them.
"""

from dataclasses import dataclass, field
from functools import cache

import numpy as np

from rodloop_cli.march.dense import Shapes
from rodloop_cli.march.state import Step
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.numerics.roots import Point, bracketed_root, root_between
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.clearance import crossing_indicator, least_clearance
from rodloop_cli.physics.crossing import crosses_itself, star_shaped
from rodloop_cli.physics.energies import Quadrature
from rodloop_cli.physics.rod import LENGTH
from rodloop_cli.physics.sampling import Sampler

TIME_PRECISION = 1e-9
"""Of the step in which an event is located."""

PROMINENCE = 0.01
"""Of the whole change of the area: what a swing must be worth. Waves from the junctions ripple the area by less."""

ROUND_OFF = 1e-9
"""A change of the area by less is none."""

WATCHED_POINTS, LOCATED_POINTS = 128, 400
"""Points of the polygons on which a crossing is noticed and located; their sides leave the curve by 3e-4 κ and 3e-5
κ."""


class CrossingWatch:
    """Finds the first time at which the centreline crosses itself.

    A shape without concave parts cannot cross, nor can one that is seen whole from its centre; one that is a distance
    d from crossing cannot cross before some point has moved by d/2. Otherwise the shapes at the stages of a step are
    tested, so that a crossing that comes and goes within a step is seen if it lasts as long as the gap between two
    stages.
    """

    def __init__(self) -> None:
        self._equations: BoxEquations | None = None
        self._watched: Sampler
        self._reference: Array
        self._safe = 0.0

    def first_in(self, step: Step) -> float | None:
        """Time of the first crossing in the step, None if there is none."""
        if step.fields.moment.min() >= 0:
            self._safe = 0.0
            return None
        self._use(step.start.equations)
        suspects = self._suspects(step, 0)
        if not suspects:
            return None
        polygons = self._watched(step.fields.position)
        star = star_shaped(polygons).tolist()
        while suspects:
            stage = suspects.pop(0)
            if star[stage]:
                continue
            if crosses_itself(*polygons[:, stage]):
                before = float(step.nodes[stage - 1]) if stage else 0.0
                return self._locate(step, before, float(step.nodes[stage]))
            self._keep(step, stage, polygons[:, stage])
            suspects = self._suspects(step, stage + 1)
        return None

    def _suspects(self, step: Step, first: int) -> list[int]:
        """The stages from this one on at which some point has moved too far since the shape was found simple."""
        if self._safe <= 0:
            return list(range(first, len(step.nodes)))
        moved = step.fields.position[:, first:] - self._reference[:, None]
        moved *= moved
        too_far = (moved[0] + moved[1]).max(axis=(1, 2), initial=0.0) >= self._safe**2
        return [stage for stage, far in enumerate(too_far.tolist(), first) if far]

    def _keep(self, step: Step, stage: int, polygon: Array) -> None:
        """Remember a simple shape and how far its points can move before it may cross.

        Both strands of a clearance move, and the sides of the polygon lie inside the bends by κ h²/8. Strands that are
        not opposed now may come to be in a bend that closes, whose radius is 1/κ.
        """
        self._reference = step.fields.position[:, stage]
        sharpest = float(np.abs(step.fields.moment[stage] / step.start.equations.mesh.stiffness[:, None]).max())
        clearance = least_clearance(*polygon) - sharpest * (LENGTH / WATCHED_POINTS) ** 2 / 4
        self._safe = max(0.0, min(clearance / 2, 1 / sharpest))

    def _locate(self, step: Step, before: float, after: float) -> float:
        sampler = _sampler(step.start.equations, LOCATED_POINTS)

        @cache
        def clearance(fraction: float) -> float:
            position = Shapes(step, np.array([step.start.time + fraction * step.size])).position
            return crossing_indicator(*sampler(position)[:, 0])

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
            self._watched = _sampler(equations, WATCHED_POINTS)


def _sampler(equations: BoxEquations, points: int) -> Sampler:
    return Sampler(equations.mesh, equations.rule, np.linspace(0.0, LENGTH, points, endpoint=False))


@dataclass
class AreaExtrema:
    """Minima and maxima of the enclosed area: (time, area) each, in order.

    first_area, last_area: at the beginning and the end of the run.
    """

    minima: list[tuple[float, float]] = field(default_factory=list)
    maxima: list[tuple[float, float]] = field(default_factory=list)
    first_area: float = 0.0
    last_area: float = 0.0
    sign: float = 0.0
    _equations: BoxEquations | None = None
    _quadrature: Quadrature | None = None

    def watch(self, step: Step, until: float | None = None) -> None:
        """Look for changes of sign of dA/dt between the stages of the step, those before ``until``."""
        quadrature = self._quadrature_on(step.start.equations)
        rates = quadrature.area_rate(step.fields.velocity[..., :-1], step.fields.tangent)
        before: Point | None = None
        for after in zip(step.nodes.tolist(), rates.tolist(), strict=True):
            sign = float((after[1] > 0) - (after[1] < 0))
            if self.sign * sign < 0:
                self._locate(step, before, after, np.inf if until is None else until)
            self.sign = sign or self.sign
            before = after

    def _quadrature_on(self, equations: BoxEquations) -> Quadrature:
        if self._quadrature is None or equations is not self._equations:
            self._equations, self._quadrature = equations, Quadrature(equations.mesh, equations.rule)
        return self._quadrature

    def _locate(self, step: Step, before: Point | None, after: Point, until: float) -> None:
        """Find the extremum between two stages, given as fraction of the step and dA/dt, or the start (None) and one.

        Stages and dense output differ a little: what the latter puts just beyond a stage is found at that stage.
        """
        quadrature = self._quadrature_on(step.start.equations)

        @cache
        def shape(fraction: float) -> Shapes:
            return Shapes(step, np.array([step.start.time + fraction * step.size]))

        def rate(fraction: float) -> float:
            at = shape(fraction)
            return quadrature.area_rate(at.velocity[..., :-1], at.tangent).item()

        before = before or (0.0, rate(0.0))
        fraction = root_between(rate, before, after, TIME_PRECISION, smooth=True)
        time = step.start.time + fraction * step.size
        if time <= until:
            at = shape(fraction)
            area = quadrature.area(at.position[..., :-1], at.tangent).item()
            (self.minima if self.sign < 0 else self.maxima).append((time, area))

    def prominent_minima(self) -> list[tuple[float, float]]:
        """Those on either side of which the area rises by PROMINENCE of its whole change before it falls below them."""
        points = [(-np.inf, self.first_area), *sorted(self.minima + self.maxima), (np.inf, self.last_area)]
        areas = np.array([area for _, area in points])
        least = max(ROUND_OFF, PROMINENCE * float(np.ptp(areas)))
        known = set(self.minima)
        return [
            point
            for i, point in enumerate(points)
            if point in known and min(_rise(areas[i::-1]), _rise(areas[i:])) >= least
        ]

    @property
    def period(self) -> float | None:
        """Time from the first minimum of the area to the second, None before that."""
        minima = self.prominent_minima()
        return minima[1][0] - minima[0][0] if len(minima) >= 2 else None


def _rise(areas: Array) -> float:
    """How far ``areas`` (k,) rise above the first of them before they fall below it."""
    below = np.flatnonzero(areas < areas[0])
    until = below[0] if below.size else len(areas)
    return float(areas[:until].max() - areas[0])
