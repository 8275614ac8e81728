"""Where a function changes sign."""

from collections.abc import Callable

MOST_EVALUATIONS = 200


def bracketed_root(function: Callable[[float], float], low: float, high: float, tolerance: float) -> float:
    """A point where ``function`` changes sign, to ``tolerance``, on the side of ``high``; ends must differ in sign.

    Secant steps inside the bracket; a bisection whenever the last two steps did not halve it, which also serves a
    function that jumps from one sign to the other.
    """
    at_low, at_high = function(low), function(high)
    positive = at_high > 0
    slow = 0
    for _ in range(MOST_EVALUATIONS):
        width = high - low
        if width <= tolerance or at_high == 0:
            break
        guess = low + width / 2
        if slow < 2 and at_high != at_low:
            guess = min(max(high - at_high * width / (at_high - at_low), low + 0.02 * width), high - 0.02 * width)
        value = function(guess)
        if (value > 0) == positive or value == 0:
            high, at_high = guess, value
        else:
            low, at_low = guess, value
        slow = 0 if slow == 2 or high - low < width / 2 else slow + 1
    return high
