"""What shows each cause: its pictures, numbers beside what was expected, the findings behind it."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import pandas as pd
import pytest

from stages.report.sections import findings
from tests.report import synthetic, synthetic_faults
from tests.report.synthetic_diagnosis import diagnosed
from tests.report.synthetic_values import GAP_FINDING, RINGING_FINDING

TURN = "segment/incomplete/z-backward"


def shown(made: dict[str, Any]) -> dict[str, str]:
    """What shows each cause of a report, by the finding that names it, as HTML in its order."""
    section = synthetic.section_on(made, findings.SECTION)
    parts = section.split('<h3 id="evidence/diagnosis/')[1:]
    return {name: own for name, _, own in (part.partition('">') for part in parts)}


@cache
def faulty() -> dict[str, str]:
    return shown(synthetic_faults.faulty())


@pytest.mark.parametrize("fault", synthetic_faults.FAULTS, ids=lambda fault: fault.cause)
def test_a_fault_with_a_place_is_shown_where_it_is(fault: synthetic_faults.Fault) -> None:
    html = faulty()[fault.identifier]
    first = f"{fault.shown[0] + 1:,}".replace(",", "\u202f")
    assert html.count('role="img"') == 1
    assert f"{fault.manoeuvre}.asc" in html
    assert f"lines {first} to " in html
    assert ("Cross-hatched: masked" in html) == (fault.masks and fault.cause != "duplicate")
    few = fault.inside[1] - fault.inside[0] <= 40
    assert ("Ringed: affected" in html) == few


def test_what_has_no_place_has_no_close_up() -> None:
    assert "<svg" not in faulty()["quality/wrong_day"]
    assert "close up" not in faulty()["quality/rate_off"]


@pytest.mark.parametrize(
    ("identifier", "said"),
    [
        ("quality/rate_off", "50.00 Hz measured, 100.0 Hz expected"),
        # 0.10197 is 1 m/s² in units of 9.80665 m/s²
        ("quality/wrong_scale_factor", "0.9987 m/s² measured, 9.794 m/s² expected"),
        # What is used is 9.7936174 m/s², and the stated value is larger by 0.0130.
        ("quality/gravity_error", "9.806617 m/s² stated, 9.793617 m/s² expected"),
        (GAP_FINDING, "−240.2° measured, −360.0° expected"),
    ],
)
def test_a_number_stands_beside_what_was_expected(identifier: str, said: str) -> None:
    assert said in faulty()[identifier]


def test_a_gap_is_shown_by_its_two_lines() -> None:
    html = faulty()[GAP_FINDING]
    rows = re.findall(r"<tr>\s*<td[^>]*>(before|after)</td>(.*?)</tr>", html, re.DOTALL)
    cells = {side: re.findall(r"<td[^>]*>([^<]*)</td>", row) for side, row in rows}
    assert cells["before"][:2] == ["2\u202f192", "21.890"]
    assert cells["after"][:2] == ["2\u202f193", "33.870"]
    assert [len(row) for row in cells.values()] == [8, 8]  # line, time and six readings
    assert "11.980 s apart" in html
    assert "Hatched: not recorded" in html


def test_what_a_cause_explains_stands_with_it_and_nowhere_else() -> None:
    behind = {
        name: re.findall(r"<code>([^<]+)</code>", html)
        for name, html in shown(synthetic.brief()).items()
    }
    assert behind == {  # the g-sensitivity, of the model alone, stands among unmodelled effects
        GAP_FINDING: [GAP_FINDING, TURN],
        "criticism/oscillation": ["criticism/oscillation", RINGING_FINDING],
    }


def test_samples_that_one_finding_has_shown_are_not_shown_again() -> None:
    made = synthetic.brief("z-backward.asc")
    close_ups = made["quality_close_ups"].query("finding == @GAP_FINDING")
    made["segment_close_ups"] = close_ups.assign(finding=TURN)
    html = shown(made)[GAP_FINDING]
    assert html.count("lines 2\u202f192 and 2\u202f193, 11.980 s apart") <= 1
    assert html.count("The record before the gap") == 1


@pytest.mark.slow
def test_a_storm_of_findings_keeps_the_page_light() -> None:
    made = synthetic_faults.faulty()
    spikes = made["quality_findings"].query("cause == 'spike'")
    close_up = made["quality_close_ups"].query("finding == @spikes.id.iloc[0]")
    many = [f"quality/spike/x-up.asc/{number}" for number in range(60)]
    made["quality_findings"] = pd.concat([spikes.assign(id=name) for name in many])
    made["quality_close_ups"] = pd.concat(
        close_up.assign(finding=name, record=close_up["record"] + number)
        for number, name in enumerate(many)
    )
    found = shown(made | diagnosed(made))
    pictures = sum(html.count('role="img"') for html in found.values())
    assert pictures == findings.MOST_PICTURES
    assert max(len(html.encode()) for html in found.values()) < 40_000


@pytest.mark.slow
def test_samples_without_time_are_drawn_over_their_lines() -> None:
    made = synthetic_faults.faulty()
    for name in ("traces", "segments", "clocks", "quality_findings"):
        made[name][["from_s", "to_s"]] = float("nan")
    made["quality_close_ups"]["time"] = float("nan")
    html = shown(made)["quality/spike/x-up.asc/accel_x"]
    assert html.count('role="img"') == 1
    assert ">Record<" in html
    assert ">Line<" in html
