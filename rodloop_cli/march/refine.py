"""Cells are halved where the shape is no longer resolved.

The angles at the Gauss points of a cell are expanded in Legendre polynomials; the size of the last coefficients,
times the cell's length, is how far the rod's position inside the cell is uncertain. The nodes are far more accurate
(order 2m).
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.march.state import State, Step
from rodloop_cli.numerics.gauss import Array, lagrange_matrix
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.closure import Closure, left_ends
from rodloop_cli.physics.equations import FORCE, NODAL, THETA

POSITION_ERROR = 0.6
"""Position error inside a cell over (last Legendre coefficients of its angles) (its length) / (2 m + 1).

∫P_m grows to 2/(2 m + 1) of its length; the coefficients that are missing are smaller than the last. Measured, error
of a whole run over the largest estimate in it, m = 6 … 20: 0.01 to 0.9 with stiffness contrast, with drag and at
p = 64; 0.05 to 10 for the homogeneous loop at p = 3.8, which amplifies its past."""

SPREADING_ERROR = 0.06
"""Position error over δv w √T (ρ/b)^¼, for a velocity that is wrong by δv along w: as a bending wave it has spread over
√T (b/ρ)^¼ after a time T, and moved the rod by its momentum over that. Cells that are too long for the waves that the
load sends out from the junctions show in velocities long before they do in positions. Measured at T = growth time on
loops of stiffness contrast up to 10: 0.1 to 0.5 in such runs, 3 to 16 tol wrong; with 0.06 none is left."""

ROUND_OFF = 1e-12
"""Of positions: no step can be asked for less, and no velocity is known better than that over the step."""

SHARE = 0.5
"""Of the tolerance, for the error of space."""


@dataclass(frozen=True)
class Refiner:
    """Decides on refinement; ``most_cells`` bounds the mesh, ``fixed`` leaves it alone.

    horizon: the time in which a wrong velocity becomes a wrong position; 0 where no junction of stiffness sends waves.
    """

    most_cells: int = 4096
    fixed: bool = False
    horizon: float = 0.0

    def refined(self, step: Step, allowed: float) -> "Finer | None":
        """The finer mesh that this step asks for, if any."""
        if self.fixed:
            return None
        equations = step.start.equations
        shape, motion = unresolved(equations, step.unknowns[-1]), sqrt(self.horizon) * unresolved_motion(step)
        flagged = np.maximum(shape, motion) > SHARE * allowed
        if not flagged.any() or equations.mesh.cells + flagged.sum() > self.most_cells:
            return None
        return Finer(equations, flagged)


def unresolved(equations: BoxEquations, unknowns: Array) -> Array:
    """(n,): estimated error of the position inside each cell."""
    coefficients = unknowns[:, NODAL:] @ equations.rule.legendre[:, -2:]
    tail: Array = np.abs(coefficients).max(axis=1) * equations.mesh.lengths
    return POSITION_ERROR / (2 * equations.rule.m + 1) * tail


def unresolved_motion(step: Step) -> Array:
    """(n,): the same for the velocity, and what it leads to in a unit of time, see SPREADING_ERROR.

    Not where cells resolve waves that the step damps, a wave spreads over √Δt (b/ρ)^¼ in it, nor where it is round-off.
    """
    equations = step.start.equations
    mesh = equations.mesh
    width, spread = mesh.lengths / equations.rule.m, (mesh.stiffness / mesh.density) ** 0.25
    velocity = unresolved(equations, step.rates[-1])
    negligible = (width < spread * sqrt(step.size)) | (velocity < ROUND_OFF / step.size)
    return np.where(negligible, 0.0, SPREADING_ERROR * width / spread * velocity)


class Finer:
    """A mesh with the flagged cells halved, and the transfer of a state to it."""

    def __init__(self, equations: BoxEquations, flagged: NDArray[np.bool_]) -> None:
        self.equations = BoxEquations(equations.mesh.bisected(flagged), equations.rule, equations.load)
        pieces = np.where(flagged, 2, 1)
        self._parent = np.repeat(np.arange(len(flagged)), pieces)
        self._second = np.zeros(len(self._parent), dtype=bool)
        self._second[np.cumsum(pieces)[flagged] - 1] = True
        halved = flagged[self._parent]
        points = equations.rule.points
        nodes = np.concatenate([[0.0], points, [1.0]])
        whole = np.concatenate([points, [1.0]])
        matrices = np.stack([lagrange_matrix(nodes, target) for target in (whole, whole / 2, (1 + whole) / 2)])
        self._matrix = matrices[np.where(halved, 1 + self._second, 0)]

    def interpolate(self, values: Array) -> Array:
        """(…, n', m + 1) from values (…, n, m + 1) that are continuous around the loop."""
        left = np.roll(values[..., -1:], 1, axis=-2)
        return self._on_cells(np.concatenate([left, values], axis=-1))

    def _on_cells(self, padded: Array) -> Array:
        """(…, n', m + 1) from (…, n, m + 2), the left end of each cell first."""
        values: Array = np.einsum("nij,...nj->...ni", self._matrix, padded[..., self._parent, :])
        return values

    def transfer(self, state: State) -> State:
        """The state on the finer mesh.

        Angles and their rates carry over; positions and velocities are integrated anew from them, so that the rod is
        inextensible on the new mesh too: an inconsistency ε would become a velocity ε/Δt in the next step. Forces and
        moments are mere guesses.
        """
        unknowns, rates = self._unknowns(state.unknowns, 2 * np.pi), self._unknowns(state.rates, 0.0)
        closure = Closure(self.equations)
        position = closure.position(unknowns, closure.centre(self.interpolate(state.position)))
        velocity = closure.velocity(unknowns, rates, closure.centre(self.interpolate(state.velocity)))
        force = self.interpolate(state.force)
        unknowns[:, FORCE] = left_ends(force)
        acceleration = self.interpolate(state.acceleration)
        return State(state.time, self.equations, unknowns, rates, position, velocity, acceleration, force)

    def _unknowns(self, unknowns: Array, turn: float) -> Array:
        """Angles through the Gauss points and both ends of the old cells; the other nodal values between neighbours
        alone.
        """
        right = np.roll(unknowns[:, :NODAL], -1, axis=0)
        right[-1, THETA] += turn
        angles = np.concatenate([unknowns[:, [THETA]], unknowns[:, NODAL:], right[:, [THETA]]], axis=1)
        fine = self._on_cells(angles)
        out = np.empty((len(fine), unknowns.shape[1]))
        out[:, NODAL:] = fine[:, :-1]
        out[:, :NODAL] = unknowns[self._parent, :NODAL]
        out[self._second, :NODAL] = (unknowns[self._parent, :NODAL] + right[self._parent])[self._second] / 2
        out[self._second, THETA] = fine[np.flatnonzero(self._second) - 1, -1]
        return out
