"""Which faults are put into a source."""

import pytest
from mutations import mutations


@pytest.mark.parametrize(
    ("source", "faults"),
    [
        ("a + b", {"(a) - (b)", "a"}),
        ("a - b * c", {"(a) + (b * c)", "a", "(b) / (c)", "2 * (b) * (c)"}),
        ("m @ v", {"(m).T @ (v)"}),
        ("m.T @ v", {"m"}),
        ("-x", {"x"}),
        ("x**2", {"(x) ** (2 + 1)"}),
        ("m[i, j]", {"(m)[j, i]"}),
        ("m[0] / m[1]", {"(m[0]) * (m[1])", "(m)[1]", "(m)[0]"}),
        ("f'{a + b}' + 'text'", set()),
        ("x: 'a + b' = 1", set()),
        ("m[:, None]", set()),
        ("Pair = tuple[int, str]", set()),
        ("sizes = by_grade(2 * g, 5, 20)", set()),
        ("WIDTH = 2 * g", {"(2) / (g)", "2 * (2) * (g)"}),
    ],
)
def test_each_expression_has_its_faults(source, faults):
    found = mutations(source.encode())
    assert {one.after for one in found} == {f"({fault})" for fault in faults}
    for one in found:
        compile(one.applied(source.encode()), "mutant", "exec")


def test_a_fault_stands_in_its_place_behind_other_letters():
    source = "σ = 1  # µ\ny = (σ + 2) * 3\n"
    (sign,) = (one for one in mutations(source.encode()) if one.kind == "sign")
    assert sign.applied(source.encode()).decode() == "σ = 1  # µ\ny = (((σ) - (2))) * 3\n"
