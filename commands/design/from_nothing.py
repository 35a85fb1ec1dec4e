"""The best plan for an instrument on a table in a given time."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from commands.design.turntable import Instrument, Turntable
from commands.design.visits import Item, Visit, items_of, plan_of, possible, visit_seconds
from inertial.arrays import Array, Integers
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.foreseen import (
    extended,
    foreseen,
    information_of_positions,
    nothing_recorded,
    session_seconds,
    sigmas,
)
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.rotating_positions import LEVER_ARM
from inertial.estimation import accelerometers, gyroscopes
from inertial.estimation.optimal_design import Candidates, Plan, best_plan
from inertial.estimation.triad import UNKNOWNS


@dataclass(frozen=True)
class Designed:
    """A plan, what is foreseen of it, and the exchange that found it.

    `items`: as in a campaign file; `seconds` at the table; `sigmas`: (24,), SI.
    """

    items: list[Item]
    seconds: float
    data: CampaignData
    sigmas: Array
    search: Plan | None = None


def foreseen_of(items: Sequence[Item], table: Turntable, noise: NoiseLevels) -> Designed:
    """What is foreseen of a plan at a table."""
    plan = plan_of(items, table)
    data = foreseen(plan, table.pace, noise, table.known)
    return Designed(list(items), session_seconds(plan, table.pace), data, sigmas(data))


def prior_information(table: Turntable) -> tuple[Array, Array]:
    """What is known of the unknowns of gyros and accelerometers without any recording."""
    known = table.known
    gyro = [*gyroscopes.PRIOR_SIGMA, known["earth_rate_up"].scatter]
    accel = [*accelerometers.PRIOR_SIGMA, known["gravity"].scatter, *LEVER_ARM.values()]
    return np.diag(np.array(gyro) ** -2), np.diag(np.array(accel) ** -2)


def candidates_of(
    visits: Sequence[Visit],
    table: Turntable,
    noise: NoiseLevels,
    known: tuple[Array, Array],
    reference: Array,
) -> Candidates:
    """The information of every visit; `known`: of gyros and accelerometers without any.

    `reference`: sigmas of the 24 parameters, accelerometers first.
    """
    names = [f"candidate{number}" for number in range(len(visits))]
    plans = [
        plan_of(visit.items(name, table), table) for name, visit in zip(names, visits, strict=True)
    ]
    nothing = nothing_recorded(noise, table.known)
    found = information_of_positions(extended(nothing, plans, table.pace))
    gyro, accel = (np.array(own) for own in zip(*(found[name] for name in names), strict=True))
    seconds = np.array([visit_seconds(visit, table) for visit in visits])
    return Candidates((accel, gyro), (known[1], known[0]), seconds, UNKNOWNS, reference)


def best(
    instrument: Instrument, table: Turntable, minutes: float, criterion: str, reference: Array
) -> Designed:
    """The best plan of so many minutes at the table, by a criterion of the variances.

    `reference`: sigmas in which the 24 are counted.
    """
    visits = possible(table, instrument.max_rate)
    known = prior_information(table)
    candidates = candidates_of(visits, table, instrument.noise, known, reference)
    # Nothing has to be changed to the first position.
    search = best_plan(candidates, 60 * minutes + table.pace.change, criterion)
    chosen = in_order(visits, search.counts)
    made = foreseen_of(items_of(chosen, table), table, instrument.noise)
    return Designed(made.items, made.seconds, made.data, made.sigmas, search)


def in_order(visits: Sequence[Visit], counts: Integers) -> list[Visit]:
    """The chosen visits, in turn through all attitudes.

    So a position is left before its attitude is set again, and repetitions are far apart in time,
    where a bias that drifts is another.
    """
    by_attitude: dict[tuple[float, float, float], list[Visit]] = {}
    for place in np.flatnonzero(counts):
        visit = visits[int(place)]
        by_attitude.setdefault(visit.up, []).extend([visit] * int(counts[place]))
    rounds = zip_longest(*by_attitude.values())
    return [visit for each in rounds for visit in each if visit is not None]
