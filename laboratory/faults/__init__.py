"""What the laboratory can do to a recording.

To add a fault, write its file beside this one, list it here, and describe its parameters under
`faults` in simulated.schema.yaml.
"""

from collections.abc import Callable, Mapping
from typing import Any, Final

from laboratory.faults.fault import Fault
from laboratory.faults.lose import Lose

FAULTS: Final[dict[str, Callable[[Mapping[str, Any]], Fault]]] = {"lose": Lose.specified}
