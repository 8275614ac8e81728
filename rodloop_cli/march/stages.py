"""The equations of all stages of one step, solved by a simplified Newton iteration.

The stages couple through the accelerations alone, by R², R the matrix of rates. In the eigenvectors of R they fall
apart into one real and some complex box systems with λ² ρ in place of the inertia and λ ζ in place of the drag: the
linearisation at one instant serves all of them [Hairer & Wanner, Solving ODEs II, IV.8].
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rodloop_cli.march.predictor import Guess
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import AnyArray, Fields, Instant, Iterate, Motion
from rodloop_cli.physics.whole_loop import LoopEquations

Equations = BoxEquations | LoopEquations

SLOW = 0.3
"""Contraction above which the linearisation is renewed in the middle of an iteration."""

MOST_RENEWALS = 2
"""In one step. The first linearisation of a step has forces that are not its own; where they change at once (a load
or a jump of the moment switched on), the second one is the first that is worth anything."""

DIVERGING = 10.0
"""Growth of the correction after which no linearisation helps."""

MAX_ITERATIONS = 10

ROUND_OFF = 1e-11
STALLED = 0.5
"""A correction that is smaller than ROUND_OFF and no longer contracts is round-off, which a shorter step amplifies."""

LEAST_CONTRACTION = 0.03
"""Assumed of the corrections that follow: the first one contracts better, as most of a guess's error is smooth."""

CERTAIN = 0.05
"""A correction this much smaller than the target ends the iteration whatever the contraction."""


@dataclass(frozen=True, eq=False)
class StageModes:
    """Eigen-decomposition of the matrix of rates (before division by the step): see `RadauIIA` for the shapes.

    They may all be real where there is but one stage: half the work.
    """

    eigenvalues: AnyArray
    to_modes: AnyArray
    from_modes: AnyArray


class Solution(NamedTuple):
    """Stage values that solve the equations.

    unknowns: (s, n, 6 + m), those of the boxes;  iterations, contraction: of Newton.
    """

    unknowns: Array
    fields: Fields
    iterations: int
    contraction: float


class Linearisation:
    """The factored systems of one instant and one matrix of rates.

    length: what the eigenvalues are divided by, the step for Radau IIA and what BDF2 makes of it.
    """

    def __init__(self, equations: Equations, modes: StageModes, length: float, instant: Instant) -> None:
        self.equations, self.length, self.instant, self._modes = equations, length, instant, modes
        rates: AnyArray = modes.eigenvalues / length
        self.systems = equations.factored(rates, *instant)

    def correction(self, residual: Array) -> Array:
        """Newton's correction of the stages, in the shape of their ``residual`` (s, ...)."""
        stages = len(residual)
        coordinates: AnyArray = self._modes.to_modes @ residual.reshape(stages, -1)
        solved: AnyArray = self.systems.solve(coordinates.reshape(-1, *residual.shape[1:]))
        correction = (self._modes.from_modes @ solved.reshape(len(solved), -1)).real
        return correction.reshape(residual.shape)


def solve_stages(
    equations: Equations,
    motion: Motion,
    guess: Guess,
    linearisation: Linearisation | None,
    renew: Callable[[Iterate, bool], Linearisation],
    target: float,
) -> tuple[Solution | None, Linearisation]:
    """Iterate until the position error is below ``target``, judged by the contraction; None if it does not contract.

    ``renew(iterate, trusted)`` makes a linearisation at the present iterate, whose forces are trusted only after an
    iteration: those of a guess contain its accelerations, which amplify its error by Δt⁻².
    """
    iterate: Iterate = equations.iterate(guess.unknowns, guess.force, motion)
    linearisation = linearisation or renew(iterate, False)
    renewals = 0
    last, contraction = np.inf, 0.0
    for iteration in range(1, MAX_ITERATIONS + 1):
        residual = iterate.residual(linearisation.instant)
        size = iterate.correct(linearisation.correction(residual))
        if not np.isfinite(size):
            break
        if iteration > 1:
            contraction = size / last
        if size < CERTAIN * target or (iteration > 1 and _converged(size, contraction, target)):
            return Solution(*iterate.solution(), iteration, contraction), linearisation
        if iteration > 1:
            too_slow = contraction >= 1 or _hopeless(size, contraction, target, MAX_ITERATIONS - iteration)
            if (too_slow or contraction > SLOW) and contraction < DIVERGING and renewals < MOST_RENEWALS:
                linearisation, renewals = renew(iterate, True), renewals + 1
            elif too_slow:
                break
        last = size
    return None, linearisation


def _converged(size: float, contraction: float, target: float) -> bool:
    if contraction > STALLED and size < ROUND_OFF:
        return True
    contraction = max(contraction, LEAST_CONTRACTION)
    return contraction < 1 and size * contraction / (1 - contraction) < target


def _hopeless(size: float, contraction: float, target: float, left: int) -> bool:
    return bool(contraction**left * size / (1 - contraction) > target)
