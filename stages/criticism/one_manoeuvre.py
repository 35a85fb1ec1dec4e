"""Whether several effects are what a single manoeuvre alone shows.

A manoeuvre in which something else happened, as a knock against the table or a cable that pulls, is
described by several effects at once: a jump and another one back, a shift and a slip. Effects of a
sensor, a mounting or a site are in more than one manoeuvre. So where without one of them no effect
is significant, nor named, and no structure is left, that manoeuvre is off by a cause without a
name.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from inertial.campaign.equations import Campaign
from inertial.estimation.probability import chi2_sf
from inertial.model_selection.cause import LAW, UNKNOWN_STRUCTURE
from inertial.physics.effect import Effect
from inertial.sensors import PLURAL, SENSORS
from inertial.text.cause_names import in_words
from inertial.text.enumeration import listed
from inertial.text.messages import _
from inertial.text.numbers import p_is
from stages.criticism.finding_rows import TableRow, finding_id, finding_row, member_rows, snr_of
from stages.criticism.residual_structure import (
    ACTION_IF_CARRIED,
    CAUSE,
    PRIOR_SIGMA,
    Tested,
    consequence,
    moved_by,
)
from stages.criticism.rivals import members_of
from stages.criticism.selection import OffManoeuvre, Selection

LEAST_EFFECTS = 2  # of one sensor: a single one may be the own error of that manoeuvre
MIN_CHANCE = 0.01  # of the effects in the other manoeuvres by noise alone
MIN_INFORMATION = 1e-6  # of what an effect does to the readings, that the parameters leave
MAX_CHANCE = 0.001  # of the same in all manoeuvres, in a sensor that shows them
OFF = _(
    "The readings of the {sensors} in {manoeuvre} differ from those in all others ({p_value}): "
    "only several effects at once would explain them, {effects}, and without {manoeuvre} none of "
    "these is there."
)

Selected = tuple[Selection, Tested]


def select_beside_one_manoeuvre(
    found: Selected,
    campaign: Campaign,
    select: Callable[[Campaign], Selected],
    without: Callable[[Campaign, str], Campaign],
    tests: Callable[[Campaign], Tested],
) -> Selected:
    """The selection and its tests; without effects where one manoeuvre alone carries several.

    Parameters
    ----------
    found : what is selected of the campaign
    select : of a campaign the effects, and the tests of its residuals
    without : a campaign without a manoeuvre
    tests : of the residuals of a campaign without effects
    """
    selection, _ = found
    named = [cause for cause in selection.named.causes if cause.verdict != LAW]
    of_sensors = Counter(selection.sensor(cause) for cause in named)
    if max(of_sensors.values(), default=0) < LEAST_EFFECTS:
        return found
    effects = selection.effects
    every = set(campaign.manoeuvres)
    chances = {m: _least_chance(_drops(campaign, effects, every - {m})) for m in sorted(every)}
    carrier = max(chances, key=chances.__getitem__)
    if chances[carrier] < MIN_CHANCE:
        return found
    other, other_tested = select(without(campaign, carrier))
    if other.named.causes or other_tested.detected:
        return found
    whole = campaign.with_random_walks(other.campaign.solution.random_walks)
    drops = _drops(whole, effects, every).items()
    shown = {sensor: drop for sensor, drop in drops if chi2_sf(*drop) < MAX_CHANCE}
    if not shown:
        return found
    off = OffManoeuvre(carrier, shown, members_of(selection))
    return replace(other, campaign=whole, off=off), tests(whole)


def _least_chance(drops: Mapping[str, tuple[float, int]]) -> float:
    """That noise alone explains as much, in the sensor where it does so least."""
    return min((float(chi2_sf(*drop)) for drop in drops.values()), default=1.0)


def _drops(
    campaign: Campaign, effects: Sequence[Effect], only: set[str]
) -> dict[str, tuple[float, int]]:
    """The reduction of χ² by effects in some manoeuvres, and its degrees, by sensor."""
    drops = {}
    for sensor in SENSORS:
        if (system := campaign.system(sensor, effects, PRIOR_SIGMA, only)) is not None:
            rest, columns, raw = system.projected(0)
            columns = columns[:, np.sum(columns**2, axis=0) > MIN_INFORMATION * raw]
            fitted, _, rank, _ = np.linalg.lstsq(columns, rest)
            if rank:
                drops[sensor] = (float(rest @ (columns @ fitted)), int(rank))
    return drops


def carrier_of_excess(campaign: Campaign, sensor: str, effects: Sequence[Effect]) -> str | None:
    """The only manoeuvre without which the residuals of a sensor are no larger than noise."""
    every = set(campaign.manoeuvres_of(sensor))
    chances = dict.fromkeys(sorted(every), 0.0)
    for name in chances:
        others = set(campaign.manoeuvres) - {name}
        if (system := campaign.system(sensor, effects, PRIOR_SIGMA, others)) is not None:
            rest = system.solve_shared()
            chances[name] = float(chi2_sf(rest.chi_squared, max(rest.degrees, 1)))
    carriers = [name for name, chance in chances.items() if chance > MIN_CHANCE]
    return carriers[0] if len(carriers) == 1 else None


def off_rows(selection: Selection, tested: Tested, mount: str) -> Iterator[TableRow]:
    """The finding of each sensor that a manoeuvre is off, where no structure says so."""
    off = selection.off
    if off is None:
        return
    for sensor, (drop, degrees) in off.drops.items():
        if tested.of(sensor):
            continue
        chance = float(chi2_sf(drop, degrees))
        names = listed([in_words(name) for name in off.members])
        identifier = finding_id(f"{CAUSE}/{sensor}", mount)
        moves = moved_by(selection.campaign, sensor, [off.manoeuvre])
        yield finding_row(
            CAUSE,
            mount,
            id=identifier,
            sensor=sensor,
            size=drop**0.5,
            unit="sigma",
            p_value=chance,
            sentence=OFF.format(
                sensors=PLURAL[sensor],
                manoeuvre=off.manoeuvre,
                p_value=p_is(chance),
                effects=names,
            ),
            consequence=consequence([off.manoeuvre], moves),
            action=ACTION_IF_CARRIED.format(manoeuvres=off.manoeuvre),
            verdict=UNKNOWN_STRUCTURE,
            statistic=drop,
            degrees=degrees,
            snr=snr_of(drop, degrees),
            moves=moves,
        )
        yield from member_rows(identifier, mount, off.members)
        row = {"finding": identifier, "mount": mount, "rank": 1, "manoeuvre": off.manoeuvre}
        yield "structure_manoeuvres", row
