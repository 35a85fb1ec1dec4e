"""The gyros on a rate table against straight lines: S4's runs at many rates."""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.estimation.consistency import outliers
from inertial.estimation.gyroscope_observations import Earth, SteadyRate
from inertial.estimation.rate_linearity import columns_of, nonlinearities, own_axis
from inertial.text.messages import _
from stages.comparison.difference import Difference

KIND = "straight_line"
MAX_OUTLIER_P = 0.05  # chance below which a run, after Bonferroni, is left out
FORMS = {"cubic": "s²/rad²", "asymmetry": "1"}


def straight_line(
    runs: Sequence[SteadyRate], earth: Earth, scatter: Sequence[float]
) -> Iterator[Difference]:
    """Whether what the gyros read goes with the rate alone; the runs of all mounts at once.

    The noise is that of the residuals; `scatter`, rad/s, between the runs of each mount tells only
    how runs weigh. Runs that do not belong to the others are left out. One form
    for all gyros may be the table's as well as the gyros'. Where no mount recorded another gyro
    than the one that turned, it is also all that "installation errors" can be made of: S4's least
    squares, its inputs in another order, turns the bend into cross terms.
    """
    data = own_axis(runs, earth, float(np.sqrt(np.mean(np.square(scatter)))))
    if not len(data.rate):
        return
    bent = np.hstack([data.straight, columns_of(data)["cubic"]])
    apart = [one.row for one in outliers(bent, data.mean, data.sigma, MAX_OUTLIER_P)]
    found = nonlinearities(data.less(apart))
    left_out = ", ".join(runs[data.run[row]].position.name for row in apart)
    for form, unit in FORMS.items():
        if form in found:
            test = found[form]
            yield Difference(
                kind=KIND,
                stage="gyroscope",
                quantity=form,
                unit=unit,
                first=_("{rate} steady runs", rate=len(data.rate) - len(apart)),
                second=_("a scale factor and a bias for each gyro"),
                first_value=float(test.values[0]),
                second_value=0.0,
                sigma=float(test.sigma[0]),
                degrees=test.degrees,
                between=("the steady runs", "straight lines"),
                remark=_(
                    "Left out, for they do not belong to the others: {left_out}", left_out=left_out
                )
                if apart
                else "",
            )
