"""What an export says of effects: of the extended result a file carries M and bias alone."""

from collections.abc import Iterable, Iterator

from inertial.text.cause_names import in_words
from stages.exporting.calibration import Sensors


def told(chosen: Iterable[Sensors]) -> Iterator[str]:
    """For each triad whose extended result counts, the terms that the file does not hold."""
    for sensors in chosen:
        if not sensors.effects:
            continue
        names = dict.fromkeys(row["parameter"].partition(".")[0] for row in sensors.effects)
        each = ", ".join(
            f"{row['parameter']} = {row['value']:.4g} {row['unit'].removeprefix('1')}".rstrip()
            for row in sensors.effects
        )
        yield (
            f"- terms of effects of the {sensors.kind}s: its numbers are those of the model with"
            f" {' and '.join(in_words(name) for name in names)}, which readings corrected without"
            f" these terms still contain: {each}"
        )
