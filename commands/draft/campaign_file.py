"""The campaign file as text: what the logs show, each guess marked, questions at the top."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from commands.draft.formats import (
    format_name,
    formats,
    instrument,
    logs_of,
    part_of,
    wired_otherwise,
)
from commands.draft.header import header
from commands.draft.manoeuvres import Manoeuvre, leaning
from commands.draft.questions import GRAVITY, GRAVITY_SIGMA
from commands.draft.sensors import Kind
from commands.new_campaign import GUESS, flow, guess, in_flow, scalar
from inertial.text.messages import _
from inertial.text.numbers import significant

HAND_POSITION, TABLE_SIGMA = 3600, 180  # arc seconds, of what a person or an unknown table sets
HAND_TURN, FEW_TURNS = 8.0, 3  # °, sigma of an angle by hand; turns that show it
BEST_HAND_TURN = 5.0  # degrees, sigma of an angle by hand that the gyros confirm
TABLE_RATE = 1000  # ppm, of a table of which nothing is known
VERSION = "campaign: 1"


def campaign_file(kinds: Sequence[Kind], plan: Sequence[Manoeuvre], name: str) -> str:
    """The text of campaign.yaml."""
    by_hand = not any(m.by_table for m in plan)
    site = {"latitude_deg": None, "gravity_m_s2": GRAVITY, "gravity_sigma_m_s2": GRAVITY_SIGMA}
    anywhere = _("gravity anywhere on earth; a latitude and height make it better")
    named = formats(kinds)
    logs = {m.part.logs[0].path.name for m in plan}
    lines = [
        *header(kinds, plan, name, by_hand),
        VERSION,
        *instrument(kinds, name),
        "serial: unknown",
        "date: unknown",
        f"site: {flow(**site)}{guess(anywhere)}",
        *(f"notes: {scalar(text)}" for text in wired_otherwise(kinds)),
        *_table(plan, by_hand),
        *(["formats:"] if named else []),
        *(line for lines in named.values() for line in lines),
    ]
    if len(logs) == 1:
        lines += [f"{key}: {in_flow(value)}" for key, value in logs_of(plan[0], kinds).items()]
    lines.append("plan:")
    sigma = _angle_sigma(plan)
    for m, own, position in zip(plan, _ids(plan), _positions(plan), strict=True):
        stated = _keys(m, None if m.by_table else sigma)
        keys = {"id": own, **position, **stated, **part_of(m, kinds)}
        if len(kinds) > 1:
            keys["format"] = format_name(m, kinds)
        if len(logs) > 1:
            keys |= logs_of(m, kinds)
        lines.append(f"  - {flow(**keys)}{_seen(m)}")
    told = _("delete each when it is confirmed")
    lines.insert(lines.index(VERSION) + 1, f"guessed: {in_flow(_guessed(lines))}  # {told}")
    return "\n".join(lines) + "\n"


def _guessed(lines: Sequence[str]) -> list[str]:
    """The parts of the file in which a guess is marked."""
    part, found = "", dict[str, None]()
    for line in lines:
        if opened := re.match(r"(?:  )?(instrument|format|formats|site|table|plan):", line):
            part = "format" if opened[1] == "formats" else opened[1]
        if GUESS in line and not line.startswith("#"):
            found[part] = None
    return list(found)


def _table(plan: Sequence[Manoeuvre], by_hand: bool) -> Iterator[str]:
    """The table; by hand only where the plan says more than positions."""
    if by_hand and all(m.do == "positions" for m in plan):
        return
    if by_hand:
        seen = leaning(plan)
        degrees = 1.0 if seen is None else max(1.0, float(np.ceil(2 * np.degrees(seen)) / 2))
        keys = {"name": "by hand", "position_sigma_arcsec": round(degrees * HAND_POSITION)}
        yield f"table: {flow(**keys)}" + guess(
            _("a case on its faces stands to within {degrees:g}°", degrees=degrees)
        )
    else:
        keys = {
            "name": "not known",
            "position_sigma_arcsec": TABLE_SIGMA,
            "angle_sigma_arcsec": TABLE_SIGMA,
            "rate_sigma_ppm": TABLE_RATE,
        }
        yield f"table: {flow(**keys)}" + guess(_("steady rates are those of a table"))


# ---- the plan


def _angle_sigma(plan: Sequence[Manoeuvre]) -> float:
    """The sigma of the turns by hand, °: how far the gyros have them from round angles."""
    off = [m.seen - m.degrees for m in plan if m.degrees and m.seen and not m.by_table]
    if len(off) < FEW_TURNS:
        return HAND_TURN
    return float(np.clip(np.ceil(np.sqrt(np.mean(np.square(off)))), BEST_HAND_TURN, HAND_TURN))


def _keys(m: Manoeuvre, angle_sigma: float | None) -> dict[str, Any]:
    """What the plan states of a manoeuvre."""
    if m.do == "positions":
        return {"do": "positions"} | ({} if m.seconds is None else {"seconds": m.seconds})
    keys: dict[str, Any] = {"do": m.do, "up": m.up or "unknown"}
    if m.do == "turn":
        if m.about != m.up:
            keys["about"] = m.about
        if m.degrees is not None:
            keys["degrees"] = m.degrees
            if angle_sigma is not None:
                keys["degrees_sigma"] = angle_sigma
        if m.rate is not None:
            keys["rate_deg_s"] = m.rate
        if m.steady:
            keys["recorded"] = "steady"
    elif m.part.label is None and m.rows is None and m.seconds is not None:
        keys["seconds"] = float(f"{m.seconds:.2g}")
    return keys


def _seen(m: Manoeuvre) -> str:
    """What the log shows of a manoeuvre, as a comment behind it."""
    if m.do == "turn" and m.seen is not None:
        angle = significant(m.seen)
        return guess(_("the gyros have {seen}° in {seconds:.1f} s", seen=angle, seconds=m.seconds))
    if m.do == "rest" and m.up is None:
        return guess(_("no axis points up"))
    if m.seconds is None:
        return "  # " + _("{count} means", count=m.count)
    if m.do == "positions":
        return "  # " + _(
            "{count} static positions of at least {seconds:g} s", count=m.count, seconds=m.seconds
        )
    return "  # " + _("{seconds:.1f} s", seconds=m.seconds)


def _ids(plan: Sequence[Manoeuvre]) -> Iterator[str]:
    """A name for each manoeuvre: its label, or what it is, numbered where there are several."""
    names = [_name(m) for m in plan]
    several, used = Counter(names), Counter[str]()
    for name in names:
        used[name] += 1
        yield f"{name}-{used[name]}" if several[name] > 1 else name


def _positions(plan: Sequence[Manoeuvre]) -> Iterator[dict[str, str]]:
    """The position of each manoeuvre that shares one with others, named by the first of them."""
    held = [m.held for m in plan]
    name = ""
    for own, before, behind in zip(_ids(plan), held, [*held[1:], False], strict=True):
        name = name if before else own
        yield {"position": name} if before or behind else {}


def _name(m: Manoeuvre) -> str:
    if slug := re.sub(r"[^a-z0-9+-]+", "-", (m.part.label or "").lower()).strip("-"):
        return slug
    if m.do == "rest":
        return f"{m.up[1]}-{'up' if m.up[0] == '+' else 'down'}" if m.up else "rest"
    if m.do == "turn" and m.about:
        backward = (m.degrees or m.rate or 1) < 0
        return f"{m.about[1]}-{'backward' if backward else 'forward'}"
    return m.do
