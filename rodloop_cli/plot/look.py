"""The look of every figure, and the colours that mean something."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

AFTER_CROSSING = "#8c8c8c"
"""Grey is kept for frames after a self-crossing, which are not physics; nothing else is grey and dashed."""
NOT_PHYSICAL = "self-crossed: not physical"
DASHES = (0, (3, 1.6))

INK = "#222222"
ALARM = "#b3261e"
JUNCTION = "#9a9a9a"

_SHEET = Path(__file__).with_name("rodloop.mplstyle")


def style() -> AbstractContextManager[None]:
    """Within this context figures are made, drawn and saved."""
    return mpl.rc_context(fname=_SHEET)


def figure_of(ax: Axes) -> Figure:
    """The figure that the axes are in."""
    figure = ax.get_figure(root=True)
    assert figure is not None
    return figure
