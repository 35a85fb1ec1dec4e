"""The names of causes as a person would say them."""

from __future__ import annotations

import pytest

from inertial.text.cause_names import in_words


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
