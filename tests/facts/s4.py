"""S4 as printed: the Beihang University rate table, mean rates in °/s (signs restored)."""

import numpy as np

RATES = np.array([10, 20, 40, 60, 80, -10, -20, -40, -60, -80], dtype=np.float64)
# Gyros x, y, z, each about its own axis; forward, then backward.
FORWARD = [
    [9.9243, 19.9380, 39.8195, 59.6146, 79.3660],
    [10.0445, 19.9458, 39.9983, 59.9388, 79.2885],
    [10.0398, 19.9238, 39.9615, 59.7230, 79.3576],
]
BACKWARD = [
    [-9.9123, -19.9246, -39.8253, -59.6601, -79.1389],
    [-10.3317, -19.9998, -40.4727, -59.7430, -79.2054],
    [-9.9690, -19.8442, -39.8682, -59.4884, -79.0262],
]
MEANS = np.hstack([FORWARD, BACKWARD])

# The inputs of the program, column by column: the rates of the other axes are the list permuted.
PERMUTED = np.array(
    [
        RATES,
        [80, 60, 40, 20, 10, -10, -20, -40, -60, -80],
        [60, 40, 20, 10, 80, -10, -20, -40, -60, -80],
    ]
)
