"""Cases at the edges of what may be asked, as keywords of `Case`."""

from typing import Any

import numpy as np

Keywords = dict[str, Any]

STORED = {"snapshots": 9, "output_points": 64}


def motion_time(case: Keywords) -> float:
    """Time scale of the motion: the growth time of the load, longer for a heavier rod."""
    heaviest = max([1.0, case.get("density_ratio", 1.0), *(s["density"] for s in case.get("segments", ()))])
    return float(np.sqrt(heaviest) * (1 + abs(case["p"])) ** -0.75)


def random_case(seed: int) -> Keywords:
    """One case, of its own generator, so that each can be run again by its number."""
    draw = np.random.default_rng(seed)
    case: Keywords = {"p": _signed(draw, -2, 4), **STORED, **_rod(draw), **_drag(draw), **_perturbation(draw)}
    t_end = float(draw.uniform(0.5, 6.0)) * motion_time(case)
    case["stop_at"] = [(), ("crossing",), ("crossing", "settled")][draw.integers(3)]
    return case | (_fixed(draw, t_end) if draw.random() < 0.4 else _adaptive(draw, t_end))


def _log(draw: np.random.Generator, low: float, high: float) -> float:
    return float(10 ** draw.uniform(low, high))


def _signed(draw: np.random.Generator, low: float, high: float) -> float:
    """Either sign, sometimes zero."""
    if draw.random() < 0.05:
        return 0.0
    return _log(draw, low, high) * float(draw.choice([-1, 1]))


def _rod(draw: np.random.Generator) -> Keywords:
    kind = draw.random()
    if kind < 0.15:
        return {}
    if kind < 0.75:
        return {
            "stiffness_ratio": _log(draw, -3, 3) if draw.random() < 0.8 else 1.0,
            "density_ratio": _log(draw, -3, 3) if draw.random() < 0.5 else 1.0,
            "k": float(draw.uniform(0.01, 0.99)),
        }
    count = int(draw.integers(3, 7))
    fractions = draw.dirichlet(np.ones(count)) * 0.94 + 0.06 / count
    fractions[-1] = 1 - fractions[:-1].sum()
    values = [(1.0, 1.0), *((_log(draw, -2, 2), _log(draw, -2, 2)) for _ in range(count - 1))]
    return {
        "segments": [
            {"fraction": float(f), "stiffness": b, "density": d} for f, (b, d) in zip(fractions, values, strict=True)
        ]
    }


def _drag(draw: np.random.Generator) -> Keywords:
    if draw.random() < 0.4:
        return {}
    return {"zeta_perp": _log(draw, -2, 4), "gamma": float(draw.choice([0.0, 0.5, 1.0, draw.random()]))}


def _perturbation(draw: np.random.Generator) -> Keywords:
    kind, amplitude = draw.random(), _log(draw, -8, np.log10(0.2))
    if kind < 0.15:
        return {}
    if kind < 0.25:
        return {"perturbation": [{"mode": 2, "amplitude": 0.0}]}
    if kind < 0.5:
        return {"perturbation": [{"random": {"amplitude": amplitude, "modes": [2, 12], "seed": int(draw.integers(9))}}]}
    mode = int(draw.choice([2, 3, 4, 7, 20]))
    return {"perturbation": [{"mode": mode, "amplitude": min(amplitude, 3.0 / mode**2), "phase": float(draw.random())}]}


def _adaptive(draw: np.random.Generator, t_end: float) -> Keywords:
    return {"t_end": t_end, "tol": _log(draw, -6, -2)}


def _fixed(draw: np.random.Generator, t_end: float) -> Keywords:
    dt = _log(draw, -6, 0)
    steps = int(draw.integers(5, 200))
    cells = int(_log(draw, np.log10(40), 2.7)) if draw.random() < 0.9 else int(_log(draw, 3, 4))
    dt = min(dt, t_end)
    steps = steps if cells < 1000 else 10
    return {"t_end": max(dt, min(t_end, steps * dt)), "scheme": "bdf2", "N": cells, "dt": dt}
