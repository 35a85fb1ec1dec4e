"""Differences between tables in sentences."""

from collections.abc import Iterator, Mapping, Sequence

from inertial.campaign.records import Row
from inertial.text import numbers
from inertial.text.messages import _, plural
from stages.report import outline

PPM = 1e-6
MOST_LETTERS = 120
# Either explanation, by the effect; `size` has its sigma.
EXPLAINED = {
    "table_speed_error": _(
        "All gyros read {size} ppm more on {more} than on {less}, along {axes} and in {imus} "
        "alike: either the rates of {more} are higher than set by that much, or those of {less} "
        "lower. Which of them is off the difference does not tell; a third table would, or the "
        "time that whole turns take. A campaign alone takes it for the scale factors of its gyros."
    ),
    "table_angle_scale": _(
        "All gyros read {size} ppm more on {more} than on {less}, along {axes} and in {imus} "
        "alike: either the angles of {more} are larger than stated by that much, or those of "
        "{less} smaller. Which of them is off the difference does not tell; a third table would, "
        "or an optical polygon. A campaign alone takes it for the scale factors of its gyros."
    ),
    "gravity_error": _(
        "All accelerometers read {size} ppm more on {more} than on {less}, along {axes} and in "
        "{imus} alike: either gravity at {more} is larger than stated by that much, or at {less} "
        "smaller, or the clocks of their logs differ. Which of them is off the difference does not "
        "tell; a third table would, or a gravimeter. A campaign alone takes it for the scale "
        "factors of its accelerometers."
    ),
}
STATED = {
    "table_speed_error": _("What is stated of their rates leaves {stated} ppm (1 σ) open."),
    "table_angle_scale": _("What is stated of their angles leaves {stated} ppm (1 σ) open."),
    "gravity_error": _("What is stated of gravity leaves {stated} ppm (1 σ) open."),
}


def difference_sentences(rows: Mapping[str, Sequence[Row]]) -> Iterator[outline.Part]:
    """What each difference may be."""
    effects = {row["finding"]: row["effect"] for row in rows["findings"]}
    for row in rows["table_differences"]:
        effect = effects[row["finding"]]
        said = EXPLAINED[effect].format(
            size=numbers.plus_minus(row["value"] / PPM, row["sigma"] / PPM),
            **_names(row),
            axes=plural("{count} axis", "{count} axes", row["axes"]),
            imus=plural("{count} IMU", "{count} IMUs", row["imus"]),
        )
        if row["stated"] is not None:
            stated = numbers.significant(row["stated"] / PPM, 2)
            said += " " + STATED[effect].format(stated=stated)
        yield outline.Paragraph(said, "fair")


def compared(rows: Mapping[str, Sequence[Row]], finding: str) -> str | None:
    """The tables of a difference; None where a finding is none."""
    for row in rows["table_differences"]:
        if row["finding"] == finding:
            names = _names(row)
            return _("{more} against {less}", more=names["more"], less=names["less"])
    return None


def _names(row: Row) -> dict[str, str]:
    return {key: numbers.shortened(row[key], MOST_LETTERS) for key in ("more", "less")}
