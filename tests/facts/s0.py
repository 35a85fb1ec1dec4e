"""S0 as printed: the Wuhan University lab report of 18 October 2023; SI units."""

import numpy as np

GRAVITY = 9.7936174  # m/s²
LATITUDE = np.radians(30.5278)  # of its site; the report prints g alone
RATE = np.radians(10)  # rad/s, set rate of the turns

# Table 5-1: accelerometer, M = I + S + N; γ_yx, the x axis senses the y force, in row x, column y.
ACCELEROMETER = np.eye(3) + np.array(
    [
        [0.00032852, 0.0021831, 0.0076080],
        [-0.0027442, 0.00032826, -0.0007839],
        [-0.0075585, 0.0007016, 0.00023567],
    ]
)
ACCELEROMETER_BIAS = np.array([-0.0052949, 0.0050641, -0.0018790])  # m/s²

# Tables 5-3 and 5-4: variances of the same parameters epoch by epoch, from running means and from
# single epochs; of M as above, and of the bias, (m/s²)².
RUNNING_MEANS = np.array(
    [
        [9.42943e-13, 1.48141e-12, 1.71049e-12],
        [1.01553e-12, 7.98108e-13, 2.26505e-11],
        [2.50716e-13, 1.19753e-11, 3.47800e-12],
    ]
)
RUNNING_MEANS_BIAS = np.array([1.43744e-11, 8.57243e-10, 1.19669e-10])
SINGLE_EPOCHS = np.array(
    [
        [5.47944e-09, 5.43524e-09, 1.25669e-08],
        [1.94010e-07, 6.28853e-09, 4.03349e-07],
        [1.22084e-08, 2.03699e-07, 5.98968e-09],
    ]
)
SINGLE_EPOCHS_BIAS = np.array([2.40240e-07, 6.23850e-06, 2.36542e-06])

# Gyros x, y, z. Table 5-2: turns of 360°; 5-5: their middle 180°; 5-7, 5-8: rests.
TURNS_BIAS = np.array([2.96905e-07, 7.16724e-07, 3.64076e-07])  # rad/s
TURNS_SCALE = np.array([6.15071e-04, -1.61520e-05, 6.44204e-04])
WINDOWS_SCALE = np.array([0.0011960, 5.389648e-04, 0.0012043])
RESTS_BIAS = np.array([-2.15039e-08, -7.45963e-07, -6.06855e-07])  # rad/s
RESTS_SCALE = np.array([0.029747, -0.016849, -0.009088])

# Table 5-6: mean rate in the steady part, rad/s, printed to 1e-5.
STEADY_FORWARD = np.array([0.17466, 0.17457, 0.17468])
STEADY_BACKWARD = np.array([-0.17333, -0.17448, -0.17463])
LAST_DIGIT = 1e-5

# Table 5-9: means after compensation, axis up and axis down, m/s².
COMPENSATED_UP = np.array([9.7938337, 9.7936749, 9.7937698])
COMPENSATED_DOWN = np.array([-9.7933709, -9.7935387, -9.7935250])

ANGLE_RANDOM_WALK = 0.1  # °/√h, of the data sheet
VELOCITY_RANDOM_WALK = 0.03  # m/s/√h, of the data sheet


def per_root_second(per_root_hour: float) -> float:
    """A random walk of a data sheet, per √h, in SI, per √s: an hour has 60 roots of a second."""
    return per_root_hour / 60
