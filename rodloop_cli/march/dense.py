"""The motion between the ends of a step.

Positions and angles integrate the polynomial through the rates at the start and the stages, one degree above the
stages' own; velocities are that polynomial; forces and moments interpolate the stages alone, the constraint's forces
at the start being of lower order.
"""

from typing import NamedTuple

import numpy as np

from rodloop_cli.march.state import Step
from rodloop_cli.numerics.gauss import Array, gauss_rule, lagrange_matrix
from rodloop_cli.physics.equations import NODAL, THETA


class Shapes(NamedTuple):
    """The loop at k instants, at the Gauss points and, last, at the right end of each cell.

    times: (k,);  tangent: (2, k, n, m) at the Gauss points alone;  theta, moment: (k, n, m + 1);
    position, velocity, force: (2, k, n, m + 1);  spin: (k, n, m) θ_t at the Gauss points, empty without rotary inertia.
    """

    times: Array
    tangent: Array
    theta: Array
    position: Array
    velocity: Array
    force: Array
    moment: Array
    spin: Array


def shapes_at(step: Step, times: Array) -> Shapes:
    """The loop at ``times`` (k,) within the step."""
    fractions = np.clip((times - step.start.time) / step.size, 0.0, 1.0)
    unknowns = _moved(step, fractions)
    tangent, position = step.start.equations.shape(unknowns)
    from_stages = lagrange_matrix(step.nodes, fractions)
    from_rates = lagrange_matrix(np.concatenate([[0.0], step.nodes]), fractions)
    velocity = np.einsum("ks,csnm->cknm", from_rates[:, 1:], step.fields.velocity)
    velocity += from_rates[:, 0, None, None] * step.start.velocity[:, None]
    force = np.einsum("ks,csnm->cknm", from_stages, step.fields.force)
    moment = np.tensordot(from_stages, step.fields.moment, 1)
    spin = _spin(step, from_rates) if step.start.equations.load.rotary_inertia else np.zeros(0)
    return Shapes(times, tangent, _theta(unknowns), position, velocity, force, moment, spin)


def _moved(step: Step, fractions: Array) -> Array:
    """(k, n, 6 + m): the unknowns at fractions (k,) of the step (positions and angles; the rest has no meaning)."""
    rates = np.concatenate([step.start.rates[None], step.rates])
    weights = step.size * integrals_of_basis(np.concatenate([[0.0], step.nodes]), fractions)
    moved: Array = (weights @ rates.reshape(len(rates), -1)).reshape(len(fractions), *rates.shape[1:])
    moved += step.start.unknowns
    return moved


def _spin(step: Step, from_rates: Array) -> Array:
    """(k, n, m): θ_t."""
    spin: Array = np.tensordot(from_rates[:, 1:], step.rates[..., NODAL:], 1)
    spin += from_rates[:, 0, None, None] * step.start.rates[:, NODAL:]
    return spin


def _theta(unknowns: Array) -> Array:
    theta = np.empty((*unknowns.shape[:-1], unknowns.shape[-1] - NODAL + 1))
    theta[..., :-1] = unknowns[..., NODAL:]
    theta[..., -1] = np.roll(unknowns[..., THETA], -1, axis=-1)
    theta[..., -1, -1] += 2 * np.pi
    return theta


def integrals_of_basis(nodes: Array, fractions: Array) -> Array:
    """(k, nodes): integrals from 0 to each fraction of the Lagrange basis on ``nodes``."""
    rule = gauss_rule(len(nodes) // 2 + 1)
    samples = lagrange_matrix(nodes, np.multiply.outer(fractions, rule.points).ravel())
    integrals: Array = np.einsum("g,kgn->kn", rule.weights, samples.reshape(len(fractions), rule.m, len(nodes)))
    return integrals * fractions[:, None]
