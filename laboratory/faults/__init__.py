"""The faults of a recording that the laboratory can simulate.

To add a fault, write its file beside this one, list it here, and describe its parameters under
`faults` in simulated.schema.yaml.
"""

from typing import Final

from laboratory.faults.clip import Clip
from laboratory.faults.drift import Drift
from laboratory.faults.drop import Drop
from laboratory.faults.exchange import Exchange
from laboratory.faults.fault import Fault
from laboratory.faults.flip import Flip
from laboratory.faults.gate import Gate
from laboratory.faults.glitch import Glitch
from laboratory.faults.jitter import Jitter
from laboratory.faults.kill import Kill
from laboratory.faults.knock import Knock
from laboratory.faults.lose import Lose
from laboratory.faults.oscillate import Oscillate
from laboratory.faults.repeat import Repeat
from laboratory.faults.spikes import Spikes
from laboratory.faults.step import Step
from laboratory.faults.swap import Swap
from laboratory.faults.turn_back import TurnBack

FAULTS: Final[dict[str, type[Fault]]] = {
    fault.name: fault
    for fault in (
        # records
        Lose,
        Drop,
        Repeat,
        # readings
        Spikes,
        Glitch,
        Clip,
        Gate,
        Kill,
        Step,
        Oscillate,
        Knock,
        Swap,
        Flip,
        # stamps
        TurnBack,
        Drift,
        Jitter,
        # names
        Exchange,
    )
}
