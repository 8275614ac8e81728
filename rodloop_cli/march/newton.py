"""Newton's iteration from step to step: the factored linearisation of one step serves others while it contracts."""

from rodloop_cli.errors import SingularSystem
from rodloop_cli.march.predictor import Guess
from rodloop_cli.march.stages import Equations, Linearisation, Solution, StageModes, solve_stages
from rodloop_cli.march.work import Work
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import Instant, Iterate, Motion

REUSE_BELOW = 0.05
"""A linearisation is kept for the next step of the same length while Newton contracts faster than this."""

SAME = 1e-9
"""Lengths that differ by less, relatively, differ by round-off of the time."""


class Newton:
    """Solves the stages of one step after the other.

    linearisation, contraction: of the last step; without them the next one only takes longer.
    """

    def __init__(self, modes: StageModes, work: Work) -> None:
        self._modes, self._work = modes, work
        self.linearisation: Linearisation | None = None
        self.contraction = 1.0

    @property
    def reusable_length(self) -> float | None:
        """Length of step for which the present linearisation still serves."""
        if self.linearisation is None or self.contraction > REUSE_BELOW:
            return None
        return self.linearisation.length

    def solve(
        self, equations: Equations, motion: Motion, guess: Guess, length: float, force: Array, target: float
    ) -> Solution | None:
        """The stages of a step, see `solve_stages`; None if Newton fails.

        length: what the eigenvalues of the modes are divided by;  force: (2, n, m + 1) at the start of the step.
        """

        def renew(iterate: Iterate, trusted: bool) -> Linearisation:
            self._work.jacobians += 1
            self._work.factorizations += 1
            return self.linearised(equations, length, iterate.instant(self._middle, None if trusted else force))

        kept = self._kept(equations, length)
        try:
            solution, self.linearisation = solve_stages(equations, motion, guess, kept, renew, target)
        except SingularSystem:
            solution = None
        if solution is None:
            self.linearisation = None
            return None
        self._work.newton_iterations += solution.iterations
        self.contraction = solution.contraction
        return solution

    def linearised(self, equations: Equations, length: float, instant: Instant) -> Linearisation:
        """The factored systems of a step. Raises SingularSystem."""
        return Linearisation(equations, self._modes, length, instant)

    @property
    def _middle(self) -> int:
        stages: int = self._modes.to_modes.shape[-1]
        return stages // 2

    def _kept(self, equations: Equations, length: float) -> Linearisation | None:
        kept, reusable = self.linearisation, self.reusable_length
        if kept is None or reusable is None or kept.equations is not equations:
            return None
        return kept if abs(reusable / length - 1) < SAME else None
