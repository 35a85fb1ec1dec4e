"""What is wrong with a recording, before the set-up is dismantled.

python -m commands.check --campaign demo

It reads the findings of all stages up to criticism, which parameters are determined, and the
verdict of the diagnosis, all of which `make check` lets the workflow make first; criticism and
diagnosis only where they are there. It states what gets no result,
and each cause with what follows from it. It ends with 0 where each sensor gets a result, if on a
condition, whether that is a repair or something assumed; with 1 where something spoils a result or
a sensor gets none, and with 2 where the tables are missing.
"""

import argparse
import sys
import textwrap
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path

import numpy as np
import pandas as pd

from commands import run
from inertial import tables
from inertial.campaign.competition import ExplainedFindings, circumstances, compete
from inertial.campaign.hypotheses import UNKNOWN_STRUCTURE, Findings, hypotheses
from inertial.campaign.noise_levels import only_noise
from inertial.campaign.records import Performed, Row, performed_of, rows_of
from inertial.estimation.triad import linear_names
from inertial.tables.declared import read_declared
from inertial.tables.errors import Refusal
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.numbers import counted, shortened, significant, visible
from inertial.text.parameters import SENSOR_OF, sign_of
from inertial.text.units import DEGREE_PER_HOUR, STANDARD_GRAVITY
from stages.diagnosis.causes import (
    APPLIED,
    INTERPOLATED,
    LEFT_OUT,
    MASKED,
    NONE,
)
from stages.diagnosis.decision import MAX_MOVE
from stages.diagnosis.declared import DECLARED
from stages.diagnosis.sizes_of_causes import MAX_HARMLESS_MOVE

# ---- What leaves the report without a result, though nothing need be wrong with the recording.

TWELVE = linear_names()
MIN_NEW_POSITION_DEG = 5.0  # degrees: less than this from the rest before is no new position
MAX_SPLIT = 0.5  # share of rests that are no new position
MAX_REASONS = 4
SEE_REPORT = _("the report shows the residuals: make report")


@dataclass(frozen=True)
class NoResult:
    """What gets no result, or none to rely on, why, and the cure; `sensor`: gyro or accel.

    `incomplete`: whether some of its parameters are determined, which stand in the report.
    """

    subject: str
    sentence: str
    action: str
    sensor: str = ""
    incomplete: bool = False


def no_results(derived: Path) -> Iterator[NoResult]:
    """Of the tables of a campaign.

    Raises
    ------
    Refusal
        where one of them is missing, damaged, or of another version
    """
    blocks = tables.BLOCKS.read(derived / "segment/blocks.parquet")
    recorded = {
        s: bool(_readings(blocks, channel).notna().any(axis=None))
        for s, channel in SENSOR_OF.items()
    }
    plan = tables.MANOEUVRES.read(derived / "plan/manoeuvres.parquet")
    if only_noise(plan, tables.NOISE_TERMS.read(derived / "noise/terms.parquet")):
        return
    verdicts = _not_usable(derived / "diagnosis/verdict.parquet")
    curves = _with_curves(derived / "diagnosis/temperature_curves.parquet")
    for stage in SENSOR_OF:
        if recorded[stage] or not any(recorded.values()):
            subject = _("gyros") if stage == "gyroscope" else _("accelerometers")
            parameters = tables.PARAMETERS.read(derived / f"{stage}/parameters.parquet")
            nothing = parameters["value"].isna().all()
            found = list(_undetermined(subject, parameters))
            if nothing and SENSOR_OF[stage] in curves and SENSOR_OF[stage] not in verdicts:
                continue  # of use for what changes with the temperature, and that is all it is for
            if not found and (sentence := verdicts.get(SENSOR_OF[stage])) is not None:
                found = [NoResult(subject, sentence, SEE_REPORT)]
            yield from (replace(each, sensor=SENSOR_OF[stage]) for each in found)
    yield from _split_rests(plan, blocks)


def _not_usable(verdicts: Path) -> dict[str, str]:
    """By sensor, `gyro` or `accel`, why the report has no result of it, where it is diagnosed."""
    if not verdicts.exists():
        return {}
    rows = tables.VERDICTS.read(verdicts)
    rows = rows[rows["verdict"] == "not_usable"]
    return dict(zip(rows["sensor"], rows["sentence"], strict=True))


def _with_curves(curves: Path) -> set[str]:
    """The sensors, `gyro` or `accel`, with curves of the temperature, where it is diagnosed."""
    return set(tables.TEMPERATURE_CURVES.read(curves)["sensor"]) if curves.exists() else set()


def _undetermined(sensors: str, parameters: pd.DataFrame) -> Iterator[NoResult]:
    """The sensors where not all twelve parameters are determined by one method on one mount."""
    linear = parameters[parameters["effect"].isna() & parameters["parameter"].isin(TWELVE)]
    methods = [
        rows for _name, rows in linear.groupby(["mount", "method"]) if len(rows) == len(TWELVE)
    ]
    lacking = min((rows[rows["value"].isna()] for rows in methods), key=len, default=linear)
    if methods and lacking.empty:
        return
    incomplete = 0 < len(lacking) < len(TWELVE)
    sentence = (
        _(
            "{count} of 12 parameters are not determined: {names}. The others are.",
            count=len(lacking),
            names=", ".join(map(sign_of, lacking["parameter"])),
        )
        if incomplete
        else _("No parameter is determined.")
    )
    reasons = lacking["reason"].value_counts(sort=False).index[:MAX_REASONS]
    yield NoResult(sensors, sentence, "; ".join(reasons) + ".", incomplete=incomplete)


def _split_rests(plan: pd.DataFrame, blocks: pd.DataFrame) -> Iterator[NoResult]:
    """Rests of unknown attitude most of which stand as the one before: the log is cut to pieces."""
    free = blocks[(blocks["phase"] == "rest") & ~blocks["manoeuvre"].isin(plan["manoeuvre"])]
    means = _readings(free, "accel").groupby(free["manoeuvre"], sort=False).mean().dropna()
    up = means.to_numpy() / np.linalg.norm(means, axis=1)[:, None]
    cosines = np.clip((up[1:] * up[:-1]).sum(axis=1), -1.0, 1.0)
    split = int((np.degrees(np.arccos(cosines)) < MIN_NEW_POSITION_DEG).sum())
    if split > MAX_SPLIT * len(up):
        yield NoResult(
            _("positions"),
            _(
                "{rests} were found, and {split} stand as the one before, within "
                "{degrees:g}°: the log is cut to pieces that are no positions.",
                rests=counted(len(up), "rest"),
                split=split,
                degrees=MIN_NEW_POSITION_DEG,
            ),
            _(
                "state the time of the log and its true rate (time: column, unit, rate_hz in the "
                "format), or more seconds in the manoeuvre."
            ),
        )


def _readings(blocks: pd.DataFrame, channel: str) -> pd.DataFrame:
    return blocks[[f"{channel}_{axis}" for axis in tables.AXES]]


# ---- The check.

LINE_WIDTH = 100
MAX_FULL_CAUSES = 20  # of further ones only the names are listed
WITHOUT_IT = (MASKED, INTERPOLATED, LEFT_OUT)  # cures
SPOILING, WEAKENING, HARMLESS = 3, 2, 1  # severities
SPOILS, SET_RIGHT, CONDITIONAL, WEAKENS, GOOD_TO_KNOW = range(5)
GRADES = {
    SPOILS: (_("spoils a result"), _("spoil a result")),
    SET_RIGHT: (_("is set right"), _("are set right")),
    CONDITIONAL: (_("leaves a result on condition"), _("leave a result on condition")),
    WEAKENS: (_("weakens a result"), _("weaken a result")),
    GOOD_TO_KNOW: (_("is good to know"), _("are good to know")),
}
OF_FORCE = {"(rad/s)/(m/s²)": 1, "(rad/s)/(m/s²)²": 2}  # by unit the power of the force
INDENT = " " * 4


@dataclass(frozen=True)
class Recording:
    """What gets no result; causes, the worst first; what was performed of each manoeuvre; refused
    lines by log; what is said of the recording beside its causes, for it is no fault; by cause how
    large it is beside the biases.
    """

    without: Sequence[NoResult]
    causes: Sequence[ExplainedFindings]
    performed: Sequence[Performed]
    refused: dict[str, int]
    remarks: Sequence[str] = ()
    beside_bias: Mapping[str, str] = field(default_factory=dict)

    @property
    def spoiled(self) -> bool:
        """Whether there is no result, or a cause spoils one and nothing undoes it."""
        return bool(self.without) or any(_grade(each) == SPOILS for each in self.causes)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print what is wrong, the worst first; the exit code."""
    parser = argparse.ArgumentParser(prog="check", description="what is wrong with a recording")
    parser.add_argument("--campaign", required=True, help="name of the campaign")
    parser.add_argument("--data", type=Path, default=Path("data"), help="holds derived/")
    options = parser.parse_args(arguments)
    try:
        recording = recording_of(options.data / "derived" / options.campaign)
    except Refusal as refusal:
        sys.stderr.write(visible(f"check: {refusal}\n"))
        return 2
    sys.stdout.write(visible(as_text(recording, options.campaign)))
    return 1 if recording.spoiled else 0


def recording_of(derived: Path) -> Recording:
    """From the tables of a campaign.

    Raises
    ------
    Refusal
        where one of them is missing, damaged, or of another version
    """
    sources = {each.name: DECLARED.reads[each.name] for each in fields(Findings)}
    criticised = (derived / "criticism/findings.parquet").exists()
    made = {name: one for name, one in sources.items() if criticised or one.stage != "criticism"}
    none = {name: source.table.empty() for name, source in sources.items() if name not in made}
    findings = Findings(**read_declared(derived, made), **none)
    performed = performed_of(tables.PERFORMED.read(derived / "segment/performed.parquet"))
    refused = {
        row["log"]: row["lines"]
        for row in rows_of(tables.ACCOUNTS.read(derived / "decode/accounts.parquet"))
        if row["kind"] == "refused"
    }
    diagnosed = _diagnosed(derived / "diagnosis/causes.parquet")
    severities = _severities(diagnosed)
    by_id = {row["id"]: row for row in diagnosed}
    beside = dict(_beside_bias(diagnosed, derived / "diagnosis/result.parquet"))
    competed = compete(list(hypotheses(findings)))
    conditions = {(row["cause"], row["sensor"]): row["condition"] for row in diagnosed}
    explained = [_as_diagnosed(each, severities, conditions, by_id) for each in competed]
    causes = sorted(explained, key=_worst_first)
    remarks = [row["sentence"] for row in circumstances(rows_of(findings.segment_findings))]
    done = list(performed.values())
    return Recording(list(no_results(derived)), causes, done, refused, remarks, beside)


def _diagnosed(path: Path) -> list[Row]:
    """The causes of the diagnosis; none where there is none."""
    return rows_of(tables.CAUSES.read(path)) if path.exists() else []


def _beside_bias(diagnosed: Sequence[Row], result: Path) -> Iterator[tuple[str, str]]:
    """By identifier of a cause what it changes a bias by at 1 g, where force changes a bias.

    The largest parameter where the result has them: the size is that of the surest one.
    """
    if not result.exists():
        return
    rows = rows_of(tables.PARAMETERS.read(result))
    for cause in diagnosed:
        if cause["unit"] not in OF_FORCE or cause["size"] is None:
            continue
        own = [
            row
            for row in rows
            if row["sensor"] == cause["sensor"]
            and row["mount"] == cause["mount"]
            and row["value"] is not None
        ]
        biases = [abs(row["value"]) for row in own if row["parameter"].startswith("bias_")]
        if biases:
            sizes = [abs(row["value"]) for row in own if row["effect"] == cause["cause"]]
            size = max(sizes, default=abs(cause["size"]))
            at_1_g = size * STANDARD_GRAVITY ** OF_FORCE[cause["unit"]]
            yield (
                cause["id"].removeprefix("diagnosis/"),
                _(
                    "At 1 g it changes a bias by up to {size} °/h; the largest bias is {bias} °/h.",
                    size=significant(at_1_g / DEGREE_PER_HOUR, 3),
                    bias=significant(max(biases) / DEGREE_PER_HOUR, 3),
                ),
            )


def _severities(diagnosed: Sequence[Row]) -> dict[tuple[str, str], int]:
    """By cause and sensor, how grave it is once cured, or not, where the diagnosis knows."""
    severities: dict[tuple[str, str], int] = {}
    for row in diagnosed:
        if (severity := _severity(row)) is not None:
            key = row["cause"], row["sensor"]
            severities[key] = max(severity, severities.get(key, 0))
    return severities


def _severity(row: Row) -> int | None:
    if row["cure"] in WITHOUT_IT:
        return WEAKENING
    if row["cure"] == NONE and row["moves"] is None and row["verdict"] == UNKNOWN_STRUCTURE:
        return SPOILING  # for its sensor gets no result
    if row["cure"] != NONE or row["moves"] is None:
        return None
    if row["moves"] > MAX_MOVE:
        return SPOILING
    return HARMLESS if row["moves"] < MAX_HARMLESS_MOVE else None


def _as_diagnosed(
    each: ExplainedFindings,
    severities: Mapping[tuple[str, str], int],
    conditions: Mapping[tuple[str, str], str | None],
    diagnosed: Mapping[str, Row],
) -> ExplainedFindings:
    """The same, as grave as it is by the diagnosis, with the sizes and condition of the result."""
    row = each.cause.row
    kind = row["cause"], row["sensor"]
    severity = severities.get(kind)
    if severity is None or (severity == WEAKENING and row["severity"] < SPOILING):
        severity = row["severity"]
    as_diagnosed = {**row, "severity": severity, "condition": conditions.get(kind)}
    own = diagnosed.get(f"diagnosis/{row['id']}", row)
    if own["count"] == row["count"]:  # of more than one the row of the diagnosis is of all
        as_diagnosed |= {name: own[name] for name in ("sentence", "consequence", "action")}
    return replace(each, cause=replace(each.cause, row=as_diagnosed))


def _worst_first(each: ExplainedFindings) -> tuple[int, float, int, str]:
    """By grade, then the least likely by chance, then by count."""
    row = each.cause.row
    p_value = 1.0 if row["p_value"] is None else row["p_value"]
    return _grade(each), p_value, -row["count"], row["id"]


def _grade(each: ExplainedFindings) -> int:
    """How grave a cause is; what a repair undoes, or is assumed to be right, spoils nothing."""
    repair, severity = each.cause.repair, each.cause.row["severity"]
    if repair is not None and repair["state"] in APPLIED:
        return SET_RIGHT
    if each.cause.row.get("condition"):
        return CONDITIONAL
    return {SPOILING: SPOILS, WEAKENING: WEAKENS}.get(severity, GOOD_TO_KNOW)


def as_text(recording: Recording, campaign: str) -> str:
    """What was recorded, what gets no result, the causes, and their number at the end."""
    paragraphs = [_recorded(recording, campaign)]
    paragraphs += [_without(each, recording.causes) for each in recording.without]
    paragraphs += [
        _cause(each, recording.beside_bias) for each in recording.causes[:MAX_FULL_CAUSES]
    ]
    if others := recording.causes[MAX_FULL_CAUSES:]:
        named = Counter(in_words(each.cause.cause) for each in others)
        listed = ", ".join(f"{cause} ({count})" for cause, count in named.most_common())
        paragraphs.append(
            _wrapped(_("And {others} more: {listed}.", others=len(others), listed=listed))
        )
    paragraphs.append(_wrapped(_summary(recording)))
    return "\n\n".join(paragraphs) + "\n"


def _recorded(recording: Recording, campaign: str) -> str:
    planned = counted(len(recording.performed), "manoeuvre")
    found = sum(manoeuvre.found for manoeuvre in recording.performed)
    complete = sum(manoeuvre.found and manoeuvre.complete for manoeuvre in recording.performed)
    sentences = [
        _(
            "{campaign}: {found} of {planned} found, {complete} complete.",
            campaign=campaign,
            found=found,
            planned=planned,
            complete=complete,
        )
    ]
    if len(recording.performed) == 1 and (said := recording.performed[0].sentence):
        sentences = [f"{campaign}: {said}"]  # of one that says how many rests it holds
    sentences += [
        _(
            "{lines} of {log} cannot be read and {value} left out.",
            lines=counted(lines, "line"),
            log=log,
            value="is" if lines == 1 else "are",
        )
        for log, lines in recording.refused.items()
    ]
    sentences += recording.remarks
    return "\n".join(_wrapped(shortened(sentence, 300)) for sentence in sentences)


def _without(each: NoResult, causes: Sequence[ExplainedFindings]) -> str:
    """Whose result is missing, why, and what to do: set right first what spoils it, if anything."""
    spoiling = dict.fromkeys(
        in_words(one.cause.cause)
        for one in causes
        if _grade(one) == SPOILS and each.sensor and one.cause.sensor in (None, each.sensor)
    )
    if not spoiling and each.action == SEE_REPORT:  # by what is said of the other sensor
        named = (in_words(one.cause.cause) for one in causes)
        spoiling = dict.fromkeys(name for name in named if name in each.sentence)
    what = _("Why, and what helps: {action}", action=each.action)
    if spoiling:
        what = _("Set right first what spoils it: {causes}, below.", causes=", ".join(spoiling))
    answers = each.sentence, what
    heading = _("INCOMPLETE RESULT") if each.incomplete else _("NO RESULT")
    title = _wrapped(" · ".join([heading, each.subject]))
    return "\n".join([title, *(_wrapped(shortened(text, 600), INDENT) for text in answers)])


def _cause(each: ExplainedFindings, beside_bias: Mapping[str, str]) -> str:
    """Grade, cause and place, the sentence, and what page one of the report answers as well."""
    row = each.cause.row
    one, _many = GRADES[_grade(each)]
    place = row["manoeuvre"] or row["log"]
    title = [one.upper(), in_words(row["cause"])]
    title += [shortened(place, 60)] if place else []
    paragraphs = [_wrapped(" · ".join(title)), _wrapped(shortened(row["sentence"], 600), INDENT)]
    pairs = [(_("How large"), beside_bias.get(row["id"], "")), *_answers(each)]
    answers = [f"{name}: {shortened(text, 600)}" for name, text in pairs if text]
    return "\n".join([*paragraphs, *(_wrapped(answer, INDENT) for answer in answers)])


def _answers(each: ExplainedFindings) -> Iterator[tuple[str, str]]:
    row, repair = each.cause.row, each.cause.repair
    yield _("What it does"), row["consequence"]
    if repair is not None:
        yield _("What was done"), repair["sentence"]
        if repair["state"] == "applied":
            yield _("Valid if"), repair["condition"]
    elif condition := row.get("condition"):
        yield _("Valid if"), condition
    names = (in_words(other.cause) for other in each.consequences if other.id != each.cause.id)
    following = Counter(name for name in names if name not in in_words(row["cause"]))
    yield _("Therefore"), ", ".join(f"{name} ({n})" for name, n in following.most_common())
    yield _("What to do"), each.cause.action


def _summary(recording: Recording) -> str:
    sentences = []
    for template, incomplete in (
        (_("No result: {subjects}."), False),
        (_("Incomplete result: {subjects}."), True),
    ):
        lacking = [each.subject for each in recording.without if each.incomplete == incomplete]
        if lacking:
            sentences.append(template.format(subjects=", ".join(lacking)))
    if recording.causes:
        grades = Counter(_grade(each) for each in recording.causes)
        each = [f"{n} {GRADES[grade][n > 1]}" for grade, n in sorted(grades.items())]
        sentences.append(f"{counted(len(recording.causes), 'cause')}: {', '.join(each)}.")
    elif refused := sum(recording.refused.values()):
        lines = counted(refused, "line")
        sentences.append(_("No cause, but {refused} cannot be read.", refused=lines))
    return " ".join(sentences) or _("No cause of a fault was found in this recording.")


def _wrapped(text: str, indent: str = "") -> str:
    """In lines; the narrow space within a number is no place to break one."""
    return textwrap.fill(
        text.replace("\n", " "),
        LINE_WIDTH,
        initial_indent=indent,
        subsequent_indent=indent,
        break_on_hyphens=False,
    )


if __name__ == "__main__":
    run(main)
