"""The tables that pass between stages, each column with its unit, frame and meaning."""

from inertial.sensors import CHANNELS, UNITS
from inertial.tables.calibrated import (
    ARCHIVED,
    CALIBRATION,
    CHARACTERISTICS,
    CHECKS,
    COMPENSATED,
    EARLIER,
    RESIDUALS,
    UNCERTAINTY_BUDGET,
)
from inertial.tables.certified import (
    ALLOWED_CHANGES,
    CERTIFICATE,
    CONFORMITY,
    STANDARDS,
    TOLERANCES,
)
from inertial.tables.diagnosed import (
    CANDIDATE_EFFECTS,
    CANDIDATES,
    CAUSE_MEMBERS,
    CAUSES,
    CHANNEL_REPAIRS,
    CONSEQUENCES,
    DRIFT_MEANS,
    PROPOSED,
    REPAIRS,
    TEMPERATURE_CURVES,
    VERDICTS,
    WARM_UP,
)
from inertial.tables.estimated import (
    ALLAN,
    AVERAGING,
    COVARIANCE,
    DIFFERENCES,
    FIT,
    FIT_MANOEUVRES,
    LEVELS,
    NOISE,
    NOISE_TERMS,
    PARAMETERS,
    POSITIONS,
    SPECTRA,
    SWITCH_ONS,
    WANTED,
)
from inertial.tables.extended import GAIN, GAIN_EFFECTS, HELD_OUT, MOVED, WORTH
from inertial.tables.historical import CHANGES, FORECAST, JUMPS, REPEATABILITY
from inertial.tables.navigated import (
    ALIGNMENTS,
    ATTITUDE_ERRORS,
    MODULATION_GAINS,
    NAVIGATION_COURSES,
    NAVIGATION_ERRORS,
    NAVIGATION_SHARES,
)
from inertial.tables.planned import (
    ACCEPTED,
    CAMPAIGN,
    COUNT_SIZES,
    GUESSES,
    IDEAL_READINGS,
    INPUTS,
    KNOWN,
    LOGS,
    MANOEUVRES,
    PUBLISHED,
    PURPOSES,
    RANGES,
    SENSORS,
)
from inertial.tables.recorded import (
    ACCOUNTS,
    BLOCKS,
    CHANNEL_STATISTICS,
    CLOCKS,
    CLOSE_UPS,
    FINDINGS,
    GAPS,
    IMU_TYPES,
    MASKS,
    MEAN_SIGMAS,
    PERFORMED,
    REFUSED,
    SAMPLES,
    SEGMENTS,
    TRACES,
)
from inertial.tables.studied import (
    BANDWIDTHS,
    ENCODER,
    EPOCHS,
    MOTIONS,
    NOT_STUDIED,
    SPREADS,
    TIME_ANGLE,
    WINDOWS,
)
from inertial.tables.table import ACCEL, BODY, CHANNEL_PARTS, GYRO, OF_TRIAD, STATIC_PHASES
from inertial.tables.unmodelled import (
    CAUSE_POSITIONS,
    DETECTION_LIMITS,
    DRIFTS_AT_REST,
    EFFECT_FINDINGS,
    EFFECTS,
    FIDELITY,
    INFORMATION_MATRIX,
    LINES,
    MEMBERS,
    RANDOM_WALKS,
    SCORE_VECTOR,
    SCORES,
    SIMULATED,
    STRUCTURE_MANOEUVRES,
    STRUCTURE_POINTS,
    STRUCTURES,
)
from inertial.text.parameters import AXES
