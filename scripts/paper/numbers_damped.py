"""Reproduction of the damped motion and of what the model leaves open: times, drag anisotropy, rotary inertia."""

from __future__ import annotations

from scripts.paper import measures
from scripts.paper.markdown import Lines, compared, paragraph, row, section, table
from scripts.paper.panels import midpoint
from scripts.paper.results import case, result

GAMMAS = (0, 0.25, 0.5, 0.75, 1)
INERTIAS = (1e-6, 1e-4, 1e-3, 1e-2)


def damped() -> Lines:
    """Figs. 6, 12 and 13: times in experiment and simulation."""
    yield from section("Times of the experiments (Figs. 6, 12, 13)")
    yield from table("quantity", "paper", "ours", "difference", "why")
    run = result("fig06")
    width = measures.half_width(run)
    contracted = float(run.attrs["first_area_minimum_time"])
    for share in (0.02, 0.03, 0.05):
        onset = measures.first_time(run, width[0] - width > share)
        yield compared(f"onset, Fig. 6: half width less by {share:g}", 1.7, onset, "a mark set by eye; ε unstated")
    yield compared(
        "ms per unit time, Fig. 6: 34 ms to the contraction", 10, 34 / (contracted - 1.7), "from the onset 1.7"
    )
    soft = result("fig12_drag2")
    turns = measures.turning_points(soft["t"].to_numpy(), midpoint(soft))
    yield compared("ms per unit time, Fig. 12: 18 ms to the contraction", 23.6, 18 / turns[0], "paper 23.6-25.2")
    yield from _predicted_times()
    yield paragraph(
        """
        A round 304 steel rod with the B of Fig. 6 has the mass per length of our case files. The paper's 12 and 24
        ms both need about 8e-5 to 8.6e-5 kg/m, so they share one mass per length, as the text says of the two
        halves; a steel rod as soft as B1 would be thinner, 5.0e-5 kg/m, and give 18 ms. The paper does not state
        the diameter. For Fig. 13 it gives no ratio; its 28 ms to the largest swing would make some 50 ms, twice
        that of Fig. 12: the outer film, which also reaches the frame, is not the uniform load of the model.
        """
    )
    yield _shares()


def _predicted_times() -> Lines:
    for name, stated in (("fig06", 12), ("fig12_drag2", 24)):
        scales = case(name).scales
        assert scales is not None
        needed = scales.B1 * (1e-3 * stated / scales.R**2) ** 2
        why = f"Eq. (8), R = 45 mm, ρA = {scales.rho_A1:.3g} kg/m; {stated} ms needs {needed:.3g} kg/m"
        yield compared(f"ms per unit time predicted, {name}", stated, 1e3 * scales.time, why)


def _shares() -> str:
    """Section 5.4: the share of the released surface energy that the film has taken in the end."""
    shares = []
    for name in ("fig12_drag2", "fig13_drag2"):
        last = result(name).isel(t=-1)
        first = result(name).isel(t=0)
        shares.append(float(last["dissipated_energy"] / (first["surface_energy"] - last["surface_energy"])))
    outer, inner = shares
    return f"\nOf the surface energy released in Fig. 14, {outer:.0%} (p = 5) and {inner:.0%} (p = -5) is dissipated."


def anisotropy() -> Lines:
    """The sensitivity to γ that the paper mentions."""
    yield from section("Sensitivity to the drag anisotropy γ")
    yield from table(
        "γ", "Fig. 6: contraction at", "largest distance from γ = 0.5", "Fig. 12: contraction at", "largest distance"
    )
    for gamma in GAMMAS:
        cells = []
        for name in ("fig06", "fig12_drag2"):
            run = result(name, f"gamma={gamma}")
            distance = measures.largest_distance(run, result(name))
            cells += [f"{run.attrs['first_area_minimum_time']:.3f}", f"{distance:.3f}"]
        yield row(gamma, *cells)
    yield paragraph(
        """
        Distances are the largest of corresponding points at equal times, over R. The shapes that the loop runs
        through hardly change, as the paper says; but tangential drag slows the growth from the circle and delays
        the motion of Fig. 6 by up to 2 %, and at equal times that shows.
        """
    )


def inertia() -> Lines:
    """Rotary inertia, Appendix A."""
    yield from section("Rotary inertia (Appendix A)")
    yield "\n`rotary_inertia` is I/(A R²), a²/(4 R²) for a round rod: 5e-7 for the rods of the experiments."
    names = ("fig09", "fig11h", "fig12_drag2")
    yield from table("I/(A R²)", *(f"{name}: largest distance from 0" for name in names), "fig09: half period")
    for value in INERTIAS:
        runs = [(result(name, f"rotary_inertia={value}"), result(name)) for name in names]
        apart = [f"{measures.largest_distance(*pair):.2e}" for pair in runs]
        yield row(f"{value:g}", *apart, f"{runs[0][0].attrs['first_area_minimum_time']:.4f}")
    yield paragraph(
        """
        Nearly proportional to I/(A R²) from 1e-4 on; at 1e-6 and below the change is of the size of the runs' own
        error (tol 1e-5 in Fig. 9, 1e-4 in the others), as the paper's estimate says.
        """
    )
