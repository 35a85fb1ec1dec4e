"""An effect or a fault put into the bytes of a real recording, and what the stages say of it.

The recording is drafted and run as it is; its equations say how large an effect is there, so the
injected one has a drawn signal-to-noise ratio by this recording's own noise. What the laboratory
makes of the effect, by the readings as the truth, is added to the numbers of the log, in the counts
of its instrument; all else of the log keeps its bytes.
"""

import os
import shutil
import tempfile
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import chain
import numpy as np
from hidden_sizes import BESIDE, LEVEL
from hidden_ways import WAYS, Array
from recordings.known import RECORDINGS, told

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.observations import campaign_of
from inertial.effects import CATALOGUE
from inertial.estimation.probability import chi2_sf, f_sf
from inertial.estimation.scatter_and_random_walk import MIN_CONSISTENT_P_VALUE
from inertial.model_selection.naming import law_of
from inertial.model_selection.null_simulation import Chance, power
from inertial.model_selection.scatter_tests import ScatterTests, named_share, residual_columns
from inertial.physics.effect import Effect
from inertial.tables import ACCEL, GYRO
from inertial.tables.code import code_of, hash_of
from injections import known_effect
from injections.rewritten_logs import held, lines_of, rewritten, unit_of, write
from laboratory.effects import EFFECTS
from laboratory.sensor import Sensors, Triad
from stages.criticism.effect_selection import evidence_of, scatter_tests_of, select_with_scatter
from stages.criticism.selection import Selection

SEED = 104_729
KEPT = chain.ROOT / "data/derived/injections/as-it-is"
# Logs of text with whole manoeuvres, by hand; the others are means, containers, or in pieces.
INTO = (
    *(f"mikoff-{number}" for number in range(1, 6)),
    *(f"snu-{number}" for number in range(1, 4)),
    *("imucal-labelled", "imucal-continuous", "cuyo"),
)
# Read off the recordings as they are and written down before the first injection: impacts and
# stamps are there to see, and what is not known to be there is named as such.
THERE: Mapping[str, frozenset[str]] = {
    "mikoff-1": frozenset({"impact"}),
    "mikoff-2": frozenset({"impact", "table_moving", "bias_jump"}),
    "mikoff-3": frozenset({"table_moving"}),
    "mikoff-4": frozenset({"impact", "spike"}),
    "mikoff-5": frozenset({"impact", "oscillation", "table_moving"}),
    "snu-1": frozenset({"arrival_stamps", "table_moving"}),
    "snu-2": frozenset({"arrival_stamps", "table_moving"}),
    "snu-3": frozenset({"arrival_stamps", "oscillation", "table_moving"}),
    "imucal-labelled": frozenset({"unknown_structure", "accel_random_walk"}),
    "imucal-continuous": frozenset({"gyro_random_walk", "accel_random_walk"}),
    "cuyo": frozenset({"saturation", "quantisation"}),
}
HIDDEN = (
    *("gyro_g_sensitivity", "gyro_g2_sensitivity", "gyro_bias_jump", "gyro_bias_ramp"),
    *("gyro_warm_up", "accel_quadratic", "accel_scale_asymmetry", "accel_cross_products"),
    *("accel_cubic", "accel_bias_jump", "accel_bias_ramp", "accel_warm_up"),
)
# A bias that jumps while the IMU rests is found there, and the model need not name it once more.
AT_REST = {"gyro_bias_jump": ("bias_jump", "gyro"), "accel_bias_jump": ("bias_jump", "accel")}
RATIOS = (5.0, 8.0, 12.0, 20.0)
FAULTS: Mapping[str, frozenset[str]] = {
    "spikes": frozenset({"spike"}),
    "dead axis": frozenset({"dead_axis"}),
    "repeated lines": frozenset({"duplicate", "held_record"}),
}
FAULT_EVERY = 5  # injections, of which one is a fault
SPIKES, SPIKE_SIGMAS, REPEATED_LINES = 12, 60.0, 40
DRAWS = 20_000  # of the residuals, for a limit
AS_SHARES = (0.15, 0.5)  # of the recording, a time constant
CHANNELS = {"accelerometer": ACCEL, "gyro": GYRO}
UNIT = Sensors(Triad(np.eye(3), np.zeros(3)), Triad(np.eye(3), np.zeros(3)))

Outcome = dict[str, Any]


@cache
def code() -> str:
    """A hash of all that an outcome rests on."""
    files = {file for stage in chain.ORDER for file in code_of(stage)}
    files |= {*(chain.ROOT / "laboratory/effects").glob("*.py"), chain.ROOT / "config.yaml"}
    files |= {*Path(__file__).parent.glob("*ed.py"), *Path(__file__).parent.glob("*logs.py")}
    files |= {chain.ROOT / "tests/hidden/hidden_ways.py"}
    files |= {*(chain.ROOT / "commands/draft").glob("*.py")}
    return hash_of(sorted(files))[:16]


def folder_of_recordings() -> Path:
    """Where the real recordings are, which are not part of the project."""
    return Path(os.environ.get("RECORDINGS", chain.ROOT.parent / "shared/recordings"))


@dataclass(frozen=True)
class Recording:
    """One as it is: its campaign, results, causes, and what its equations say of every effect.

    `law`: what noise alone brings forth; `time`: s, of every sample since the first.
    """

    name: str
    campaign: Path
    results: chain.Results
    selection: Selection

    @property
    def layout(self) -> Mapping[str, Any]:
        """How its log is to be read, by the campaign file."""
        layout: Mapping[str, Any] = told(self.campaign)["instrument"]["format"]
        return layout

    @property
    def equations(self) -> Campaign:
        """Its equations, scatter and random walks included."""
        return self.selection.campaign

    def ratio(self, effect: Effect, values: Array) -> float:
        """The signal-to-noise ratio of an effect, all else fitted.

        By hand by residuals alone: there the parameters have no priors but vague ones. Residuals
        that nothing explains, as the recording is, are noise here.
        """
        families, columns = self.selection.families, effect.columns
        if self.equations.by_hand is None:
            said = evidence(self.equations, [effect])
            information = said.scaled(said.excesses([])).total.information
            return float(np.sqrt(values @ information @ values))
        searched = {one.label for family in families.values() for one in family}
        further = [] if effect.label in searched else [effect]
        said, _searched = evidence_of(self.equations, families, np.inf, further)
        own = [said.names.index(name) for name in columns]
        roots = (
            residual_columns(*each)[0][own] for each in zip(said.sensors, said.raw, strict=True)
        )
        return float(np.sqrt(sum(np.sum((values @ root) ** 2) for root in roots)))

    @cached_property
    def law(self) -> Chance | None:
        """What noise alone brings forth."""
        return law_of(self.selection.evidence.observable(), self.selection.searched, LEVEL)

    def limit(self, name: str, ratio: float, *, scatter_known: bool = False) -> float:
        """The power at a ratio that no search of the catalogue exceeds on this recording.

        By hand the scatter of positions is not known: where the residuals with the effect are
        larger than noise, it is what takes more of them away than by chance that is found.
        """
        said = self.selection.evidence.observable()
        searched = self.selection.searched
        number = [one.name for one in searched].index(name)
        if self.law is None or not self.law.tails[number].degrees:
            return 0.0
        sensor = said.sensor_of([i for one in searched[number].candidates for i in one])
        threshold = self.law.threshold(number, said.noise_degrees_of(sensor))
        if scatter_known or self.equations.by_hand is None:
            return float(power(ratio, self.law.tails[number].degrees, threshold))
        own, scattering = said.labels[sensor], self.equations.scattering
        share = named_share(self.tests({own, *scattering}), LEVEL)
        beside = Beside.of(self.tests([own]), number, share)
        return beside.power(ratio, None if own in scattering else threshold)

    def shows(self, data: CampaignData, effect: Effect) -> bool:
        """Whether a test that knows an effect would find it in the recording with it."""
        said, searched = self.selection.evidence.observable(), self.selection.searched
        number = [one.name for one in searched].index(effect.name)
        sensor = said.sensor_of([i for one in searched[number].candidates for i in one])
        own = said.labels[sensor]
        p_value, beside_scatter = known_effect.p_value(data, effect, own)
        if beside_scatter:
            tests = self.tests({own, *self.equations.scattering})
            return p_value < named_share(tests, LEVEL)
        assert self.law is not None  # else nothing is put in
        threshold = self.law.threshold(number, said.noise_degrees_of(sensor))
        return p_value < float(chi2_sf(threshold, self.law.tails[number].degrees))

    def tests(self, sensors: Collection[str]) -> Sequence[ScatterTests]:
        """Those of all effects against a scatter of some sensors."""
        said, searched = self.selection.evidence, self.selection.searched
        return scatter_tests_of(said, searched[: len(self.selection.families)], sensors)


@dataclass(frozen=True)
class Beside:
    """An effect of `used` degrees of freedom of all `degrees`, in which a scatter may be, too.

    `share`: the p-value by F from which it is named. Where it leaves no residuals `used` is 0.
    """

    degrees: int
    used: int
    share: float

    @classmethod
    def of(cls, tests: Sequence[ScatterTests], number: int, share: float) -> "Beside":
        """Of the effect of this number among those that are searched."""
        for one in tests:
            own = [
                u for (effect, _), u in zip(one.places, one.used, strict=True) if effect == number
            ]
            return cls(one.degrees, int(max(own, default=0)), share)
        return cls(0, 0, share)

    def power(self, ratio: float, noise_threshold: float | None = None) -> float:
        """That it is found at a ratio.

        `noise_threshold`: of its drop of chi-squared, where there is no scatter by itself; then one
        is supposed only where the residuals are larger than noise.
        """
        if not self.used:
            return 0.0
        random, left = np.random.default_rng(0), self.degrees - self.used
        drop = random.noncentral_chisquare(self.used, ratio**2, DRAWS)
        rest = random.chisquare(left, DRAWS)
        found = f_sf(drop / self.used / rest * left, self.used, left) < self.share
        if noise_threshold is not None:
            quiet = chi2_sf(drop + rest, self.degrees) >= MIN_CONSISTENT_P_VALUE
            found = np.where(quiet, drop > noise_threshold, found)
        return float(found.mean())


@cache
def as_it_is(name: str) -> Recording:
    """A recording, drafted and run; kept on disk for as long as the code is the same."""
    folder = KEPT / f"{name}-{code()}"
    if not folder.exists():
        KEPT.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=KEPT) as part:
            _run(name, Path(part) / "made")
            for old in {*KEPT.glob(f"{name}-*")} - {folder}:
                shutil.rmtree(old, ignore_errors=True)
            with suppress(OSError):  # another process was first
                (Path(part) / "made").rename(folder)
    results = chain.Results(folder / "derived")
    (data,) = chain.mounts(results)
    return Recording(name, folder / "data/raw" / name, results, _selected(data))


def _run(name: str, place: Path) -> None:
    (one,) = (one for one in RECORDINGS if one.name == name)
    campaign = one.drafted(folder_of_recordings(), place / "data")
    chain.run(campaign, place / "derived", "diagnosis", BESIDE)


def _selected(data: CampaignData) -> Selection:
    """What criticism selects among the effects of block means."""
    campaign = campaign_of(data).without_drift_at_rest()
    effects = [effect for effect in CATALOGUE.values() if effect.sought_in == "blocks"]
    return select_with_scatter(campaign, effects, LEVEL, data.noise.degrees)


@dataclass(frozen=True)
class Drawn:
    """What a number draws: where it is put, what it is, and how large."""

    recording: str
    name: str
    ratio: float
    random: np.random.Generator

    @property
    def is_fault(self) -> bool:
        """Whether it is a fault of the recording, no effect."""
        return self.name in FAULTS


def drawn(number: int) -> Drawn:
    """The injection of a number."""
    random = np.random.default_rng([SEED, number])
    recording = INTO[number % len(INTO)]
    if number // len(INTO) % FAULT_EVERY == 0:
        return Drawn(recording, str(random.choice(list(FAULTS))), np.nan, random)
    name = str(random.choice(HIDDEN))
    return Drawn(recording, name, float(random.choice(RATIOS)), random)


def outcome(number: int) -> Outcome:
    """What is said of one injection; a number below zero is a recording as it is."""
    with tempfile.TemporaryDirectory() as place:
        if number < 0:
            name = INTO[number]
            causes = _causes(as_it_is(name).results)
            false = [cause for (cause, _), members in causes if not members & THERE[name]]
            return {"number": number, "code": code(), "recording": name, "false": false}
        what = drawn(number)
        kept = as_it_is(what.recording)
        campaign = shutil.copytree(kept.campaign, Path(place) / kept.name)
        (log,) = (path for path in campaign.iterdir() if path.name != "campaign.yaml")
        told_of = {"number": number, "code": code(), "recording": what.recording}
        told_of |= {"name": what.name, "ratio": what.ratio}
        if what.is_fault:
            wanted, limit = FAULTS[what.name], np.nan
            _damage(kept, what, log)
        else:
            wanted, limit = frozenset({what.name}), kept.limit(what.name, what.ratio)
            known = kept.limit(what.name, what.ratio, scatter_known=True)
            told_of |= {"known": known}
            if not (effect := _hide(kept, what, log)):
                return told_of | {"limit": 0.0, "found": False, "beside": [], "shown": False}
            told_of |= {"values": effect}
        own = _causes(kept.results)
        after = chain.run(campaign, Path(place) / "again", "diagnosis", BESIDE)
        rows = _causes(after)
        if not what.is_fault:
            (data,) = chain.mounts(after)
            told_of |= {"shows": kept.shows(data, _modelled(what.name, effect))}
        before_it = {cause for (cause, _), _ in own}
        at_rest = {AT_REST.get(what.name)} - {one for one, _ in own}
        found = [one in at_rest or bool(members & wanted) for one, members in rows]
        beside = [
            cause
            for ((cause, _), _), its_own in zip(rows, found, strict=True)
            if not its_own and cause not in before_it
        ]
        return told_of | {"limit": limit, "found": any(found), "beside": beside, "shown": True}


def _causes(results: chain.Results) -> list[tuple[tuple[str, str | None], frozenset[str]]]:
    """The rows of the diagnosis: cause and sensor, and all that it may be."""
    members = results["diagnosis/members"].groupby("cause")["member"].agg(set).to_dict()
    rows = results["diagnosis/causes"].to_dict("records")
    return [
        (
            (str(row["cause"]), row["sensor"]),
            frozenset({row["cause"], *members.get(row["id"], ())}),
        )
        for row in rows
    ]


def _modelled(name: str, values: Mapping[str, float]) -> Effect:
    """The effect of the catalogue at the value of its scan that was put in."""
    scan = WAYS[name].scan
    return CATALOGUE[name] if scan is None else CATALOGUE[name].fixed(values[scan[0]])


def _hide(recording: Recording, what: Drawn, log: Path) -> dict[str, float]:
    """Put an effect into the log; its values, none where this recording does not show it."""
    way, samples = WAYS[what.name], recording.results["decode/samples"]
    time = samples["time"].to_numpy(float)
    time = time - time[0]
    values = what.random.standard_normal(len(way.names))
    effect, parameters = CATALOGUE[what.name], {}
    if way.scan is not None:
        key, low, high = way.scan
        low, high = (low, high) if way.share else AS_SHARES
        at = float(what.random.uniform(low, high) * time[-1])
        effect, parameters = effect.fixed(at), {key: at}
    unit = recording.ratio(effect, values)
    if not unit > 0 or not np.isfinite(unit) or recording.limit(what.name, 20.0) == 0:
        return {}
    values = values * what.ratio / unit
    largest = [effect.largest_of(one) for one in effect.parameters]
    if (np.abs(values) > largest).any():  # no sensor has it so large
        return {}
    hidden = EFFECTS[what.name](way.told(values) | parameters)
    readings = {sensor: samples[columns].to_numpy(float) for sensor, columns in CHANNELS.items()}
    instants = SimpleNamespace(since=lambda moment: (time >= moment).astype(float))
    truth = SimpleNamespace(
        force=readings["accelerometer"],
        rate=readings["gyro"],
        time=time,
        motion=SimpleNamespace(instants=instants),
    )
    error = hidden.reading_error(truth, UNIT)
    added = {
        sensor: getattr(error, sensor) / unit_of(recording.layout, sensor) for sensor in CHANNELS
    }
    rewritten(log, recording.layout, samples["line"].tolist(), added, what.random)
    return {name: float(value) for name, value in zip(way.names, values, strict=True)} | parameters


def _damage(recording: Recording, what: Drawn, log: Path) -> None:
    """Put a fault into the log."""
    samples, random = recording.results["decode/samples"], what.random
    lines = samples["line"].tolist()
    if what.name == "repeated lines":
        text = lines_of(log)
        first = int(random.integers(len(lines) // 4, len(lines) // 2))
        some = slice(lines[first] - 1, lines[first + REPEATED_LINES] - 1)
        text[some.stop : some.stop] = text[some]
        write(log, text)
        return
    sensor = str(random.choice(list(CHANNELS)))
    axis = int(random.integers(3))
    if what.name == "dead axis":
        first = int(random.integers(len(lines) // 3, 2 * len(lines) // 3))
        held(log, recording.layout, lines[first:], (sensor, axis))
        return
    readings = samples[CHANNELS[sensor]].to_numpy(float)
    error = np.zeros_like(readings)
    size = SPIKE_SIGMAS * 1.4826 * float(np.median(np.abs(np.diff(readings[:, axis])))) / np.sqrt(2)
    places = random.choice(np.arange(10, len(lines) - 10), SPIKES, replace=False)
    error[places, axis] = size * random.choice([-1.0, 1.0], SPIKES)
    added = {sensor: error / unit_of(recording.layout, sensor)}
    rewritten(log, recording.layout, lines, added, random)
