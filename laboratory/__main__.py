"""python -m laboratory data/simulated/demo.yaml data/raw/demo"""

import argparse
import sys
from pathlib import Path

from laboratory import SpecificationError, perform, read, write


def main() -> int:
    """Simulate one campaign and write its folder."""
    parser = argparse.ArgumentParser(
        prog="python -m laboratory", description="Simulate a campaign and write its logs."
    )
    parser.add_argument("specification", type=Path, help="data/simulated/<campaign>.yaml")
    parser.add_argument("folder", type=Path, help="data/raw/<campaign>, made if missing")
    arguments = parser.parse_args()
    try:
        specification = read(arguments.specification)
    except SpecificationError as error:
        print(error, file=sys.stderr)
        return 1
    recording = perform(specification)
    write(recording, arguments.folder)
    size = sum(map(len, recording.logs.values()))
    print(f"{arguments.folder}: {len(recording.logs)} logs, {size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
