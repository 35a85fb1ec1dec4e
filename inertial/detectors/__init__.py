"""The faults of a recording that the pipeline can see.

To add a detector, write its file beside this one and add it here; quality, segment, the report
and the tests take it from these lists. A detector masks what it detects for those after it.
"""

from inertial.detectors.bias_jump import BiasJump
from inertial.detectors.clock_jitter import ClockJitter
from inertial.detectors.clock_scale import ClockScale
from inertial.detectors.dead_axis import DeadAxis
from inertial.detectors.disturbances import Impact, PeriodicGlitch
from inertial.detectors.encoder_against_plan import (
    EncoderAngles,
    EncoderJump,
    EncoderScale,
    EncoderScaleOrEccentricity,
)
from inertial.detectors.gap import Gap
from inertial.detectors.manoeuvres_against_plan import (
    ManoeuvreMissing,
    ManoeuvreSwapped,
    RestsDivided,
    ShortRest,
    TurningPointOnce,
    WrongSpans,
)
from inertial.detectors.misread_axes_and_signs import (
    AxisSwap,
    AxisSwapAgainstPlan,
    AxisSwapOfGyros,
    SignFlip,
    SignFlipAgainstPlan,
    SignFlipOfGyros,
)
from inertial.detectors.oscillation import Oscillation
from inertial.detectors.position_not_kept import FixtureCreep, PositionNotKept
from inertial.detectors.processed_readings import (
    BiasRemoved,
    CopiedChannel,
    CopiedLog,
    NormalisedForce,
)
from inertial.detectors.quantisation import Quantisation
from inertial.detectors.receiver_statements import StatusInvalid, WrongImuType
from inertial.detectors.repeated_records import Duplicate, HeldRecord, SlowerSensor
from inertial.detectors.saturation import Saturation
from inertial.detectors.saturation_of_turns import SaturationOfTurns
from inertial.detectors.spike import Spikes
from inertial.detectors.stamp_faults import (
    ArrivalStamps,
    ClockStep,
    RateOff,
    TimeBackwards,
    TimeStandsStill,
    WrongDay,
    WrongTimeUnit,
)
from inertial.detectors.stated_against_gravity import GravityError, TableRateByGravity
from inertial.detectors.table_moving import MotionAfterTurns, TableMoving
from inertial.detectors.temperatures import (
    TemperatureDrift,
    TemperatureMisstated,
    TemperatureUnknown,
    WrongTemperatureUnit,
)
from inertial.detectors.time_of_turns import (
    LostSamplesOfTurns,
    SampleRateByTurns,
    WrongTimeUnitOfTurns,
)
from inertial.detectors.turns_against_plan import (
    IncompleteTurn,
    TurnTooFar,
    WrongDirection,
    WrongMark,
    WrongRate,
)
from inertial.detectors.wrong_scale_factor import (
    GravityRemoved,
    WrongScaleFactor,
    WrongScaleOfTurns,
)
from inertial.detectors.zero_below_threshold import ZeroBelowThreshold
from inertial.signal.detector import Detector
from inertial.signal.plan_detector import PlanDetector

# Without the plan, in every record of every log.
OF_RECORDS: tuple[Detector, ...] = (
    # records and their stamps
    Duplicate(),
    Gap(),
    TimeBackwards(),
    HeldRecord(),
    SlowerSensor(),
    StatusInvalid(),
    TimeStandsStill(),
    ArrivalStamps(),
    ClockJitter(),
    ClockStep(),
    ClockScale(),
    RateOff(),
    WrongTimeUnit(),
    WrongDay(),
    WrongImuType(),
    # what a column holds
    CopiedLog(),
    CopiedChannel(),
    GravityRemoved(),
    NormalisedForce(),
    BiasRemoved(),
    # readings: a blow, a channel at its limit, one that repeats, or a glitch would resemble spikes
    Impact(),
    Saturation(),
    ZeroBelowThreshold(),
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
    WrongTemperatureUnit(),
)
# Of the records of each rest, once the plan is found in the logs.
OF_RESTS: tuple[Detector, ...] = (TableMoving(), BiasJump())
# Of what was recorded of all manoeuvres, against the plan.
OF_PLAN: tuple[PlanDetector, ...] = (
    AxisSwapAgainstPlan(),
    SignFlipAgainstPlan(),
    WrongScaleOfTurns(),
    WrongTimeUnitOfTurns(),
    SampleRateByTurns(),
    TableRateByGravity(),
    WrongSpans(),
    WrongMark(),
    ManoeuvreSwapped(),
    ManoeuvreMissing(),
    WrongDirection(),
    SaturationOfTurns(),
    IncompleteTurn(),
    TurnTooFar(),
    LostSamplesOfTurns(),
    MotionAfterTurns(),
    WrongRate(),
    EncoderJump(),
    EncoderScale(),
    EncoderScaleOrEccentricity(),
    EncoderAngles(),
    ShortRest(),
    PositionNotKept(),
    FixtureCreep(),
    RestsDivided(),
    TurningPointOnce(),
    TemperatureMisstated(),
    TemperatureUnknown(),
)
