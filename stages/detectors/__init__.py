"""The faults of a recording that the pipeline can see.

To add a detector, write its file beside this one and add it here; quality, segment, the report
and the tests take it from these lists. Those that come first mask what those after them are not
to be misled by.
"""

from stages.detectors.against_plan import AgainstPlan
from stages.detectors.axis_swap import AxisSwap, AxisSwapOfGyros
from stages.detectors.axis_swap_against_plan import AxisSwapAgainstPlan
from stages.detectors.bias_jump import BiasJump
from stages.detectors.clock_jitter import ClockJitter
from stages.detectors.clock_scale import ClockScale
from stages.detectors.clock_step import ClockStep
from stages.detectors.dead_axis import DeadAxis
from stages.detectors.detector import Detector
from stages.detectors.duplicate import Duplicate
from stages.detectors.gap import Gap
from stages.detectors.gravity_error import GravityError
from stages.detectors.held_record import HeldRecord
from stages.detectors.incomplete_turn import IncompleteTurn
from stages.detectors.manoeuvre_missing import ManoeuvreMissing
from stages.detectors.manoeuvre_swapped import ManoeuvreSwapped
from stages.detectors.oscillation import Oscillation
from stages.detectors.quantisation import Quantisation
from stages.detectors.rate_off import RateOff
from stages.detectors.saturation import Saturation
from stages.detectors.short_rest import ShortRest
from stages.detectors.sign_flip import SignFlip, SignFlipOfGyros
from stages.detectors.sign_flip_against_plan import SignFlipAgainstPlan
from stages.detectors.spike import Spikes
from stages.detectors.status_invalid import StatusInvalid
from stages.detectors.table_moving import TableMoving
from stages.detectors.temperature_drift import TemperatureDrift
from stages.detectors.time_backwards import TimeBackwards
from stages.detectors.time_stands_still import TimeStandsStill
from stages.detectors.wrong_day import WrongDay
from stages.detectors.wrong_direction import WrongDirection
from stages.detectors.wrong_imu_type import WrongImuType
from stages.detectors.wrong_rate import WrongRate
from stages.detectors.wrong_scale_factor import WrongScaleFactor
from stages.detectors.wrong_scale_of_turns import WrongScaleOfTurns

# Without the plan, in every record of every log.
OF_RECORDS: tuple[Detector, ...] = (
    # records and their stamps
    Duplicate(),
    Gap(),
    TimeBackwards(),
    HeldRecord(),
    StatusInvalid(),
    TimeStandsStill(),
    ClockJitter(),
    ClockStep(),
    ClockScale(),
    RateOff(),
    WrongDay(),
    WrongImuType(),
    # readings: what stands at its limit or stands still would look like a spike
    Saturation(),
    DeadAxis(),
    Spikes(),
    AxisSwap(),
    AxisSwapOfGyros(),
    SignFlip(),
    SignFlipOfGyros(),
    Quantisation(),
    Oscillation(),
    # what a count is, and where it stands
    GravityError(),
    WrongScaleFactor(),
    TemperatureDrift(),
)
# Of the records of each rest, once the plan is found in the logs.
OF_RESTS: tuple[Detector, ...] = (TableMoving(), BiasJump())
# Of what was recorded of all manoeuvres, against the plan.
OF_PLAN: tuple[AgainstPlan, ...] = (
    AxisSwapAgainstPlan(),
    SignFlipAgainstPlan(),
    WrongScaleOfTurns(),
    ManoeuvreSwapped(),
    ManoeuvreMissing(),
    WrongDirection(),
    IncompleteTurn(),
    WrongRate(),
    ShortRest(),
)
