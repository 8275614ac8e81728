"""Each figure beside what the paper's text says of it; written after looking at the drawings."""

AGREEMENT: tuple[tuple[str, str, str], ...] = (
    ("2", "n = 3, 4, 6, 8 grow fastest at p = 16, 32, 64, 128", "agrees; a closed formula"),
    (
        "3",
        "circle, ellipse, dumbbell and back; F_n zero at s/L = 0, 1/4, 1/2, 3/4",
        "agrees; F_t is compressive but for the flanks of the waist at the largest swing",
    ),
    ("4", "bursts with quiet intervals; ΔE_b against ΔE_t; E_k small", "agrees"),
    (
        "5",
        "n = 3, 4, 5, 6 in the end; F_t three-periodic at p = 16, irregular above",
        "agrees for the seed shown; at p = 128 the sequence crosses itself 6 % before the paper's last time",
    ),
    ("6", "contraction, rebound, decaying oscillation", "agrees; it comes to rest as a dumbbell, half width 0.20"),
    ("7", "E_k and E_d settle before E_b and E_t; P_d one large peak, then small ones", "agrees"),
    (
        "8",
        "peak 3.025 at ratio 1.04, steep fall; for k = 0.49 and 0.51 two maxima, peaks above 3",
        "k = 0.5, 0.49 agree (3.17 near 1.12); k = 0.51, tied to 0.49 by (18): a shoulder 2.8 near 0.9, then 3",
    ),
    (
        "9",
        "soft half bends inward; stiff half compressed throughout, soft half tensile at large swing; ripples in F_n",
        "agrees; the ripples are weak",
    ),
    ("10", "smooth, nearly sinusoidal exchange", "agrees"),
    (
        "11",
        "waves in the soft half; collapse there at p = 32 (b, f); coalescence in d (both halves), g, h (soft half)",
        "b, f: collapse at s = L/4, agrees; g, h: coalescence, agrees, besides a collapse; d: collapses first",
    ),
    ("12", "soft half contracts, rebounds, settles; the stiff half hardly moves, the other way", "agrees"),
    ("13", "both halves swing in step, the soft one further", "agrees"),
    ("14", "ΔE_b against ΔE_t; inner rupture: smaller energies, larger share dissipated", "agrees"),
    (
        "15",
        "light half ahead; its middle turns convex between 10.6 and 11.5; alike at 22.7 and 24.1",
        "agrees with ε = 2e-3",
    ),
    (
        "16",
        "heavy half smooth, light half in high waves; no pronounced loss of lobes",
        "heavy and light half agree; one or two lobes are lost a panel, three small ones at p = 16",
    ),
    (
        "17",
        "the lighter half deforms more; collapse there in b, c; coalescence in d, h",
        "agrees; d, h show collapses besides",
    ),
    (
        "C.1",
        "six lobes first; a valley rises, two peaks merge, 6 to 5, sometimes 4; one collapse for the larger ε",
        "agrees in a; e loses two lobes, 6 to 5 to 4, both by collapse",
    ),
)
"""Figure, what the text says, what ours shows."""
