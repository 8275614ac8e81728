"""Reduced form of the uniform loop without drag, by Fourier differentiation: the reference for smooth loops.

With omega = theta_t and the shear force Q = -theta'', inextensibility, a' = omega_t n - omega^2 t, turns the force
balance a = (T' - kappa Q) t + (kappa T + Q' + p) n into one linear problem for the tension T and an explicit
angular acceleration:

    T'' - kappa^2 T = (kappa Q)' + kappa Q' + kappa p - omega^2
    omega_t = (kappa T + Q' + p)' + kappa (T' - kappa Q)

psi = theta - s is sampled at an odd number of equidistant points, so that no derivative loses a Nyquist mode.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from .observables import Row, make_row, relative_to_start
from .problem import PI2, Problem
from .shapes import initial_angle

Array = NDArray[np.float64]

FINE_POINTS = 512  # for observables: cos(theta) has more harmonics than theta


@dataclass(frozen=True)
class Ring:
    """Differentiation matrices on N points, N odd; ``derivatives`` stacks d, d^2, d^3, d^4 to [4 N, N]."""

    p: float
    points: Array
    d: Array
    derivatives: Array
    to_tension: Array  # minus second derivative


def make_ring(problem: Problem, n: int) -> Ring:
    if not problem.uniform or problem.zeta_perp:
        raise ValueError("the Fourier reference covers the uniform loop without drag")
    n += 1 - n % 2
    wave = np.fft.fftfreq(n, 1 / n)
    powers = [np.fft.ifft((1j * wave[:, None]) ** k * np.fft.fft(np.eye(n), axis=0), axis=0).real for k in range(1, 5)]
    density = problem.segments[0].density
    stiffness = problem.segments[0].stiffness
    if density != 1 or stiffness != 1:
        raise ValueError("scale the uniform loop to unit stiffness and density")
    return Ring(problem.p, PI2 * np.arange(n) / n, powers[0], np.vstack(powers), -powers[1])


def start(problem: Problem, ring: Ring) -> Array:
    """psi and omega at t = 0, [2 N]."""
    return np.concatenate([initial_angle(problem)(ring.points) - ring.points, np.zeros_like(ring.points)])


def rate(_t: float, y: Array, ring: Ring) -> Array:
    """Time derivative of (psi, omega); the tension matrix kappa^2 - d^2 is positive definite (Cholesky)."""
    n = len(ring.points)
    omega = y[n:]
    d1, d2, d3, d4 = (ring.derivatives @ y[:n]).reshape(4, n)
    kappa = 1 + d1
    source = omega * omega + kappa * d3 + ring.d @ (kappa * d2) - ring.p * kappa
    system = ring.to_tension.copy()
    system.ravel()[:: n + 1] += kappa * kappa
    _, tension, _ = lapack.dposv(system, source, overwrite_a=True)
    turned = ring.d @ np.column_stack([tension, kappa * tension])
    return np.concatenate([omega, turned[:, 1] - d4 + kappa * (turned[:, 0] + kappa * d2)])


def jacobian(_t: float, y: Array, ring: Ring) -> Array:
    """Derivative of ``rate`` with respect to (psi, omega), [2 N, 2 N]; T is differentiated through its own system."""
    n = len(ring.points)
    omega, d = y[n:], ring.d
    m1, m2, m3, m4 = ring.derivatives.reshape(4, n, n)
    d1, d2, d3, _ = (ring.derivatives @ y[:n]).reshape(4, n)
    kappa = (1 + d1)[:, None]
    system = ring.to_tension.copy()
    system.ravel()[:: n + 1] += (1 + d1) ** 2
    source = omega * omega + (1 + d1) * d3 + d @ ((1 + d1) * d2) - ring.p * (1 + d1)
    solved = np.linalg.solve(system, np.column_stack([source, np.eye(n)]))
    tension, inverse = solved[:, 0], solved[:, 1:]
    d_source = (d3 - ring.p)[:, None] * m1 + kappa * m3 + d @ (d2[:, None] * m1 + kappa * m2)
    by_psi = inverse @ (d_source - (2 * kappa * tension[:, None]) * m1)
    by_omega = inverse * (2 * omega)
    slope = d @ tension
    out = np.zeros((2 * n, 2 * n))
    out[:n, n:] = np.eye(n)
    out[n:, :n] = d @ (tension[:, None] * m1 + kappa * by_psi) - m4 + kappa * (d @ by_psi)
    out[n:, :n] += (slope + 2 * (1 + d1) * d2)[:, None] * m1 + kappa**2 * m2
    out[n:, n:] = d @ (kappa * by_omega) + kappa * (d @ by_omega)
    return out


def observe(times: Array, states: Array, problem: Problem) -> list[Row]:
    """Observables of the columns of ``states`` [2 N, times]; positions and velocities are Fourier integrals."""
    return relative_to_start([_row(t, y, problem) for t, y in zip(times, states.T, strict=True)])


def _row(t: float, y: Array, problem: Problem) -> Row:
    psi, omega = (_refine(part) for part in np.split(y, 2))
    s = PI2 * np.arange(FINE_POINTS) / FINE_POINTS
    tangent = np.exp(1j * (s + psi))
    z, velocity = _integrate(tangent), _integrate(1j * omega * tangent)
    kappa = 1 + np.fft.irfft(1j * np.arange(FINE_POINTS // 2 + 1) * np.fft.rfft(psi), FINE_POINTS)
    quarters = z[:: FINE_POINTS // 4]
    return make_row(
        t,
        problem.p,
        area=PI2 * 0.5 * np.mean(z.real * tangent.imag - z.imag * tangent.real),
        bending=PI2 * 0.5 * float(np.mean(kappa**2)),
        kinetic=PI2 * 0.5 * np.mean(np.abs(velocity) ** 2),
        quarters=np.column_stack([quarters.real, quarters.imag]),
        moment=kappa[0],
    )


def closure_gap(y: Array) -> float:
    """Distance between the two ends of the loop: the invariant that the reduced form does not enforce."""
    psi = _refine(np.split(y, 2)[0])
    return float(abs(PI2 * np.mean(np.exp(1j * (PI2 * np.arange(FINE_POINTS) / FINE_POINTS + psi)))))


def _refine(values: Array) -> Array:
    """Trigonometric interpolation to ``FINE_POINTS``."""
    return np.fft.irfft(np.fft.rfft(values), FINE_POINTS) * (FINE_POINTS / len(values))


def _integrate(values: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Periodic primitive without mean (no net momentum: the load has no resultant)."""
    wave = np.fft.fftfreq(len(values), 1 / len(values))
    spectrum = np.fft.fft(values)
    spectrum[0] = 0
    spectrum[1:] /= 1j * wave[1:]
    return np.fft.ifft(spectrum)
