"""Radau IIA methods with 1, 3, 5 or 7 stages, as data [Hairer & Wanner, Solving ODEs II, IV.5 and IV.8]."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from rodloop_cli.numerics.gauss import Array

Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class RadauIIA:
    """An s-stage Radau IIA method, A^-1 diagonalised: ``inverse @ vectors = vectors @ diag(eigenvalues)``.

    Complex eigenvalues come in pairs; of each pair only the one with positive imaginary part is kept, the real one
    first.

    nodes: (s,) with c_s = 1;  matrix: (s, s) A;  inverse: (s, s) A^-1;
    eigenvalues: (E,) with E = (s + 1)/2;
    to_modes: (E, s) maps stage values to eigenvector coordinates;
    from_modes: (s, E), the real part of ``from_modes @ coordinates`` are the stage values (the pair counted twice);
    embedded: (s,) weights of the embedded error estimate, see `embedded_weights`.
    """

    nodes: Array
    matrix: Array
    inverse: Array
    eigenvalues: Complex
    to_modes: Complex
    from_modes: Complex
    embedded: Array

    @property
    def stages(self) -> int:
        return len(self.nodes)


@cache
def radau_iia(stages: int) -> RadauIIA:
    """The method with an odd number of stages; order 2s - 1."""
    nodes = _right_radau_points(stages)
    matrix = _collocation_matrix(nodes)
    inverse: Array = np.linalg.inv(matrix).astype(float)
    eigenvalues, vectors = np.linalg.eig(inverse)
    kept = np.flatnonzero(eigenvalues.imag > -1e-9)
    kept = kept[np.argsort(np.abs(eigenvalues[kept].imag))]
    multiplicity = np.where(np.abs(eigenvalues[kept].imag) < 1e-9, 1, 2)
    values = eigenvalues[kept]
    values[0] = values[0].real
    return RadauIIA(
        nodes=nodes,
        matrix=matrix,
        inverse=inverse,
        eigenvalues=values.astype(complex),
        to_modes=np.linalg.inv(vectors)[kept].astype(complex),
        from_modes=(vectors[:, kept] * multiplicity).astype(complex),
        embedded=embedded_weights(nodes, inverse, float(values[0].real)),
    )


def embedded_weights(nodes: Array, inverse: Array, real_eigenvalue: float) -> Array:
    """Weights e (s,) of the error estimate, generalised from RADAU5 to any s.

    The formula with weight 1/γ on the start of the step, γ the real eigenvalue of A^-1, and of order s on the nodes
    (0, c) differs from the method by ``(f_0 + Σ e_i z_i/Δt) Δt/γ``, z_i the stage increments.
    """
    moments = np.zeros(len(nodes))
    moments[0] = -1.0 / real_eigenvalue
    weight_change = np.linalg.solve(np.vander(nodes, increasing=True).T, moments)
    weights: Array = real_eigenvalue * inverse.T @ weight_change
    return weights


def _right_radau_points(stages: int) -> Array:
    """Zeros of P_{s-1} - P_s on [-1, 1] moved to (0, 1]; polished, because the last one must be 1 exactly."""
    coefficients = np.zeros(stages + 1)
    coefficients[stages - 1 :] = 1, -1
    roots = np.sort(legendre.legroots(coefficients).real)
    slope = legendre.legder(coefficients)
    for _ in range(3):
        roots = roots - legendre.legval(roots, coefficients) / legendre.legval(roots, slope)
    roots[-1] = 1.0
    points: Array = (roots + 1) / 2
    return points


def _collocation_matrix(nodes: Array) -> Array:
    stages = len(nodes)
    antiderivatives = legendre.legint(np.linalg.inv(legendre.legvander(2 * nodes - 1, stages - 1)), lbnd=-1, axis=0)
    matrix: Array = legendre.legvander(2 * nodes - 1, stages) @ antiderivatives / 2
    return matrix
