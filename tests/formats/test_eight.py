"""Line ends and digits, eight bytes at a time, are those that Python finds one by one."""

import re

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from stages.formats import eight
from stages.formats.compiled import compiled


@compiled
def first_of(byte, data, place):
    return eight.first_of(byte, data, place)


@compiled
def digits(data, place):
    return eight.digits(data, place)


NOTHING = np.frombuffer(b"", np.uint8)
first_of(0, NOTHING, 0)  # compiled before hypothesis looks at the clock
digits(NOTHING, 0)
BYTES = st.lists(st.sampled_from(b"\n\x0b\t\x8a\x0009/:;5,*"), max_size=40).map(bytes)


@given(BYTES, st.integers(0, 40))
def test_the_first_of_a_byte(text, place):
    data = np.frombuffer(text, np.uint8)
    found = text.find(b"\n", place)
    expected = max(len(text), place) if found < 0 else found
    assert first_of(ord("\n"), data, place) == expected


@given(st.binary(max_size=8), st.from_regex(rb"[0-9]{0,18}", fullmatch=True), BYTES)
def test_a_number_in_digits(before, number, rest):
    text = before + number + rest
    number = re.compile(b"[0-9]*").match(text, len(before))[0][:18]
    stop = len(before) + len(number)
    if text[stop : stop + 1].isdigit():  # more than 18
        text = text[:stop]
    found = digits(np.frombuffer(text, np.uint8), len(before))
    assert found == (int(number or b"0"), stop)
