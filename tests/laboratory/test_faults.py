"""Every fault by the bytes of the log: exactly what it says is there, and nothing else."""

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from math import cos, pi
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from inertial.arrays import Integers
from laboratory import Recording, SpecificationError, perform, specify
from laboratory.faults import FAULTS

Spans = list[tuple[int, int]]
Strike = Callable[..., tuple["Written", Spans]]

DT = 10_000_000  # ns
FORCE, RATE = 0.05 / 2**15 / 0.01, 0.1 / (3600 * 256) / 0.01  # of a count, m/s² and rad/s
ACCEL_Y, ACCEL_Z, GYRO_X, GYRO_Y, GYRO_Z = 1, 2, 3, 4, 5
TURN = {"do": "turn", "up": "+z", "degrees": 90, "rate_deg_s": 90, "accel_deg_s2": 180}
PLAN = [
    {"id": "rest", "do": "rest", "up": "+z", "seconds": 4, "log": "rest.asc"},
    {"id": "turn", **TURN, "log": "turn.asc"},  # 1.5 s, and 0.5 s of rest on both sides
]


@dataclass(frozen=True)
class Written:
    """What stands in a log, read from its text."""

    stamps: Integers  # ns of GPS time, (n,)
    counts: Integers  # (n, 6), accelerometer x y z, gyro x y z

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Written) and (
            np.array_equal(self.stamps, other.stamps) and np.array_equal(self.counts, other.counts)
        )


def written(log: bytes) -> Written:
    """The records of a log; every line whole, its checksum right, its header like its body."""
    stamps, counts = [], []
    for line in log.split(b"\r\n")[:-1]:
        text, _, checksum = line[1:].partition(b"*")
        assert line[:1] == b"%" and int(checksum, 16) == zlib.crc32(text, 2**32 - 1) ^ (2**32 - 1)
        header, _, body = text.partition(b";")
        week, second, status, *sent = body.split(b",")
        whole, _, nanoseconds = second.partition(b".")
        stamps.append((int(week) * 604_800 + int(whole)) * 10**9 + int(nanoseconds))
        z, minus_y, x, gyro_z, gyro_minus_y, gyro_x = map(int, sent)
        counts.append((x, -minus_y, z, gyro_x, -gyro_minus_y, gyro_z))
        _, header_week, header_second = header.split(b",")
        shown = float(header_week) * 604_800 + float(header_second)
        assert shown == pytest.approx(stamps[-1] / 1e9, abs=6e-4)
        assert status == b"00000077"
    assert log.endswith(b"\r\n") or not log
    return Written(np.array(stamps, dtype=np.int64), np.array(counts, np.int64).reshape(-1, 6))


@pytest.fixture
def campaign(demo: dict[str, Any]) -> dict[str, Any]:
    """Two short logs of the demo's IMU, with its noise, without effects and faults."""
    demo["campaign"] |= {"plan": PLAN}
    return demo | {"handling": {"still_s": 0.5}, "effects": {}, "faults": []}


@pytest.fixture
def spoil(campaign: dict[str, Any]) -> Callable[..., Recording]:
    """The campaign, performed with some faults."""
    return lambda *faults: perform(specify(campaign | {"faults": list(faults)}))


@pytest.fixture
def clean(spoil: Callable[..., Recording]) -> dict[str, Written]:
    """What is in the logs without any fault."""
    return {name: written(log) for name, log in spoil().logs.items()}


@pytest.fixture
def strike(spoil: Callable[..., Recording], clean: dict[str, Written]) -> Strike:
    """One log after one fault of it, and what is told of it; the other log is as it was."""

    def struck(name: str, log: str = "turn.asc", **parameters: Any) -> tuple[Written, Spans]:
        recording = spoil({name: {"log": log, **parameters}})
        other = next(one for one in recording.logs if one != log)
        assert written(recording.logs[other]) == clean[other]
        found = written(recording.logs[log])
        for one in recording.spoiled:
            assert (one.fault, one.log) == (name, log)
            assert one.first_stamp == found.stamps[one.first]
            assert one.last_stamp == found.stamps[one.after - 1]
        return found, [(one.first, one.after) for one in recording.spoiled]

    return struck


def with_counts(log: Written, rows: Any, channel: int, counts: Any) -> Written:
    """The same log, but for some counts of one channel."""
    changed = log.counts.copy()
    changed[rows, channel] = counts
    return Written(log.stamps, changed)


# ---- records


def test_lose(strike: Strike, clean: dict[str, Written]) -> None:
    found, spans = strike("lose", line=11, samples=20)
    before = clean["turn.asc"]
    assert np.array_equal(found.stamps, np.delete(before.stamps, range(10, 30)))
    assert np.array_equal(found.counts, np.delete(before.counts, range(10, 30), axis=0))
    assert spans == [(10, 11)]


def test_drop(strike: Strike, clean: dict[str, Written]) -> None:
    """Lines 101 and 102 make one gap; where the log ends nothing comes after the gap."""
    lines = [7, 102, 101, len(clean["turn.asc"].stamps)]
    found, spans = strike("drop", lines=lines)
    before, rows = clean["turn.asc"], [line - 1 for line in lines]
    assert np.array_equal(found.stamps, np.delete(before.stamps, rows))
    assert np.array_equal(found.counts, np.delete(before.counts, rows, axis=0))
    assert spans == [(6, 7), (99, 100)]
    assert np.flatnonzero(np.diff(found.stamps) != DT).tolist() == [5, 98]


def test_repeat_with_the_same_stamp(strike: Strike, clean: dict[str, Written]) -> None:
    found, spans = strike("repeat", line=50, samples=3, stamps="same")
    before = clean["turn.asc"]
    assert np.array_equal(found.stamps, np.insert(before.stamps, 50, before.stamps[[49] * 3]))
    counts = np.insert(before.counts, [50] * 3, before.counts[49], axis=0)
    assert np.array_equal(found.counts, counts)
    assert spans == [(50, 53)]


def test_repeat_with_running_stamps(strike: Strike, clean: dict[str, Written]) -> None:
    found, spans = strike("repeat", line=50, samples=3, stamps="running")
    before = clean["turn.asc"]
    assert np.array_equal(found.stamps, before.stamps)
    counts = before.counts.copy()
    counts[50:53] = counts[49]
    assert np.array_equal(found.counts, counts)
    assert spans == [(50, 53)]


# ---- readings


@pytest.mark.parametrize(
    ("channel", "column", "size", "counts"),
    [
        ("accel_z", ACCEL_Z, {"size_m_s2": 2.0}, 13107),  # 2 / 1.52588e-4 = 13107.2
        ("gyro_y", GYRO_Y, {"size_rad_s": -0.01}, -922),  # 0.01 / 1.08507e-5 = 921.6
    ],
)
def test_spikes(
    strike: Strike,
    clean: dict[str, Written],
    channel: str,
    column: int,
    size: dict[str, float],
    counts: int,
) -> None:
    found, spans = strike("spikes", channel=channel, lines=[90, 10, 11], **size)
    before, rows = clean["turn.asc"], [9, 10, 89]
    assert found == with_counts(before, rows, column, before.counts[rows, column] + counts)
    assert spans == [(9, 11), (89, 90)]


@pytest.mark.parametrize(("period", "phase"), [(1.0, 0.25), (0.1, 0.03)])
def test_glitch(strike: Strike, clean: dict[str, Written], period: float, phase: float) -> None:
    """Every record whose GPS time is `phase` after a whole period, whatever the log's beginning."""
    wrong = {"period_s": period, "phase_s": phase, "size_rad_s": 0.01}
    found, spans = strike("glitch", channel="gyro_y", **wrong)
    before = clean["turn.asc"]
    at = (before.stamps - round(phase * 1e9)) % round(period * 1e9)
    away = np.minimum(at, round(period * 1e9) - at)
    rows = np.flatnonzero(away < DT // 2)  # the record nearest to that instant
    assert abs(len(rows) - 2.5 / period) <= 1  # in 2.5 s
    assert found == with_counts(before, rows, GYRO_Y, before.counts[rows, GYRO_Y] + 922)
    assert spans == [(row, row + 1) for row in rows]


@pytest.mark.parametrize("degrees", [90, -90])
def test_clip(campaign: dict[str, Any], degrees: float) -> None:
    """A gyro that ends at 1 rad/s, on a turn at 1.57 rad/s, both ways round."""
    campaign["campaign"]["plan"] = [PLAN[1] | {"degrees": degrees}]
    fault = {"clip": {"log": "turn.asc", "channel": "gyro_z", "limit_rad_s": 1.0}}
    before = written(perform(specify(campaign)).logs["turn.asc"])
    recording = perform(specify(campaign | {"faults": [fault]}))
    limit = round(1.0 / RATE)
    beyond = np.flatnonzero(np.abs(before.counts[:, GYRO_Z]) > limit)
    assert 50 < len(beyond) < 150 and np.all(np.diff(beyond) == 1)
    counts = int(np.sign(degrees)) * limit
    assert written(recording.logs["turn.asc"]) == with_counts(before, beyond, GYRO_Z, counts)
    (span,) = recording.spoiled
    assert (span.first, span.after) == (beyond[0], beyond[-1] + 1)


def test_clip_for_some_samples(strike: Strike, clean: dict[str, Written]) -> None:
    found, spans = strike("clip", channel="accel_z", limit_m_s2=5.0, line=3, samples=10)
    counts = round(5.0 / FORCE)
    assert found == with_counts(clean["turn.asc"], slice(2, 12), ACCEL_Z, counts)
    assert spans == [(2, 12)]


@pytest.mark.parametrize("reads", ["zero", "frozen"])
def test_kill(strike: Strike, clean: dict[str, Written], reads: str) -> None:
    before = clean["turn.asc"]
    rows = slice(99, 149)
    counts = 0 if reads == "zero" else before.counts[99, GYRO_Z]
    found, spans = strike("kill", channel="gyro_z", reads=reads, line=100, samples=50)
    assert found == with_counts(before, rows, GYRO_Z, counts)
    assert spans == [(99, 149)]
    found, spans = strike("kill", channel="accel_y", reads="zero")
    assert found == with_counts(before, slice(None), ACCEL_Y, 0)
    assert spans == [(0, len(before.stamps))]


@pytest.mark.parametrize("size", [7.3e-5, -7.3e-5, 2e-3])
def test_step(strike: Strike, clean: dict[str, Written], size: float) -> None:
    """Half a count or 13: the sum from the first sample on is right to a count, and to its mean."""
    before, n = clean["turn.asc"], len(clean["turn.asc"].stamps)
    for after, more in ((n, {}), (150, {"samples": 131})):
        found, spans = strike("step", channel="accel_y", size_m_s2=size, line=20, **more)
        added = found.counts[:, ACCEL_Y] - before.counts[:, ACCEL_Y]
        assert not added[:19].any() and not added[after:].any()
        wanted = np.arange(1, after - 19 + 1) * size / FORCE
        off = np.cumsum(added[19:after]) - wanted
        assert np.abs(off).max() <= 1 and abs(off.mean()) < 4 * 0.41 / np.sqrt(len(off))
        assert np.abs(added[19:after] - size / FORCE).max() <= 2
        power = np.abs(np.fft.rfft(off - off.mean()))[1:] ** 2
        assert power.max() < 15 * power.mean()  # white: of rounding by one rule half is one line
        assert found == with_counts(before, slice(None), ACCEL_Y, found.counts[:, ACCEL_Y])
        assert spans == [(19, after)]


def test_oscillate(strike: Strike, clean: dict[str, Written]) -> None:
    """7 Hz, 0.02 rad/s: every sum is the exact integral, A (1 − cos 2πf t) / 2πf, to a count."""
    before, n = clean["turn.asc"], len(clean["turn.asc"].stamps)
    wave = {"frequency_hz": 7, "amplitude_rad_s": 0.02}
    for after, more in ((n, {}), (169, {"samples": 150})):
        found, spans = strike("oscillate", channel="gyro_x", line=20, **wave, **more)
        added = found.counts[:, GYRO_X] - before.counts[:, GYRO_X]
        assert not added[:19].any() and not added[after:].any()
        angular, ends = 2 * pi * 7, np.arange(1, after - 19 + 1) * 0.01
        wanted = 0.02 * (1 - np.cos(angular * ends)) / angular / (RATE * 0.01)
        assert np.abs(np.cumsum(added[19:after]) - wanted).max() <= 0.5 + 1e-6
        assert np.abs(added).max() * RATE == pytest.approx(0.02, rel=0.02)
        assert found == with_counts(before, slice(None), GYRO_X, found.counts[:, GYRO_X])
        assert spans == [(19, after)]


def test_an_oscillation_goes_on_through_a_gap_and_by_the_true_time(
    spoil: Callable[..., Recording], clean: dict[str, Written]
) -> None:
    wave = {"frequency_hz": 7, "amplitude_rad_s": 0.02}
    recording = spoil(
        {"turn_back": {"log": "turn.asc", "line": 30, "seconds": 3.05}},
        {"lose": {"log": "turn.asc", "line": 51, "samples": 33}},
        {"oscillate": {"log": "turn.asc", "channel": "gyro_x", "line": 1, **wave}},
    )
    found = written(recording.logs["turn.asc"]).counts[:, GYRO_X]
    added = found - np.delete(clean["turn.asc"].counts, range(50, 83), axis=0)[:, GYRO_X]
    k, angular = 100, 2 * pi * 7 * 0.01
    wanted = 0.02 / angular * (cos(angular * (k + 33)) - cos(angular * (k + 34))) / RATE
    assert added[k] == pytest.approx(wanted, abs=1)


def test_swap_in_every_log(spoil: Callable[..., Recording], clean: dict[str, Written]) -> None:
    """The readings keep their own signs, also that of y, which the receiver turns over."""
    recording = spoil({"swap": {"log": "all", "sensor": "accelerometer", "axes": ["z", "y"]}})
    for name, before in clean.items():
        counts = before.counts[:, [0, 2, 1, 3, 4, 5]]
        assert written(recording.logs[name]) == Written(before.stamps, counts)
    told = [(one.fault, one.log, one.first, one.after) for one in recording.spoiled]
    assert told == [("swap", name, 0, len(log.stamps)) for name, log in clean.items()]


def test_swap_and_flip_for_some_samples(strike: Strike, clean: dict[str, Written]) -> None:
    before, some = clean["turn.asc"], {"line": 101, "samples": 30}
    found, spans = strike("swap", sensor="gyro", axes=["x", "z"], **some)
    counts = before.counts.copy()
    counts[100:130] = counts[100:130][:, [0, 1, 2, 5, 4, 3]]
    assert (found, spans) == (Written(before.stamps, counts), [(100, 130)])
    found, spans = strike("flip", sensor="gyro", axis="z", **some)
    turned = -before.counts[100:130, GYRO_Z]
    assert found == with_counts(before, slice(100, 130), GYRO_Z, turned)
    assert spans == [(100, 130)]
    found, _ = strike("flip", sensor="accelerometer", axis="y")
    assert found == with_counts(before, slice(None), ACCEL_Y, -before.counts[:, ACCEL_Y])


# ---- stamps


def test_turn_back(strike: Strike, clean: dict[str, Written]) -> None:
    found, spans = strike("turn_back", line=100, seconds=0.5)
    before = clean["turn.asc"]
    assert np.array_equal(found.counts, before.counts)
    assert np.array_equal(before.stamps - found.stamps, np.repeat([0, 500_000_000], [99, 151]))
    assert np.flatnonzero(np.diff(found.stamps) < 0).tolist() == [98]
    assert spans == [(99, 100)]


@pytest.mark.parametrize("ppm", [5000.0, -200.0])
def test_drift(strike: Strike, clean: dict[str, Written], ppm: float) -> None:
    """Every interval is off by ppm, to a nanosecond; after them the offset stays."""
    before, n = clean["turn.asc"], len(clean["turn.asc"].stamps)
    for line, samples in ((1, n - 1), (41, 100)):
        some = {} if line == 1 else {"line": line, "samples": samples}
        found, spans = strike("drift", ppm=ppm, **some)
        assert np.array_equal(found.counts, before.counts)
        inside = np.clip(np.arange(n) - (line - 1), 0, samples)
        offset = found.stamps - before.stamps
        assert np.array_equal(offset, np.rint(inside * DT * ppm * 1e-6))
        assert spans == [(line, line + samples)]


def test_jitter(strike: Strike, clean: dict[str, Written]) -> None:
    """400 stamps with 1 ms: their scatter is 1 ms within 5 sigma, 1/√800 each."""
    found, spans = strike("jitter", log="rest.asc", sigma_s=1e-3)
    before = clean["rest.asc"]
    assert np.array_equal(found.counts, before.counts)
    off = (found.stamps - before.stamps) / 1e6
    assert len(off) == 400 and np.std(off) == pytest.approx(1, abs=5 / np.sqrt(800))
    assert abs(np.mean(off)) < 5 / np.sqrt(400)
    assert spans == [(0, 400)]
    assert strike("jitter", log="rest.asc", sigma_s=1e-3)[0] == found


def test_jitter_to_a_grid(strike: Strike, clean: dict[str, Written]) -> None:
    found, spans = strike("jitter", rounded_to_s=0.004, line=11, samples=100)
    off, before = found.stamps - clean["turn.asc"].stamps, clean["turn.asc"]
    assert not (found.stamps[10:110] % 4_000_000).any()
    assert not off[:10].any() and not off[110:].any() and np.abs(off).max() <= 2_000_000
    assert np.array_equal(found.counts, before.counts)
    assert spans == [(10, 110)]


def test_chance_is_by_log_and_goes_on(
    campaign: dict[str, Any], spoil: Callable[..., Recording], clean: dict[str, Written]
) -> None:
    """Another seed, another log or a second time: other offsets. Another fault: the same."""
    jitter = {"jitter": {"log": "all", "sigma_s": 1e-3}}
    once, twice = spoil(jitter), spoil(jitter, jitter)
    behind = spoil(
        {"step": {"log": "all", "channel": "gyro_x", "size_rad_s": 1, "line": 1}}, jitter
    )
    other = perform(specify(campaign | {"faults": [jitter], "seed": 1}))

    def offsets(recording: Recording, log: str) -> Integers:
        return written(recording.logs[log]).stamps[:250] - clean[log].stamps[:250]

    first = offsets(once, "turn.asc")
    assert np.array_equal(first, offsets(behind, "turn.asc"))
    for another in (
        offsets(once, "rest.asc"),
        offsets(other, "turn.asc"),
        offsets(twice, "turn.asc") - first,
    ):
        assert abs(np.corrcoef(first, another)[0, 1]) < 5 / np.sqrt(250)


# ---- names, and several faults together


def test_exchange(spoil: Callable[..., Recording], clean: dict[str, Written]) -> None:
    """Byte for byte; what comes after finds the log that now has the name."""
    plain = spoil()
    swapped = spoil({"exchange": {"logs": ["turn.asc", "rest.asc"]}})
    assert list(swapped.logs) == list(plain.logs)
    assert swapped.logs["rest.asc"] == plain.logs["turn.asc"]
    assert swapped.logs["turn.asc"] == plain.logs["rest.asc"]
    told = [(one.log, one.first, one.after) for one in swapped.spoiled]
    assert told == [("rest.asc", 0, 250), ("turn.asc", 0, 400)]
    back = {"turn_back": {"log": "turn.asc", "line": 301, "seconds": 1}}
    later = spoil({"exchange": {"logs": ["turn.asc", "rest.asc"]}}, back)
    assert np.argmin(np.diff(written(later.logs["turn.asc"]).stamps)) == 299
    with pytest.raises(SpecificationError, match=r"which has 250$"):
        spoil(back, {"exchange": {"logs": ["turn.asc", "rest.asc"]}})


def test_what_was_spoiled_stays_with_its_records(
    spoil: Callable[..., Recording], clean: dict[str, Written]
) -> None:
    """Eight faults of one log: each is told where it is found in the log as written at last."""
    faults: list[dict[str, Any]] = [
        {"spikes": {"lines": [20, 60, 150], "channel": "gyro_x", "size_rad_s": 0.5}},
        {"step": {"line": 101, "samples": 50, "channel": "accel_y", "size_m_s2": 3.0}},
        {"lose": {"line": 60, "samples": 1}},  # and a spike with it
        {"lose": {"line": 120, "samples": 10}},  # in the middle of the step
        {"repeat": {"line": 10, "samples": 5, "stamps": "same"}},
        {"turn_back": {"line": 200, "seconds": 2}},
        {"drop": {"lines": [1, 124, 200]}},  # a line behind a gap; a line where time goes back
        {"drift": {"line": 209, "samples": 20, "ppm": 500}},
    ]
    log = {"log": "turn.asc"}
    recording = spoil(*({name: log | p} for fault in faults for name, p in fault.items()))
    found, before = written(recording.logs["turn.asc"]), clean["turn.asc"]
    told: dict[str, Spans] = {name: [] for name in FAULTS}
    for one in recording.spoiled:
        told[one.fault].append((one.first, one.after))

    # The true samples, 0 … 249, in the order in which they stand in the log at last.
    source = np.arange(250)
    source = np.delete(source, 59)
    source = np.delete(source, range(119, 129))
    source = np.insert(source, 10, [9] * 5)
    source = np.delete(source, [0, 123, 199])
    assert len(source) == len(found.stamps)
    added = found.counts - before.counts[source]
    assert runs(added[:, GYRO_X] != 0) == told["spikes"]
    assert runs(added[:, ACCEL_Y] != 0) == told["step"]
    gaps = np.flatnonzero(np.diff(source) > 1) + 1
    assert sorted({first for first, _ in [*told["lose"], *told["drop"]]}) == [0, *gaps.tolist()]
    (back,) = np.flatnonzero(np.diff(found.stamps) < 0) + 1
    assert told["turn_back"] == [(back, back + 1)]
    assert told["repeat"] == runs(np.insert(np.diff(source) == 0, 0, False))
    intervals = np.diff(found.stamps) - np.diff(source) * DT
    fast = (intervals == 5000).nonzero()[0] + 1
    assert told["drift"] == [(fast[0], fast[-1] + 1)] and len(fast) == 20


def runs(true: NDArray[np.bool_]) -> Spans:
    """Where something is true, as first and behind-the-last."""
    rows = np.flatnonzero(true)
    parts = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)
    return [(int(part[0]), int(part[-1]) + 1) for part in parts]


def test_a_log_can_be_lost_whole(spoil: Callable[..., Recording]) -> None:
    recording = spoil(
        {"lose": {"log": "turn.asc", "line": 1, "samples": 250}},
        {"exchange": {"logs": ["turn.asc", "rest.asc"]}},
    )
    assert recording.logs["rest.asc"] == b""
    assert {one.log for one in recording.spoiled} == {"turn.asc"}


# ---- refusals

TURN_LOG = {"log": "turn.asc"}
ACCEL = TURN_LOG | {"channel": "accel_x"}
REFUSED: list[tuple[list[dict[str, Any]], str]] = [
    (
        [{"spikes": ACCEL | {"lines": [9, 251], "size_m_s2": 1}}],
        "faults[0].spikes: found lines up to 251; expected lines of turn.asc, which has 250",
    ),
    (
        [
            {"lose": TURN_LOG | {"line": 1, "samples": 50}},
            {"step": ACCEL | {"line": 201, "size_m_s2": 1}},
        ],
        "faults[1].step: found lines up to 201; expected lines of turn.asc, which has 200 "
        "after the faults before this one",
    ),
    (
        [{"swap": {"log": "all", "sensor": "gyro", "axes": ["x", "y"], "line": 251}}],
        "faults[0].swap: found lines up to 251; expected lines of turn.asc, which has 250",
    ),
    (
        [{"repeat": TURN_LOG | {"line": 241, "samples": 10, "stamps": "running"}}],
        "faults[0].repeat: found lines up to 251; expected lines of turn.asc, which has 250",
    ),
    (
        [{"drift": TURN_LOG | {"ppm": 20, "line": 241, "samples": 10}}],
        "faults[0].drift: found lines up to 251; expected lines of turn.asc, which has 250",
    ),
    (
        [{"exchange": {"logs": ["turn.asc", "tern.asc"]}}],
        "faults[0].exchange.logs: found tern.asc; expected a log of the plan: rest.asc, turn.asc",
    ),
    (
        [{"exchange": {"logs": ["turn.asc", "turn.asc"]}}],
        "faults[0].exchange.logs: found ['turn.asc', 'turn.asc'] (list); "
        "expected two different logs by name",
    ),
    (
        [{"exchange": {"logs": ["turn.asc", "all"]}}],
        "faults[0].exchange.logs[1]: found 'all' (text); expected a log by its own name",
    ),
    (
        [{"spikes": ACCEL | {"lines": [9], "size_rad_s": 1}}],
        "faults[0].spikes.size_m_s2: found nothing; expected m/s², for an accelerometer\n"
        "trial.yaml: faults[0].spikes.size_rad_s: found 1 (number); "
        "expected nothing, because the channel is an accelerometer: m/s²",
    ),
    (
        [{"clip": TURN_LOG | {"channel": "gyro_x", "limit_rad_s": -1}}],
        "faults[0].clip.limit_rad_s: found -1 (number); expected rad/s, 0 or more, for a gyro",
    ),
    (
        [{"oscillate": ACCEL | {"channel": "gyro", "line": 1, "frequency_hz": 1}}],
        "faults[0].oscillate.channel: found 'gyro' (text); "
        "expected one of accel_x, accel_y, accel_z, gyro_x, gyro_y, gyro_z",
    ),
    (
        [{"swap": TURN_LOG | {"sensor": "gyro", "axes": ["x", "x"]}}],
        "faults[0].swap.axes: found ['x', 'x'] (list); expected two different axes, such as [x, y]",
    ),
    (
        [{"drop": TURN_LOG | {"lines": [3, 0]}}],
        "faults[0].drop.lines[1]: found 0 (number); expected a line, counted from 1",
    ),
    (
        [{"jitter": TURN_LOG}],
        "faults[0].jitter: found {'log': 'turn.asc'} (mapping); expected jitter of the stamps, "
        "sigma_s, or rounding, rounded_to_s: one of the two",
    ),
    (
        [{"turn_back": TURN_LOG | {"line": 3, "second": 1}}],
        "faults[0].turn_back.second: found a key that is not known; expected one of log, line, "
        "seconds (did you mean seconds?)\n"
        "trial.yaml: faults[0].turn_back.seconds: found nothing; expected how much earlier, s, "
        "0 or more",
    ),
    (
        [{"kill": ACCEL | {"reads": "nothing"}}],
        "faults[0].kill.reads: found 'nothing' (text); "
        "expected zero: no counts at all; frozen: always the counts of `line`",
    ),
]


@pytest.mark.parametrize(("faults", "message"), REFUSED)
def test_what_cannot_be_is_refused_in_words(
    campaign: dict[str, Any], faults: list[dict[str, Any]], message: str
) -> None:
    with pytest.raises(SpecificationError) as refusal:
        specify(campaign | {"faults": faults}, "trial.yaml")
    assert str(refusal.value) == f"trial.yaml: {message}"


def test_a_refused_fault_does_not_hide_the_next(campaign: dict[str, Any]) -> None:
    faults = [
        {"lose": TURN_LOG | {"line": 200, "samples": 100}},
        {"flip": {"log": "tern.asc", "sensor": "gyro", "axis": "x"}},
        {"drop": TURN_LOG | {"lines": [251]}},
    ]
    with pytest.raises(SpecificationError) as refusal:
        specify(campaign | {"faults": faults})
    places = [complaint.place for complaint in refusal.value.complaints]
    assert places == ["faults[0].lose", "faults[1].flip.log", "faults[2].drop"]


def test_knock(strike: Strike, clean: dict[str, Written]) -> None:
    """All channels ring, at 30 Hz and below the peak; at the end nothing of it remains."""
    before = clean["turn.asc"]
    blow = {"peak_m_s2": 80.0, "peak_rad_s": 2.0, "frequency_hz": 30.0, "decay_s": 0.05}
    found, spans = strike("knock", line=101, **blow)
    added = found.counts - before.counts
    assert not added[:100].any() and added[100:103].any(axis=0).all()
    assert (np.abs(added[:, :3]).max(axis=0) * FORCE <= 80).all()
    assert (np.abs(added[:, 3:]).max(axis=0) * RATE <= 2).all()
    assert (np.abs(added.sum(axis=0)) <= 1).all()
    k = np.arange(1, 11)
    ringing = np.exp(-k * 0.01 / 0.05) * np.sin(2 * pi * 30 * k * 0.01)
    sums = np.cumsum(added[100:110], axis=0).astype(np.float64)
    shares = sums[0] / ringing[0]
    assert np.abs(sums - ringing[:, None] * shares).max() <= 0.5 + np.abs(1 / ringing[0])
    assert np.array_equal(found.stamps, before.stamps)
    assert spans[0][0] == 100
