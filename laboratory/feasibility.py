"""Specifications that the schema allows and that are not feasible."""

from collections.abc import Iterator, Mapping, Sequence
from functools import reduce
from itertools import pairwise
from typing import Any

from laboratory.effects.effect import Effect
from laboratory.errors import Complaint
from laboratory.layout import changes_between, logs_of, steps_between
from laboratory.manoeuvre import Manoeuvre
from laboratory.profiles import Trapezoid
from laboratory.receiver import COLUMNS

Document = Mapping[str, Any]


def impossible(
    document: Document, manoeuvres: Sequence[Manoeuvre], effects: Sequence[Effect]
) -> Iterator[Complaint]:
    """What is not feasible in a specification, apart from its plan and its faults."""
    yield from of_the_table(document["handling"], manoeuvres)
    yield from of_the_truth(document, manoeuvres)
    yield from of_the_instrument(document)
    yield from of_the_encoder(document)
    yield from of_the_effects(document)
    yield from of_the_turns(document["handling"], manoeuvres, effects)


def of_the_table(handling: Document, manoeuvres: Sequence[Manoeuvre]) -> Iterator[Complaint]:
    """Changes of position that are not specified."""
    pairs = [pair for log in logs_of(manoeuvres).values() for pair in pairwise(log)]
    if "change_s" not in handling and any(changes_between(*pair) for pair in pairs):
        expected = "the time from one position to the next, s, since a log has several"
        yield Complaint("handling.change_s", "nothing", expected)
    if "step" not in handling and any(steps_between(*pair) for pair in pairs):
        expected = "rate and acceleration of the table between two rests of a tumble"
        yield Complaint("handling.step", "nothing", expected)


def of_the_encoder(document: Document) -> Iterator[Complaint]:
    """An encoder whose angle has no column."""
    message = document["receiver"]["message"]
    if "encoder" in document and message != COLUMNS:
        expected = f"receiver.message: {COLUMNS}, since {message} has no angle of the table"
        yield Complaint("encoder", "an encoder", expected)


def of_the_truth(document: Document, manoeuvres: Sequence[Manoeuvre]) -> Iterator[Complaint]:
    """An unknown latitude, mounts that the plan does not use."""
    truth, campaign = document["truth"], document["campaign"]
    if truth.get("latitude_deg", campaign["site"].get("latitude_deg")) is None:
        expected = "the true latitude, degrees north, since the campaign does not state it"
        yield Complaint("truth.latitude_deg", "nothing", expected)
    mounts = list(dict.fromkeys(manoeuvre.mount for manoeuvre in manoeuvres))
    for name in truth.get("mounts", {}):
        if name not in mounts:
            expected = "a mount of the plan: " + ", ".join(mounts)
            yield Complaint(f"truth.mounts.{name}", "a mount that is not in the plan", expected)


def of_the_instrument(document: Document) -> Iterator[Complaint]:
    """Columns of text from an instrument that writes none."""
    instrument = document["campaign"]["instrument"]
    if document["receiver"]["message"] == "columns" and not isinstance(instrument, Mapping):
        expected = (
            "an instrument written out, without format: the receiver adds that of its columns"
        )
        yield Complaint("campaign.instrument", str(instrument), expected)


def of_the_effects(document: Document) -> Iterator[Complaint]:
    """Effects that require what the specification lacks."""
    effects, campaign = document.get("effects", {}), document["campaign"]
    for name, effect in effects.items():
        if "to_s" in effect and effect["to_s"] <= effect["from_s"]:
            expected = f"later than from_s, {effect['from_s']} s"
            yield Complaint(f"effects.{name}.to_s", f"{effect['to_s']}", expected)
        if "temperature" in name and "temperature" not in document:
            yield Complaint("temperature", "nothing", f"its course, since {name} depends on it")
    if "heading_error" in effects and campaign["table"].get("heading_deg") is None:
        expected = "the stated azimuth of the zero mark, of which the true one differs"
        yield Complaint("campaign.table.heading_deg", "nothing", expected)


def of_the_turns(
    handling: Document, manoeuvres: Sequence[Manoeuvre], effects: Sequence[Effect]
) -> Iterator[Complaint]:
    """Turns that effects make longer than the rest after them allows."""
    delay = max(
        sum(effect.gyro_delay() for effect in effects),
        sum(effect.accelerometer_delay() for effect in effects),
    )
    for manoeuvre in manoeuvres:
        planned = manoeuvre.profile
        actual = reduce(lambda profile, effect: effect.actual_profile(profile), effects, planned)
        if isinstance(planned, Trapezoid) and isinstance(actual, Trapezoid):
            needed = actual.seconds - planned.seconds + delay
            if needed > planned.start:
                expected = f"at least {needed:.6g} s, by which effects delay {manoeuvre.name}"
                yield Complaint("handling.still_s", f"{handling['still_s']}", expected)
