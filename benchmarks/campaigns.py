"""Cost of a campaign in memory: from blocks to the extended model, by stage.

Campaigns of the plans in which effects are hidden (`tests/hidden/hidden_plans.py`), of about
200,000 samples, without effects and with those that a fit takes longest about: a drift and one that
goes with the attitude. Reading and writing of tables do not count.
"""

import time

import chain  # of the tests: the stages one after another in this process
from hidden_plans import PLANS, sensors
from numpy.random import default_rng

import laboratory
from benchmarks.tables import Table, digits

STAGES = ("accelerometer", "gyroscope", "simulation", "criticism", "extension")
BESIDE = ("studies", "comparison")  # evidence for the diagnosis, not of this way
BAR = 2.5  # s of one processor, per 200,000 samples
SAMPLES = 200_000
RUNS = 2
EFFECTS = {
    "clean": {},
    "drift and g-sensitivity": {
        "gyro_bias_ramp": {"ramp_deg_h_h": [0.5, -0.3, 0.4]},
        "gyro_g_sensitivity": {"matrix_deg_h_g": [[0.2, 0, 0], [0, -0.2, 0], [0, 0, 0.2]]},
    },
}


def measured() -> list[Table]:
    """Every plan, without effects and with two; the least processor time of some runs."""
    table = Table(
        "Cost of a campaign in memory: processor seconds from blocks to the extended model",
        ("plan", "effects", "samples", *STAGES, "together", f"per {SAMPLES:,}"),
    )
    worst = 0.0
    for plan, document in PLANS.items():
        for hidden, effects in EFFECTS.items():
            told = document(seed=1, effects=effects) | {"truth": sensors(default_rng(1))}
            recording = laboratory.perform(laboratory.specify(told))
            samples = sum(len(records) for records in recording.records.values())
            seconds = _seconds(recording)
            whole = sum(seconds.values())
            share = whole * SAMPLES / samples
            worst = max(worst, share)
            cells = (*(digits(seconds[stage]) for stage in STAGES), digits(whole), digits(share))
            table.add(plan, hidden, f"{samples:,}", *cells)
    kept = "kept" if worst <= BAR else "MISSED"
    table.remarks.append(f"Bar: {BAR:g} s per {SAMPLES:,} samples: {worst:.2f} s at most, {kept}.")
    return [table]


def _seconds(recording: laboratory.Recording) -> dict[str, float]:
    """The least processor time of each stage, s."""
    blocks = chain.in_memory(recording, "noise")
    best: dict[str, float] = {}
    for _ in range(RUNS):
        tables = blocks.copy()
        for stage in STAGES:
            start = time.process_time()
            chain.in_memory(recording, stage, BESIDE, onto=tables)
            best[stage] = min(time.process_time() - start, best.get(stage, float("inf")))
    return best
