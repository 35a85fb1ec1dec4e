"""docs/recordings.md: every real recording, drafted and through the chain, against what is known.

PYTHONPATH=tests python -m recordings       the recordings are sought as tests/conftest.py does
"""

import os
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import chain
import numpy as np

from inertial.text.cause_names import in_words
from inertial.text.numbers import decimals_of, fixed
from recordings.known import RECORDINGS, Known, Recording, told

PAGE = chain.ROOT / "docs/recordings.md"
VERDICTS = {"usable_within_limits": "usable, with departures"}
HEAD = """# Real recordings

Written by `make recordings`, which drafts a campaign of each recording's logs as `make draft` does,
answers what only a person can know (the rate of logs without a clock, gravity where its source
states one), and runs the chain. Known is what the source of a recording publishes, none of it with
a sigma: each has a method, a gravity and rounding of its own. Ours has one sigma, which contains
the guesses of the draft: gravity anywhere on earth is 0.3 % of a scale, an angle by hand 5 to 10°.
Time is processor time of draft and chain together, s.

| recording | quantity | known x, y, z | ours x, y, z | verdict | causes named | time |
|---|---|---|---|---|---|---|
"""
NOTES = """
What the table does not hold:

- gesture: the y gyro reads −0.015 ± 0.004 °/s per g along z. It is not named, and that is right: a
  g-sensitivity has nine parameters, of which the other eight are within 1.4 sigma of nothing, and
  among all effects that are tested chance gives as much in every fourth such session (p = 0.25).
  From 0.020 °/s per g on it would be named.
- sunsided: its author notes that the x gyro is reversed, by the senses of the turns. Gravity, whose
  direction turns in the accelerometers, shows x and y reversed, −1.00 ± 0.02 and −1.01 ± 0.02 of
  the rate, and z as it is, 0.96 ± 0.06. A reversed z axis of the accelerometers would look the
  same, one reversed gyro would not. The draft sets the axes so, and its report says so under
  remarks; where the axes are left as the columns are named, the reversed signs are a cause there.
"""
NAMES = {"accel": "accelerometer", "gyro": "gyro"}
UNITS = {"m/s2": "m/s²", "deg/s": "°/s", "counts/(m/s2)": "counts per m/s²"}
UNITS["counts/(deg/s)"] = "counts per °/s"


def main() -> None:
    """Run what is there, and write the page."""
    beside = chain.ROOT.parent / "shared/recordings"
    folder = Path(os.environ.get("RECORDINGS", beside))
    if not folder.is_dir():
        sys.exit(f"recordings: they are not at {folder}; set RECORDINGS to where they are")
    lines: list[str] = []
    for recording in RECORDINGS:
        own = list(rows(recording, folder))
        sys.stdout.write("".join(own))
        sys.stdout.flush()
        lines += own
    PAGE.write_text(HEAD + "".join(lines) + NOTES, encoding="utf-8")


def rows(recording: Recording, folder: Path) -> Iterator[str]:
    """The rows of one recording in the table."""
    with tempfile.TemporaryDirectory() as place:
        start = time.process_time()
        campaign = recording.drafted(folder, Path(place) / "data")
        results = chain.run(campaign, Path(place) / "derived", "diagnosis")
        seconds = f"{time.process_time() - start:.0f}"
        causes = Counter(map(in_words, results["diagnosis/causes"]["cause"]))
        named = ", ".join(f"{cause} ({n})" if n > 1 else cause for cause, n in causes.items())
        verdicts = results["diagnosis/verdict"]
        said = [
            f"{NAMES[sensor]} {VERDICTS.get(verdict, verdict.replace('_', ' '))}"
            for sensor, verdict in zip(verdicts["sensor"], verdicts["verdict"], strict=True)
        ]
        first = (recording.name, "; ".join(said), named or "none", seconds)
        for known in recording.known or (None,):
            name, verdict, named, seconds = first
            quantity, theirs, ours = "", "", ""
            if known is not None:
                found = known.ours(results, told(campaign))
                unit = UNITS.get(known.unit, known.unit)
                quantity = f"{NAMES[known.sensor]} {known.quantity}, {unit}"
                theirs, ours = both(known, found)
            yield f"| {name} | {quantity} | {theirs} | {ours} | {verdict} | {named} | {seconds} |\n"
            first = ("", "", "", "")


def both(known: Known, found: np.ndarray) -> tuple[str, str]:
    """Theirs and ours, x, y and z, to two digits of our sigma."""
    decimals = [decimals_of(sigma) for _value, sigma in found]
    most = max((d for d in decimals if d is not None), default=2)
    ours = [
        "not determined"
        if not np.isfinite(value)
        else f"{fixed(value, most)} ± {fixed(sigma, most)}"
        for value, sigma in found.tolist()
    ]
    return ", ".join(fixed(value, most) for value in known.values), ", ".join(ours)


if __name__ == "__main__":
    main()
