"""The unloaded loop by the truncated sine series of Appendix D: its energy and area before it has converged."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
from scipy.optimize import minimize

from rodloop_cli.critical.curves import two_segments
from rodloop_cli.critical.fourier import SineSeries
from rodloop_cli.statics.loaded import mesh_of


def ground_state(stiffness_ratio: float, modes: int) -> tuple[float, float]:
    """E_b L/B1 and A/L² of the loop of least bending energy with this many modes, Eq. (D.1)."""
    rod = two_segments(stiffness_ratio, 0.5)
    series = SineSeries(*mesh_of(rod, max(12, modes)), modes)
    closed: Any = {"type": "eq", "fun": series.gap, "jac": series.gap_slope}
    options: Any = {"ftol": 1e-14, "maxiter": 300}
    found = minimize(
        series.energy, np.zeros(modes), jac=series.energy_slope, constraints=[closed], method="SLSQP", options=options
    )
    circle = float(series.weights @ np.repeat(series.mesh.stiffness, series.rule.m)) / 2
    return 2 * pi * (series.energy(found.x) + circle), series.area(found.x) / (2 * pi) ** 2
