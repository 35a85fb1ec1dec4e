"""A temperature that changes while it is recorded, or is stated otherwise than it was recorded."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

from inertial.arrays import Array, Booleans
from inertial.sensors import CHANNELS
from inertial.signal.detector import Description, Detector, Event, Log, Windows
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import DEGREE, ICE_POINT, STANDARD_GRAVITY

# K. A consumer MEMS then moves by as much as it is calibrated to; a thermometer is sure of it.
MAX_DRIFT = 1.0
MEDIAN_WINDOWS = 5  # windows of a running median, by which wrong readings of the thermometer go
MG = STANDARD_GRAVITY * 1e-3  # m/s²
# Per K: biases of accelerometers, m/s², and gyros, rad/s, at least and at most; scale factors, 1.
CONSUMER = ((0.1 * MG, 1.0 * MG), (0.005 * DEGREE, 0.08 * DEGREE), 2e-4)
TACTICAL = (0.1 * MG, 1.0 * DEGREE / 3600)
MAX_ATTITUDE_ANGLE = 0.1  # rad between specific forces that are of one attitude
MAX_RATE_DIFFERENCE = 1 * DEGREE  # rad/s about the median: the same motion, or rest
MIN_WINDOWS = 6  # windows of which the coldest and the warmest third are compared
MIN_DRIFT_SIGMA = 5.0  # sigma of the difference of their means


@dataclass(frozen=True)
class _Facts:
    """Temperatures, K, at the ends, first and last or lowest and highest; change of channels."""

    lowest: float
    highest: float
    warms: bool
    changes: Mapping[int, float]  # from cold to warm, of a channel, m/s² or rad/s
    logs: int = 0  # 0 where it is within one


class TemperatureDrift(Detector):
    """The temperature changes by more than 1 K within a log, or from log to log.

    Where a log keeps one attitude, the mean readings of its warmest third are compared with those
    of its coldest.

    Cause: the IMU warms up after it is switched on, or its surroundings change. Bias and scale
    factors are means over temperatures, and sure at none of them.
    """

    name = "temperature_drift"
    source = (
        "design study 9, 22, 23: consumer MEMS 0.1 to 1 mg, 0.005 to 0.08 °/s, 0.02 % per K by data"
        " sheets; tactical some 0.1 mg and 1 °/h per K, judged"
    )
    unit = "K"

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        temperature = log.windows.temperature
        lowest, highest = _range(temperature)
        if highest - lowest > MAX_DRIFT:
            warms = bool(np.nanargmin(temperature) < np.nanargmax(temperature))
            facts = _Facts(lowest, highest, warms, _changes(log.windows))
            yield log.event(highest - lowest, facts=facts)

    def detect_between_logs(self, logs: Mapping[str, Log]) -> Iterator[Event]:
        ranges = [_range(log.windows.temperature) for log in logs.values()]
        ranges = [own for own in ranges if np.isfinite(own[0])]
        if len(ranges) < 2:
            return
        lowest, highest = min(low for low, _ in ranges), max(high for _, high in ranges)
        within = max(high - low for low, high in ranges)
        if highest - lowest > within + MAX_DRIFT:
            facts = _Facts(lowest, highest, True, {}, len(ranges))
            yield Event(0, 0, 0, np.nan, np.nan, highest - lowest, facts=facts)

    def describe(self, event: Event, name: str) -> Description:
        facts, kelvin = event.facts, event.size
        low, high = (f"{_celsius(value)} °C" for value in (facts.lowest, facts.highest))
        size = f"{significant(kelvin, 3)} K"
        if facts.logs:
            sentence = _(
                "From log to log the temperature is between {low} and {high}, {size}.",
                low=low,
                high=high,
                size=size,
            )
        else:
            first, last = (low, high) if facts.warms else (high, low)
            sentence = _(
                "{name}: the temperature goes from {first} to {last}, by {size}.",
                name=name,
                first=first,
                last=last,
                size=size,
            )
        moved = [
            f"{CHANNELS[i].replace('_', ' ')} {_change(i, change)}"
            for i, change in facts.changes.items()
        ]
        seen = ""
        if moved:
            seen = _(
                " From its coldest third to its warmest the means move: {moved}.",
                moved=", ".join(moved),
            )
        force, rate, scale = CONSUMER
        forces = _(" to ").join(significant(each * kelvin, 2) for each in force)
        rates = _(" to ").join(significant(each * kelvin / DEGREE, 2) for each in rate)
        tactical = significant(TACTICAL[0] * kelvin, 2)
        slow = significant(TACTICAL[1] * kelvin / DEGREE * 3600, 2)
        return Description(
            f"{sentence}{seen}",
            _(
                "Biases and scale factors hold for the mean temperature. Over so much those of "
                "a consumer MEMS typically move by {forces} m/s², {rates} °/s and {significant} "
                "%; the biases of a tactical IMU by some {tactical} m/s² and {slow} °/h.",
                forces=forces,
                rates=rates,
                significant=significant(scale * kelvin * 100, 2),
                tactical=tactical,
                slow=slow,
            ),
            _(
                "Nothing is masked. Let it warm up before recording; or calibrate at several "
                "temperatures, for the model has none."
            ),
        )


POSSIBLE = (150.0, 500.0)  # K, beyond which no IMU works, though a log may say so
OPERATING = (ICE_POINT - 55.0, ICE_POINT + 125.0)  # K, at the most
KEYS = {"K": "K", "°C": "degC", "°F": "degF"}  # of units in campaign files


class WrongTemperatureUnit(Detector):
    """No IMU works at the temperature of a log, but at what it is in another unit.

    Cause: degrees Celsius that are stated as kelvin, or the reverse, or degrees Fahrenheit that are
    stated as Celsius. These change by 1.8 for each kelvin, so that what depends on the temperature
    does so by less.
    """

    name = "wrong_temperature_unit"
    source = "IEEE Std 1554-2005: instruments operate from -55 °C to 125 °C at the most"
    unit = "K"

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        lowest, highest = _range(log.windows.temperature)
        low, high = POSSIBLE
        for off, held, stated in ((-ICE_POINT, "°C", "K"), (ICE_POINT, "K", "°C")):
            if not low < lowest <= highest < high and low < lowest - off <= highest - off < high:
                yield log.event(off, facts=(lowest, highest, held, stated))
        coldest, warmest = OPERATING
        if highest > warmest and coldest < _fahrenheit(lowest) <= _fahrenheit(highest) < warmest:
            off = highest - _fahrenheit(highest)
            yield log.event(off, facts=(lowest, highest, "°F", "°C"))

    def describe(self, event: Event, name: str) -> Description:
        low, high, held, stated = event.facts
        says = _(
            "{name}: temperatures from {low} to {high} °C, as if in {held} where {stated} is "
            "stated.",
            name=name,
            low=_celsius(low),
            high=_celsius(high),
            held=held,
            stated=stated,
        )
        cure = _("State unit: {unit} of the temperature.", unit=KEYS[held])
        if held == "°F":
            return Description(
                _(
                    "{says} In °F they are from {low} to {high} °C, at which IMUs work.",
                    says=says,
                    low=_celsius(_fahrenheit(low)),
                    high=_celsius(_fahrenheit(high)),
                ),
                _(
                    "What changes with the temperature then does so 1.8 times as much per kelvin "
                    "as is estimated, and the parameters hold for another temperature."
                ),
                _("{cure} If the thermometer is right, leave it.", cure=cure),
            )
        return Description(
            says,
            _(
                "The parameters hold for a temperature that is 273.15 K off; how they change with "
                "it is right."
            ),
            cure,
        )


def _fahrenheit(kelvin: float) -> float:
    """What degrees Fahrenheit are that were taken for degrees Celsius, K."""
    return (kelvin - ICE_POINT - 32.0) / 1.8 + ICE_POINT


def _range(temperature: Array) -> tuple[float, float]:
    """Lowest and highest temperature without wrong readings of the thermometer, K."""
    there = temperature[np.isfinite(temperature)]
    if not len(there):
        return np.nan, np.nan
    if len(there) > MEDIAN_WINDOWS**2:
        there = median_filter(there, MEDIAN_WINDOWS, mode="nearest")
    return float(there.min()), float(there.max())


def _changes(windows: Windows) -> dict[int, float]:
    """By how much channels move from the coldest third of a log to its warmest."""
    own = _of_one_attitude(windows) & np.isfinite(windows.temperature)
    if np.count_nonzero(own) < max(MIN_WINDOWS, len(own) / 2):
        return {}
    temperature, mean = windows.temperature[own], windows.mean[own]
    third = len(temperature) // 3
    order = np.argsort(temperature, kind="stable")
    changes = {}
    for i in range(len(CHANNELS)):
        cold, warm = mean[order[:third], i], mean[order[-third:], i]
        # Of neighbours, so that the drift itself does not hide the difference.
        noise = np.std(np.diff(mean[order, i])) / np.sqrt(2)
        change = float(warm.mean() - cold.mean())
        if abs(change) > MIN_DRIFT_SIGMA * noise * np.sqrt(2 / third):
            changes[i] = change
    return changes


def _of_one_attitude(windows: Windows) -> Booleans:
    """Which windows have the attitude and the rate of most of them, (k,)."""
    own = np.ones(len(windows.mean), bool)
    force, rate = windows.mean[:, :3], windows.mean[:, 3:]
    if np.isfinite(force).all(axis=1).any():
        usual = np.nanmedian(force, axis=0)
        off = np.linalg.norm(force - usual, axis=1) / np.linalg.norm(usual)
        own &= off < MAX_ATTITUDE_ANGLE
    for i in range(3):
        if np.isfinite(rate[:, i]).any():
            own &= np.abs(rate[:, i] - np.nanmedian(rate[:, i])) < MAX_RATE_DIFFERENCE
    return own


def _celsius(kelvin: float) -> str:
    return significant(kelvin - ICE_POINT, 3)


def _change(channel: int, change: float) -> str:
    if channel < 3:
        return f"{significant(change, 2)} m/s²"
    return f"{significant(change / DEGREE, 2)} °/s"


ASSUMED_SIGMA = 1.0  # K, of a stated temperature without one: the display of a chamber
MAX_SIGMA = 3.0  # of the stated temperature


class TemperatureMisstated(PlanDetector):
    """The stated temperature of a manoeuvre is more than three sigma off the recorded one.

    Cause: a wrong temperature in the plan, or a thermometer that is not where the sensors are. If
    the stated one is right, the temperature at which each parameter is valid is off as much.
    """

    name = "temperature_misstated"
    source = "IEEE Std 1554-2005: temperature of the chamber and of the instrument differ"
    unit = "K"
    severity = 1

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        off = recorded.temperature - recorded.stated_temperature
        sigma = np.where(
            np.isnan(recorded.temperature_sigma), ASSUMED_SIGMA, recorded.temperature_sigma
        )
        for i in np.flatnonzero(np.abs(off) > MAX_SIGMA * sigma):
            yield self.of(recorded, int(i), float(off[i]))

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None and deviation.size is not None
        at, stated = (
            significant(float(kelvin) - ICE_POINT, 3)
            for kelvin in (recorded.temperature[i], recorded.stated_temperature[i])
        )
        return Description(
            _(
                "{name}: the thermometer reads {at} °C, and the campaign states {stated} °C.",
                name=recorded.name[i],
                at=at,
                stated=stated,
            ),
            _(
                "The recorded one counts. If the sensors were at the other, what depends on the "
                "temperature is attributed to one that is {off} K off.",
                off=significant(abs(deviation.size), 2),
            ),
            _("Correct temperature_deg_c, or state its temperature_sigma_k."),
        )


class TemperatureUnknown(PlanDetector):
    """The thermometer reads nothing in most of a manoeuvre, while it does in others of its log.

    Cause: a thermometer that is read less often, or was not connected. The sensors are used at a
    temperature between those before and after, which is as uncertain as these differ.
    """

    name = "temperature_unknown"
    source = "JCGM 100:2008, 4.3: an estimate between limits"
    unit = "K"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        logs = np.array(recorded.log)
        unknown = np.isnan(recorded.temperature) & np.isnan(recorded.stated_temperature)
        for log in dict.fromkeys(logs[unknown & recorded.found]):
            own = np.flatnonzero((logs == log) & recorded.found)
            known = own[np.isfinite(recorded.temperature[own])]
            for i in own[unknown[own]] if len(known) else ():
                before, after = known[known < i][-1:], known[known > i][:1]
                beside = recorded.temperature[np.append(before, after)]
                apart = float(np.ptp(beside)) if len(beside) > 1 else MAX_DRIFT
                severity = 1 if apart < MAX_DRIFT else 2
                yield self.of(recorded, int(i), apart, facts=tuple(beside), severity=severity)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None and deviation.size is not None
        beside = [_celsius(kelvin) for kelvin in deviation.facts]
        return Description(
            _(
                "{name}: the thermometer reads nothing; in those before and after {beside} °C.",
                name=recorded.name[i],
                beside=_(" and ").join(beside),
            ),
            _(
                "Its readings are used, at a temperature between these. What depends on the "
                "temperature is uncertain there by up to {apart} K.",
                apart=significant(deviation.size, 2),
            ),
            _("State temperature_deg_c of the manoeuvre if it is known."),
        )
