"""What tables do to all sensors alike, and which scale factors changed, in sentences."""

from collections.abc import Iterator, Mapping, Sequence

from inertial.campaign.records import Row
from inertial.sensors import PLURAL
from inertial.text import numbers
from inertial.text.messages import _, plural
from stages.report import outline

Rows = Mapping[str, Sequence[Row]]
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

ALIKE = _(
    "No difference between tables is found in the {sensors}: {more} against {less} {size} ppm, {p}."
    " From one campaign of an IMU to the next each scale factor changes by {change} ppm (1 σ),"
    " beside its own σ."
)
COMMON = _(
    "Whether tables differ the {sensors} do not tell: {more} against {less} {size} ppm, {p}, but "
    "changes that all axes of an IMU have in common explain it as well. A further IMU on both "
    "would tell."
)
LARGER = _(
    "{imu}: the scale factor {axis} of the {sensors} is {size} ppm larger in {campaign} than in "
    "{others}, errors of tables apart, {p}. The others change by far less: it drifted, or one of "
    "these calibrations is wrong. It is in no comparison of tables."
)
SMALLER = _(
    "{imu}: the scale factor {axis} of the {sensors} is {size} ppm smaller in {campaign} than in "
    "{others}, errors of tables apart, {p}. The others change by far less: it drifted, or one of "
    "these calibrations is wrong. It is in no comparison of tables."
)


def difference_sentences(rows: Rows) -> Iterator[outline.Part]:
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

    for row in rows["tables_alike"]:
        size = numbers.plus_minus(row["value"] / PPM, row["sigma"] / PPM)
        yield outline.Paragraph(
            (COMMON if row["as_well"] else ALIKE).format(
                sensors=PLURAL[row["sensor"]],
                size=size,
                **_names(row),
                p=numbers.p_is(row["p_value"]),
                change=numbers.significant(row["change"] / PPM, 2),
            )
        )


def change_sentences(rows: Rows) -> Iterator[outline.Part]:
    """Scale factors that changed by more than the others."""
    for row in rows["outlying_changes"]:
        yield outline.Paragraph(
            (LARGER if row["value"] > 0 else SMALLER).format(
                sensors=PLURAL[row["sensor"]],
                axis=row["axis"],
                size=numbers.plus_minus(abs(row["value"]) / PPM, row["sigma"] / PPM),
                imu=numbers.shortened(row["imu"], MOST_LETTERS),
                campaign=numbers.shortened(row["campaign"], MOST_LETTERS),
                others=numbers.shortened(row["others"], MOST_LETTERS),
                p=numbers.p_is(row["p_value"]),
            ),
            "fair",
        )


def compared(rows: Rows, finding: str) -> str | None:
    """The tables of a difference; None where a finding is none."""
    for row in rows["table_differences"]:
        if row["finding"] == finding:
            names = _names(row)
            return _("{more} against {less}", more=names["more"], less=names["less"])
    return None


def _names(row: Row) -> dict[str, str]:
    return {key: numbers.shortened(row[key], MOST_LETTERS) for key in ("more", "less")}
