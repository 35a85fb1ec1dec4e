"""The faults of a recording that the pipeline can see.

To add a detector, write its file beside this one and add it here; quality, segment, the report
and the tests take it from these lists. A detector masks what it detects for those after it.
"""

from inertial.detectors.arrival_stamps import ArrivalStamps
from inertial.detectors.axis_swap import AxisSwap, AxisSwapOfGyros
from inertial.detectors.axis_swap_against_plan import AxisSwapAgainstPlan
from inertial.detectors.bias_jump import BiasJump
from inertial.detectors.clock_jitter import ClockJitter
from inertial.detectors.clock_scale import ClockScale
from inertial.detectors.clock_step import ClockStep
from inertial.detectors.dead_axis import DeadAxis
from inertial.detectors.duplicate import Duplicate
from inertial.detectors.gap import Gap
from inertial.detectors.gravity_error import GravityError
from inertial.detectors.held_record import HeldRecord
from inertial.detectors.impact import Impact
from inertial.detectors.incomplete_turn import IncompleteTurn
from inertial.detectors.manoeuvre_missing import ManoeuvreMissing
from inertial.detectors.manoeuvre_swapped import ManoeuvreSwapped
from inertial.detectors.oscillation import Oscillation
from inertial.detectors.periodic_glitch import PeriodicGlitch
from inertial.detectors.quantisation import Quantisation
from inertial.detectors.rate_off import RateOff
from inertial.detectors.saturation import Saturation
from inertial.detectors.short_rest import ShortRest
from inertial.detectors.sign_flip import SignFlip, SignFlipOfGyros
from inertial.detectors.sign_flip_against_plan import SignFlipAgainstPlan
from inertial.detectors.spike import Spikes
from inertial.detectors.status_invalid import StatusInvalid
from inertial.detectors.table_moving import TableMoving
from inertial.detectors.temperature_drift import TemperatureDrift
from inertial.detectors.time_backwards import TimeBackwards
from inertial.detectors.time_stands_still import TimeStandsStill
from inertial.detectors.wrong_day import WrongDay
from inertial.detectors.wrong_direction import WrongDirection
from inertial.detectors.wrong_imu_type import WrongImuType
from inertial.detectors.wrong_rate import WrongRate
from inertial.detectors.wrong_scale_factor import WrongScaleFactor
from inertial.detectors.wrong_scale_of_turns import WrongScaleOfTurns
from inertial.signal.detector import Detector
from inertial.signal.plan_detector import PlanDetector

# Without the plan, in every record of every log.
OF_RECORDS: tuple[Detector, ...] = (
    # records and their stamps
    Duplicate(),
    Gap(),
    TimeBackwards(),
    HeldRecord(),
    StatusInvalid(),
    TimeStandsStill(),
    ArrivalStamps(),
    ClockJitter(),
    ClockStep(),
    ClockScale(),
    RateOff(),
    WrongDay(),
    WrongImuType(),
    # readings: a blow, a channel at its limit, one that repeats, or a glitch would resemble spikes
    Impact(),
    Saturation(),
    DeadAxis(),
    PeriodicGlitch(),
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
OF_PLAN: tuple[PlanDetector, ...] = (
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
