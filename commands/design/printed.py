"""A design in words and tables of text."""

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
from ruamel.yaml import YAML

from commands.design.for_campaign import NAMES, RIGHT, Addition, Reached
from commands.design.from_nothing import Designed
from commands.design.turntable import Instrument, Turntable
from commands.design.visits import Item
from commands.new import LINE_WIDTH, comment, flow
from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.observations import campaign_of
from inertial.effects import CATALOGUE
from inertial.estimation.random_walk import NO_DRIFT
from inertial.model_selection.detection_limits import VISIBLE, Visible, visible
from inertial.model_selection.evidence import searched_effect
from inertial.sensors import SENSORS
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import quantity

Limits = Mapping[tuple[str, str], Visible]

DIGITS = 3
UNITS = {"accelerometer/bias": "m/s²", "gyroscope/bias": "rad/s"}
NONE = "–"


def sigma_rows(plans: Sequence[Array]) -> Iterator[list[str]]:
    """Parameter, unit, and its sigma by each plan in units of a laboratory."""
    for i, name in enumerate(NAMES):
        parameter = name.partition("/")[2]
        unit = quantity(parameter, UNITS.get(name.rpartition("_")[0], "1")).laboratory
        yield [name, unit.name, *(_number(sigmas[i] / unit.size) for sigmas in plans)]


def detection_limits(data: CampaignData) -> Limits:
    """The detection limits of a campaign that is not recorded yet, by effect and parameter."""
    campaign = replace(campaign_of(data), drifts=dict.fromkeys(SENSORS, NO_DRIFT))
    sought = [effect for effect in CATALOGUE.values() if effect.sought_in == "blocks"]
    families = campaign.candidates(sought)
    found = evidence(campaign, [effect for family in families.values() for effect in family])
    place = {name: i for i, name in enumerate(found.names)}
    searched = [
        searched_effect(
            name,
            *[[place[f"{e.label}.{p.name}"] for p in e.parameters] for e in family],
        )
        for name, family in families.items()
    ]
    return {
        (one.effect, CATALOGUE[one.effect].parameters[one.parameter].name): one
        for one in visible(found, searched)
    }


def limit_rows(plans: Sequence[Limits]) -> Iterator[list[str]]:
    """Effect, parameter, unit, and the detection limit by each plan; none: not observable."""
    for key in plans[0]:
        effect, parameter = key
        (own,) = (p for p in CATALOGUE[effect].parameters if p.name == parameter)
        unit = quantity(parameter, own.unit).laboratory
        sizes = [
            limits[key].size / unit.size if limits[key].reason == VISIBLE else np.nan
            for limits in plans
        ]
        if np.isfinite(sizes).any():
            yield [in_words(effect), parameter, unit.name, *map(_number, sizes)]


def _number(value: float) -> str:
    return significant(float(value), DIGITS) if np.isfinite(value) else NONE


def from_nothing(best: Designed, beside: Mapping[str, Designed]) -> str:
    """A plan from nothing, with what is foreseen of it and of others."""
    assert best.search is not None  # it was searched for
    plans = {_("designed"): best, **beside}
    minutes = ", ".join(f"{name} {plan.seconds / 60:.1f} min" for name, plan in plans.items())
    worst = [float(np.max(best.sigmas / other.sigmas)) for other in beside.values()]
    mean = [float(np.sqrt(np.mean((best.sigmas / o.sigmas) ** 2))) for o in beside.values()]
    compared = [
        _(
            "Of {name}'s sigmas those of the designed plan are {mean:.2f} rms, and {worst:.2f} at "
            "the most.",
            name=name,
            mean=each_mean,
            worst=each_worst,
        )
        for name, each_mean, each_worst in zip(beside, mean, worst, strict=True)
        if np.isfinite(each_mean)
    ]
    head = _(
        "{count} manoeuvres in {positions} positions. Table time: {minutes}. No plan of the same "
        "manoeuvres and time reaches less than {share:.0f} % of its variances by the criterion.",
        count=len(best.items),
        positions=len({item["position"] for item in best.items}),
        minutes=minutes,
        share=100 * best.search.efficiency,
    )
    sigmas = [[_("sigma of"), _("unit"), *plans]]
    sigmas += sigma_rows([plan.sigmas for plan in plans.values()])
    limits = [[_("detection limit of"), "", _("unit"), *plans]]
    limits += limit_rows([detection_limits(plan.data) for plan in plans.values()])
    paragraphs = [_wrapped(" ".join([head, *compared])), aligned(sigmas, 2), aligned(limits, 3)]
    return "\n\n".join(paragraphs) + "\n"


def of_class(addition: Addition, own_seconds: float) -> str:
    """What to record to split a class."""
    names = ", ".join(in_words(name) for name in addition.of.members)
    if not addition.visits:
        return _wrapped(
            _(
                "{names}: already now the likeliest is the right one in {before:.0f} % of "
                "campaigns, or nothing at this table distinguishes them in the time that there is.",
                names=names,
                before=100 * max(addition.before, 0.0),
            )
        )
    head = _(
        "{names}: with {count} manoeuvres more, {minutes:.1f} minutes at the table where the "
        "campaign took {own:.1f}, the likeliest is the right one in {after:.0f} % of campaigns; "
        "{wanted:.0f} % are wanted, without them it is {before:.0f} %.",
        names=names,
        count=len(addition.items),
        minutes=addition.seconds / 60,
        own=own_seconds / 60,
        after=100 * max(addition.after, 0.0),
        wanted=100 * RIGHT,
        before=100 * max(addition.before, 0.0),
    )
    rows = [[_("separation of"), _("and"), _("now"), _("then")]]
    rows += [
        [in_words(first), in_words(second), f"{now:.1f}", f"{then:.1f}"]
        for (first, second), (now, then) in addition.separations.items()
    ]
    return f"{_wrapped(head)}\n\n{aligned(rows, 2)}"


def of_wanted(reached: Reached) -> str:
    """What to record to reach wanted sigmas."""
    if not reached.items:
        return _("Every wanted sigma is reached already.")
    head = _(
        "{count} manoeuvres more, {minutes:.1f} minutes at the table, reach every wanted sigma.",
        count=len(reached.items),
        minutes=reached.seconds / 60,
    )
    rows = [[_("sigma of"), _("unit"), _("now"), _("then")]]
    rows += sigma_rows([reached.before, reached.after])
    return f"{_wrapped(head)}\n\n{aligned(rows, 2)}"


def aligned(rows: Sequence[Sequence[str]], left: int) -> str:
    """A table of text, the first columns flush left, the others flush right."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = [
        "  ".join(
            text.ljust(width) if i < left else text.rjust(width)
            for i, (text, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
    return "\n".join(lines)


def _wrapped(text: str) -> str:
    return textwrap.fill(text, LINE_WIDTH, break_on_hyphens=False)


# ---- The campaign file of a design: a new one, or a recorded one with what is to be added.

TABLE_KEYS = ("name", "heading_deg", "position_sigma_arcsec", "angle_sigma_arcsec")


def new_campaign(
    name: str, instrument: Instrument, table: Turntable, items: Sequence[Item], minutes: float
) -> str:
    """The text of campaign.yaml for a plan from nothing."""
    entry = table.entry
    head = _(
        "{name}: {count} manoeuvres, {minutes:.1f} minutes at the table, all in one log, which "
        "nothing may interrupt. {still:g} s at rest before and after every turn. The attitude of "
        "each position is set anew. Fill in serial and date, record by it, put the log beside it; "
        "then make check CAMPAIGN={name}",
        name=name,
        count=len(items),
        minutes=minutes,
        still=entry["still_s"],
    )
    receiver = instrument.entry.get("format", {}).get("kind") == "rawimus"
    lines = [
        *comment(head),
        "campaign: 1",
        f"instrument: {instrument.name}",
        "serial: unknown",
        "date: unknown",
        f"site: {flow(**entry['site'])}",
        f"table: {flow(**{key: entry[key] for key in (*TABLE_KEYS, 'rate_sigma_ppm')})}",
        f"log: session.{'asc' if receiver else 'csv'}",
        "plan:",
        *(f"  - {flow(**item)}" for item in items),
    ]
    return "\n".join(lines) + "\n"


def with_more(text: str, items: Sequence[Item], mount: str, minutes: float) -> tuple[str, str]:
    """The text of a campaign with manoeuvres added in a log of their own, and the log's name."""
    yaml = YAML()
    yaml.width = 10 * LINE_WIDTH
    content = yaml.load(text)
    first = content["plan"][0]
    log = f"next{Path(str(first.get('log', content.get('log')))).suffix}"
    keys: dict[str, Any] = {"log": log}
    keys |= {"format": first["format"]} if "format" in first else {}
    keys |= {"mount": mount} if mount else {}
    there = len(content["plan"])
    for item in items:
        added = yaml.map()
        added.fa.set_flow_style()
        added.update({**item, **keys})
        content["plan"].append(added)
    what = _(
        "To be recorded next, {minutes:.1f} minutes in {log}; what was recorded stays as it is.",
        minutes=minutes,
        log=log,
    )
    content["plan"].yaml_set_comment_before_after_key(there, before=what, indent=2)
    stream = StringIO()
    yaml.dump(content, stream)
    return stream.getvalue(), log
