"""The page of all campaigns: IMUs with their due dates, campaigns with verdict, cause, sigmas."""

import json
from argparse import Namespace
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from inertial.sensors import SENSORS, SINGULAR, unit_of
from inertial.text import numbers
from inertial.text.messages import _, plural
from inertial.text.parameters import PARTS
from inertial.text.typography import capital
from inertial.text.units import Unit, quantity
from overviews.known import serials, with_result
from overviews.tables_of import RESULT, files_of, made_from, tables_of
from overviews.units import Imu, imus_of
from stages import ORDER
from stages.report import outline
from stages.report.page import page
from stages.report.sections.findings import causes, harmless, title_of
from stages.report.sections.verdict import LEVELS, worst
from stages.report.tables import Tables

SCRIPT = Path(__file__).with_name("sorted_tables.js")
MOST_CAUSES = 2
KINDS = {"bias": _("bias"), "scale": _("scale"), "cross": _("cross")}


@dataclass(frozen=True)
class Without:
    """A campaign without a result, and what its last run said, where it was run."""

    campaign: str
    said: str


def documents(given: Namespace, code: str) -> dict[str, str]:
    """reports/index.html, of the campaigns named."""
    names = with_result(given.names, given.derived)
    settings = {"tolerance": {}} | given.settings["history"]
    html = index_page(
        {name: tables_of(given.derived / name, RESULT) for name in names},
        [Without(n, last_words(given.derived / n)) for n in given.names if n not in names],
        {
            folder: imus_of(given.archive, folder, given.derived, **settings)
            for folder in serials(given.archive)
        },
        (given.derived, given.reports),
        code,
    )
    return {"index.html": html}


def last_words(derived: Path) -> str:
    """What the first stage that failed said."""
    for stage in ORDER:
        log = derived / stage / "stage.log"
        if log.is_file() and (said := log.read_text("utf-8", "replace").split()):
            return " ".join(said)
    return ""


def index_page(
    campaigns: Mapping[str, Tables],
    without: Sequence[Without],
    imus: Mapping[str, Sequence[Imu]],
    folders: tuple[Path, Path],
    code: str,
) -> str:
    """One HTML page that filters and sorts itself, with no network.

    campaigns : tables of those with a result; imus : by the file name of the serial number;
    folders : of the tables and of the pages
    """
    derived, reports = folders
    every = [imu for own in imus.values() for imu in own]
    due = {imu.last.row["campaign"]: imu.due for imu in every}
    files = [file for name in campaigns for file in files_of(derived / name, RESULT)]
    sections = [
        _campaigns(campaigns, without, due, reports),
        _imus(imus, reports),
        made_from(files, code),
    ]
    chapters = [
        outline.Chapter(str(number), section, list(section.parts(Tables({}, {}))))
        for number, section in enumerate(sections, 1)
    ]
    return page(
        outline.Report(
            title=_("Calibrations"),
            campaign=_("All campaigns"),
            instrument=", ".join(
                (
                    plural("{count} campaign", "{count} campaigns", len(campaigns) + len(without)),
                    plural("{count} IMU", "{count} IMUs", len(every)),
                )
            ),
            running=_("All campaigns"),
            simulated=False,
            chapters=chapters,
            script=_script(),
            wide=True,
        )
    )


def _script() -> str:
    """The script with its words; no text of a campaign is among them."""
    words = {
        "filter": _("Filter by words"),
        "sort": _("Sort by"),
        "shown": _("{shown} of {all} shown", shown="{shown}", all="{all}"),
        "days": _("days"),
        "months": _("months"),
        "years": _("years"),
        "ago": _("{span} ago", span="{span}"),
        "ahead": _("in {span}", span="{span}"),
        "overdue": _("overdue by"),
    }
    text = json.dumps(words, ensure_ascii=False).replace("<", "\\u003c")
    return f"const words = {text};\n{SCRIPT.read_text(encoding='utf-8')}"


# ---- Campaigns.


def _campaigns(
    campaigns: Mapping[str, Tables],
    without: Sequence[Without],
    due: Mapping[str, str | None],
    reports: Path,
) -> outline.Section:
    def parts(_tables: Tables) -> Iterator[outline.Part]:
        newest_first = sorted(
            campaigns.items(), key=lambda item: _day(item[1].row("campaign")["date"]), reverse=True
        )
        yield outline.Table(
            _("Campaigns with a result, the newest first."),
            (
                outline.Column(_("Campaign")),
                *outline.columns("text", _("IMU"), _("Date"), _("Verdict"), _("Causes")),
                *(
                    outline.Column(
                        f"{name}, {_unit(sensor, kind).name}",
                        "number",
                        _("worst σ, {sensor}", sensor=SINGULAR[sensor]),
                    )
                    for sensor in SENSORS
                    for kind, name in KINDS.items()
                ),
                outline.Column(_("Due")),
            ),
            [_row(name, tables, due.get(name), reports) for name, tables in newest_first],
            _("None: no campaign has a result yet."),
            _(
                "Due: of the newest campaign of an IMU; section IMUs says why there is no date. "
                "Two campaigns beside each other: make compare A=… B=…"
            ),
            sortable=True,
        )
        if without:
            yield outline.Table(
                _("Campaigns without a result."),
                (outline.Column(_("Campaign")), outline.Column(_("What the last run said"))),
                [
                    outline.table_row(
                        numbers.shortened(one.campaign, 80),
                        numbers.shortened(one.said, 300) or _("not run yet"),
                    )
                    for one in without
                ],
            )

    return outline.Section(
        "campaigns",
        _("Campaigns"),
        _("Each campaign with its verdict, the causes behind it, and its largest sigmas."),
        _(
            "The verdict is that of the worse sensor, a cause what moves a result or was removed. "
            "A worst σ is the largest of the three biases, three scale factors or six cross-axis "
            "terms of the final result; — where one of them has no value."
        ),
        (),
        parts,
    )


def _day(date: str) -> str:
    """A date to be sorted by; nothing where it is not known."""
    return date if date[:1].isdigit() else ""


def _row(name: str, tables: Tables, due: str | None, reports: Path) -> outline.Row:
    about, level = tables.row("campaign"), worst(tables)
    word, tone, _meaning = LEVELS[level]
    sigmas = [_worst_sigma(tables, sensor, kind) for sensor in SENSORS for kind in KINDS]
    date = numbers.shortened(about["date"], 20)
    serial, instrument = (numbers.shortened(about[key], 60) for key in ("serial", "instrument"))
    imu = f"{serial} · {instrument}" + (_(" · simulated") if about["simulated"] else "")
    cells = (
        numbers.shortened(name, 80),
        imu,
        date,
        word,
        _causes(tables) or _("none"),
        *(numbers.significant(sigma, 2) for sigma in sigmas),
        due or "—",
    )
    order = (
        name,
        imu,
        f"date:{date}" if date[:1].isdigit() else "",
        str(list(LEVELS).index(level)),
        cells[4],
        *("" if sigma is None else f"{sigma:.6g}" for sigma in sigmas),
        f"due:{due}" if due else "",
    )
    return outline.Row(
        cells, tone="" if tone == "good" else tone, href=_link(reports, f"{name}.html"), sort=order
    )


def _link(reports: Path, file: str) -> str:
    """The address of a page relative to this one, where there is one."""
    return quote(file) if (reports / file).is_file() else ""


def _causes(tables: Tables) -> str:
    """The gravest of what is not harmless."""
    titles = [title_of(tables, row) for row in causes(tables) if not harmless(row)]
    titles = list(dict.fromkeys(titles))
    more = len(titles) - MOST_CAUSES
    shown = "; ".join(titles[:MOST_CAUSES])
    return shown + (_("; {count} more", count=more) if more > 0 else "")


def _unit(sensor: str, kind: str) -> Unit:
    parameter = next(name for name, parts in PARTS.items() if parts.kind == kind)
    return quantity(parameter, unit_of(sensor, parameter)).laboratory


def _worst_sigma(tables: Tables, sensor: str, kind: str) -> float | None:
    """The largest sigma of a kind, unit of the laboratory; none where one has no value."""
    sigmas = [
        row["sigma"] if row["value"] is not None else None
        for row in tables.rows("result")
        if row["sensor"] == sensor
        and row["effect"] is None
        and row["parameter"] in PARTS
        and PARTS[row["parameter"]].kind == kind
    ]
    known = [sigma for sigma in sigmas if sigma is not None]
    return _unit(sensor, kind).of(max(known)) if known and len(known) == len(sigmas) else None


# ---- IMUs.


def _imus(imus: Mapping[str, Sequence[Imu]], reports: Path) -> outline.Section:
    def parts(_tables: Tables) -> Iterator[outline.Part]:
        yield outline.Table(
            _("IMUs with a serial number."),
            (
                outline.Column(_("Serial")),
                outline.Column(_("Instrument")),
                outline.Column(_("Calibrations"), "number"),
                outline.Column(_("Last")),
                outline.Column(_("Jumps"), "number"),
                outline.Column(_("Due")),
                outline.Column(_("Why not"), "note"),
            ),
            [_imu(folder, imu, reports) for folder, own in imus.items() for imu in own],
            _("None: the archive holds no calibration with a serial number."),
            sortable=True,
        )

    return outline.Section(
        "imus",
        _("IMUs"),
        _("Each IMU of the archive with its last calibration and the day on which it is due."),
        _("The serial number leads to the history of its parameters."),
        (),
        parts,
    )


def _imu(folder: str, imu: Imu, reports: Path) -> outline.Row:
    row, due = imu.last.row, imu.due
    date = numbers.shortened(row["date"], 20)
    instrument = imu.name + (_(" · simulated") if imu.simulated else "")
    jumps = len(imu.tables.rows("jumps"))
    cells = (
        numbers.shortened(row["serial"], 80),
        numbers.shortened(instrument, 80),
        numbers.whole(len(imu.calibrations)),
        date,
        numbers.whole(jumps),
        due or "—",
        "" if due else capital(numbers.shortened(imu.why_not_due, 300)),
    )
    order = (
        *cells[:2],
        str(len(imu.calibrations)),
        f"date:{date}" if date[:1].isdigit() else "",
        str(jumps),
        f"due:{due}" if due else "",
        cells[6],
    )
    return outline.Row(cells, href=_link(reports, f"history/{folder}.html"), sort=order)
