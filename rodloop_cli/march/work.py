"""What a run cost."""

from dataclasses import dataclass


@dataclass
class Work:
    """Counters of one run, all from the start of it."""

    steps: int = 0
    rejected: int = 0
    newton_failures: int = 0
    newton_iterations: int = 0
    jacobians: int = 0
    factorizations: int = 0
    refinements: int = 0
