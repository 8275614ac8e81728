"""Where a function changes sign."""

from collections.abc import Callable

Point = tuple[float, float]
"""Where, and the value there."""

MOST_EVALUATIONS = 200


def bracketed_root(function: Callable[[float], float], low: float, high: float, tolerance: float) -> float:
    """A point where ``function`` changes sign, to ``tolerance``, on the side of ``high``; ends must differ in sign."""
    return root_between(function, (low, function(low)), (high, function(high)), tolerance)


def root_between(
    function: Callable[[float], float], below: Point, above: Point, tolerance: float, smooth: bool = False
) -> float:
    """The same with the values at the ends, which need not be exact if their signs are what counts.

    Chandrupatla's method [Advances in Engineering Software 28 (1997) 145], begun with a secant: inverse quadratic
    interpolation where the function is like a parabola, bisection elsewhere, which also serves one that jumps. No
    guess comes nearer to an end than half the tolerance, so that the bracket closes once the root is found. Where it
    need not, because the function is ``smooth`` and either side will do, a guess is taken once the next would hardly
    differ from it.
    """
    positive = above[1] > 0
    guess = _secant(below, above)
    for _ in range(MOST_EVALUATIONS):
        width = above[0] - below[0]
        if width <= tolerance or above[1] == 0:
            break
        margin = min(tolerance, width) / 2
        guess = min(max(guess, below[0] + margin), above[0] - margin)
        new = guess, function(guess)
        if (new[1] > 0) == positive or new[1] == 0:
            left, above = above, new
            guess = _interpolated(new, below, left)
        else:
            left, below = below, new
            guess = _interpolated(new, above, left)
        if smooth and abs(guess - new[0]) <= tolerance:
            return new[0]
    return above[0]


def _secant(one: Point, other: Point) -> float:
    (x1, f1), (x2, f2) = one, other
    return x1 + (x2 - x1) * f1 / (f1 - f2) if f1 != f2 else (x1 + x2) / 2


def _interpolated(new: Point, opposite: Point, left: Point) -> float:
    """The root of the parabola x(f) through three points if it is monotonic between the first two, else their middle.

    ``left`` lies behind the new point, which replaced it as an end of the bracket.
    """
    (x1, f1), (x2, f2), (x3, f3) = new, opposite, left
    if f2 == f3:
        return (x1 + x2) / 2
    place, height = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
    if height**2 >= place or (1 - height) ** 2 >= 1 - place:
        return (x1 + x2) / 2
    towards_opposite = f1 / (f2 - f1) * f3 / (f2 - f3) * (x2 - x1)
    towards_left = f1 / (f3 - f1) * f2 / (f3 - f2) * (x3 - x1)
    return x1 + towards_opposite + towards_left
