"""What to record, before anything or next.

    python -m commands.design --instrument imar-fsas --table three-axis --minutes 30
    python -m commands.design --campaign june --table three-axis
    python -m commands.design --campaign june --table three-axis --want gyroscope/scale=5e-6

From nothing: the best plan of this time, with the sigmas that are foreseen and the detection
limits, beside those of S0's and S3's plans. Of a campaign: what splits its classes, or reaches the
wanted sigmas. Either writes a campaign file to record by. It ends with 0, or with 2 where an input
cannot be used.
"""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from ruamel.yaml import YAML

from commands import run
from commands.design import for_campaign, printed
from commands.design.for_campaign import (
    Splitting,
    campaign_tables,
    classes_of,
    reach,
    wanted_sigmas,
)
from commands.design.from_nothing import Designed, best, foreseen_of
from commands.design.printed import new_campaign, with_more
from commands.design.turntable import FULL_SCALE_SHARE, Instrument, Turntable, instrument, turntable
from commands.design.visits import Item, possible, published
from commands.new import free_folder
from inertial import tables
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.foreseen import session_seconds
from inertial.estimation.optimal_design import CRITERIA, A
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.numbers import visible
from inertial.text.units import DEGREE

PLANS = {"S0": "six-position", "S3": "turn-stop"}  # commands/plans, by the label of their source
SHARE = 0.5  # of the time of a campaign, that may be spent to split a class


def main(arguments: Sequence[str] | None = None) -> int:
    """Design, print and write; the exit code."""
    parser = argparse.ArgumentParser(prog="design", description="what to record")
    parser.add_argument("--campaign", default="", help="what to record next in a campaign")
    parser.add_argument("--instrument", default="", help="an entry of data/instruments.yaml")
    parser.add_argument("--table", default="", help="an entry of data/tables.yaml")
    parser.add_argument("--minutes", default="30", help="at the table, from nothing")
    parser.add_argument("--criterion", default=A, choices=CRITERIA, help="of the variances")
    parser.add_argument("--want", default="", help="sigmas, such as gyroscope/scale=5e-6, SI")
    parser.add_argument("--name", default="", help="of the campaign that is written")
    parser.add_argument("--data", type=Path, default=Path("data"), help="holds tables.yaml, raw/")
    options = parser.parse_args(arguments)
    try:
        table = turntable(options.table, options.data)
        if options.instrument:
            imu = instrument(options.instrument, options.data)
            name = options.name or f"{options.instrument}-{options.table}"
            folder = free_folder(name, options.data)
            text, file = _from_nothing(
                imu, table, _minutes(options.minutes), options.criterion, name
            )
        else:
            name = options.name or f"{options.campaign}-next"
            folder = free_folder(name, options.data)
            text, file = _next(options.campaign, table, options.want.split(), options.data)
    except Refusal as refusal:
        sys.stderr.write(visible(f"design: {refusal}\n"))
        return 2
    sys.stdout.write(visible(f"{text}\n"))
    if file:
        folder.mkdir(parents=True)
        (folder / "campaign.yaml").write_text(file, encoding="utf-8")
        sys.stdout.write(visible(_("Written: {path}\n", path=folder / "campaign.yaml")))
    return 0


def _minutes(stated: str) -> float:
    try:
        minutes = float(stated)
    except ValueError:
        minutes = np.nan
    if not 1 <= minutes <= 1000:
        raise Refusal(
            "MINUTES", "", repr(stated), _("1 to 1000 minutes"), _("state the time at the table")
        )
    return minutes


def source_plans(imu: Instrument, table: Turntable) -> dict[str, Designed]:
    """What is foreseen of S0's and S3's plans at this table, whatever attitudes it sets."""
    folder, found = Path(__file__).parent.parent / "plans", {}
    for label, plan in PLANS.items():
        content = YAML(typ="safe").load(folder / f"{plan}.yaml")
        found[label] = foreseen_of(list(published(content["plan"], table)), table, imu.noise)
    return found


def _from_nothing(
    imu: Instrument, table: Turntable, minutes: float, criterion: str, name: str
) -> tuple[str, str]:
    """The text of a design, and of its campaign file."""
    beside = source_plans(imu, table)
    made = best(imu, table, minutes, criterion, beside["S3"].sigmas)
    file = new_campaign(name, imu, table, made.items, made.seconds / 60)
    return printed.from_nothing(made, beside), file


def _next(
    campaign: str, table: Turntable, want: Sequence[str], data_folder: Path
) -> tuple[str, str]:
    """What to record next in a campaign, and its campaign file with that."""
    derived = data_folder / "derived" / campaign
    mounts = campaign_tables(derived)
    limit = FULL_SCALE_SHARE * _full_scale(derived)
    if want:
        data = mounts[0]
        reached = reach(data, _at(table, data), possible(table, limit), wanted_sigmas(want))
        text, items, seconds = printed.of_wanted(reached), reached.items, reached.seconds
    else:
        classes = classes_of(
            tables.EFFECT_FINDINGS.read(derived / "criticism/findings.parquet"),
            tables.MEMBERS.read(derived / "criticism/members.parquet"),
            tables.SCORES.read(derived / "criticism/scores.parquet"),
        )
        if not classes:
            return _(
                "Nothing to add: each effect that was found in this campaign is one alone, or none "
                "was found. For a smaller sigma state WANT=, such as gyroscope/scale=5e-6."
            ), ""
        data = next(each for each in mounts if each.mount == classes[0].mount)
        here, own = _at(table, data), session_seconds(data.plan, table.pace)
        visits = possible(
            here,
            limit,
            for_campaign.RESTS,
            for_campaign.RATE_SHARES,
            for_campaign.TURNING,
            both=False,
            single=True,
        )
        added = Splitting(data, classes[0], here).best(visits, SHARE * own)
        text, items, seconds = printed.of_class(added, own), added.items, added.seconds
    return text, _extended_file(data_folder / "raw" / campaign, items, data.mount, seconds)


def _extended_file(folder: Path, items: Sequence[Item], mount: str, seconds: float) -> str:
    if not items:
        return ""
    text = (folder / "campaign.yaml").read_text(encoding="utf-8")
    return with_more(text, items, mount, seconds / 60)[0]


def _at(table: Turntable, data: CampaignData) -> Turntable:
    """The table, as well known as the campaign states."""
    return replace(table, known=data.known)


def _full_scale(derived: Path) -> float:
    """Of the gyros, °/s; inf where it is not known."""
    sensors = tables.SENSORS.read(derived / "plan/sensors.parquet")
    scale = sensors.loc[sensors["sensor"] == "gyro", "full_scale"].min()
    return np.inf if np.isnan(scale) else float(scale) / DEGREE


if __name__ == "__main__":
    run(main)
