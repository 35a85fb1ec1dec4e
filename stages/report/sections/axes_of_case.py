"""A small drawing of the axes of the case."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from inertial.tables import AXES
from stages.report.drawing import AXIS_COLOUR, INK, style, svg

# Towards the right and up on paper: x to the front left, y to the right, z up.
ON_PAPER = np.array([[-0.55, -0.42], [0.94, -0.2], [0.0, 1.0]])
BOX = np.array([1.0, 1.2, 0.55])  # edges of the case along x, y, z
ARROW = 0.55  # beyond the case


def axes_of_case() -> str:
    """A box with the axes through its sides, as SVG."""
    with style():
        figure = Figure(figsize=(1.7, 1.5))
        axes = figure.add_axes((0, 0, 1, 1))
        half = BOX / 2
        for side in range(3):
            across, up = (one for one in range(3) if one != side)
            corners = np.full((5, 3), half)
            corners[:, across] *= [1, -1, -1, 1, 1]
            corners[:, up] *= [1, 1, -1, -1, 1]
            axes.plot(*(corners @ ON_PAPER).T, color=INK, linewidth=0.7)
        for side, name in enumerate(AXES):
            start = np.zeros(3)
            start[side] = half[side]
            end = start.copy()
            end[side] += ARROW
            first, last = start @ ON_PAPER, end @ ON_PAPER
            axes.annotate(
                "",
                last,
                first,
                arrowprops={
                    "arrowstyle": "-|>",
                    "color": AXIS_COLOUR[name],
                    "linewidth": 1.4,
                    "shrinkA": 0,
                    "shrinkB": 0,
                },
            )
            across, up = last + 0.16 * (last - first) / np.linalg.norm(last - first)
            axes.text(across, up, name, ha="center", va="center")
        axes.set_aspect("equal")
        axes.set_xlim(-1.1, 1.35)
        axes.set_ylim(-1.0, 1.05)
        axes.set_axis_off()
        return svg(figure, "axes of the case")
