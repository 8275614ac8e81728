"""A loop under a load, in equilibrium or on the way to it, and what follows from its unknowns."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rodloop_cli.numerics.gauss import Array, GaussRule, gauss_rule
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.closure import Closure, left_ends, turned
from rodloop_cli.physics.energies import Quadrature
from rodloop_cli.physics.equations import FX, FY, MOMENT, NODAL, POSITION, THETA, Fields, Load
from rodloop_cli.physics.rod import Mesh, Rod, cells_by_length
from rodloop_cli.physics.shapes import circle
from rodloop_cli.statics.relaxation import laid_on, unloaded

POINTS_PER_CELL = 6
"""Gauss points in a cell: nodal values of order 12."""

ROUND = 1e-6
"""A curvature that varies by less than this belongs to a circle."""


@dataclass(frozen=True, eq=False)
class Loaded:
    """Unknowns (n, 6 + m) of a loop on one mesh under the equations' load."""

    equations: BoxEquations
    unknowns: Array

    @property
    def p(self) -> float:
        return float(self.equations.load.p)

    def moved(self, correction: Array, dp: float) -> "Loaded":
        """The loop after a change of the unknowns (n, 6 + m) and of the load."""
        mesh, rule = self.equations.mesh, self.equations.rule
        equations = BoxEquations(mesh, rule, Load(self.p + dp)) if dp else self.equations
        return Loaded(equations, self.unknowns + correction)

    @cached_property
    def fields(self) -> Fields:
        """All fields, with a leading axis of length one."""
        return self.equations.fields(self.unknowns[None], None)

    @property
    def tangent(self) -> Array:
        """(2, n, m): cos θ and sin θ at the Gauss points."""
        return np.stack([self.fields.cosine[0], self.fields.sine[0]])

    @property
    def position(self) -> Array:
        """(2, n, m): at the Gauss points."""
        return self.fields.position[:, 0, :, :-1]

    @property
    def residual(self) -> Array:
        """(n, 6 + m): zero in equilibrium."""
        residual: Array = self.equations.residual(self.unknowns[None], self.fields)[0]
        return residual

    @cached_property
    def responses(self) -> Array:
        """(2, n, 6 + m, 6 + m): the parts L0 and L1 of `BoxEquations.linearise`."""
        still = np.zeros_like(self.tangent)
        force = self.fields.force[:, 0, :, :-1]
        return self.equations.linearise(self.fields.cosine[0], self.fields.sine[0], force, still)

    @cached_property
    def weights(self) -> Array:
        """(n, m): Gauss weights of integrals over the arclength."""
        weights: Array = self.equations.mesh.lengths[:, None] * self.equations.rule.weights
        return weights

    @property
    def curvature(self) -> Array:
        """(n, m): κ = M/b at the Gauss points."""
        curvature: Array = self.fields.moment[0, :, :-1] / self.equations.mesh.stiffness[:, None]
        return curvature

    @property
    def area(self) -> float:
        """Enclosed area over R²."""
        return float(self._quadrature.area(self.position, self.tangent))

    @property
    def bending_energy(self) -> float:
        """∮ M²/(2b) ds in B1/R."""
        return float(self._quadrature.bending(self.fields.moment[0, :, :-1]))

    @property
    def _quadrature(self) -> Quadrature:
        return Quadrature(self.equations.mesh, self.equations.rule)

    @cached_property
    def load_response(self) -> Array:
        """(n, 6 + m): change of the residual with p, which acts as the force density F' = p (sin θ, -cos θ)."""
        cosine, sine = self.tangent
        return self.response_to(np.stack([sine, -cosine]))

    def response_to(self, density: Array) -> Array:
        """(n, 6 + m): change of the residual with a force density (2, n, m) at the Gauss points."""
        return self.equations.load_response(self.fields.cosine[0], self.fields.sine[0], density)

    def displacement(self, change: Array) -> Array:
        """(2, n, m + 1): displacement of the Gauss points and right ends by a change of the unknowns (n, 6 + m)."""
        return self.equations.displacement(self.fields.cosine[0], self.fields.sine[0], change)

    @cached_property
    def position_rows(self) -> Array:
        """(2, n, m, 6 + m): change of the position at the Gauss points with the cell's own unknowns."""
        shape = self.unknowns.shape
        columns = [self.displacement(np.broadcast_to(unit, shape))[..., :-1] for unit in np.eye(shape[1])]
        return np.stack(columns, axis=-1)

    @property
    def area_row(self) -> Array:
        """(n, 6 + m): change of the area ½ ∮ (x sin θ - y cos θ) ds with the unknowns."""
        (cosine, sine), (x, y), weights = self.tangent, self.position, self.weights
        rows = self.position_rows
        row = np.einsum("nm,nma->na", weights * sine, rows[0]) - np.einsum("nm,nma->na", weights * cosine, rows[1])
        row[:, NODAL:] += weights * (x * cosine + y * sine)
        half: Array = row / 2
        return half

    @cached_property
    def relabelling(self) -> tuple[Array, Array] | None:
        """The neutral motion that a uniform rod has besides the rigid ones: it slides along its own shape.

        Displacement (2, n, m) and turning (n, m) at the Gauss points, node 0 held: t(s) - t(0) - κ(0) e_z × (r - r(0))
        and κ(s) - κ(0). None where stiffness varies, and for the circle, which only turns.
        """
        curvature = self.curvature
        if np.ptp(self.equations.mesh.stiffness) > 0 or np.ptp(curvature) < ROUND:
            return None
        node = self.unknowns[0]
        first = node[MOMENT] / self.equations.mesh.stiffness[0]
        x, y = self.position - node[POSITION, None, None]
        start = np.array([np.cos(node[THETA]), np.sin(node[THETA])])
        return self.tangent - start[:, None, None] - first * np.stack([-y, x]), curvature - first


def mesh_of(rod: Rod, cells: int, points: int = POINTS_PER_CELL) -> tuple[Mesh, GaussRule]:
    """About ``cells`` cells, shared out by length, and the rule inside them."""
    return Mesh.on(rod, cells_by_length(rod, cells)), gauss_rule(points)


def at_zero_load(rod: Rod, cells: int, points: int = POINTS_PER_CELL) -> Loaded:
    """The loop of least bending energy."""
    mesh, rule = mesh_of(rod, cells, points)
    return Loaded(BoxEquations(mesh, rule, Load(0.0)), unloaded(mesh, rule))


def loaded_circle(rod: Rod, p: float, cells: int, points: int = POINTS_PER_CELL) -> Loaded:
    """The circle in equilibrium with the load: F = -p t."""
    mesh, rule = mesh_of(rod, cells, points)
    equations = BoxEquations(mesh, rule, Load(p))
    unknowns = laid_on(circle(), mesh, rule)
    position = equations.shape(unknowns[None])[1][:, 0]
    x, y = left_ends(position).T
    unknowns[:, FX], unknowns[:, FY] = p * y, -p * x
    return Loaded(equations, unknowns)


def upright(loop: Loaded) -> Loaded:
    """The same loop with its centre at the origin, turned by 0 on average against the circle."""
    closure = Closure(loop.equations)
    unknowns = turned(loop.unknowns, -closure.mean_turn(loop.unknowns))
    position = loop.equations.shape(unknowns[None])[1][:, 0]
    unknowns[:, POSITION] -= closure.centre(position)
    return Loaded(loop.equations, unknowns)
