"""A table that does not stand quite where it is set."""

from stages.model.effect import Effect, Parameter
from stages.model.sizes import of_tables
from stages.notation.units import ARC_SECOND


class TablePositionError(Effect):
    """f += δ × f, with a tilt δ of its own in every set position.

    It has no mean over the positions, so no columns, but a covariance: two tilts of every
    position are unknowns of the equations, with the position's stated sigma. Backlash is that
    part of it which has the sign of the approach.
    """

    name = "table_position_error"
    cause = "encoder, backlash and clamping leave every position off by a little"
    source = "IEEE Std 1554-2005, position accuracy of tables"
    parameters = (Parameter("sigma", "rad", 2 * ARC_SECOND, "scatter of the two tilts"),)
    sizes = of_tables(ARC_SECOND, 2, 30)
    sought_in = "noise"
