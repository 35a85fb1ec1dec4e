"""The calibration as a header in C99, for firmware: M⁻¹ and bias of each triad, and its effects.

The effects are functions, made of the equations of calibration.json; `docs/apply/apply.c` uses it.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from inertial.campaign.records import Row
from inertial.tables import AXES
from inertial.text.parameters import SENSOR_OF
from stages.export.dcc_results import unusable

# What stands in a text of C as it is; all other bytes are octal.
_NOT_PLAIN = re.compile(rb"[^A-Za-z0-9 _.,:;/+()-]")
TYPES = """\
#include <math.h>

#define MOUNTS {mounts}
#define SAMPLES {samples} /* of a mount, at most */

/* Three sensors x, y, z: truth = inverse (reading - bias - effects(truth)); m/s^2 or rad/s.
   NAN: not determined, or not to be used. effects adds to `added` what they add to the readings:
   f specific force, m/s^2; w angular rate, rad/s; s what the three sense along their own axes,
   reading - bias - effects; t time of the log, s; T temperature, K. */
struct triad {{
    double inverse[3][3], bias[3];
    void (*effects)(const double f[3], const double w[3], const double s[3], double t, double T,
                    double added[3]);
}};

/* A reading of the campaign and what is to come out of it; f: accelerometers, w: gyros. */
struct sample {{
    double t, T, f_reading[3], w_reading[3], f_corrected[3], w_corrected[3];
}};

struct mount {{
    const char *name;
    struct triad accelerometer, gyroscope;
    int samples;
    struct sample sample[SAMPLES];
}};
"""
AXIS_NAMES = """\
    const double f_x = f[0], f_y = f[1], f_z = f[2], w_x = w[0], w_y = w[1], w_z = w[2];
    const double s_x = s[0], s_y = s[1], s_z = s[2];
    (void)f_x, (void)f_y, (void)f_z, (void)w_x, (void)w_y, (void)w_z, (void)t, (void)T;
    (void)s_x, (void)s_y, (void)s_z;"""


def c_header(content: Row) -> str:
    """The header; `content`: what calibration.json contains."""
    return "\n".join(_lines(content)) + "\n"


def _lines(content: Row) -> Iterator[str]:
    mounts = content["mounts"]
    samples = max((len(mount["worked_samples"]) for mount in mounts), default=0)
    yield "#ifndef CALIBRATION_H\n#define CALIBRATION_H"
    yield TYPES.format(mounts=len(mounts), samples=max(samples, 1))
    for key in ("campaign", "instrument", "serial", "date"):
        yield f"static const char {key}[] = {_text(content[key])};"
    yield f"static const int simulated = {int(content['simulated'])};"
    for number, mount in enumerate(mounts, 1):
        for kind in SENSOR_OF:
            yield from _effects(f"effects_{kind}_{number}", mount[kind])
    yield "\nstatic const struct mount calibration[MOUNTS + 1] = {"
    for number, mount in enumerate(mounts, 1):
        yield f"    {{{_text(mount['mount'])},"
        for kind in SENSOR_OF:
            yield f"     {_triad(mount[kind])}, effects_{kind}_{number}}},"
        yield f"     {len(mount['worked_samples'])},"
        yield f"     {{{', '.join(map(_sample, mount['worked_samples'])) or '{0}'}}}}},"
    yield "    {0}};"
    yield "\n#endif"


def _effects(name: str, triad: Row) -> Iterator[str]:
    """A function that adds what the effects of a triad add to its readings."""
    yield (
        f"\nstatic void {name}(const double f[3], const double w[3], const double s[3], double t,"
        " double T, double added[3])\n{"
    )
    yield AXIS_NAMES
    inside = [effect for effect in triad["effects"] if effect["in_equation"]]
    for effect in inside:
        own = [*effect["parameters"], *effect["constants"]]
        members = ", ".join(row["name"].partition(".")[2] for row in own)
        numbers = ", ".join(_number(row["value"]) for row in own)
        yield f"    static const struct {{ double {members}; }} {effect['effect']} = {{{numbers}}};"
    sums: dict[str, list[str]] = {axis: [] for axis in AXES}
    for effect in inside:
        for term in effect["added"]:
            sums[term["axis"]].append(re.sub(r"\babs\(", "fabs(", term["to_reading"]))
    for i, terms in enumerate(sums.values()):
        yield f"    added[{i}] += {' + '.join(terms) or '0.0'};"
    yield "}"


def _triad(triad: Row) -> str:
    use = not unusable(triad)
    inverse = triad["inverse"]["value"] if use and triad["inverse"]["value"] else [[None] * 3] * 3
    bias = triad["bias"]["value"] if use else [None] * 3
    return f"{{{_braces(map(_vector, inverse))}, {_vector(bias)}"


def _sample(sample: Mapping[str, Any]) -> str:
    vectors = (
        _vector(sample[kind][key] or [None] * 3)
        for key in ("reading", "corrected")
        for kind in SENSOR_OF
    )
    return _braces([_number(sample["time"]), _number(sample["temperature"]), *vectors])


def _vector(values: Sequence[float | None]) -> str:
    return _braces(map(_number, values))


def _braces(parts: Iterable[str]) -> str:
    return "{" + ", ".join(parts) + "}"


def _number(value: float | None) -> str:
    return "NAN" if value is None else repr(float(value))


def _text(text: str | None) -> str:
    plain = _NOT_PLAIN.sub(lambda byte: b"\\%03o" % byte[0][0], (text or "").encode())
    return f'"{plain.decode()}"'
