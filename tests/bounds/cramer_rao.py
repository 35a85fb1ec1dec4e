"""The least sigma that any unbiased estimate of the 24 parameters can have (Cramér and Rao)."""

import numpy as np
import study_plans as plans
from block_statistics import ARC_SECOND, LEVER_ARM, Layout


def densities(instrument: str) -> np.ndarray:
    """White noise of the six channels, m/s/√s and rad/√s."""
    gyro, accelerometer = plans.NOISE[instrument]
    return np.repeat([accelerometer / 60, np.radians(gyro) / 60], 3)


def bound(layout: Layout, instrument: str) -> np.ndarray:
    """Sigmas of the 24 parameters, (24,); inf where the plan does not determine one."""
    truth, known = layout.truth(), layout.known
    step = np.where(known == LEVER_ARM, 1e-2, ARC_SECOND)
    step[:9] = step[12:21] = 1e-5
    step[9:12], step[21:24] = 1e-4, 1e-7
    jacobian = np.stack(
        [
            (layout.read(truth + one) - layout.read(truth - one)) / (2 * step[i])
            for i, one in enumerate(np.diag(step))
        ],
        axis=-1,
    )
    rows = known_rows(layout, jacobian, densities(instrument))
    information = rows.T @ rows + np.diag(np.nan_to_num(1 / known**2))
    # In units in which every column alone has length 1.
    size = np.sqrt(np.diag(information))
    values, vectors = np.linalg.eigh(information / np.outer(size, size))
    seen = values > 1e-13
    spread = (vectors[:, seen] / values[seen]) @ vectors[:, seen].T
    hidden = (vectors[:, ~seen] ** 2).sum(axis=1) > 1e-6
    sigma = np.sqrt(np.diag(spread)) / size
    return np.where(hidden, np.inf, sigma)[:24]


def known_rows(layout: Layout, jacobian: np.ndarray, density: np.ndarray) -> np.ndarray:
    """What is read, in units of its noise: all blocks; but the table keeps no exact rate.

    So of a gyro along the axis of a turn only the sum over the whole turn counts.
    """
    rows = []
    block = 0
    for piece in layout.parts:
        own = slice(block, block + len(piece.seconds))
        block = own.stop
        root = np.sqrt(piece.seconds)[:, None, None]
        each = jacobian[own] * root / density[:, None]
        if piece.turn is None:
            rows.append(each.reshape(-1, each.shape[-1]))
            continue
        along = 3 + int(np.argmax(np.abs(piece.about)))
        moving = np.array([not phase.startswith("rest") for phase in piece.phases])
        summed = (jacobian[own][moving, along] * piece.seconds[moving, None]).sum(axis=0)
        rows.append(summed[None] / (density[along] * np.sqrt(piece.seconds[moving].sum())))
        rows += [each[~moving, along], np.delete(each, along, axis=1).reshape(-1, each.shape[-1])]
    return np.vstack(rows)
