"""Fleets: sums, search, what an effect belongs to, populations; numbers by other ways."""

import time

import numpy as np
import pytest
from scipy import stats

from inertial.estimation.fleet_components import Sharing, population, shares
from inertial.estimation.type_population import Campaigns, of_new_imu, type_population
from inertial.model_selection.fleet_evidence import EVERY, FleetEvidence, Shared
from inertial.model_selection.fleet_search import FleetLaw, FleetSearch, fleet_law

EFFECTS = {"drift": [0], "curve": [1, 2], "tilt": [3, 4, 5]}
ALL = [i for columns in EFFECTS.values() for i in columns]
LEVEL, RARE = 0.05, 0.01
IMUS, TABLES = 5, 3
LAW = FleetLaw(LEVEL, 2e-4, 250)


def designs(campaigns, seed):
    """White equations of each campaign, (c, rows, k)."""
    return np.random.default_rng(seed).normal(size=(campaigns, 40, len(ALL)))


def labels(imus=IMUS, each=3, tables=TABLES):
    """IMU i comes to table i, i + 1, … in turn."""
    rows = [(i, (i + n) % tables) for i in range(imus) for n in range(each)]
    return {
        "type": ["type"] * len(rows),
        "table": [f"table {t}" for _, t in rows],
        "imu": [f"imu {i}" for i, _ in rows],
        "campaign": [str(n) for n in range(len(rows))],
    }


def fleet(own, beta, seed, noise=1.0):
    """The evidence of equations y = X β + e of each campaign."""
    x = designs(len(own["type"]), 1)
    random = np.random.default_rng(seed)
    y = np.einsum("crk,ck->cr", x, beta) + noise * random.normal(size=x.shape[:2])
    information, right = np.einsum("crk,crl->ckl", x, x), np.einsum("crk,cr->ck", x, y)
    return FleetEvidence(EFFECTS, information, right, own), x, y


def sizes(own, level, group, columns, ratio, seed):
    """β of an effect that a group shares, of a pooled signal-to-noise ratio."""
    members = np.array([label == group for label in own[level]])
    x = designs(len(members), 1)[members][:, :, columns].reshape(-1, len(columns))
    direction = np.random.default_rng(seed).normal(size=len(columns))
    direction *= ratio / np.linalg.norm(x @ direction)
    beta = np.zeros((len(members), len(ALL)))
    beta[np.ix_(members, columns)] = direction
    return beta


# ---- Sums and drops.


@pytest.mark.parametrize(
    ("one", "beside"),
    [
        (Shared(1, "type", 0), ()),
        (Shared(2, "table", 1), (Shared(0, "type", 0), Shared(1, "imu", 2))),
        (Shared(1, "imu", EVERY), (Shared(1, "type", 0), Shared(0, "table", EVERY))),
        (Shared(2, "campaign", EVERY), (Shared(2, "table", 0),)),
    ],
)
def test_a_drop_is_that_of_a_fit_to_all_samples(one, beside):
    own = labels()
    evidence, x, y = fleet(own, np.zeros((len(own["type"]), len(ALL))), 2)

    def columns(model):
        every = []
        for each in model:
            names = list(dict.fromkeys(own[each.level]))
            for group in names if each.group == EVERY else [names[each.group]]:
                members = np.array([label == group for label in own[each.level]])
                of_effect = list(EFFECTS.values())[each.effect]
                every.append((members[:, None, None] * x[:, :, of_effect]).reshape(y.size, -1))
        return np.hstack(every) if every else np.zeros((y.size, 0))

    def left(design):
        return np.sum((y.ravel() - design @ np.linalg.lstsq(design, y.ravel())[0]) ** 2)

    smaller, larger = columns(beside), columns([*beside, one])
    drops, degrees = evidence.drops(one.effect, one.level, evidence.given(beside))
    assert drops[one.group] == pytest.approx(left(smaller) - left(larger), rel=1e-6)
    rank = np.linalg.matrix_rank(larger) - (np.linalg.matrix_rank(smaller) if beside else 0)
    assert degrees[one.group] == rank


def test_adding_a_campaign_changes_the_sums_of_its_groups_alone():
    own = labels()
    whole, _, _ = fleet(own, np.zeros((len(own["type"]), len(ALL))), 3)
    less = FleetEvidence(
        EFFECTS,
        whole.information[:-1],
        whole.right[:-1],
        {level: of[:-1] for level, of in own.items()},
    )
    for level in ("type", "table", "imu"):
        before, after = less.levels[level], whole.levels[level]
        changed = [
            label
            for g, label in enumerate(before.labels)
            if not np.array_equal(before.information[g], after.information[g])
        ]
        assert changed == [own[level][-1]]


def test_the_cost_of_a_campaign_does_not_grow_with_their_number():
    def seconds(imus):
        own = labels(imus)
        evidence, _, _ = fleet(own, np.zeros((len(own["type"]), len(ALL))), 4)
        start = time.process_time()
        for _ in range(3):
            again = FleetEvidence(EFFECTS, evidence.information, evidence.right, own)
            for effect in range(len(EFFECTS)):
                for level in ("type", "table", "imu", "campaign"):
                    again.drops(effect, level, again.given((Shared(0, "type", 0),)))
        return (time.process_time() - start) / len(own["type"])

    seconds(50)
    assert seconds(1600) < 2 * seconds(200)


# ---- The search.


@pytest.mark.slow
def test_noise_alone_gives_findings_as_rarely_as_wanted():
    own = labels()
    evidence, _, _ = fleet(own, np.zeros((len(own["type"]), len(ALL))), 0)
    law = fleet_law(evidence, LEVEL)
    count = 0
    for seed in range(300):
        clean, _, _ = fleet(own, np.zeros((len(own["type"]), len(ALL))), 100 + seed)
        count += bool(FleetSearch(clean, law).found())
    assert count <= stats.binom.isf(1e-3, 300, LEVEL)
    assert count > 0  # the level is used


@pytest.mark.parametrize(
    ("level", "group"), [("type", "type"), ("table", "table 1"), ("imu", "imu 3")]
)
@pytest.mark.parametrize("effect", EFFECTS)
def test_what_an_effect_belongs_to_is_told(level, group, effect):
    own = labels()
    beta = sizes(own, level, group, EFFECTS[effect], 25.0, 5)
    evidence, _, _ = fleet(own, beta, 6)
    found = FleetSearch(evidence, fleet_law(evidence, RARE)).found()
    (one,) = found
    assert evidence.names[one.hypothesis.effect] == effect
    assert one.levels == (level,)
    assert evidence.levels[level].labels[one.hypothesis.group] == group
    values, covariance = evidence.estimate([one.hypothesis])
    truth = beta[own[level].index(group), EFFECTS[effect]]
    error = values - truth
    assert error @ np.linalg.solve(covariance, error) < stats.chi2.isf(1e-3, len(truth))


def test_an_effect_of_one_campaign_is_not_said_to_belong_to_its_imu():
    own = labels()
    beta = sizes(own, "campaign", "4", EFFECTS["curve"], 25.0, 7)
    evidence, _, _ = fleet(own, beta, 8)
    (one,) = FleetSearch(evidence, fleet_law(evidence, RARE)).found()
    assert one.hypothesis == Shared(1, "campaign", 4)
    assert one.levels == ("campaign",)


def test_a_finding_is_stated_as_what_shares_it():
    """By significance alone a size of each table may win a little over one of the type."""
    own = labels(imus=4, each=2, tables=2)
    beta = sizes(own, "type", "type", EFFECTS["tilt"], 30.0, 40)
    for seed in range(40):
        evidence, _, _ = fleet(own, beta, 600 + seed)
        for one in FleetSearch(evidence, LAW).found():
            assert one.hypothesis.level in one.levels
            drops, degrees = evidence.drops(2, one.hypothesis.level, evidence.given(()))
            assert one.statistic == pytest.approx(drops[one.hypothesis.group])
            assert one.degrees == degrees[one.hypothesis.group]


def test_what_one_table_cannot_tell_is_named_together():
    own = labels(tables=1)
    beta = sizes(own, "type", "type", EFFECTS["curve"], 25.0, 9)
    evidence, _, _ = fleet(own, beta, 10)
    (one,) = FleetSearch(evidence, fleet_law(evidence, RARE)).found()
    assert set(one.levels) == {"type", "table"}
    assert one.sharings["type"] == pytest.approx(one.sharings["table"])


def test_one_imu_on_one_table_tells_nothing_apart():
    own = labels(imus=1, each=6, tables=1)
    beta = sizes(own, "type", "type", EFFECTS["curve"], 25.0, 11)
    evidence, _, _ = fleet(own, beta, 12)
    (one,) = FleetSearch(evidence, fleet_law(evidence, RARE)).found()
    assert set(one.levels) == {"type", "table", "imu"}


@pytest.mark.slow
def test_an_effect_of_type_and_table_has_a_share_of_each():
    own = labels(imus=6, each=4, tables=6)
    beta = sizes(own, "type", "type", EFFECTS["tilt"], 40.0, 13)
    for table in range(6):
        beta += sizes(own, "table", f"table {table}", EFFECTS["tilt"], 16.0, 20 + table)
    evidence, _, _ = fleet(own, beta, 15)
    found = FleetSearch(evidence, fleet_law(evidence, RARE)).found()
    assert {evidence.names[one.hypothesis.effect] for one in found} == {"tilt"}
    of_effect = shares(evidence.sharing([one.hypothesis for one in found], 2))
    assert min(of_effect["type",][0], of_effect["table",][0]) > 0.2
    assert max(of_effect["imu",][0], of_effect["campaign",][0]) < 0.1


# ---- Shares and spreads.


@pytest.mark.slow
@pytest.mark.parametrize("level", ["type", "table", "imu", "campaign"])
def test_shares_are_those_of_what_was_drawn(level):
    own = labels(imus=12, each=3, tables=6)
    of = np.unique(own[level], return_inverse=True)[1]
    drawn = np.random.default_rng(16).normal(size=(of.max() + 1, 3))[of]
    information = np.tile(400 * np.eye(3), (len(of), 1, 1))
    noise = 20 * np.random.default_rng(17).normal(size=drawn.shape)
    found = shares(Sharing(information, 400 * drawn + noise, own))
    assert sum(share for share, _ in found.values()) == pytest.approx(1)
    share, sigma = found[(level,)]
    assert share == max(one for one, _ in found.values())
    assert abs(1 - share) < 3 * sigma


def test_spreads_are_those_of_an_analysis_of_variance():
    """Of balanced data REML and ANOVA are one (Searle, Casella & McCulloch, 1992, 3.8)."""
    each, imus = 4, 9
    random = np.random.default_rng(18)
    values = 3 * np.repeat(random.normal(size=imus), each) + random.normal(size=each * imus)
    own = labels(imus=imus, each=each, tables=1)
    table = values.reshape(imus, each)
    between = each * table.mean(axis=1).var(ddof=1)
    within = table.var(axis=1, ddof=1).mean()
    known = 0.3
    found = population(values, np.full(len(values), known), own)
    spread = {one.levels: one.value for one in found.spreads}
    assert spread["imu",] == pytest.approx(np.sqrt((between - within) / each), rel=2e-3)
    assert spread["campaign",] == pytest.approx(np.sqrt(within - known**2), rel=2e-3)
    assert found.mean == pytest.approx(values.mean(), rel=1e-6)
    assert found.mean_sigma == pytest.approx(np.sqrt(between / each / imus), rel=2e-3)
    sigma, degrees = of_new_imu(found)
    assert sigma == pytest.approx(
        np.sqrt(sum(s**2 for s in spread.values()) + between / 36), rel=2e-3
    )
    assert degrees < each * imus


def test_degrees_of_freedom_of_the_mean_on_one_table_are_those_of_the_imus():
    """Of balanced data var(mean) = MS_imu / c, a mean square of one degree less than IMUs."""
    imus, each = 9, 4
    random = np.random.default_rng(21)
    values = 3 * np.repeat(random.normal(size=imus), each) + random.normal(size=each * imus)
    own = labels(imus=imus, each=each, tables=1)
    found = population(values, np.full(len(values), 0.1), own)
    assert found.mean_degrees == pytest.approx(imus - 1, rel=0.03)
    surer = found.with_known(2 * found.mean_sigma)
    assert surer.mean_sigma == pytest.approx(np.sqrt(5) * found.mean_sigma, rel=1e-3)
    assert surer.mean_degrees == pytest.approx(25 * found.mean_degrees, rel=0.02)


@pytest.mark.parametrize("tables", [2, 3, 6])
def test_where_only_tables_differ_the_mean_is_that_of_as_many_values(tables):
    of_tables = np.random.default_rng(23).normal(size=tables)
    own = labels(imus=6, each=tables, tables=tables)
    table = np.unique(own["table"], return_inverse=True)[1]
    values = of_tables[table] + 1e-2 * np.random.default_rng(24).normal(size=len(table))
    found = population(values, np.full(len(values), 1e-2), own)
    assert found.mean == pytest.approx(of_tables.mean(), abs=1e-2)
    assert found.mean_sigma == pytest.approx(of_tables.std(ddof=1) / np.sqrt(tables), rel=0.02)
    assert found.mean_degrees == pytest.approx(tables - 1, rel=0.05)


@pytest.mark.parametrize("difference", [0.0, 0.4, 3.0])
def test_the_mean_of_two_tables_has_the_generalised_interval_of_mean_squares(difference):
    """Of crossed balanced data var(mean) = (MS_table + MS_imu - MS_rest) / c.

    Here by draws of the three, MS · degrees / χ² each (Weerahandi 1993), of 1, 19 and 19 degrees.
    """
    imus, tables, draws = 20, 2, 400_000
    random = np.random.default_rng(21)
    table = 2 * random.normal(size=imus)[:, None] + random.normal(size=(imus, tables))
    table += np.array([0.0, difference]) - table.mean(axis=0)
    rows, columns, grand = table.mean(axis=1), table.mean(axis=0), table.mean()
    rest = table - rows[:, None] - columns + grand
    squares = np.array(
        [imus * columns.var(ddof=1), tables * rows.var(ddof=1), (rest**2).sum() / (imus - 1)]
    )
    degrees = np.array([tables - 1, imus - 1, imus - 1])
    of_table, of_imu, of_rest = (squares * degrees / random.chisquare(degrees, (draws, 3))).T
    variance = (np.maximum(of_table - of_rest, 0) + of_imu) / (imus * tables)
    errors = np.abs(random.normal(size=draws)) * np.sqrt(variance)
    own = labels(imus=imus, each=tables, tables=tables)
    values = np.array([table[i, (i + n) % tables] for i in range(imus) for n in range(tables)])
    found = population(values, np.full(imus * tables, 0.1), own)
    for outside in (0.32, 0.05):
        width = found.law.half_width(outside)
        assert width == pytest.approx(np.quantile(errors, 1 - outside), rel=0.04)
    half = found.mean_sigma * stats.t.isf(LEVEL / 2, found.mean_degrees)
    assert half == pytest.approx(found.law.half_width(LEVEL), rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tables", "spread", "held"),
    [
        *((1, 1.0, 0.95), (2, 0.0, 0.984), (2, 1.0, 0.986), (2, 3.0, 0.963), (2, 9.0, 0.953)),
        *((5, 1.0, 0.96), (5, 3.0, 0.96)),
    ],
)
def test_intervals_hold_the_mean_of_simulated_populations(tables, spread, held):
    """20 IMUs of spread 3, each twice: 1500 times, so that 95 % have a standard error of 0.6 %.

    More than 95 % where two tables differ less than IMUs: that they do is not known from one
    difference. How much more is by 20 000 draws of the mean squares of a crossed analysis of
    variance; with Satterthwaite's degrees of the likeliest spreads they held 93.6 and 87.9 % of 1
    and 3.
    """
    imus, each, sigma, own_spread, count = 20, 2, 0.7, 0.5, 1500
    own = labels(imus=imus, each=each, tables=tables)
    imu, table = (np.unique(own[level], return_inverse=True)[1] for level in ("imu", "table"))
    random = np.random.default_rng([22, tables, int(spread)])
    inside = 0
    for _ in range(count):
        of_tables = spread * random.normal(size=tables)
        values = 3 * random.normal(size=imus)[imu] + of_tables[table]
        values += np.hypot(own_spread, sigma) * random.normal(size=len(imu))
        found = population(values, np.full(len(imu), sigma), own)
        truth = of_tables[0] if tables == 1 else 0.0
        size = abs(found.mean - truth) / found.mean_sigma
        inside += bool(size < stats.t.isf(LEVEL / 2, found.mean_degrees))
    assert inside / count == pytest.approx(held, abs=0.018)


@pytest.mark.parametrize("ratio", [1.0, 1.1, 2.0])
def test_two_imus_that_hardly_differ_have_a_mean_of_one_degree(ratio):
    """Two values of sigmas 4 and 400, so far apart as these allow: a spread next to zero."""
    sigma = np.array([4e-6, 4e-4])
    own = {"type": ["x"] * 2, "table": ["t"] * 2, "imu": ["a", "b"], "campaign": ["1", "2"]}
    found = population(np.array([0.0, ratio * np.hypot(*sigma)]), sigma, own)
    assert found.mean_degrees == pytest.approx(1, rel=1e-6)
    assert sigma[0] < found.mean_sigma < sigma[1]
    new = of_new_imu(found)
    assert new is not None and np.isfinite(new).all()


@pytest.mark.parametrize("tables", [1, 2])
@pytest.mark.parametrize("seed", range(6))
def test_a_new_imu_is_known_by_no_more_degrees_than_there_are_campaigns(tables, seed):
    """Four IMUs twice: of three components of their own degrees there were up to 16."""
    random = np.random.default_rng(seed)
    own = labels(imus=4, each=2, tables=tables)
    imu, table = (np.unique(own[level], return_inverse=True)[1] for level in ("imu", "table"))
    values = random.normal(size=4)[imu] + random.normal(size=tables)[table]
    values += random.normal(size=8)
    new = of_new_imu(population(values, np.full(8, 0.1), own))
    assert new is not None and 1 <= new[1] <= 7


def test_of_imus_once_each_a_new_one_has_the_degrees_of_their_variance():
    values = 3 * np.random.default_rng(31).normal(size=6)
    own = labels(imus=6, each=1, tables=1)
    sigma, degrees = of_new_imu(population(values, np.full(6, 0.01), own))
    assert sigma == pytest.approx(values.std(ddof=1) * np.sqrt(1 + 1 / 6), rel=2e-3)
    assert degrees == pytest.approx(5, rel=0.03)


def test_one_imu_is_no_population():
    own = labels(imus=1, each=4, tables=1)
    assert of_new_imu(population(np.arange(4.0), np.ones(4), own)) is None


def test_an_outlier_is_named_and_left_out():
    own = labels(imus=12, each=2, tables=2)
    of = np.repeat(np.arange(12), 2)
    random = np.random.default_rng(19)
    values = 2 * random.normal(size=(12, 2))[of] + 0.1 * random.normal(size=(24, 2))
    clean = type_population(Campaigns(values, np.tile(0.01 * np.eye(2), (24, 1, 1)), own), 0.01)
    assert not clean.outliers
    values[of == 5, 1] += 25
    found = type_population(Campaigns(values, np.tile(0.01 * np.eye(2), (24, 1, 1)), own), 0.01)
    assert [(one.imu, one.parameter) for one in found.outliers] == [("imu 5", 1)]
    kept = values[of != 5, 1]
    assert found.parameters[1].mean == pytest.approx(kept.mean(), abs=0.05)
