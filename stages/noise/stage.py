"""White noise of every channel in every manoeuvre, and all terms of the noise at rest."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, groupby, pairwise, product

import numpy as np
import pandas as pd

from inertial import tables
from inertial.arrays import Array, Integers
from inertial.campaign.findings import Finding, table_of
from inertial.campaign.masked_samples import MaskedSamples, pieces
from inertial.campaign.noise_levels import RESIDUALS, STATED, effective_levels
from inertial.campaign.records import Clock, Row, clocks_of, rows_of
from inertial.campaign.references import BY_HAND
from inertial.estimation.low_pass import AVERAGE
from inertial.sensors import COLUMNS, PLURAL
from inertial.signal.scatter import smallest_step
from inertial.tables.stage import Stage, Tables
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import quantity
from stages.noise.declared import DECLARED
from stages.noise.rounding import Level, carried_rounding, count_sizes, rounding_levels
from stages.noise.spectra import Spectra, shapes_of
from stages.noise.static_stretches import Filtered, SensorNoise, StaticStretches

# ---- White noise at rest that is far above the data sheet's: the IMU is another one, or is shaken.

CAUSE = "noise_above_data_sheet"
MAX_RATIO = 3.0  # to the data sheet: types differ by less from one to the next, and with the range


def louder(terms: Sequence[Row]) -> Iterator[Finding]:
    """A finding for each sensor of which channels are; `terms`: rows of the terms of the noise."""
    above = [
        row
        for row in terms
        if row["term"] == "white_noise"
        and row["value"]
        and row["data_sheet"]
        and row["value"] > MAX_RATIO * row["data_sheet"]
    ]
    for sensor, rows in groupby(above, lambda row: row["channel"].partition("_")[0]):
        own = list(rows)
        most = max(own, key=lambda row: row["value"] / row["data_sheet"])
        ratio = most["value"] / most["data_sheet"]
        unit = quantity("white_noise", most["unit"]).laboratory
        yield Finding(
            id=f"noise/{CAUSE}/{sensor}",
            cause=CAUSE,
            sensor=sensor,
            size=ratio,
            severity=1,
            sentence=_(
                "At rest the {sensors} {axes} have up to {ratio} times the white noise of the data "
                "sheet: {axis} {value} {unit} in place of {stated}.",
                sensors=PLURAL[sensor],
                axes=", ".join(row["channel"][-1] for row in own),
                ratio=significant(ratio, 3),
                axis=most["channel"][-1],
                value=significant(unit.of(most["value"]), 3),
                stated=significant(unit.of(most["data_sheet"]), 3),
                unit=unit.name,
            ),
            consequence=_(
                "The sigmas stand, for they are by the noise that is measured; they are larger "
                "than those that the instrument could have."
            ),
            action=_(
                "See whether it is the instrument, and the range, of the data sheet; look for what "
                "shakes the table, and for a supply or a connector that is not right."
            ),
        )


# ---- A low pass behind which the noise at rest is, so slow that it delays what is read of a ramp.

SLOW = "slow_low_pass"
MIN_DELAY_S = 0.05  # a ramp of a table has corners no sharper than that
SETTLED = 7.0  # delays, after which a thousandth is left behind a filter of first order


def slow(noise_at_rest: SensorNoise) -> Iterator[Finding]:
    """A finding for a sensor whose channels are late; where rests are over sooner, it spoils."""
    sensor, filtered = noise_at_rest.sensor, noise_at_rest.filtered
    late = {channel: own.low_pass for channel, own in filtered.items()}
    late = {channel: own for channel, own in late.items() if own.delay > MIN_DELAY_S}
    if not late:
        return
    most = max(late.values(), key=lambda own: own.delay)
    yield Finding(
        id=f"noise/{SLOW}/{sensor}",
        cause=SLOW,
        sensor=sensor,
        size=most.delay,
        unit="s",
        severity=3 if SETTLED * most.delay > noise_at_rest.usual else 1,
        sentence=_(
            "The noise of the {sensors} {axes} at rest is that behind a low pass of {corner} Hz "
            "({kind}): what they read of a motion is late by {delay} s.",
            sensors=PLURAL[sensor],
            axes=", ".join(channel[-1] for channel in late),
            corner=significant(most.corner, 2),
            kind=_("a moving average")
            if most.order == AVERAGE
            else _("of order {order}", order=most.order),
            delay=significant(most.delay, 2),
        ),
        consequence=_(
            "In ramps the two sensors do not read the same moment, which the sigmas there allow "
            "for. After each motion the filter settles for {seconds} s, of which what begins "
            "sooner contains a part.",
            seconds=significant(SETTLED * most.delay, 2),
        ),
        action=_(
            "Record without the filter, or with one of a higher frequency: means have as little "
            "noise without it. Else rest for longer than it settles after each motion."
        ),
    )


# ---- The stage.

MAX_SAMPLES = 32768  # of one periodogram: bounds the memory of a long log
PHASES = {"rest": "rest", "rest-before": "rest", "rest-after": "rest", "steady": "steady"}
LEAST_SIGMA = {"accel": 1e-6, "gyro": 1e-8}  # m/s² and rad/s: no mean is known better


def noise(
    masked_samples: MaskedSamples,
    segments: pd.DataFrame,
    by_hand: bool,
    clocks: pd.DataFrame,
    gaps: pd.DataFrame,
    sensors: pd.DataFrame,
    carried: frozenset[tuple[str, str]],
    of_means: Sequence[Row],
    *,
    from_hz: float,
    to_hz: float,
) -> Tables:
    """White noise by manoeuvre, phase (rest or steady) and channel; the terms of each channel.

    by_hand : whether positions are set by hand: what moves at rest is the support as well
    carried : logs and sensors whose counts carry over what they leave
    of_means : the levels of means without time
    """
    sheet = {f"{row['sensor']}_{row['axis']}": row for row in rows_of(sensors)}
    spectra, static, counts = _read(
        _unbroken(masked_samples, gaps),
        _quiet(segments),
        clocks_of(clocks),
        carried,
        (from_hz, to_hz),
        by_hand,
    )
    noises = list(static.noises(counts))
    _without_quantisation(spectra, noises)
    shapes = shapes_of(spectra)
    rows = [
        row | {"data_sheet": sheet[row["channel"]]["white_noise"]}
        for (manoeuvre, phase), collected in spectra.items()
        for row in collected.rows(manoeuvre, phase, shapes)
    ]
    filtered = {channel: own for each in noises for channel, own in each.filtered.items()}
    measured = pd.DataFrame(before_filters(rows, filtered)) if rows else tables.NOISE.empty()
    drifts = dict(chain.from_iterable(n.drifts(sheet) for n in noises))
    for channel, quantisation in carried_rounding(spectra, counts, measured).items():
        drifts[channel] = {"quantisation": quantisation, **drifts.get(channel, {})}
    levels = effective_levels(measured, drifts, rounding_levels(spectra, counts))
    if of_means:
        own = pd.DataFrame(of_means, columns=levels.columns)
        levels = pd.concat([levels, own]) if rows else own
    terms = [row for each in noises for row in each.term_rows(sheet)]
    return {
        "noise": measured,
        "levels": levels,
        "allan": [row for each in noises for row in each.allan_rows()],
        "spectra": [row for each in noises for row in each.spectrum_rows()],
        "terms": terms,
        "findings": table_of(
            [
                *(one for each in noises for one in slow(each)),
                *([] if by_hand else louder(terms)),
            ]
        ),
    }


def before_filters(rows: Sequence[Row], filtered: Mapping[str, Filtered]) -> Iterator[Row]:
    """The white noise of each manoeuvre as it is before the filter of its channel.

    In the band of these levels a slow filter leaves a part of it, the same at rest and in motion.
    """
    usual = {
        channel: own.white_noise
        / float(
            np.median(
                [
                    row["white_noise"]
                    for row in rows
                    if row["channel"] == channel and row["phase"] == "rest"
                ]
            )
        )
        for channel, own in filtered.items()
    }
    for row in rows:
        factor = usual.get(row["channel"], 1.0)
        scaled = {key: factor * row[key] for key in ("white_noise", "sigma")}
        yield row | scaled


def _without_quantisation(
    spectra: Mapping[tuple[str, str], Spectra], noises: Sequence[SensorNoise]
) -> None:
    """Leave in the spectra the white noise, beside which quantisation is a term of its own."""
    for noise_at_rest in noises:
        for channel, model in noise_at_rest.quantised.items():
            sensor, axis = channel.split("_")
            for own in spectra.values():
                own.without_quantisation(
                    sensor, tables.AXES.index(axis), model, noise_at_rest.interval
                )


def _read(
    parts: Iterable[tuple[str, Integers, Array, bool]],
    quiet: Sequence[Row],
    clock: Mapping[str, Clock],
    carried: frozenset[tuple[str, str]],
    band: tuple[float, float],
    by_hand: bool,
) -> tuple[dict[tuple[str, str], Spectra], StaticStretches, Array]:
    """From one pass over the samples: spectra by manoeuvre and phase, rests, sizes of counts."""
    lengths = [row["to_record"] - row["from_record"] for row in quiet if row["phase"] != "steady"]
    spectra: dict[tuple[str, str], Spectra] = {}
    static = StaticStretches(max(lengths, default=0), by_hand)
    number = 0
    changes = np.full(len(tables.CHANNELS), np.inf)
    levels_seen: list[Array] = []
    for log, record, values, continues in parts:
        changes = np.minimum(changes, [smallest_step(channel) for channel in values.T])
        levels_seen.append(values[0].copy())  # a view would keep the whole piece
        step = clock[log].interval
        number += not continues
        for row in quiet:
            if row["log"] != log or step is None:
                continue
            chosen = values[(record >= row["from_record"]) & (record < row["to_record"])]
            collected = spectra.setdefault((row["manoeuvre"], PHASES[row["phase"]]), Spectra())
            for start in range(0, len(chosen), MAX_SAMPLES):
                collected.add(chosen[start : start + MAX_SAMPLES], 1 / step, band)
            collected.carried |= {sensor for sensor in COLUMNS if (log, sensor) in carried}
            if row["phase"] != "steady" and len(chosen):
                static.add((row["manoeuvre"], row["phase"], number), chosen, step)
    return spectra, static, count_sizes(changes, np.reshape(levels_seen, (-1, len(changes))))


def set_by_hand(campaign: pd.DataFrame, manoeuvres: pd.DataFrame) -> bool:
    """Whether there is no table that sets positions."""
    free = manoeuvres["do"] == "positions"
    return bool(free.any() or (campaign["table"] == BY_HAND).any())


def _quiet(segments: pd.DataFrame) -> list[Row]:
    """The segments of which the noise is seen: at rest, or at a steady rate."""
    return [row for row in rows_of(segments) if row["phase"] in PHASES]


def carried_counts(ranges: pd.DataFrame) -> frozenset[tuple[str, str]]:
    """Logs and sensors whose counts are increments: what one leaves over is in the next."""
    own = ranges[ranges["increments"].astype(bool)]
    return frozenset(zip(own["log"], own["sensor"], strict=True))


def levels_of_means(
    segments: pd.DataFrame, ranges: pd.DataFrame, blocks: pd.DataFrame, mean_sigmas: pd.DataFrame
) -> list[Row]:
    """The levels of means without time, of which a sample counts as 1 s.

    That of the standard deviation of each mean by its log, or of the stated one of a sample. Where
    the residuals of the fit must show it, next to nothing: the fits estimate what is beyond that as
    a scatter between manoeuvres.
    """
    stated = rows_of(ranges[ranges["sigma"].notna()])
    in_log = _stated_levels(blocks, mean_sigmas) if stated else {}
    levels = []
    for row, of_log in product(_quiet(segments), stated):
        if row["log"] == of_log["log"]:
            place = (row["manoeuvre"], PHASES[row["phase"]])
            channel = f"{of_log['sensor']}_{of_log['axis']}"
            known = in_log.get((*place, channel), of_log["sigma"])
            level = known or LEAST_SIGMA[of_log["sensor"]]
            levels.append(
                {
                    **dict(zip(("manoeuvre", "phase"), place, strict=True)),
                    "channel": channel,
                    **dict.fromkeys(("white_noise", "measured", "per_sample"), level),
                    "sigma": 0.0,
                    "source": STATED if known else RESIDUALS,
                    "degrees": np.inf,
                }
            )
    return levels


def _stated_levels(blocks: pd.DataFrame, mean_sigmas: pd.DataFrame) -> dict[Level, float]:
    """The level of each manoeuvre, phase and channel whose log states the sigma of each mean.

    A mean that counts as c samples, c s, has the weight c, so the mean of several has the sigma
    √Σ(c σ)² / Σc, and the level is that times √Σc.
    """
    means = (
        blocks[blocks["log"].isin(mean_sigmas["log"])]
        .melt(
            ["manoeuvre", "phase", "log", "from_record", "count"], list(tables.CHANNELS), "channel"
        )
        .dropna(subset="value")
    )
    sigmas = mean_sigmas.assign(channel=mean_sigmas["sensor"] + "_" + mean_sigmas["axis"])
    both = means.merge(
        sigmas, left_on=["log", "from_record", "channel"], right_on=["log", "record", "channel"]
    )
    both = both[both["phase"].isin(list(PHASES))]
    both = both.assign(phase=both["phase"].map(PHASES), square=(both["count"] * both["sigma"]) ** 2)
    sums = both.groupby(["manoeuvre", "phase", "channel"])[["count", "square"]].sum()
    levels = (sums["square"] / sums["count"]) ** 0.5
    return dict(zip(levels.index.to_list(), levels.to_list(), strict=True))


def _unbroken(
    recorded: MaskedSamples, gaps: pd.DataFrame
) -> Iterator[tuple[str, Integers, Array, bool]]:
    """Records of one log without a gap or a masked record between them.

    Log, numbers, values, and whether they continue those before. A record that repeats an earlier
    one took no time: those beside it follow each other.
    """
    columns = ["record", *tables.CHANNELS]
    before: tuple[str, int, bool, bytes] | None = None  # log, next sample, masks
    repeated: dict[str, int] = defaultdict(int)  # records of each log so far
    for log, piece in pieces(recorded.samples, columns, recorded.repairs):
        record = piece["record"]
        values = np.column_stack([piece[channel] for channel in tables.CHANNELS])
        starts = gaps.loc[gaps["log"] == log, "record"].to_numpy(np.int64)
        masked = recorded.masked.of(log, record)
        values[masked.channels] = np.nan
        sample = record - repeated[log] - np.cumsum(masked.repeated)
        repeated[log] += int(masked.repeated.sum())
        once = ~masked.repeated
        record, sample, values = record[once], sample[once], values[once]
        bad, here = masked.lost[once], masked.channels[once]
        breaks = (np.diff(sample) != 1) | np.isin(record[1:], starts) | np.diff(bad)
        breaks |= (here[1:] != here[:-1]).any(axis=1)
        edges = [0, *(np.flatnonzero(breaks) + 1).tolist(), len(record)] if len(record) else []
        for first, after in pairwise(edges):
            start = (log, int(sample[first]), bool(bad[first]), here[first].tobytes())
            continues = start == before and int(record[first]) not in starts
            before = (log, int(sample[after - 1]) + 1, *start[2:])
            if not bad[first]:
                yield log, record[first:after], values[first:after], continues


STAGE = Stage(
    noise,
    DECLARED,
    gathers={
        "masked_samples": MaskedSamples,
        "by_hand": set_by_hand,
        "carried": carried_counts,
        "of_means": levels_of_means,
    },
)
