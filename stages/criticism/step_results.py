"""Rows of the steps of the angle that one turn alone carries."""

from collections.abc import Iterator, Mapping, Sequence
from math import degrees

from inertial.campaign.hypotheses import STEP_IN_TURN
from inertial.model_selection.cause import FOUND
from inertial.text.messages import _
from inertial.text.numbers import fixed, plus_minus, significant
from stages.criticism.finding_rows import TableRow, finding_id, finding_row
from stages.criticism.oscillation_search import SearchResult
from stages.criticism.step_in_turn import StepInTurn

SENTENCE = _(
    "In {manoeuvre} alone the case turns further than the table by {size}° about {axis} within "
    "{seconds} s, at {time} s of the log: the IMU slips in its fixture, or the table jumps once."
)
CONSEQUENCE = _(
    "The angle of this turn is off by so much; if the IMU slipped, its axes point elsewhere in all "
    "that follows."
)
ACTION = _(
    "The stretch is left out of the search for oscillations. Fasten the IMU, look at the drive of "
    "the table, and record the turn again."
)


def step_rows(
    result: SearchResult, moves: Sequence[float | None], logs: Mapping[str, str], mount: str
) -> Iterator[TableRow]:
    """A finding for each step; `moves`: the largest shift of a parameter by each, in its sigma.

    `logs`: the log of each manoeuvre.
    """
    for number, (step, moved) in enumerate(zip(result.steps, moves, strict=True)):
        yield finding_row(
            STEP_IN_TURN,
            mount,
            id=finding_id(STEP_IN_TURN, mount, *([str(number + 1)] if number else [])),
            sensor="gyro",
            axis=step.axis,
            log=logs[step.manoeuvre],
            manoeuvre=step.manoeuvre,
            from_s=step.from_s,
            to_s=step.to_s,
            size=abs(step.size),
            unit="rad",
            p_value=step.chance(len(result.turns)),
            sentence=_sentence(step),
            consequence=CONSEQUENCE,
            action=ACTION,
            verdict=FOUND,
            statistic=step.sigmas**2,
            degrees=1,
            snr=step.sigmas,
            moves=moved,
        )


def _sentence(step: StepInTurn) -> str:
    return SENTENCE.format(
        manoeuvre=step.manoeuvre,
        size=plus_minus(degrees(step.size), degrees(step.sigma)),
        axis=step.axis,
        seconds=significant(step.to_s - step.from_s, 2),
        time=fixed((step.from_s + step.to_s) / 2, 2),
    )
