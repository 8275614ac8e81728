"""The loops that references and benchmarks are computed for.

All quantities are nondimensional as in the paper: loop length 2 pi, forces in B1/R^2, time in R^2 sqrt(rho1 A/B1).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

PI2 = 6.283185307179586


@dataclass(frozen=True)
class Segment:
    """A uniform stretch of rod: its share of the arclength, B/B1 and rho/rho1."""

    fraction: float
    stiffness: float = 1.0
    density: float = 1.0


@dataclass(frozen=True)
class Mode:
    """One term amplitude * cos(mode * phi - phase) of the radial perturbation of the circle."""

    mode: int
    amplitude: float
    phase: float = 0.0


@dataclass(frozen=True)
class Problem:
    """A loop, its load and the times at which observables are stated."""

    name: str
    p: float
    times: tuple[float, ...]
    segments: tuple[Segment, ...] = (Segment(1.0),)
    zeta_perp: float = 0.0
    gamma: float = 0.5
    perturbation: tuple[Mode, ...] = ()

    @property
    def t_end(self) -> float:
        return self.times[-1]

    @property
    def uniform(self) -> bool:
        """True if neither stiffness nor density changes along the loop."""
        return len({(s.stiffness, s.density) for s in self.segments}) == 1

    @property
    def edges(self) -> list[float]:
        """Arclength of the segment ends, from 0 to 2 pi."""
        edges = [0.0]
        for segment in self.segments:
            edges.append(edges[-1] + PI2 * segment.fraction)
        return [*edges[:-1], PI2]

    def at(self, times: tuple[float, ...]) -> Problem:
        """The same loop with other stated times."""
        return replace(self, times=times)

    def describe(self) -> dict[str, object]:
        """What a reader of a result needs to set the problem up again."""
        return {
            "p": self.p,
            "segments": [vars(s) for s in self.segments],
            "zeta_perp": self.zeta_perp,
            "gamma": self.gamma,
            "perturbation": [vars(m) for m in self.perturbation],
        }


def halves(stiffness_ratio: float = 1.0, density_ratio: float = 1.0) -> tuple[Segment, Segment]:
    """Two halves, the first (right) one with unit properties."""
    return Segment(0.5), Segment(0.5, stiffness_ratio, density_ratio)


TWO_LOBES = (Mode(2, 5e-3),)
HIGH_MODES = (Mode(5, 2e-5, 0.4), Mode(6, 5e-5), Mode(7, 2e-5, 1.0))
DRAG_TIMES = (0.0, 0.1, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0)
STIFFNESS_TIMES = (0.0, 0.1, 0.3, 0.55, 0.8, 1.0, 1.125, 1.25, 1.7, 2.0, 2.25, 2.26)
DENSITY_TIMES = (0.0, 2.0, 4.0, 6.0, 8.0, 8.5, 10.6, 11.5)

#: The benchmark cases H, S, P64 and D, and the density contrast R.
PROBLEMS = {
    "H": Problem("homogeneous_p3.8", 3.8, (0.0, 1, 2, 3, 4, 4.5, 4.8, 5.5, 7, 9, 9.6), perturbation=TWO_LOBES),
    "S": Problem("stiffness5_p3.8", 3.8, STIFFNESS_TIMES, halves(5.0)),
    "P64": Problem("homogeneous_p64", 64.0, (0.0, 0.1, 0.15, 0.2, 0.25, 0.28), perturbation=HIGH_MODES),
    "D": Problem("stiffness12.8_p5_drag2", 5.0, DRAG_TIMES, halves(12.8), zeta_perp=2.0),
    "R": Problem("density5_p3.8", 3.8, DENSITY_TIMES, halves(1.0, 5.0), perturbation=TWO_LOBES),
}
