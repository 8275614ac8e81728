"""What passes between time steps: the state of the loop, and one accepted step."""

from dataclasses import dataclass, replace

import numpy as np

from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.closure import Closure
from rodloop_cli.physics.equations import Fields


@dataclass(frozen=True, eq=False)
class State:
    """The loop at one time on one mesh.

    unknowns, rates: (n, 6 + m) as in `physics.equations`, and their time derivatives;
    position, velocity, acceleration, force: (2, n, m + 1) at the Gauss points and the right end of each cell.
    """

    time: float
    equations: BoxEquations
    unknowns: Array
    rates: Array
    position: Array
    velocity: Array
    acceleration: Array
    force: Array

    @classmethod
    def at_rest(cls, equations: BoxEquations, unknowns: Array, time: float = 0.0) -> "State":
        """Zero velocity; acceleration and forces are not known yet."""
        fields = equations.fields(unknowns[None], None)
        still = np.zeros_like(fields.position[:, 0])
        return cls(
            time, equations, unknowns, np.zeros_like(unknowns), fields.position[:, 0], still, still, fields.force[:, 0]
        )

    def closed(self) -> "State":
        """The same with positions and velocities integrated anew from the angles and their rates.

        Newton's iteration leaves gaps between the cells, smaller than its target ε. The next step closes them, with
        forces of ε/Δt²: a step that failed would fail the more the shorter it is made.
        """
        unknowns, rates, closure = self.unknowns.copy(), self.rates.copy(), Closure(self.equations)
        position = closure.position(unknowns, closure.centre(self.position))
        velocity = closure.velocity(unknowns, rates, closure.centre(self.velocity))
        return replace(self, unknowns=unknowns, rates=rates, position=position, velocity=velocity)


@dataclass(frozen=True, eq=False)
class Step:
    """One accepted step: the start, the stages, the end.

    nodes: (s,) stage times in (0, 1], the last 1;  unknowns, rates: (s, n, 6 + m);  fields at the stages;
    error: estimated position error over its allowance (0 where the scheme has no estimate);
    moment_at_start: (n, m + 1) where moment and force there are as good as at the stages (BDF2 after its first step).
    """

    start: State
    size: float
    nodes: Array
    unknowns: Array
    rates: Array
    fields: Fields
    newton_iterations: int
    error: float
    moment_at_start: Array | None = None

    @property
    def end(self) -> State:
        """The state at the last stage."""
        fields = self.fields
        return State(
            self.start.time + self.size,
            self.start.equations,
            self.unknowns[-1],
            self.rates[-1],
            fields.position[:, -1],
            fields.velocity[:, -1],
            fields.acceleration[:, -1],
            fields.force[:, -1],
        )
