"""Equilibria of the loop on the same boxes as its motion.

The energy is minimised by implicit steps of a gradient flow: every step solves the statics with an inertia μ(X -
X_before) added, which also holds the rigid motions in place. As the steps contract, μ goes down and the flow turns into
Newton's method.
"""

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.numerics.condensed import CondensedSystems
from rodloop_cli.numerics.gauss import Array, GaussRule
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.closure import Closure, turned
from rodloop_cli.physics.equations import MOMENT, NODAL, THETA, Load, Motion
from rodloop_cli.physics.rod import LENGTH, Mesh
from rodloop_cli.physics.sampling import Sampler
from rodloop_cli.physics.shapes import Shape, circle

LARGEST_TURN = 0.5
"""Angles change by at most this in one step."""

WEAKEST_HOLD = 1e-6
"""Smallest μ: weak enough for quadratic convergence, strong enough to keep the rigid motions determined."""

CONVERGED = 1e-12
STALLED = 1e-7
"""Corrections of the angles below this that no longer shrink are round-off: 1e-8 at a stiffness ratio of 10³."""
SHRINKING = 0.5

MOST_STEPS = 200


def relax(equations: BoxEquations, unknowns: Array) -> Array:
    """The equilibrium (n, 6 + m) near ``unknowns``, under the equations' load (drag has no part in it).

    Raises ConvergenceError if the flow does not come to rest.
    """
    hold, before = 1.0, np.inf
    position = equations.shape(unknowns[None])[1]
    for _ in range(MOST_STEPS):
        correction = _held_correction(equations, unknowns, position, hold)
        size = float(np.abs(correction[:, NODAL:]).max())
        unknowns = unknowns + min(1.0, LARGEST_TURN / max(size, 1e-300)) * correction
        if _at_rest(size, before):
            return unknowns
        position = equations.shape(unknowns[None])[1]
        hold, before = max(WEAKEST_HOLD, hold * min(1.0, size)), size
    raise ConvergenceError(
        f"no equilibrium found in {MOST_STEPS} steps at p = {equations.load.p:g}; "
        "try a smaller contrast of stiffness, or more cells (N)"
    )


def _at_rest(size: float, before: float) -> bool:
    """Whether the next correction would be negligible, if it shrinks at least like this one, or this one is round-off,
    tiny but not shrinking.
    """
    if size < CONVERGED or before == np.inf:
        return size < CONVERGED
    shrinking = size / before
    return size * shrinking < CONVERGED or (size < STALLED and shrinking > SHRINKING)


def _held_correction(equations: BoxEquations, unknowns: Array, position: Array, hold: float) -> Array:
    rate = np.sqrt(hold)
    still = np.zeros_like(position)
    fields = equations.fields(unknowns[None], Motion(np.array([[rate]]), -rate * position, still))
    residual = equations.residual(unknowns[None], fields)[0]
    parts = equations.linearise(fields.cosine[0], fields.sine[0], fields.force[:, 0, :, :-1], still[:, 0, :, :-1])
    systems = CondensedSystems((parts[0] + hold * parts[1])[None], NODAL)
    return np.asarray(systems.solve_real(residual))


def unloaded(mesh: Mesh, rule: GaussRule) -> Array:
    """(n, 6 + m): the loop of least bending energy, its centre at the origin, turned by 0 on average against the
    circle.
    """
    equations = BoxEquations(mesh, rule, Load(p=0.0))
    unknowns = relax(equations, laid_on(circle(), mesh, rule))
    closure = Closure(equations)
    unknowns = turned(unknowns, -closure.mean_turn(unknowns))
    closure.position(unknowns, np.zeros(2))
    return unknowns


def as_shape(mesh: Mesh, rule: GaussRule, unknowns: Array) -> Shape:
    """The equilibrium as functions of arclength, with a break at every node."""
    equations = BoxEquations(mesh, rule, Load(p=0.0))
    fields = equations.fields(unknowns[None], None)
    theta = np.concatenate([unknowns[:, NODAL:], fields.theta[0, :, -1:]], axis=1)
    values, turns = np.stack([theta, fields.moment[0]]), np.array([[LENGTH], [0.0]])

    def along(s: Array) -> tuple[Array, Array]:
        sample = Sampler(mesh, rule, np.ravel(s))
        angle, moment = sample(values, turns)
        return angle.reshape(s.shape), (moment / sample.stiffness).reshape(s.shape)

    return Shape(along, mesh.edges, np.zeros(2))


def laid_on(shape: Shape, mesh: Mesh, rule: GaussRule) -> Array:
    """(n, 6 + m): unknowns that follow the shape, closed to round-off; the forces are zero."""
    equations = BoxEquations(mesh, rule, Load(p=0.0))
    theta, curvature = shape.along(mesh.points(np.append(0.0, rule.points)))
    unknowns = np.zeros((mesh.cells, NODAL + rule.m))
    unknowns[:, THETA], unknowns[:, NODAL:] = theta[:, 0], theta[:, 1:]
    unknowns[:, MOMENT] = mesh.stiffness * curvature[:, 0]
    Closure(equations).position(unknowns, shape.centre)
    return unknowns
