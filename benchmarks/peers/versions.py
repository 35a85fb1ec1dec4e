"""Which versions of some packages are installed here."""

import sys
from importlib.metadata import version

from benchmarks.answering import answer

answer(**{name: version(name) for name in sys.argv[1:]})
