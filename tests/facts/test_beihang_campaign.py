"""S4's thirty runs as a campaign: what its least squares invents is refused, the bend is told."""

import chain
import numpy as np
import pytest
import s4

from inertial.estimation.rate_table import AXES

RATE_HZ, SECONDS = 50, 12
# What the program of S4 makes of its permuted inputs (test_beihang_rates, T17).
CROSS = {"xy": 0.001268, "xz": -0.002003, "yx": 0.003274}


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """The means as printed, as logs of one gyro each, with noise far below their scatter."""
    folder = tmp_path_factory.mktemp("beihang") / "campaign"
    folder.mkdir()
    random = np.random.default_rng(1)
    plan = []
    for axis, means in zip(AXES, s4.MEANS, strict=True):
        for rate, mean in zip(s4.RATES, means, strict=True):
            name = f"{axis}{rate:+.0f}"
            read = mean + random.normal(0, 0.01, RATE_HZ * SECONDS)
            (folder / f"{name}.txt").write_text("".join(f"{one:.5f}\n" for one in read))
            plan.append(
                f"  - {{id: {name}, do: turn, up: +{axis}, rate_deg_s: {rate:.0f},"
                f" recorded: steady, mount: {axis}, format: {axis}, log: {name}.txt}}"
            )
    columns = {axis: ["null"] * i + ["1"] + ["null"] * (2 - i) for i, axis in enumerate(AXES)}
    text = [
        "campaign: 1",
        f"instrument: {{name: rate-table unit, rate_hz: {RATE_HZ}}}",
        "serial: unknown",
        "date: unknown",
        "site: {latitude_deg: 39.98, height_m: 50}",
        "table: {heading_deg: null, position_sigma_arcsec: 30, rate_sigma_ppm: 100}",
        "formats:",
        *(
            f"  {axis}: {{kind: columns, time: {{rate_hz: {RATE_HZ}}},"
            f" gyro: {{columns: [{', '.join(own)}], unit: deg/s}}}}"
            for axis, own in columns.items()
        ),
        "plan:",
        *plan,
    ]
    (folder / "campaign.yaml").write_text("\n".join(text) + "\n")
    told = ", ".join(f"cross_{axes}: {{value: {value}}}" for axes, value in CROSS.items())
    (folder / "published.yaml").write_text(f"source: program of S4\ngyro: {{{told}}}\n")
    return chain.run(folder, folder.parent / "derived", "history")


def test_each_gyro_has_its_straight_line(results):
    for i, axis in enumerate(AXES):
        table = results["gyroscope/parameters"].query("method == 'rate_table'")
        found = table[table["mount"] == axis].set_index("parameter")
        own = found.loc[f"scale_{axis}"]
        # S4's K, T17; the earth's rate is in the bias of all runs alike. To a tenth of 1e-3.
        assert 1 + own["value"] == pytest.approx([0.992491, 0.995121, 0.992232][i], abs=1e-4)
        refused = found.loc[[f"cross_{axis}{other}" for other in AXES if other != axis]]
        assert refused["value"].isna().all()
        assert refused["reason"].str.contains("have rank 2 of 4: record all three gyros").all()


def test_published_cross_terms_that_nobody_recorded_are_told_so(results):
    told = results["history/published_differences"]
    for axes in CROSS:
        own = told[
            (told["quantity"] == f"cross_{axes}")
            & (told["kind"] == "published")
            & (told["mount"] == axes[0])
        ]
        (sentence,) = own["sentence"]
        assert "program of S4 cannot be judged" in sentence and "rank 2 of 4" in sentence


def test_the_bend_of_the_rates_is_told(results):
    told = results["comparison/differences"].set_index("quantity")
    cubic = told.loc["cubic"]
    # T18: the two runs of y left out; the earth's rate is in all runs of an axis alike.
    assert "y-10, y-40" in cubic["sentence"] or "y-40, y-10" in cubic["sentence"]
    assert cubic["difference"] * np.radians(1) ** 2 == pytest.approx(-1.375e-6, rel=0.01)
    assert cubic["in_sigmas"] == pytest.approx(-8.4, abs=0.1)
    assert "more than chance" in cubic["sentence"]
    assert "no more than chance" in told.loc["asymmetry", "sentence"] or (
        "agree within" in told.loc["asymmetry", "sentence"]
    )
