"""What a campaign takes as known: every quantity with its sigma and where it is from."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from math import cos, pi, radians, sin
from typing import Any

from inertial.campaign.records import Row
from inertial.campaign.references import BY_HAND
from inertial.physics.site import (
    EARTH_RATE,
    HEIGHT_SIGMA,
    USUAL_HEIGHT,
    earth_rate,
    gravity_at,
    is_refuted,
    latitude_of,
)
from inertial.tables.yaml_file import YamlFile
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.statements import (
    GUESSED,
    NO_POSITION_SET,
    NO_TABLE,
    NO_TURN_SET,
    STATED,
)
from inertial.text.units import ARC_SECOND, DEGREE_PER_HOUR

# Where a campaign states no sigma, these are assumed, and the report states that.
ASSUMED_POSITION = 30 * ARC_SECOND
ASSUMED_ANGLE = 30 * ARC_SECOND
ASSUMED_RATE = 1e-3
ASSUMED_GRAVITY = 5e-5  # m/s² of a stated value: 5 mGal
ASSUMED_LATITUDE = radians(0.01)


def by_hand(campaign: dict[str, Any]) -> bool:
    """Whether there is no table: none is stated, or it is said."""
    return bool(campaign.get("table", {"name": BY_HAND}).get("name") == BY_HAND)


def _sets_positions(file: YamlFile) -> bool:
    """Whether any manoeuvre begins in a position that is known, or turns about a known axis."""
    plan = file.content["plan"]
    return any(item.get("up", "unknown") != "unknown" or item["do"] == "turn" for item in plan)


def known(file: YamlFile, repairs: Sequence[Row] = ()) -> Iterator[Row]:
    """Every quantity that the estimation takes as known, with its sigma and where it is from.

    `repairs`: those of gravity, of which at most one is applied.
    """
    site, table = file.content["site"], file.content.get("table", {})
    guessed = file.content.get("guessed", [])
    sets_positions, handled = _sets_positions(file), by_hand(file.content)
    turns = any(item["do"] == "turn" for item in file.content["plan"])
    if handled and sets_positions and "position_sigma_arcsec" not in table:
        raise file.refuse_text(
            ["table"],
            _("no position_sigma_arcsec"),
            _("position_sigma_arcsec for positions set by hand"),
            _(
                "state how well the faces were set, for example table: {example} for 1°",
                example="{name: by hand, position_sigma_arcsec: 3600}",
            ),
        )
    gravity, origin = _gravity(file), GUESSED if "site" in guessed else _gravity_origin(site)
    for repair in repairs:
        if repair["state"] != "refused":
            gravity, origin = (repair["value"], repair["sigma"]), repair["sentence"]
    yield _row("gravity", *gravity, "m/s²", origin, assumed=origin == GUESSED)
    yield from _earth_rate(site["latitude_deg"])
    heading = table.get("heading_deg")
    if heading is None:
        of_none = NO_TABLE if handled and not sets_positions else _("not known")
        yield _row("heading", None, None, "rad", of_none)
    else:
        yield _row("heading", radians(heading), None, "rad", STATED)
    of_table = partial(_of_table, table, GUESSED if "table" in guessed else STATED)
    if sets_positions or "position_sigma_arcsec" in table:
        yield of_table("position", "position_sigma_arcsec", ARC_SECOND, ASSUMED_POSITION, "rad")
    else:
        yield _row("position", 0.0, ASSUMED_POSITION, "rad", NO_POSITION_SET)
    if "angle_sigma_arcsec" not in table and (sigmas := _sigmas_of_turns(file.content["plan"])):
        by_plan = GUESSED if "plan" in guessed else _("stated in the plan, the largest of a turn")
        sigma = radians(max(sigmas))
        yield _row("turn_angle", 0.0, sigma, "rad", by_plan, assumed=by_plan == GUESSED)
    elif handled and not turns and "angle_sigma_arcsec" not in table:
        yield _row("turn_angle", 0.0, ASSUMED_ANGLE, "rad", NO_TURN_SET)
    else:
        yield of_table("turn_angle", "angle_sigma_arcsec", ARC_SECOND, ASSUMED_ANGLE, "rad")
    if handled and not turns and "rate_sigma_ppm" not in table:
        yield _row("turn_rate", 0.0, ASSUMED_RATE, "1", NO_TABLE)
    else:
        yield of_table("turn_rate", "rate_sigma_ppm", 1e-6, ASSUMED_RATE, "1")


def _sigmas_of_turns(plan: Sequence[Mapping[str, Any]]) -> list[float]:
    """The sigma of the angle of each turn, degrees; none unless the plan states it of all."""
    turns = [item for item in plan if item["do"] == "turn" and "degrees" in item]
    return [i["degrees_sigma"] for i in turns] if all("degrees_sigma" in i for i in turns) else []


def _row(
    quantity: str,
    value: float | None,
    sigma: float | None,
    unit: str,
    origin: str,
    *,
    assumed: bool = False,
) -> Row:
    return {
        "quantity": quantity,
        "value": value,
        "sigma": sigma,
        "unit": unit,
        "origin": origin,
        "assumed": assumed,
    }


def _of_table(
    table: Mapping[str, Any],
    stated: str,
    quantity: str,
    key: str,
    unit_size: float,
    assumed: float,
    unit: str,
) -> Row:
    """The sigma of what the table sets, `stated` or `assumed`; `unit_size`: of the key."""
    if key in table:
        sigma = table[key] * unit_size
        return _row(quantity, 0.0, sigma, unit, stated, assumed=stated == GUESSED)
    origin = _("assumed, for the campaign file states no {key}", key=key)
    return _row(quantity, 0.0, assumed, unit, origin, assumed=True)


def _earth_rate(latitude_deg: float | None) -> Iterator[Row]:
    """The latitude, rad, where it is stated, and the parts upwards and level, rad/s."""
    if latitude_deg is None:
        # A direction of which nothing is known: each part has a third of the squared rate.
        unknown = _("assumed, for the latitude is not known")
        yield _row("earth_rate_up", 0.0, EARTH_RATE / 3**0.5, "rad/s", unknown, assumed=True)
        # Its square is two thirds of the whole on the average, itself π/4.
        level, level_sigma = (EARTH_RATE * part**0.5 for part in (2 / 3, 2 / 3 - (pi / 4) ** 2))
        rough = _(
            "assumed, for the latitude is not known; its sigma, {sigma} °/h, is neglected",
            sigma=significant(level_sigma / DEGREE_PER_HOUR, 2),
        )
        yield _row("earth_rate_level", level, None, "rad/s", rough, assumed=True)
        return
    latitude = radians(latitude_deg)
    up, level = earth_rate(latitude)
    up_sigma, level_sigma = (
        EARTH_RATE * abs(share) * ASSUMED_LATITUDE for share in (cos(latitude), sin(latitude))
    )
    stated = _("stated; its sigma is assumed")
    yield _row("latitude", latitude, ASSUMED_LATITUDE, "rad", stated)
    yield _row("earth_rate_up", up, up_sigma, "rad/s", _("computed from the latitude"))
    neglected = _(
        "computed from the latitude; its sigma, {sigma} °/h, is neglected",
        sigma=significant(level_sigma / DEGREE_PER_HOUR, 2),
    )
    yield _row("earth_rate_level", level, None, "rad/s", neglected)


def _gravity(file: YamlFile) -> tuple[float, float]:
    site = file.content["site"]
    stated: float | None = site.get("gravity_m_s2")
    if stated is not None:
        return stated, site.get("gravity_sigma_m_s2", ASSUMED_GRAVITY)
    if site["latitude_deg"] is None:
        raise file.refuse_text(
            ["site"],
            _("neither gravity_m_s2 nor a latitude"),
            _("one of the two"),
            _("state gravity_m_s2, or latitude_deg and height_m for normal gravity"),
        )
    value, sigma = gravity_at(radians(site["latitude_deg"]), site.get("height_m"))
    return value, site.get("gravity_sigma_m_s2", sigma)


def gravity_repairs(file: YamlFile, repairs: str) -> Iterator[Row]:
    """Normal gravity in place of a stated one that is not that of the place, if it is not.

    Parameters
    ----------
    repairs : apply or refuse
    """
    site = file.content["site"]
    if "gravity_m_s2" not in site or site["latitude_deg"] is None:
        return
    stated, sigma = _gravity(file)
    latitude, height = radians(site["latitude_deg"]), site.get("height_m")
    if not is_refuted(stated, sigma, latitude, height):
        return
    value, of_value = gravity_at(latitude, height)
    place = _place(site)
    state = "confirmed" if "gravity" in file.content.get("accept", []) else "applied"
    yield {
        "id": "gravity",
        "repair": "gravity",
        "state": state if repairs == "apply" else "refused",
        "sensor": "accel",
        "value": value,
        "sigma": of_value,
        "stated": stated,
        "unit": "m/s²",
        "finding": "quality/gravity_error/accel",
        "condition": _(
            "gravity is that of {place}, not the stated {stated:.5f} m/s².{rival}",
            place=place,
            stated=stated,
            rival="" if height is None else _other_latitude(stated, site["latitude_deg"], height),
        ),
        "sentence": _(
            "Gravity is taken as {value:.5f} m/s², normal gravity at {place}, in place of the "
            "stated {stated:.5f} m/s².",
            value=value,
            place=place,
            stated=stated,
        ),
    }


def _other_latitude(stated: float, latitude: float, height: float) -> str:
    """What latitude would explain a gravity, which is degrees away where no anomaly does."""
    other = latitude_of(stated, height)
    if other is None:
        return _(" No latitude explains it.")
    return _(
        " A latitude of {other:.1f}° would explain it as well, {away:.1f}° from the stated one.",
        other=other,
        away=abs(other - abs(latitude)),
    )


def _gravity_origin(site: dict[str, Any]) -> str:
    if "gravity_m_s2" in site:
        if "gravity_sigma_m_s2" in site:
            return STATED
        return _("{stated}, its sigma assumed as 5 mGal", stated=STATED)
    return _("normal gravity at {place}", place=_place(site))


def _place(site: Mapping[str, Any]) -> str:
    """Latitude and height in words, with what is assumed of a height that is not stated."""
    if "height_m" in site:
        return _(
            "latitude {latitude_deg:g}°, height {height_m:g} m",
            latitude_deg=site["latitude_deg"],
            height_m=site["height_m"],
        )
    return _(
        "latitude {latitude_deg:g}°, height assumed as {usual:.0f} ± {sigma:.0f} m, for none is "
        "stated",
        latitude_deg=site["latitude_deg"],
        usual=USUAL_HEIGHT,
        sigma=HEIGHT_SIGMA,
    )
