"""The names of causes, and how many findings are how grave, as a person would say it."""

from __future__ import annotations

import pytest

from inertial.text.cause_names import in_words, tally


@pytest.mark.parametrize(
    ("severities", "said"),
    [
        ([3, 2, 1], "3 findings: 1 spoils a result, 1 weakens one, 1 is good to know."),
        ([3, 3], "2 findings: 2 spoil a result."),
        ([2, 2, 1, 1], "4 findings: 2 weaken a result, 2 are good to know."),
        ([1], "1 finding: 1 is good to know."),
    ],
)
def test_findings_are_counted_by_how_grave_they_are(severities: list[int], said: str) -> None:
    assert tally(severities) == said


@pytest.mark.parametrize(
    ("cause", "words"),
    [
        ("incomplete_turn", "incomplete turn"),
        ("gyro_g_sensitivity", "gyro g-sensitivity"),
        ("time_backwards", "time goes backwards"),
        ("heard_of\x1bnever", "heard of�never"),
    ],
)
def test_names_of_causes(cause: str, words: str) -> None:
    assert in_words(cause) == words
