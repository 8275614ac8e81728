"""Growth rates λ of the small motions about an equilibrium, with drag or without.

Without drag λ² is real, and λ = √λ². With drag the motions without it are a basis, orthonormal in the mass: in their
coordinates c

    λ² c + λ C c = Ω c,    Ω = diag(λ_j²),    C = Vᵀ D⁻¹ w ζ⊥ [1 + (γ - 1) t tᵀ] D⁻¹ V,

the rigid motions included. The basis is complete, so this is the quadratic problem of the boxes themselves.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import Load
from rodloop_cli.stability.compliance import Compliance
from rodloop_cli.statics.loaded import Loaded

Complex = NDArray[np.complex128]

MOST_COUPLED = 400
"""Motions without drag that are combined into one with drag: the drag is smooth and hardly couples those that are far
apart.
"""

RIGID_SHARE = 0.5
"""A motion with more of its kinetic energy than this in rigid motion is a drift of the whole loop, which drag slows
down.
"""


@dataclass(frozen=True, eq=False)
class Eigenmotion:
    """One small motion x e^{λt}: the growth rate λ and the change x (n, 6 + m) of the unknowns, complex where λ is."""

    rate: complex
    unknowns: NDArray[Any]


def shift_for(loop: Loaded) -> float:
    """A shift at about the largest λ² that the load can bring: (1 + p/b)² b/(4ρ) of a uniform circle, Eq. (17) for
    large n.
    """
    mesh = loop.equations.mesh
    bound = (1 + abs(loop.p) / mesh.stiffness) ** 2 * mesh.stiffness / (4 * mesh.density)
    return 1.0 + 1.1 * float(bound.max())


def eigenmotions(loop: Loaded, count: int, load: Load | None = None) -> list[Eigenmotion]:
    """The ``count`` fastest growing of the small motions of lowest frequency; of a complex pair the one with Im λ > 0.

    ``load`` gives the drag. Rigid motions are left out.
    """
    compliance = Compliance(loop, shift_for(loop))
    if load is None or load.zeta_perp == 0:
        return _conservative(compliance, count)
    return _damped(compliance, load, count)


def _conservative(compliance: Compliance, count: int) -> list[Eigenmotion]:
    squares, vectors = compliance.eigenpairs
    return [
        Eigenmotion(complex(np.emath.sqrt(square)), compliance.corrections_of(square, vector))
        for square, vector in zip(squares[:count].tolist(), vectors.T, strict=False)
    ]


def _damped(compliance: Compliance, load: Load, count: int) -> list[Eigenmotion]:
    squares, vectors = compliance.eigenpairs
    neutral = compliance.neutral
    squares = np.concatenate([np.zeros(neutral.shape[1]), squares[:MOST_COUPLED]])
    basis = np.concatenate([neutral, vectors[:, :MOST_COUPLED]], axis=1)
    rates, coordinates = _quadratic(squares, _drag(compliance, basis, load))
    chosen = _elastic(rates, coordinates, neutral.shape[1], count)
    displacements = (basis / compliance.root_mass[:, None]) @ coordinates[:, chosen]
    return [
        Eigenmotion(complex(rates[i]), _response(compliance, load, complex(rates[i]), displacement))
        for i, displacement in zip(chosen, displacements.T, strict=True)
    ]


def _response(compliance: Compliance, load: Load, rate: complex, displacement: Complex) -> Complex:
    """(n, 6 + m): change of the unknowns in the motion u e^{λt}, u (2nm,): under its inertia and drag, the shift's part
    taken off.
    """
    moved = displacement.reshape(2, -1)
    tangent = compliance.loop.tangent.reshape(2, -1)
    along = (load.gamma - 1) * (tangent * moved).sum(axis=0)
    drag = load.zeta_perp * (moved + along * tangent)
    force = (rate**2 - compliance.shift) * compliance.density * displacement + rate * drag.ravel()
    response: Complex = (compliance.corrections @ force).reshape(compliance.loop.unknowns.shape)
    return response if rate.imag else response.real.astype(complex)


def _drag(compliance: Compliance, basis: Array, load: Load) -> Array:
    """(J, J): C in the basis (2nm, J)."""
    loop = compliance.loop
    velocity = (basis / compliance.root_mass[:, None]).reshape(2, -1, basis.shape[1])
    weights = load.zeta_perp * loop.weights.ravel()
    along = np.einsum("cg,cgj->gj", loop.tangent.reshape(2, -1), velocity)
    isotropic = np.einsum("cgi,g,cgj->ij", velocity, weights, velocity, optimize=True)
    drag: Array = isotropic + (load.gamma - 1) * (along.T * weights) @ along
    return drag


def _quadratic(squares: Array, drag: Array) -> tuple[Complex, Complex]:
    """λ (2J,) and coordinates c (J, 2J) of λ² c + λ C c = Ω c, by the companion form in (c, λc)."""
    size = len(squares)
    companion = np.zeros((2 * size, 2 * size))
    companion[:size, size:] = np.eye(size)
    companion[size:, :size] = np.diag(squares)
    companion[size:, size:] = -drag
    rates, vectors = np.linalg.eig(companion)
    return rates.astype(complex), vectors[:size].astype(complex)


def _elastic(rates: Complex, coordinates: Complex, neutral: int, count: int) -> list[int]:
    """Indices of the ``count`` slowest motions that are neither neutral nor the mirror image of another, fastest
    growing first.
    """
    energy = np.abs(coordinates) ** 2
    share = energy[:neutral].sum(axis=0) / energy.sum(axis=0)
    scale = np.abs(rates).max()
    wanted = np.flatnonzero((share < RIGID_SHARE) & (rates.imag > -1e-12 * scale))
    slowest = wanted[np.argsort(np.where(rates[wanted].real > 0, 0.0, np.abs(rates[wanted])), kind="stable")][:count]
    # Rounded: of motions that grow alike the slower comes first.
    order = np.lexsort([np.abs(rates[slowest].imag), -np.round(rates[slowest].real, 9)])
    return [int(i) for i in slowest[order]]
