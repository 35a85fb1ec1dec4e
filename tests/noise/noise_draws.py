"""Simulated recordings whose noise is known, and what is found of it."""

import time
from collections.abc import Iterator
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from noise_simulation import Array, noise
from numpy.typing import NDArray

import inertial.estimation.noise_terms as estimated
from inertial.estimation.multiresolution import Powers
from inertial.estimation.noise_model import TERMS

Row = dict[str, Any]

RECORDINGS = 2000  # with all five terms
NULLS = 500  # with some of them absent, or too small to be seen
PARTS = {"all": RECORDINGS, "null": NULLS, "small": NULLS}
INTERVAL = 0.01  # s
SAMPLES = 1 << 17  # 22 min
NULL_SAMPLES = 1 << 16  # 11 min
STRETCHES = (4, 8)  # of a recording with gaps
GAP_SHARE = 0.01  # of the recording, that a gap takes
# Of the null draws: what is in the recording beside white noise
BESIDE: tuple[tuple[str, ...], ...] = (
    (),
    ("quantisation",),
    ("bias_instability",),
    ("random_walk",),
    ("ramp",),
)
SMALL = 0.3  # of a size that can be seen, at the most


@cache
def code() -> str:
    """A hash of the code that an outcome rests on, as it was at the start."""
    here, estimation = Path(__file__).parent, Path(estimated.__file__).parent
    files = [here / "noise_draws.py", here / "noise_simulation.py"]
    names = ("multiresolution", "noise_likelihood", "noise_model", "noise_terms", "probability")
    files += [estimation / f"{name}.py" for name in names]
    return sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:16]


def drawn(part: str, number: int) -> tuple[dict[str, float], list[Array]]:
    """The coefficients of a recording, and its stretches, (n, 1) each.

    The corners between the terms are drawn: quantisation meets white noise a little below the
    highest frequency, white noise meets flicker about 1 Hz, flicker meets the random walk two
    decades below, and the ramp is 6 to 12 of its sigmas.
    """
    chance = np.random.default_rng([number, len(part), ord(part[0])])
    samples = SAMPLES if part == "all" else NULL_SAMPLES
    seconds = samples * INTERVAL
    white = 1e-3 * 2 ** chance.uniform(-1, 1)
    corner, slow = 2 ** chance.uniform(-0.5, 0.5, 2) * (1.5, 0.03)
    flicker = white * np.sqrt(2 * np.pi * corner)
    walk = flicker * np.sqrt(2 * np.pi * slow)
    values = {
        "quantisation": white * np.sqrt(INTERVAL) * chance.uniform(0.3, 0.5),
        "white_noise": white,
        "bias_instability": flicker,
        "random_walk": walk,
        "ramp": chance.uniform(6, 12) * walk * np.sqrt(6 / 5 / seconds),
    }
    if part != "all":
        values = _smaller(part, values, number, chance)
    whole = noise(samples, INTERVAL, chance, **values)[:, None]
    # Every second recording is of several stretches.
    return values, list(_stretches(whole, chance)) if number % 2 else [whole]


def _smaller(
    part: str, values: dict[str, float], number: int, chance: np.random.Generator
) -> dict[str, float]:
    """White noise and one more term; the others 0, or too small to be seen for certain."""
    white, seconds = values["white_noise"], NULL_SAMPLES * INTERVAL
    there = {"white_noise", *BESIDE[number // 2 % len(BESIDE)]}
    visible = {
        "quantisation": 0.1 * white * np.sqrt(INTERVAL),
        "bias_instability": white / np.sqrt(seconds),
        "random_walk": white / seconds,
        "ramp": 3 * white / seconds**1.5,
    }
    small = {name: size * chance.uniform(0, SMALL) for name, size in visible.items()}
    return {
        name: value if name in there else small[name] * (part == "small")
        for name, value in values.items()
    }


def _stretches(whole: Array, chance: np.random.Generator) -> Iterator[Array]:
    count = int(chance.integers(*STRETCHES, endpoint=True))
    gap = int(GAP_SHARE * len(whole))
    inner = np.sort(chance.choice(np.arange(1, 4 * count), count - 1, replace=False))
    cuts: NDArray[np.int64] = inner * len(whole) // (4 * count)
    for start, end in zip([0, *(cuts + gap)], [*cuts, len(whole)], strict=True):
        yield whole[start:end]


def outcome(part: str, number: int) -> Row:
    """What is found in a recording: of every term the true coefficient, and what is told."""
    values, stretches = drawn(part, number)
    start = time.process_time()
    powers = Powers(1, INTERVAL)
    for stretch in stretches:
        powers.add(stretch)
        powers.end()
    (found,) = estimated.noise_terms(powers)
    if found is None:
        raise ValueError("nothing found")
    terms = {}
    for name in TERMS:
        term = found.terms[name]
        terms[name] = {
            "true": values[name],
            "detected": term.detected,
            "value": term.value,
            "sigma": term.sigma,
            "low": term.interval[0],
            "high": term.interval[1],
            "upper": term.upper,
            "p_value": term.p_value,
            "alternatives": list(term.alternatives),
        }
    return {
        "part": part,
        "number": number,
        "stretches": len(stretches),
        "terms": terms,
        "lines": len(found.lines),
        "highest": found.highest,
        "misfit": found.misfit,
        "seconds": time.process_time() - start,
        "code": code(),
    }
