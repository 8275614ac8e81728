"""From the benchmark's rows to the table and the figure of docs/performance.md.

python -m scripts.benchmarks.report out/bench.json
"""

import argparse
import json
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

Row = dict[str, Any]

TARGETS = (1e-3, 1e-4, 1e-5, 1e-6)
CASES = {
    "H": "homogeneous, p = 3.8, t = 9.6",
    "S": "stiffness ratio 5, p = 3.8, t = 2.26",
    "P64": "homogeneous, p = 64, t = 0.28",
    "D": "stiffness 12.8, drag 2, p = 5, t = 3",
}
OURS, PAPER = "rodloop radau", "paper's scheme"
PLAIN = "paper's scheme, sparse LU in every iteration"
ALONE = "– its set-up and steps alone, as timed for the peers"
DOCUMENT = Path("docs/performance.md")
FIGURE = Path("docs/figures/work_precision.png")
COLOURS = [*(f"C{i}" for i in range(10)), "black", "gold"]
BEGIN, END = "<!-- begin table -->", "<!-- end table -->"


def main() -> None:
    """Write the table into the document and draw the figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    results = json.loads(parser.parse_args().results.read_text())
    rows = [row for row in results["rows"] if row["error"] is not None]
    table = "\n".join([f"Measured on {results['machine']['processor']}, one thread.", "", *lines(rows)])
    text = DOCUMENT.read_text()
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    DOCUMENT.write_text(f"{before}{BEGIN}\n{table}\n{END}{after}")
    draw(rows).savefig(FIGURE, dpi=150)
    print(DOCUMENT, FIGURE)


def fastest(rows: Iterable[Row], target: float) -> float | None:
    """Least wall time with an error of at most ``target``."""
    walls = [row["wall"] for row in rows if row["error"] <= target]
    return min(walls, default=None)


def by_peer(rows: Iterable[Row], case: str) -> dict[str, list[Row]]:
    """The rows of a case, a list for each peer, ours first."""
    grouped: dict[str, list[Row]] = defaultdict(list)
    for row in rows:
        if row["case"] == case:
            grouped[row["peer"]].append(row)
    return dict(sorted(grouped.items(), key=lambda item: (item[0] != OURS, not item[0].startswith(PAPER), item[0])))


def lines(rows: list[Row]) -> Iterator[str]:
    """A Markdown table for each case: wall seconds to reach an error, and three ratios."""
    for case, words in CASES.items():
        peers = by_peer(rows, case)
        if OURS not in peers:
            continue
        yield f"**{case}**: {words}"
        yield ""
        yield "| wall seconds to an error of | " + " | ".join(f"{t:.0e}" for t in TARGETS) + " |"
        yield "|---|" + "---|" * len(TARGETS)
        alone = [row | {"wall": row["wall_alone"]} for row in peers[OURS]]
        for peer, measured in ({OURS: peers[OURS], ALONE: alone} | peers).items():
            yield f"| {peer} | " + " | ".join(_seconds(fastest(measured, t)) for t in TARGETS) + " |"
        paper = [row for peer, measured in peers.items() if peer.startswith(PAPER) for row in measured]
        others = [row for peer, measured in peers.items() if peer != OURS for row in measured if row not in paper]
        yield "| *best peer / rodloop* | " + " | ".join(_ratio(others, peers[OURS], t) for t in TARGETS) + " |"
        yield "| *best peer / its steps alone* | " + " | ".join(_ratio(others, alone, t) for t in TARGETS) + " |"
        for name, measured in (("paper's scheme at its fastest", paper), (PLAIN, peers.get(PLAIN, []))):
            yield f"| *{name} / rodloop* | " + " | ".join(_ratio(measured, peers[OURS], t) for t in TARGETS) + " |"
        yield ""


def _seconds(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}" if value < 10 else f"{value:.0f}"


def _ratio(others: list[Row], ours: list[Row], target: float) -> str:
    theirs, mine = fastest(others, target), fastest(ours, target)
    if theirs is None or mine is None:
        return "–"
    ratio = theirs / mine
    return f"{ratio:.2g}" if ratio < 100 else f"{round(ratio, -1):.0f}"


def draw(rows: list[Row]) -> Figure:
    """Error against wall time, a panel for each case."""
    figure = Figure(figsize=(11, 8.5), layout="constrained")
    axes = figure.subplots(2, 2).ravel()
    styles: dict[str, str] = {}
    for ax, (case, words) in zip(axes, CASES.items(), strict=True):
        for peer, measured in by_peer(rows, case).items():
            front = pareto(measured)
            color = styles.setdefault(peer, COLOURS[len(styles) % len(COLOURS)])
            width = 2.6 if peer == OURS else 1.2
            walls, errors = [row["wall"] for row in front], [row["error"] for row in front]
            ax.loglog(walls, errors, "o-", ms=4, lw=width, color=color, label=peer)
        ax.set(title=f"{case}: {words}", xlabel="wall time / s", ylabel="error")
        ax.grid(visible=True, alpha=0.3)
    handles = {label: handle for ax in axes for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=3, frameon=False)
    return figure


def pareto(rows: list[Row]) -> list[Row]:
    """The settings that no other setting of the same solver beats in both time and error."""
    front: list[Row] = []
    for row in sorted(rows, key=lambda row: row["wall"]):
        if not front or row["error"] < front[-1]["error"]:
            front.append(row)
    return front


if __name__ == "__main__":
    main()
