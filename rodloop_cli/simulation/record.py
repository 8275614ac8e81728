"""From steps to rows of the result file."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.march.dense import Shapes
from rodloop_cli.march.state import Step
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.crossing import crosses_itself
from rodloop_cli.physics.energies import Quadrature
from rodloop_cli.physics.equations import Load
from rodloop_cli.physics.rod import LENGTH, Rod
from rodloop_cli.physics.sampling import Sampler
from rodloop_cli.simulation.account import EnergyAccount

Row = dict[str, float | Array]

ROUND_OFF = 1e-12
"""Of the time: the sum of the steps must not miss a stored time by this much."""

TURNS = np.array([0.0] * 7 + [LENGTH])[:, None, None]
"""What the sampled quantities gain round the loop: θ alone, the last one, does not come back to where it was."""


def output_points(count: int) -> Array:
    """(S,): uniform arclengths in [0, 2π)."""
    return np.linspace(0.0, LENGTH, count, endpoint=False)


class Recorder:
    """Rows at the stored times; the lobes are for whoever follows them to add."""

    def __init__(self, rod: Rod, load: Load, points: int, times: tuple[float, ...]) -> None:
        self.s = output_points(points)
        self.segment: NDArray[np.int_] = rod.segment_at(self.s) + 1
        self.account = EnergyAccount(load)
        self._times = times
        self._next = 0
        self.begun = False
        self._equations: BoxEquations | None = None
        self._sampler: Sampler
        self._quadrature: Quadrature

    def start(self, step: Step) -> Iterator[Row]:
        """The row at t = 0 if it is asked for, from the negligible step that gave the forces there."""
        self.begun = True
        self._use(step.start.equations)
        rows = list(self._rows(step, Shapes(step, np.array([step.start.time])), size=0.0, iterations=0))
        if self._times[0] <= 0:
            self._next = 1
            yield from rows

    def during(self, step: Step, crossed: float | None = None, stopped: float | None = None) -> Iterator[Row]:
        """The rows that are due in a step; if the run ``stopped`` inside it, those before and one there.

        ``crossed``: when the loop first crossed itself; later rows are tested, one by one, for it may come apart again.
        """
        self._use(step.start.equations)
        end = step.start.time + step.size
        if stopped is None:
            due = bisect_right(self._times, end * (1 + ROUND_OFF), self._next)
            times = self._times[self._next : due]
        else:
            due = bisect_left(self._times, stopped * (1 - ROUND_OFF), self._next)
            times = (*self._times[self._next : due], stopped)
        self._next = due
        if times:
            for row in self._rows(step, Shapes(step, np.array(times)), step.size, step.newton_iterations):
                row["crossing"] = self._crossing(row, crossed)
                yield row
        self.account.close(step, self._quadrature)

    def memory(self) -> Array:
        """What a continued run needs to know."""
        return np.array([float(self._next), *self.account.memory()])

    def restore(self, memory: Array) -> None:
        """Go on where the recorder with this memory was."""
        self.begun = True
        self._next = int(memory[0])
        self.account.restore(memory[1:])

    @staticmethod
    def _crossing(row: Row, crossed: float | None) -> int:
        """1 at the first contact itself, which the polygon of the output points may be too coarse to show."""
        if crossed is None or row["t"] < crossed:
            return 0
        return int(row["t"] == crossed or crosses_itself(np.asarray(row["x"]), np.asarray(row["y"])))

    def _use(self, equations: BoxEquations) -> None:
        if equations is not self._equations:
            self._equations = equations
            self._sampler = Sampler(equations.mesh, equations.rule, self.s)
            self._quadrature = Quadrature(equations.mesh, equations.rule)

    def _rows(self, step: Step, shapes: Shapes, size: float, iterations: int) -> Iterator[Row]:
        profiles = self._profiles(shapes)
        energies = self.account.at(step, shapes, self._quadrature)
        for i, (time, row) in enumerate(zip(shapes.times.tolist(), energies, strict=True)):
            curves = {name: values[i] for name, values in profiles.items()}
            yield curves | row | {"t": time, "step_size": size, "newton_iterations": iterations, "crossing": 0}

    def _profiles(self, shapes: Shapes) -> dict[str, Array]:
        """(k, S) of every profile."""
        sample = self._sampler
        quantities = (shapes.position, shapes.velocity, shapes.force, shapes.moment[None], shapes.theta[None])
        x, y, u, v, fx, fy, moment, theta = sample(np.concatenate(quantities), TURNS)
        cosine, sine = np.cos(theta), np.sin(theta)
        return {
            "x": x,
            "y": y,
            "theta": theta,
            "curvature": moment / sample.stiffness,
            "moment": moment,
            "axial_force": fx * cosine + fy * sine,
            "shear_force": fy * cosine - fx * sine,
            "velocity_x": u,
            "velocity_y": v,
        }
