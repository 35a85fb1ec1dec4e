"""The page of a fleet: effects with what shares them, populations, outliers, campaigns."""

from argparse import Namespace
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import combinations, groupby
from pathlib import Path

from inertial.campaign.records import Row
from inertial.sensors import PLURAL, SENSORS, SINGULAR
from inertial.tables.fleet import FLEET
from inertial.tables.parquet import Writer
from inertial.tables.whole_files import room_for
from inertial.text import numbers
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed, plural
from inertial.text.typography import capital
from overviews.fleet.declared import READ
from overviews.fleet.differences import change_sentences, compared, difference_sentences
from overviews.fleet.members import members_of
from overviews.fleet.results import results_of
from overviews.tables_of import made_from
from stages.report import outline
from stages.report.page import page
from stages.report.results import quantity_of, symbol
from stages.report.tables import Tables

Rows = Mapping[str, Sequence[Row]]
LEVEL = {
    "type": _("the type"),
    "table": _("the table"),
    "imu": _("the IMU"),
    "campaign": _("the campaign"),
}
EACH = {
    "table": _("each table, with a size of its own"),
    "imu": _("each IMU, with a size of its own"),
    "campaign": _("each campaign, with a size of its own"),
    "type": _("each type, with a size of its own"),
}
# The campaign that would tell two levels apart.
WOULD_TELL = {
    ("type", "table"): _("an IMU of this type on another table"),
    ("type", "imu"): _("another IMU of this type on the same table"),
    ("type", "campaign"): _("a further campaign of another IMU of this type"),
    ("table", "imu"): _("this IMU on another table, or another IMU on this table"),
    ("table", "campaign"): _("a further campaign on this table, of another IMU"),
    ("imu", "campaign"): _("a further campaign of this IMU, on another table"),
}
MOST_CORRELATIONS = 30
CORRELATED = 0.05  # share of false ones among the correlations that are shown


def documents(given: Namespace, code: str) -> dict[str, str]:
    """reports/fleet-<name>.html; the tables of the fleet are written beside those of campaigns."""
    fleet, *campaigns = given.names
    settings = given.settings["fleet"]
    folder = given.derived / ".fleets" / fleet
    members = members_of(campaigns, given.derived)
    rows, searched = results_of(members, **settings)
    made_by = {"stage": "fleet", "settings": settings, "code": code}
    with room_for(folder), Writer(folder, FLEET, lambda: made_by) as writer:
        for name, table in FLEET.items():
            writer.write(name, table.frame(rows[name]))
    files = [given.derived / c / read.place for c in campaigns for read in READ.values()]
    share = settings["false_discoveries"]
    simulated = any(member.simulated for member in members)
    html = fleet_page(rows, searched, share, fleet, files, code, simulated=simulated)
    return {f"fleet-{fleet}.html": html}


def fleet_page(
    rows: Rows,
    searched: int,
    false_discoveries: float,
    name: str,
    files: Sequence[Path],
    code: str,
    *,
    simulated: bool,
) -> str:
    """One HTML page, without network and script."""
    campaigns = rows["campaigns"]
    sections = [
        _effects(rows, searched, false_discoveries),
        _populations(rows),
        _campaigns(rows),
        made_from(files, code),
    ]
    chapters = [
        outline.Chapter(str(number), section, list(section.parts(Tables({}, {}))))
        for number, section in enumerate(sections, 1)
    ]
    counts = [
        plural("{count} campaign", "{count} campaigns", _different(campaigns, "campaign")),
        plural("{count} IMU", "{count} IMUs", _different(campaigns, "imu")),
        plural("{count} table", "{count} tables", _different(campaigns, "table")),
        plural("{count} type", "{count} types", _different(campaigns, "type")),
    ]
    title = _("Fleet {name}", name=name)
    return page(
        outline.Report(
            title=title,
            campaign=title,
            instrument=", ".join(counts),
            running=title,
            simulated=simulated,
            chapters=chapters,
        )
    )


def _different(rows: Sequence[Row], key: str) -> int:
    return len({row[key] for row in rows if row["pooled"]})


def _section(
    key: str, title: str, shows: str, reading: str, parts: Callable[[], Iterator[outline.Part]]
) -> outline.Section:
    return outline.Section(key, title, shows, reading, (), lambda _tables: parts())


# ---- Effects.


def _effects(rows: Rows, searched: int, false_discoveries: float) -> outline.Section:
    def parts() -> Iterator[outline.Part]:
        found = rows["findings"]
        if not searched:
            yield outline.Paragraph(_("Fewer than two campaigns show effects: none was searched."))
            return
        yield outline.Paragraph(
            plural("{count} effect is found.", "{count} effects are found.", len(found))
            + " "
            + _(
                "{searched} hypotheses were searched; of the findings {share} % may be false on "
                "average.",
                searched=searched,
                share=numbers.significant(100 * false_discoveries, 2),
            ),
            "fair" if found else "good",
        )
        yield from difference_sentences(rows)
        yield from change_sentences(rows)
        if found:
            yield _found(rows)
        if rows["sizes"]:
            yield _shares(rows)
            yield _sizes(rows)

    return _section(
        "effects",
        _("Effects that the campaigns show together"),
        _("Each effect of several campaigns, what it belongs to, and how many name it alone."),
        _(
            "An effect of the table is the same in all IMUs on it, one of an IMU goes with it from "
            "table to table, and one of the type has the same sign and size in all. What the "
            "campaigns do not tell apart is named together, with the campaign that would. p is that"
            " of any hypothesis by noise alone. What campaigns name by themselves their own "
            "results state already; what none names is too small for one."
        ),
        parts,
    )


def _found(rows: Rows) -> outline.Table:
    lines = []
    for row in rows["findings"]:
        members = [m for m in rows["members"] if m["finding"] == row["finding"]]
        sharings = [s for s in rows["sharings"] if s["finding"] == row["finding"]]
        possible = [s["level"] for s in sharings if s["possible"]]
        lines.append(
            outline.table_row(
                _with_chances((in_words(m["effect"]), m["probability"]) for m in members),
                row["group"] or compared(rows, row["finding"]) or EACH[row["level"]],
                _with_chances(
                    (LEVEL[s["level"]], s["probability"]) for s in sharings if s["possible"]
                ),
                "—"
                if row["statistic"] is None
                else f"{numbers.significant(row['statistic'], 3)} ({row['degrees']})",
                numbers.probability(row["p_value"]),
                "—"
                if row["asked"] is None
                else _("{count} of {all}", count=row["named_by"], all=row["asked"]),
                "; ".join(would_tell(possible)) or "—",
                tone="fair" if len(possible) > 1 or len(members) > 1 else "",
            )
        )
    return outline.Table(
        _("Effects found."),
        (
            *outline.columns("text", _("Effect"), _("In"), _("Belongs to")),
            outline.Column(_("χ² (degrees)"), "number"),
            outline.Column("p", "number"),
            outline.Column(_("Campaigns that name it alone"), "number"),
            outline.Column(_("What would tell"), "note"),
        ),
        lines,
        note=_(
            "Where several are possible, each has its probability. Between tables p is averaged "
            "over the changes from campaign to campaign that the others leave possible, as that "
            "of Student's t: no χ² goes with it."
        ),
    )


def would_tell(levels: Sequence[str]) -> list[str]:
    """Which campaigns would tell some levels apart."""
    order = list(LEVEL)
    pairs = combinations(sorted(levels, key=order.index), 2)
    return [WOULD_TELL[pair] for pair in pairs]


def _with_chances(named: Iterable[tuple[str, float]]) -> str:
    """Names, each with its probability where there are several."""
    every = list(named)
    if len(every) == 1:
        return every[0][0]
    return listed([f"{name} ({numbers.fixed(100 * p, 0)} %)" for name, p in every], "or")


def _shares(rows: Rows) -> outline.Table:
    lines = [
        outline.table_row(
            in_words(row["effect"]),
            _alike(row["levels"]),
            *(numbers.fixed(100 * row[key], 0) for key in ("share", "sigma")),
        )
        for row in rows["shares"]
    ]
    return outline.Table(
        _("Shares of the mean square of each effect."),
        (
            *outline.columns("text", _("Effect"), _("Belongs to")),
            *outline.value_and_sigma(_("share, %")),
        ),
        lines,
        note=_("Before the data every division into shares is equally probable."),
    )


def _alike(levels: str) -> str:
    return _(" or ").join(LEVEL[level] for level in levels.split(" + "))


def _sizes(rows: Rows) -> outline.Table:
    lines = []
    for finding, own in groupby(rows["sizes"], key=lambda row: row["finding"]):
        effect = next(row["effect"] for row in rows["findings"] if row["finding"] == finding)
        lines.append(outline.head(in_words(effect)))
        lines += [
            outline.table_row(
                numbers.shortened(row["group"], 60),
                symbol(row["parameter"]),
                *_cells(row, row["value"], row["sigma"]),
            )
            for row in own
        ]
    return outline.Table(
        _("Sizes, all findings fitted together."),
        (
            outline.Column(_("In")),
            outline.Column("", "symbol"),
            *outline.value_and_sigma(unit=True),
        ),
        lines,
    )


def _cells(row: Row, value: float, sigma: float | None) -> tuple[str, str, str]:
    unit = quantity_of(row).laboratory
    return (*numbers.with_own_sigma(unit.of(value), unit.of(sigma)), unit.name)


# ---- Populations.


def _populations(rows: Rows) -> outline.Section:
    def parts() -> Iterator[outline.Part]:
        for kind in dict.fromkeys(row["instrument"] for row in rows["population"]):
            yield outline.Heading(kind)
            yield from _outliers([row for row in rows["outliers"] if row["instrument"] == kind])
            for sensor in SENSORS:
                own = [
                    [r for r in rows[name] if (r["instrument"], r["sensor"]) == (kind, sensor)]
                    for name in ("population", "spreads")
                ]
                if own[0]:
                    yield _parameters(sensor, *own)
            yield from _correlations([r for r in rows["correlations"] if r["instrument"] == kind])

    return _section(
        "population",
        _("The population of each type"),
        _("Mean and spread of the parameters, correlations, and IMUs that differ from the others."),
        _(
            "A new IMU of the type is expected at mean ± σ of a new IMU. Behind either σ are its "
            "degrees of freedom, for Student's t. With one table its part is in the mean and not "
            "in σ. Spreads are of largest restricted likelihood; 0: the σ of the campaigns "
            "explains all differences. Outliers are in no number. An error of gravity is one of "
            "all campaigns that take the same value as known, that of all rates of a table one of "
            "all campaigns on it: they are in σ of the mean alone."
        ),
        parts,
    )


def _parameters(sensor: str, rows: Sequence[Row], spreads: Sequence[Row]) -> outline.Table:
    columns = list(dict.fromkeys(row["levels"] for row in spreads))
    lines = []
    for row in rows:
        unit = quantity_of(row).laboratory
        own = {s["levels"]: s for s in spreads if s["parameter"] == row["parameter"]}
        cells = [cell for levels in columns for cell in _spread(own.get(levels), row)]
        lines.append(
            outline.table_row(
                symbol(row["parameter"]),
                *numbers.with_own_sigma(unit.of(row["mean"]), unit.of(row["mean_sigma"])),
                numbers.significant(row["mean_degrees"], 2),
                *cells,
                numbers.significant(unit.of(row["prior_sigma"]), 3),
                numbers.significant(row["prior_degrees"], 2),
                unit.name,
                str(row["imus"]),
            )
        )
    return outline.Table(
        _("Parameters of the {sensor}.", sensor=PLURAL[sensor]),
        (
            outline.Column("", "symbol"),
            *outline.value_and_sigma(_("mean")),
            outline.Column(_("degrees"), "number"),
            *(
                column
                for levels in columns
                for column in outline.value_and_sigma(
                    _("spread by {levels}", levels=_alike(levels))
                )
            ),
            outline.Column(_("σ of a new IMU"), "number"),
            outline.Column(_("degrees"), "number"),
            outline.Column(_("unit"), "unit"),
            outline.Column(_("IMUs"), "number"),
        ),
        lines,
    )


def _spread(spread: Row | None, row: Row) -> tuple[str, str]:
    if spread is None:
        return "—", ""
    if not spread["value"] or spread["sigma"] is None:
        return "0", ""
    unit = quantity_of(row).laboratory
    return numbers.with_own_sigma(unit.of(spread["value"]), unit.of(spread["sigma"]))


def _outliers(rows: Sequence[Row]) -> Iterator[outline.Part]:
    for row in rows:
        yield outline.Paragraph(
            _(
                "{imu} differs from the others of its type: {parameter} of the {sensor} by {size} "
                "σ, {p}.",
                imu=numbers.shortened(row["imu"], 60),
                parameter=row["parameter"].replace("_", " "),
                sensor=SINGULAR[row["sensor"]],
                size=numbers.fixed(row["size"], 1),
                p=numbers.p_is(row["p_value"]),
            ),
            "fair",
        )


def _correlations(rows: Sequence[Row]) -> Iterator[outline.Part]:
    """Those of which few are false (Benjamini & Hochberg 1995)."""
    ordered = sorted(rows, key=lambda row: float(row["p_value"]))
    count = max(
        (n for n, r in enumerate(ordered, 1) if r["p_value"] <= CORRELATED * n / len(ordered)),
        default=0,
    )
    if not rows:
        return
    lines = [
        outline.table_row(
            *(capital(row[key].replace("_", " ")) for key in ("first", "second")),
            *numbers.with_own_sigma(row["correlation"], row["sigma"]),
            numbers.probability(row["p_value"]),
        )
        for row in ordered[:count][:MOST_CORRELATIONS]
    ]
    yield outline.Table(
        _("Parameters that are correlated between IMUs."),
        (
            *outline.columns("text", _("Parameter"), _("with")),
            *outline.value_and_sigma(_("correlation")),
            outline.Column("p", "number"),
        ),
        lines,
        note=outline.more(count - MOST_CORRELATIONS, ""),
    )


# ---- Campaigns.


def _campaigns(rows: Rows) -> outline.Section:
    def parts() -> Iterator[outline.Part]:
        yield outline.Table(
            _("Campaigns of the fleet."),
            outline.columns("text", _("Campaign"), _("Type"), _("IMU"), _("Table"), _("Remark")),
            [
                outline.table_row(
                    *(
                        numbers.shortened(row[key], 60)
                        for key in ("campaign", "type", "imu", "table")
                    ),
                    _("not pooled: {reason}", reason=row["reason"]) if row["reason"] else "",
                )
                for row in rows["campaigns"]
            ],
        )

    return _section(
        "campaigns",
        _("Campaigns"),
        _("What was taken together. A table without a name may be any, so it is one of its own."),
        "",
        parts,
    )
