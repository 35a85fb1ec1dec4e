"""The noise of every channel: Allan deviation, spectrum, and the terms that describe both."""

from collections.abc import Iterable, Iterator, Sequence

from inertial.sensors import PLURAL
from inertial.tables import AXES
from inertial.text.messages import _, listed
from inertial.text.numbers import common_decimals, shortened, significant, with_sigma
from inertial.text.parameters import FREE
from inertial.text.typography import capital
from inertial.text.units import RANDOM_WALK, Unit, quantity
from stages.report import outline
from stages.report.sections.noise_figures import LOWEST, allan_figure, spectrum_figure
from stages.report.tables import Record, Tables

# The terms of IEEE Std 952 in the order of their slopes, with their letters.
SYMBOL = {
    "quantisation": "Q",
    "white_noise": "N",
    "bias_instability": "B",
    "random_walk": "K",
    "ramp": "R",
}
NAME = {
    "gyro": {
        "quantisation": _("Quantisation"),
        "white_noise": _("Angle random walk"),
        "bias_instability": _("Bias instability"),
        "random_walk": _("Rate random walk"),
        "ramp": _("Ramp"),
    },
    "accel": {
        "quantisation": _("Quantisation"),
        "white_noise": _("Velocity random walk"),
        "bias_instability": _("Bias instability"),
        "random_walk": _("Acceleration random walk"),
        "ramp": _("Ramp"),
    },
}
RESTS = ("rest", "rest-before", "rest-after")
BIAS_UNIT = {"gyro": "rad/s", "accel": "m/s²"}
STATED_BY = {  # keys of the campaign file
    "gyro": "gyro: bias_instability_deg_h",
    "accel": "accelerometer: bias_instability_ug",
}


def parts(tables: Tables) -> Iterator[outline.Part]:
    """Allan deviation, spectrum and the terms of the noise; the levels where there is neither."""
    allan, spectra, terms = (tables.rows(name) for name in ("allan", "spectra", "noise_terms"))
    sheet = tables.rows("sensors")
    if allan:
        yield allan_figure(allan, sheet)
    else:
        yield outline.Paragraph(_nothing(tables.rows("segments")), "fair")
    if spectra:
        yield spectrum_figure(spectra, sheet)
    if terms:
        sensors = [s for s in NAME if any(row["channel"].startswith(s) for row in terms)]
        for sensor in sensors:
            own = [row for row in terms if row["channel"].startswith(sensor)]
            notes = [
                *_explained(tables, sensor),
                *_not_its_own(own),
                *_open(tables, sensor, own),
            ]
            if sensor == sensors[-1]:
                notes.append(_note(terms, sheet))
            yield _terms_table(sensor, own, " ".join(filter(None, notes)))
    else:
        yield _levels(tables.rows("levels"), sheet)


SECTION = outline.Section(
    "noise",
    _("Noise"),
    _("The noise of each channel at rest, as averaging time grows, and the terms it consists of."),
    _(
        "Points are the data with their 1-σ interval, lines the sum of the fitted terms; from left "
        "to right quantisation falls with slope −1, white noise (random walk of angle or velocity) "
        "with −½, bias instability is flat, a random walk of the bias rises with +½, a ramp with "
        "+1. Every σ of this report contains the white noise of each manoeuvre, quantisation, bias "
        "instability and random walk where they are significant (p < 0.1 %), the bias instability "
        "of the other axes where one shows none, and the rounding of counts that are coarse "
        "beside them; by hand, where the support may tilt, of the accelerometers neither. Of the "
        "data sheet, dashed, only the bias instability is used, where the rests do not determine "
        "it."
    ),
    (
        "allan",
        "spectra",
        "noise_terms",
        "levels",
        "sensors",
        "segments",
        "drifts_at_rest",
        "result",
    ),
    parts,
)


def _nothing(segments: Iterable[Record]) -> str:
    """Why there is no Allan deviation."""
    lengths = [
        row["to_s"] - row["from_s"]
        for row in segments
        if row["phase"] in RESTS and row["from_s"] is not None and row["to_s"] is not None
    ]
    if not lengths:
        return _(
            "There is no Allan deviation, for no static stretch with time stamps was recorded. "
            "One of an hour or more (do: rest) shows how the biases wander."
        )
    return _(
        "There is no Allan deviation, for no static stretch is long enough: the longest has "
        "{longest} s. One of an hour or more (do: rest) shows how the biases wander.",
        longest=significant(max(lengths), 3),
    )


# ---- terms


def _not_its_own(terms: Sequence[Record]) -> Iterator[str]:
    """Of which axes a single manoeuvre, or the support, changes the readings at rest."""
    stepped, tilted = (
        list(dict.fromkeys(row["channel"][-1] for row in terms if row[kind]))
        for kind in ("stepped", "tilted")
    )
    if stepped:
        yield _(
            "At rest in one manoeuvre alone {axes} changes by a step: B, K and R contain it, and "
            "enter no σ.",
            axes=listed(stepped),
        )
    if tilted:
        yield _(
            "{axes} drifts at rest where it is level, and not where it is upright: what drifts is "
            "the support, which tilts; B, K and R contain it, and enter no σ.",
            axes=listed(tilted),
        )


def _explained(tables: Tables, sensor: str) -> Iterator[str]:
    """That the drift of a sensor at rest is better explained otherwise, so that no σ holds it."""
    own = [row for row in tables.rows("drifts_at_rest") if row["sensor"] == sensor]
    if own and not any(row["kept"] for row in own):
        yield _(
            "B and K of the {sensors} contain a change of their biases that what is named, or "
            "single manoeuvres, explain better: the fit with effects in the model does without "
            "them.",
            sensors=PLURAL[sensor],
        )


def _open(tables: Tables, sensor: str, terms: Sequence[Record]) -> Iterator[str]:
    """What a bias instability that neither rests nor a data sheet show would add to a bias."""
    drifting = {
        row["channel"]
        for row in tables.rows("levels")
        if row["manoeuvre"] is None and (row["bias_instability"] or row["random_walk"])
    }
    by_hand = any(row["method"] == FREE for row in tables.rows("result"))
    held = set() if by_hand and sensor == "accel" else drifting  # there the support drifts as well
    sigma = {
        row["parameter"].removeprefix("bias_"): row["sigma"]
        for row in tables.rows("result")
        if row["sensor"] == sensor and row["sigma"]
    }
    added = [
        (LOWEST * row["upper"] / sigma[axis], row["upper"], sigma[axis])
        for row in terms
        if row["term"] == "bias_instability"
        and row["upper"]
        and not row["data_sheet"]
        and row["channel"] not in held
        for axis in [row["channel"][-1]]
        if axis in sigma
    ]
    ratio, upper, own = max(added, default=(0.0, 0.0, 0.0))
    if ratio > 1:
        unit = quantity("bias_x", BIAS_UNIT[sensor]).shown
        yield _(
            "No data sheet states the bias instability of the {sensors}, so none is in their σ. "
            "One of B = {upper} {unit} could hide in these rests, and would add up to {floor} "
            "{unit} to a bias whose σ is {sigma} {unit}. Stated ({key}), it is in σ.",
            sensors=PLURAL[sensor],
            upper=significant(unit.of(upper), 2),
            unit=unit.name,
            floor=significant(unit.of(LOWEST * upper), 2),
            sigma=significant(unit.of(own), 2),
            key=STATED_BY[sensor],
        )


def _note(terms: Sequence[Record], sheet: Sequence[Record]) -> str:
    """What < means, and whence the data sheet."""
    limit = _("<: upper limit, 95 %; the term is not significant.")
    limits = any(not row["detected"] for row in terms)
    floor = _(
        "The bias instability of a data sheet is taken as the floor of its Allan deviation, so B "
        "beside it is that floor over 0.664 (√(2 ln 2/π)); the figure shows the floor."
    )
    stated = any(row["term"] == "bias_instability" and row["data_sheet"] for row in terms)
    notes = [limit if limits else "", floor if stated else "", of_data_sheets(sheet)]
    return " ".join(filter(None, notes))


def _terms_table(sensor: str, rows: Sequence[Record], note: str) -> outline.Table:
    """A row for each axis: value ± σ of each term, or its upper limit; below, the data sheet."""
    units = {row["term"]: quantity(row["term"], row["unit"]).shown for row in rows}
    names = [term for term in SYMBOL if term in units]
    columns = [outline.Column(_("Axis"), "name")]
    cells: list[list[str]] = []
    axes = [axis for axis in AXES if any(row["channel"] == f"{sensor}_{axis}" for row in rows)]
    for term in names:
        columns += outline.value_and_sigma(
            NAME[sensor][term], f"{SYMBOL[term]}, {units[term].name}"
        )
        own = {row["channel"][-1]: row for row in rows if row["term"] == term}
        stated = {row["channel"][-1]: row["data_sheet"] for row in own.values()}
        values, sigmas = _written([own.get(axis) for axis in axes], units[term])
        shown = next((v for v in stated.values() if v is not None), None)
        cells.append([*values, significant(units[term].of(shown), 3) if shown else ""])
        cells.append([*sigmas, ""])
    by_row = list(zip(*cells, strict=True))
    seconds = {row["channel"][-1]: row["seconds"] for row in rows}
    lines = [
        outline.table_row(axis, *own, significant(seconds[axis], 3))
        for axis, own in zip(axes, by_row, strict=False)
    ]
    if any(by_row[-1]):
        lines.append(outline.table_row(DATA_SHEET, *by_row[-1], ""))
    return outline.Table(
        _("{sensors}: the terms of the noise.", sensors=capital(PLURAL[sensor])),
        (*columns, *outline.columns("number", _("s"), group=_("Stretch"))),
        lines,
        note=note,
    )


def _written(rows: Sequence[Record | None], unit: Unit) -> tuple[list[str], list[str]]:
    """Values with common decimals, or upper limits; and the sigmas of the values."""
    sigmas = [unit.of(row["sigma"]) for row in rows if row and row["detected"]]
    decimals = common_decimals(sigmas)
    values, spread = [], []
    for row in rows:
        found = bool(row and row["detected"])
        upper = unit.of(row["upper"]) if row and not found else None
        sigma = unit.of(row["sigma"]) if row and found else None
        pair = ("", "")
        if row is None or (not found and upper is None):
            values.append("—")
        elif found and decimals is not None:
            pair = with_sigma(unit.of(row["value"]), sigma, decimals)
            values.append(pair[0])
        else:
            text = significant(unit.of(row["value"]) if found else upper, 3 if found else 2)
            values.append(text if found else f"< {text}")
        spread.append(pair[1] if sigma else "")
    return values, spread


# ---- levels, where there are no terms


def _levels(levels: Sequence[Record], sheet: Sequence[Record]) -> outline.Table:
    """The white noise of each channel that the estimation takes, beside the data sheet."""
    stated = {f"{row['sensor']}_{row['axis']}": row["white_noise"] for row in sheet}
    own = {row["channel"]: row for row in levels if row["manoeuvre"] is None}
    lines = []
    for channel, row in own.items():
        sensor, _unused, axis = channel.partition("_")
        unit = RANDOM_WALK[sensor]
        values, sigmas = _written([row | {"detected": True, "value": row["white_noise"]}], unit)
        lines.append(
            (
                f"{listed([PLURAL[sensor][:-1]])} {axis}",
                *values,
                *sigmas,
                significant(unit.of(stated.get(channel)), 3),
                unit.name,
            )
        )
    return outline.Table(
        _("White noise by channel, of all manoeuvres together."),
        (
            outline.Column(_("Channel")),
            *outline.value_and_sigma(),
            *outline.columns("number", _("Data sheet")),
            outline.Column(_("Unit"), "unit"),
        ),
        [outline.table_row(*line) for line in lines],
        _("None: no manoeuvre is long enough to estimate the noise."),
    )


# ---- The data sheets with which the noise is compared

DATA_SHEET = _("data sheet")


def of_data_sheets(sheet: Sequence[Record]) -> str:
    """Whence the data sheet of each sensor is; nothing without one."""
    sensors: dict[str, list[str]] = {}
    for row in sheet:
        if row["source"] and PLURAL[row["sensor"]] not in sensors.setdefault(row["source"], []):
            sensors[row["source"]].append(PLURAL[row["sensor"]])
    each = (
        _("{sensors}: {source}.", sensors=capital(listed(names)), source=shortened(source, 300))
        for source, names in sensors.items()
    )
    return _("Data sheet. {each}", each=" ".join(each)) if sensors else ""
