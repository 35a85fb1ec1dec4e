"""The campaign file of a design: a new one, or a recorded one with what is to be added."""

from collections.abc import Sequence
from io import StringIO
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

from commands.design.turntable import Instrument, Turntable
from commands.design.visits import Item
from commands.new import LINE_WIDTH, comment, flow
from inertial.text.messages import _

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
