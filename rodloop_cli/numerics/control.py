"""Step-size control [Gustafsson, ACM TOMS 20 (1994) 496; Hairer & Wanner, Solving ODEs II, IV.8]."""

from dataclasses import dataclass

SAFETY = 0.9
LARGEST_GROWTH = 8.0
LARGEST_CUT = 0.2
CUT_AFTER_FAILURE = 0.35
"""After a Newton failure: halving often fails again, and a third of the step is still longer than the error would
ask."""

WORTH_CHANGING = 1.2
"""A step is not lengthened by less than this when its factorization can be used again."""


@dataclass(frozen=True)
class Controller:
    """Proposes step sizes from error estimates of order ``exponent`` in the step, relative to what is allowed.

    last_size, last_error: of the last accepted step, 0 before there is one.
    """

    exponent: int
    last_size: float = 0.0
    last_error: float = 0.0

    def factor(self, size: float, error: float) -> float:
        """By how much to multiply ``size`` after an attempt with this error (accepted if it is at most 1)."""
        error = max(error, 1e-10)
        factor: float = SAFETY * error ** (-1 / self.exponent)
        if self.last_error > 0:
            trend = size / self.last_size * (max(self.last_error, 1e-2) / error) ** (1 / self.exponent)
            factor = min(factor, factor * trend)
        return min(LARGEST_GROWTH, max(LARGEST_CUT, factor))

    def accepted(self, size: float, error: float) -> "Controller":
        """The controller after an accepted step."""
        return Controller(self.exponent, size, error)


def settle_on(proposal: float, reusable: float | None) -> float:
    """Keep the size that a factorization was made for unless the proposal is shorter or clearly longer."""
    if reusable is not None and reusable <= proposal <= WORTH_CHANGING * reusable:
        return reusable
    return proposal


def without_sliver(size: float, remaining: float) -> float:
    """A step that nearly reaches the end is stretched to it, and one that would leave less than itself goes half way.

    A sliver of a last step would multiply round-off by Δt⁻² in its forces.
    """
    if 1.999 * size < remaining:
        return size
    return remaining if size > 0.999 * remaining else remaining / 2
