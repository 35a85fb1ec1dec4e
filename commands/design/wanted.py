"""What to record next, so that wanted sigmas are reached."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from commands.design.from_nothing import candidates_of, in_order, prior_information
from commands.design.turntable import Turntable
from commands.design.visits import Item, Visit, items_of, plan_of
from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.foreseen import (
    extended,
    information_of_positions,
    session_seconds,
    sigmas,
)
from inertial.estimation.optimal_design import WORST, Candidates, best_plan, relaxed
from inertial.estimation.triad import linear_names
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.parameters import STAGES

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
