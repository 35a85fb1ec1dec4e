"""A bias that jumps to and fro has a jump, and no effect that a further jump resembles."""

from dataclasses import replace

import chain
import numpy as np
import pytest

import laboratory

COUNT = 1.52587890625e-6  # m/s, of the demo's accelerometers
G = 9.80665
STEP_S = 0.01
CLEAR = ("found", "one_of_class")
JUMP, BESIDE = {"size_micro_g": [80, 0, 0], "at_s": 1000}, {"k2_micro_g_g2": [0, 200, 0]}


@pytest.mark.slow
def test_a_second_jump_is_no_shift_of_the_case_and_no_size_effect():
    """±40 µg on x for 100 s on average: once they were a jump, a shift by 11″ and 4 mm."""
    recording = laboratory.perform(laboratory.specify(chain.demo(seed=3, effects={})))
    random = np.random.default_rng(8)
    switches = np.cumsum(random.exponential(100, 100))
    logs = {}
    for log, records in recording.records.items():
        time = (records.stamps - recording.start) / 1e9
        level = 40e-6 * G * (2 * (np.searchsorted(switches, time) % 2) - 1)
        counts = records.counts.copy()
        carried = np.rint(np.cumsum(level) * STEP_S / COUNT)
        counts[:, 0] += np.diff(carried, prepend=0.0).astype(counts.dtype)
        logs[log] = replace(records, counts=counts)
    results = chain.in_memory(replace(recording, records=logs), "criticism", chain.BESIDE)
    findings = results["criticism/findings"].set_index("cause")["verdict"]
    assert findings["accel_random_walk"] == "unknown_structure"
    assert set(findings[findings.isin(CLEAR)].index) <= {"accel_bias_jump"}
    assert not results["criticism/structures"]["detected"].any()  # the drift at rest is all


@pytest.mark.slow
def test_a_true_effect_beside_one_true_jump_stays_certain():
    document = chain.demo(seed=8, effects={"accel_bias_jump": JUMP, "accel_quadratic": BESIDE})
    results = chain.in_memory_of(document, "criticism", chain.BESIDE)
    findings = results["criticism/findings"]
    assert findings["verdict"].isin(CLEAR).all() and len(findings) == 2
    members = set(results["criticism/members"]["effect"])
    # Each axis is up once, so what disturbs it in one position does the same as these two.
    laws = {"accel_quadratic", "accel_scale_asymmetry", "accel_bias_of_position"}
    assert members == {"accel_bias_jump", *laws}
