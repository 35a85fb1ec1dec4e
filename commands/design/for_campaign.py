"""What to record next, so that the members of a class are distinguished.

Every visit that the table allows is added to the campaign in thought, all at the same time; the
equations of the estimation give its information on parameters and effects, which adds up with that
of the campaign. Visits are chosen by what they add to the separations per second. What was chosen
is then computed with all equations, in its order, and more is added until the likeliest member
would be the right one in enough campaigns.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from commands.design.from_nothing import candidates_of, in_order, prior_information
from commands.design.turntable import Turntable
from commands.design.visits import Item, Visit, items_of, plan_of, visit_seconds
from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData, CampaignTables, campaigns_of
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.foreseen import (
    by_position,
    extended,
    information_of_positions,
    session_seconds,
    sigmas,
)
from inertial.campaign.observations import campaign_of
from inertial.campaign.records import rows_of
from inertial.effects import KNOWN
from inertial.estimation.optimal_design import WORST, Candidates, best_plan, relaxed
from inertial.estimation.random_walk import NO_DRIFT
from inertial.estimation.triad import linear_names
from inertial.model_selection.evidence import searched_effect
from inertial.model_selection.splitting import MIN_SEPARATION, Rivals
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS
from inertial.tables.declared import FITTED, RECORDED, read_declared
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.parameters import STAGES

RIGHT = 0.95  # share of campaigns in which the likeliest member is to be the right one
FORESEEN_RIGHT = 0.975  # by the sizes that were estimated: half of the allowance is left to these
MAX_VISITS = 12
MAX_SEPARATION = 2 * MIN_SEPARATION  # counted of a pair; more does not help the others
RESTS = (90.0, 240.0)  # s
RATE_SHARES = (1.0, 0.5, 0.25, 0.1)  # of the largest rate
TURNING = (20.0, 60.0)  # s, about which a turn takes one way


@dataclass(frozen=True)
class Class:
    """Effects that a campaign does not distinguish, and the other causes of its mount.

    `others`: effect and value of its scanned variable, None without one.
    """

    mount: str
    members: tuple[str, ...]
    others: tuple[tuple[str, float | None], ...]


@dataclass(frozen=True)
class Addition:
    """What to record, and in which share of campaigns the likeliest member is then right.

    `visits`, `items`: of the plan; `seconds`: at the table, from the first change on; `before`,
    `after`: share without and with it; `separations`: of each pair of members, without and with.
    """

    of: Class
    visits: list[Visit]
    items: list[Item]
    seconds: float
    before: float
    after: float
    separations: dict[tuple[str, str], tuple[float, float]]


def campaign_tables(derived: Path) -> list[CampaignData]:
    """The mounts of a campaign with their joint results.

    Raises
    ------
    Refusal
        where a table is missing, damaged, or of another version
    """
    return campaigns_of(CampaignTables(**read_declared(derived, RECORDED | FITTED)))


def classes_of(findings: pd.DataFrame, members: pd.DataFrame, scores: pd.DataFrame) -> list[Class]:
    """The classes of several effects that the stage criticism names, one for each finding."""
    values = {(row["mount"], row["effect"]): row["scan_value"] for row in rows_of(scores)}
    named = [row for row in rows_of(findings) if row["cause"] in KNOWN]
    ranked = sorted(rows_of(members), key=lambda row: row["rank"])
    found = []
    for row in named:
        mount = row["mount"]
        own = [m["effect"] for m in ranked if m["finding"] == row["id"] and m["effect"] in KNOWN]
        others = [o["cause"] for o in named if o is not row and o["mount"] == mount]
        # An oscillation and the like is no part of the equations of blocks.
        others = [name for name in others if KNOWN[name].sought_in == "blocks"]
        if len(own) > 1:
            given = tuple((name, values.get((mount, name))) for name in others)
            found.append(Class(mount, tuple(own), given))
    return found


class Splitting:
    """A class, and the equations of its campaign with what may be added."""

    def __init__(self, data: CampaignData, of: Class, table: Turntable) -> None:
        self._table, self.of = table, of
        self._data = data
        present = _campaign(data)
        effects = [KNOWN[name] for name in (*of.members, *(name for name, _at in of.others))]
        self._families = present.candidates(effects)
        self._effects = [effect for family in self._families.values() for effect in family]
        found = evidence(present, self._effects).total
        column = {name: i for i, name in enumerate(found.names)}
        searched = [
            searched_effect(name, *[[column[own] for own in effect.columns] for effect in family])
            for name, family in self._families.items()
        ]
        others = [(name, _place(self._families[name], at)) for name, at in of.others]
        self._rivals = Rivals(found, searched, of.members, others)
        if len(self._rivals.names) < 2:
            raise Refusal(
                "CAMPAIGN",
                "",
                ", ".join(of.members),
                _("a class of effects that depend on the manoeuvres"),
                _("record the campaign once more: no manoeuvre distinguishes these"),
            )
        self._base = [self._present(present, sensor) for sensor in SENSORS]

    def best(self, visits: Sequence[Visit], most: float) -> Addition:
        """The visits to add, of at most so many seconds at the table."""
        before = self.with_([])
        chosen: list[Visit] = []
        now, seconds = before, 0.0
        costs = np.array([visit_seconds(visit, self._table) for visit in visits])
        each = self._of_visits(visits)
        while self._rivals.right_share(now) < FORESEEN_RIGHT and len(chosen) < MAX_VISITS:
            place = self._next(each, chosen, visits, costs, most - seconds)
            if place is None:
                break
            chosen.append(visits[place])
            seconds += float(costs[place])
            now = self.with_(chosen)
        pairs = self._rivals.separations(before), self._rivals.separations(now)
        return Addition(
            self.of,
            chosen,
            items_of(chosen, self._table, "next"),
            seconds,
            self._rivals.right_share(before),
            self._rivals.right_share(now),
            {names: (size, pairs[1][names]) for names, size in pairs[0].items()},
        )

    def with_(self, visits: Sequence[Visit]) -> Array:
        """The information on the effects with visits one after another, by all equations."""
        plan = plan_of(items_of(visits, self._table, "next"), self._table)
        data = extended(self._data, [plan], self._table.pace) if plan else self._data
        return evidence(_campaign(data), self._effects).total.information

    def _of_visits(self, visits: Sequence[Visit]) -> list[Array]:
        """The information of each visit alone, (n, q, q) of each sensor."""
        plans = [
            plan_of(visit.items(f"candidate{number}", self._table), self._table)
            for number, visit in enumerate(visits)
        ]
        campaign = _campaign(extended(self._data, plans, self._table.pace))
        found = []
        for sensor, base in zip(SENSORS, self._base, strict=True):
            equations = campaign.equations(sensor, self._effects, 1.0)
            own = {} if equations is None else by_position(equations)
            none = np.zeros_like(base)
            found.append(np.array([own.get(plan[0].position, none) for plan in plans]))
        return found

    def _present(self, campaign: Campaign, sensor: str) -> Array:
        """The information of the campaign on parameters and effects, these without priors, (q, q).

        Without a random walk of the biases, which would connect it with what is added.
        """
        system = campaign.without_random_walks().system(sensor, self._effects, 1.0)
        if system is None:
            return np.zeros((0, 0))
        rows = system.design / system.sigma[:, None]
        effects = np.array([kind == "effect" for kind, _name in system.names])
        return np.asarray(rows.T @ rows + np.diag(np.where(effects, 0.0, system.prior_sigma**-2.0)))

    def _next(
        self,
        each: Sequence[Array],
        chosen: Sequence[Visit],
        visits: Sequence[Visit],
        costs: Array,
        left: float,
    ) -> int | None:
        """The visit that adds most per second, or the shortest that suffices."""
        places = [visits.index(visit) for visit in chosen]
        base = [
            own + parts[places].sum(axis=0) for own, parts in zip(self._base, each, strict=True)
        ]
        sums = [own + parts for own, parts in zip(base, each, strict=True)]
        shares = np.array(
            [self._share(self._reduced([own[i] for own in sums])) for i in range(len(visits))]
        )
        start = self._share(self._reduced(base))
        right, gains = shares[:, 0], (shares[:, 1] - start[1]) / costs
        possible = costs <= left
        enough = possible & (right >= FORESEEN_RIGHT)
        if enough.any():
            return int(np.argmin(np.where(enough, costs, np.inf)))
        place = int(np.argmax(np.where(possible, gains, -np.inf)))
        return place if possible[place] and gains[place] > 0 else None

    def _share(self, information: Array) -> tuple[float, float]:
        """The share of right names, and the sum of squared separations as far as they count."""
        sizes = self._rivals.separations(information).values()
        counted = sum(min(size, MAX_SEPARATION) ** 2 for size in sizes)
        return self._rivals.right_share(information), counted

    def _reduced(self, sensors: Sequence[Array]) -> Array:
        """The information on the effects, the parameters eliminated."""
        count = sum(len(effect.parameters) for effect in self._effects)
        total = np.zeros((count, count))
        for whole in sensors:
            if not len(whole):
                continue
            own = len(whole) - count
            across = whole[:own, own:]
            size = np.sqrt(np.diag(whole)[:own])
            scaled = whole[:own, :own] / np.outer(size, size)
            half = np.linalg.solve(scaled, across / size[:, None])
            total += whole[own:, own:] - (across / size[:, None]).T @ half
        return total


def _campaign(data: CampaignData) -> Campaign:
    """The equations as the stage criticism has them: drifts are weighed against effects there."""
    return replace(campaign_of(data), drifts=dict.fromkeys(SENSORS, NO_DRIFT))


def _place(family: Sequence[Effect], at: float | None) -> int:
    """Which of the candidates of a scan has a value, or the nearest one."""
    if at is None:
        return 0
    return int(np.argmin([abs((effect.at or 0.0) - at) for effect in family]))


# ---- What to record next, so that wanted sigmas are reached.

NAMES = [f"{STAGES[s]}/{name}" for s in ("accel", "gyro") for name in linear_names()]
LONGEST = 4 * 3600.0  # s, at the table
GROWTH = 1.1  # of the time, while whole manoeuvres do not suffice
HALVINGS = 6


@dataclass(frozen=True)
class Reached:
    """What to record, its time at the table, s, and the sigmas without and with it, (24,)."""

    items: list[Item]
    seconds: float
    before: Array
    after: Array


def wanted_sigmas(stated: Sequence[str]) -> Array:
    """Wanted sigmas, SI, inf where none is, (24,).

    `stated`: such as gyroscope/scale=5e-6, for all of a kind, or gyroscope/scale_x=5e-6.

    Raises
    ------
    Refusal
        where one is none
    """
    sigma = np.full(len(NAMES), np.inf)
    for each in stated:
        name, _equals, text = each.partition("=")
        places = [i for i, own in enumerate(NAMES) if own == name or own.startswith(f"{name}_")]
        try:
            value = float(text)
        except ValueError:
            value = np.nan
        if not places or not value > 0:
            raise Refusal(
                "WANT",
                "",
                repr(each),
                _("a parameter or all of a kind, and a sigma in m/s², rad/s or 1"),
                _("write it as in WANT=gyroscope/scale=5e-6 or WANT=accelerometer/bias_x=1e-4"),
            )
        sigma[places] = value
    return sigma


def reach(data: CampaignData, table: Turntable, visits: Sequence[Visit], wanted: Array) -> Reached:
    """The shortest plan that is found after which every wanted sigma is reached.

    Raises
    ------
    Refusal
        where no plan of a few hours reaches them
    """
    before = sigmas(data)
    if np.all(before <= wanted):
        return Reached([], 0.0, before, before)
    known = list(prior_information(table))
    for gyro, accel in information_of_positions(data).values():
        known[0] = known[0] + gyro
        known[1] = known[1] + accel
    candidates = candidates_of(visits, table, data.noise, (known[0], known[1]), wanted)
    seconds = _least_time(candidates, wanted)
    while seconds < LONGEST:
        found = best_plan(candidates, seconds, WORST)
        items = items_of(in_order(visits, found.counts), table, "next")
        plan = plan_of(items, table)
        after = sigmas(extended(data, [plan], table.pace)) if plan else before
        if np.all(after <= wanted):
            total = session_seconds(plan, table.pace) + table.pace.change
            return Reached(items, total, before, after)
        seconds *= GROWTH
    worst = int(np.argmax(before / wanted))
    raise Refusal(
        "WANT",
        "",
        f"{NAMES[worst]}={wanted[worst]:g}",
        _("a sigma that {hours:g} hours at this table reach", hours=LONGEST / 3600),
        _("want less, or use another table: what is known of gravity or angles may limit it"),
    )


def _least_time(candidates: Candidates, wanted: Array) -> float:
    """The least time in which parts of manoeuvres would do, s."""
    least, most = float(candidates.seconds.min()), LONGEST

    def enough(seconds: float) -> bool:
        times, _bound = relaxed(candidates, seconds, WORST)
        sigma = candidates.sigmas(candidates.total(times / candidates.seconds))
        return bool(np.all(sigma <= wanted))

    for _halving in range(HALVINGS):
        middle = float(np.sqrt(least * most))
        least, most = (least, middle) if enough(middle) else (middle, most)
    return most
