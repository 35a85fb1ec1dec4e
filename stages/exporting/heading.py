"""What stands at the head of every parameter file: of which IMU it is, and where the rest is."""

from collections.abc import Iterator, Sequence

from stages.exporting.calibration import Calibration, Sensors
from stages.exporting.comments import quoted


def heading(calibration: Calibration, target: str) -> Iterator[str]:
    """Of which IMU and campaign these parameters for `target` are."""
    about = calibration.about
    yield f"Calibration of an IMU on a turntable, for {target}."
    if about["simulated"]:
        yield "SIMULATED: no real instrument has these errors."
    yield f"IMU: {quoted(about['instrument'])}, serial number {quoted(about['serial'])}"
    yield f"Campaign: {quoted(about['campaign'])}, date {quoted(about['date'])}"
    if calibration.nothing:
        yield ""
        yield f"Nothing is exported. {calibration.nothing}"
        return
    yield (
        f"The whole calibration, with every sigma, is in {about['campaign']}.calibration.json,"
        " which also holds readings before and after the correction."
    )


def mounts(calibration: Calibration, chosen: Sequence[tuple[str, Sensors]]) -> Iterator[str]:
    """From which mount the numbers are, where the campaign has several."""
    if len(calibration.mounts) > 1:
        each = ", ".join(f"{sensors.kind} {quoted(name)}" for name, sensors in chosen)
        yield (
            f"The IMU stood on {len(calibration.mounts)} mounts; each has an M of its own, for it"
            f" contains the mounting rotation. These numbers are from: {each}."
        )
