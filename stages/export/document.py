"""The calibration as one document of plain values, and its text as JSON and as YAML.

`calibration.schema.json` beside this file says what every key means and in which unit. Whoever
changes a key, or what it means, counts VERSION up there and here.
"""

import json
import re
from collections.abc import Sequence
from io import StringIO
from math import isfinite
from typing import Any

import numpy as np
from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedSeq
from ruamel.yaml.representer import RoundTripRepresenter
from ruamel.yaml.scalarstring import DoubleQuotedScalarString

from inertial.arrays import Array
from inertial.campaign.measurement import EffectOfResult
from inertial.campaign.records import Part, Row, labels, omissions
from inertial.tables import BODY, CHANNEL_PARTS, OF_TRIAD
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.parameters import SENSOR_OF
from stages.export.calibration import PARAMETERS, Calibration, Mount, Triad, added_by, equations
from stages.export.examples import Example
from stages.export.filter_noise import FilterNoise, filter_noise

FORMAT = "turntable calibration"
VERSION = 5
SQRT_HZ = {"accel": "(m/s²)/√Hz", "gyro": "(rad/s)/√Hz"}
EQUATION = {
    "reading": _("reading = M · truth + bias + effects(truth, t, T)"),
    "correction": _(
        "truth = inverse · (reading − bias − effects(truth, t, T)), with inverse = M⁻¹"
    ),
    "in_words": _(
        "Take the bias off the three readings, then multiply by the inverse: row i of it times the "
        "three differences gives the truth along axis i. All nine elements are meant, not the "
        "diagonal alone. Where there are effects, compute from this truth what they add, take it "
        "off the readings together with the bias, multiply again, and repeat until the truth no "
        "longer changes; three times are enough. The accelerometers come first, for effects of the "
        "gyros may need the specific force. Readings are those of the log in m/s² and rad/s, with "
        "the count size that the campaign states, or as the condition sets them right."
    ),
    "symbols": _(
        "f_x, f_y, f_z: specific force, m/s². w_x, w_y, w_z: angular rate, rad/s. s_x, s_y, s_z: "
        "what the three sensors sense along their own axes, M · truth, which is the reading less "
        "bias and effects; s_x is M_xx · w_x + M_xy · w_y + M_xz · w_z. t: time of the "
        "log, s, since time.epoch_gps or, where that is null, since the first sample. T: "
        "temperature of the instrument, K. M_xy, bias_x: elements of matrix and bias. Others: "
        "parameters and constants of effects by their names; an effect with T_min and T_max is "
        "valid between these temperatures, K, and not to be extrapolated. abs, exp: absolute "
        "value, exponential; (t > a) is 1 where it is true, else 0."
    ),
    "matrix": _(
        "Row: the sensor that reads, x y z. Column: the axis that it feels, x y z. "
        "scale_x is M_xx − 1, cross_xy is M_xy."
    ),
    "signs": _(
        "Specific force: the axis that points up reads +g at rest. Angular rate: right-hand rule; "
        "it contains the earth's rate, so a corrected gyro at rest reads that and not zero."
    ),
}
FRAMES = {
    BODY: _(
        "Body axes x, y, z of the IMU, right-handed, as its data sheet names them and "
        "as the campaign set them on the table. No axis is exchanged or turned over."
    ),
    OF_TRIAD: _(
        "Axes x, y, z at right angles to each other, right-handed, nearest to those of the "
        "accelerometers, so that their matrix is symmetric. Their rotation against the case is "
        "not determined: no attitude of the case was known."
    ),
}


# A list of numbers alone, as json.dumps breaks it over lines. A text holds no raw line break, and
# so is never taken for one.
_NUMBER_LIST = re.compile(r'\[\n([^\[\]{}"]*)\n\s*\]')
NO_LINE_BREAKS = 1_000_000  # characters of a line of YAML


def document(calibration: Calibration) -> Row:
    """The content of calibration.json and calibration.yaml."""
    campaign = calibration.campaign
    for_filters = _for_filters(calibration)
    texts = ("instrument", "serial", "date", "laboratory", "operator", "notes", "table")
    return {
        "format": FORMAT,
        "version": VERSION,
        "campaign": campaign["campaign"],
        "simulated": bool(campaign["simulated"]),
        "not_exported": calibration.not_exported,
        **{key: campaign[key] for key in texts},
        "equation": EQUATION | {"frame": FRAMES[_frame(calibration.mounts)]},
        "mounts": [_mount(mount) for mount in calibration.mounts],
        "noise": [_noise(row, for_filters.get(row["channel"])) for row in calibration.noise],
        "filter_use": {
            "seconds": calibration.use.seconds,
            "rate_rms": calibration.use.rate_rms,
            "force_rms": calibration.use.force_rms,
            "correlation": calibration.use.correlation,
        },
        "rate": {
            "unit": "Hz",
            "measured": _number(calibration.rate),
            "stated": _number(campaign["rate"]),
        },
        "temperature": calibration.temperature and {"unit": "K", **calibration.temperature},
        "time": {"unit": "s", "epoch_gps": _number(calibration.epoch_gps)},
        "known": [
            {
                "quantity": row["quantity"],
                "value": _number(row["value"]),
                "sigma": _number(row["sigma"]),
                "unit": row["unit"],
                "origin": row["origin"],
            }
            for row in calibration.known
        ],
        "inputs": [
            {key: row[key] for key in ("file", "size", "sha256")} for row in calibration.inputs
        ],
        "made_by": list(calibration.made_by),
    }


def _frame(mounts: Sequence[Mount]) -> str:
    """That of matrices and biases: by hand there is one mount, and no axes of a case."""
    return next((mount.accelerometer.frame for mount in mounts), BODY)


def _mount(mount: Mount) -> Row:
    return {
        "mount": mount.name,
        "accelerometer": _triad(mount.accelerometer),
        "gyroscope": _triad(mount.gyroscope),
        "worked_samples": [_example(example, mount) for example in mount.examples],
    }


def _triad(triad: Triad) -> Row:
    reasons = {**triad.reasons, "inverse": triad.no_inverse}
    verdict = triad.verdict or {}
    return {
        **{key: verdict.get(key) for key in ("verdict", "sentence", "condition", "method")},
        "why_this_method": verdict.get("reason"),
        "equation": equations(triad.kind, triad.removable),
        "effects": [_effect(one, triad.kind) for one in triad.effects],
        "matrix": _with_sigma("1", triad.matrix, triad.matrix_sigma),
        "inverse": _with_sigma("1", triad.inverse, triad.inverse_sigma),
        "bias": _with_sigma(triad.unit, triad.bias, triad.bias_sigma),
        "covariance": {"names": list(triad.ids), "value": _numbers(triad.covariance)},
        "not_determined": [
            {"name": f"{triad.id_prefix}/{name}", "reason": reason}
            for name in (*PARAMETERS, "inverse")
            if (reason := reasons.get(name))
        ],
        "fit": triad.fit and _fit(triad.fit, triad.manoeuvres),
    }


def _effect(one: EffectOfResult, kind: str) -> Row:
    return {
        "effect": one.effect.name,
        "name": in_words(one.effect.name),
        "cause": one.effect.cause,
        "in_equation": bool(one.effect.terms),
        "not_in_equation": None if one.effect.terms else one.effect.stays,
        "added": [{"axis": axis, "to_reading": t} for axis, t in added_by(one, kind).items()],
        "parameters": [_named(row) for row in one.parameters.values()],
        "constants": [_named(row) for row in one.constants.values()],
    }


def _named(row: Row) -> Row:
    """A number of an effect."""
    return {
        "name": row["parameter"],
        "value": _number(row["value"]),
        "sigma": _number(row["sigma"]),
        "unit": row["unit"],
        "meaning": row["meaning"],
    }


def _with_sigma(unit: str, value: Array | None, sigma: Array | None) -> Row:
    return {"unit": unit, "value": _numbers(value), "sigma": _numbers(sigma)}


def _fit(row: Row, manoeuvres: Sequence[Part]) -> Row:
    return {
        "chi_squared": _number(row["chi_squared"]),
        "degrees": row["degrees"],
        "p_value": _number(row["p_value"]),
        "scatter": _number(row["scatter"]),
        "unit": row["unit"],
        "used": labels(manoeuvres),
        "left_out": omissions(manoeuvres),
    }


def _example(example: Example, mount: Mount) -> Row:
    truth = mount.corrected(example)
    readings = {"accelerometer": example.reading[:3], "gyroscope": example.reading[3:]}
    return {
        "what": example.what,
        "manoeuvre": example.manoeuvre,
        "log": example.log,
        "from_record": example.first,
        "to_record": example.after,
        "line": example.line,
        "time": _number(example.time),
        "temperature": _number(example.temperature),
        **{
            kind: {
                "unit": mount.triad(kind).unit,
                "reading": _numbers(reading),
                "corrected": _numbers(truth[kind]),
            }
            for kind, reading in readings.items()
        },
    }


def _for_filters(calibration: Calibration) -> dict[str, FilterNoise]:
    """Channel → its noise for a filter, of readings that all of the result has corrected."""
    found = {}
    for kind in SENSOR_OF if calibration.mounts else ():
        triad = calibration.best(kind)[1]
        if not triad.unusable:
            for one in filter_noise(triad, calibration.noise, calibration.use):
                found[f"{SENSOR_OF[kind]}_{one.axis}"] = one
    return found


def _noise(row: Row, for_filter: FilterNoise | None) -> Row:
    numbers = ("density", "sigma", "least", "most", "data_sheet")
    return {
        "channel": row["channel"],
        "unit": SQRT_HZ[CHANNEL_PARTS[row["channel"]][0]],
        **{key: _number(row[key]) for key in numbers},
        "stretches": row["stretches"],
        "terms": [_term(name, term) for name, term in row["terms"].items()],
        "for_filter": for_filter
        and {
            "density": for_filter.density,
            "random_walk": _number(for_filter.walk),
            "random_walk_by_upper_limit": for_filter.walk_is_limit,
        },
    }


def _term(name: str, term: Row) -> Row:
    """A term of the noise: value and sigma, or an upper limit."""
    found = term["detected"]
    return {
        "term": name,
        "unit": term["unit"],
        "value": _number(term["value"]) if found else None,
        "sigma": _number(term["sigma"]) if found else None,
        "upper_limit": None if found else _number(term["upper"]),
        "data_sheet": _number(term["data_sheet"]),
        "seconds": _number(term["seconds"]),
    }


def _numbers(array: Array | None) -> Any:
    """Nested lists of an array, null for what is NaN; null for no array."""
    if array is None:
        return None
    return [_number(each) if np.ndim(each) == 0 else _numbers(each) for each in array]


def _number(value: float | None) -> float | None:
    return None if value is None or not isfinite(value) else float(value)


# ---- texts


def as_json(content: Row) -> str:
    """`content` as JSON: every number to the last bit, one row of a matrix on one line."""
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    return _NUMBER_LIST.sub(lambda row: f"[{' '.join(row[1].split())}]", text) + "\n"


def as_yaml(content: Any) -> str:
    """`content`, of dicts, lists, texts, finite numbers, truth values and None, as YAML.

    Readers of version 1.1 and of version 1.2 understand it alike: every text is quoted, so that
    none is taken for a date, a number or a truth value; every number with an exponent has a
    point, because `1e-05` is a text to readers of version 1.1.
    """
    writer = YAML()
    writer.Representer = _Representer
    writer.width = NO_LINE_BREAKS
    writer.indent(mapping=2, sequence=4, offset=2)
    text = StringIO()
    writer.dump(_styled(content), text)
    return text.getvalue()


class _Representer(RoundTripRepresenter):
    """Numbers and nulls as both versions read them."""

    def represent_plain_float(self, value: float) -> Any:
        text = repr(value)
        return self.represent_scalar(
            "tag:yaml.org,2002:float", text if "." in text else text.replace("e", ".0e")
        )

    def represent_plain_null(self, _: None) -> Any:
        return self.represent_scalar("tag:yaml.org,2002:null", "null")


_Representer.add_representer(float, _Representer.represent_plain_float)
_Representer.add_representer(type(None), _Representer.represent_plain_null)


def _styled(node: Any) -> Any:
    """The same with every text quoted, and with lists of numbers on one line."""
    if isinstance(node, dict):
        return {key: _styled(value) for key, value in node.items()}
    if isinstance(node, list):
        styled = CommentedSeq(_styled(value) for value in node)
        if all(value is None or isinstance(value, float | int) for value in node):
            styled.fa.set_flow_style()
        return styled
    return DoubleQuotedScalarString(node) if isinstance(node, str) else node
