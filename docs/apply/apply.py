"""Takes the errors of a calibrated IMU out of its readings, and checks this on those of the file.

python docs/apply/apply.py reports/demo.calibration.json
"""

import ast
import json
import operator
import sys
from pathlib import Path

import numpy as np

ROUNDS = 20  # three are enough where effects are small
ALLOWED = 1e-9  # of the length of the vector
OPERATORS = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Gt: operator.gt, ast.USub: operator.neg,
}  # fmt: skip
FUNCTIONS = {"abs": abs, "exp": np.exp}


def value(node, names):
    """The value of an equation of the file; `gyro_bias_jump.b_x` is one name."""
    match node:
        case ast.Expression(body):
            return value(body, names)
        case ast.Constant(number):
            return number
        case ast.Name() | ast.Attribute():
            return names[ast.unparse(node)]
        case ast.BinOp(left, kind, right) | ast.Compare(left, [kind], [right]):
            return OPERATORS[type(kind)](value(left, names), value(right, names))
        case ast.UnaryOp(kind, of):
            return OPERATORS[type(kind)](value(of, names))
        case ast.Call(ast.Name(function), [of]):
            return FUNCTIONS[function](value(of, names))
    raise ValueError(f"{ast.unparse(node)} is no part of an equation")


def correct(triad, reading, symbol, given):
    """truth = inverse · (reading − bias − effects(truth)), (3,); None where it is not known.

    symbol: f of accelerometers, m/s², w of gyros, rad/s; given: f_x … and t, T, as far as needed
    """
    if triad["inverse"]["value"] is None or None in [*triad["bias"]["value"], *reading]:
        return None
    inverse, bias = (np.array(triad[key]["value"]) for key in ("inverse", "bias"))
    numbers = {
        row["name"]: row["value"]
        for effect in triad["effects"]
        for row in [*effect["parameters"], *effect["constants"]]
    }
    added = [
        ("xyz".index(term["axis"]), ast.parse(term["to_reading"], mode="eval"))
        for effect in triad["effects"]
        for term in effect["added"]
    ]
    more = np.zeros(3)
    for _unused in range(ROUNDS if added else 1):
        sensed = np.array(reading) - bias - more
        truth = inverse @ sensed
        names = numbers | given
        for letter, vector in ((symbol, truth), ("s", sensed)):
            names |= {
                f"{letter}_{axis}": number for axis, number in zip("xyz", vector, strict=True)
            }
        more = np.zeros(3)
        for i, equation in added:
            more[i] += value(equation, names)
    return truth


def correct_both(mount, sample):
    """Specific force and angular rate; the accelerometers first, for gyros may feel the force."""
    given = {"t": sample["time"], "T": sample["temperature"]}
    force = correct(mount["accelerometer"], sample["accelerometer"]["reading"], "f", given)
    if force is not None:
        given |= dict(zip(("f_x", "f_y", "f_z"), force, strict=True))
    rate = correct(mount["gyroscope"], sample["gyroscope"]["reading"], "w", given)
    return {"accelerometer": force, "gyroscope": rate}


def main(file):
    calibration = json.loads(Path(file).read_text(encoding="utf-8"))
    print(calibration["instrument"], calibration["serial"])
    wrong = 0
    for mount in calibration["mounts"]:
        for sample in mount["worked_samples"]:
            for kind, truth in correct_both(mount, sample).items():
                expected = sample[kind]["corrected"]
                if expected is not None:
                    difference = np.linalg.norm(truth - expected)
                    print(f"{kind}: {truth} {sample[kind]['unit']}, differs by {difference:.1e}")
                    wrong += not difference <= ALLOWED * np.linalg.norm(expected)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
