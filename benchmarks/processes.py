"""Work in a process of its own, so that its memory is its own: by this project, or by a peer.

Such a program takes its arguments from the command line and answers with one JSON object. Peers
have an environment of their own and use nothing of the project but how to answer and how to time.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
PEERS_PYTHON = HERE / ".venv" / "bin" / "python"

Answer = dict[str, Any]


def in_peers(program: str, *arguments: str | Path) -> Answer:
    """Run benchmarks/peers/<program>.py in the peers' environment."""
    return _run(PEERS_PYTHON, f"benchmarks.peers.{program}", arguments)


def in_own(program: str, *arguments: str | Path) -> Answer:
    """Run benchmarks/own/<program>.py in the project's environment."""
    return _run(Path(sys.executable), f"benchmarks.own.{program}", arguments)


def _run(python: Path, module: str, arguments: tuple[str | Path, ...]) -> Answer:
    command = [python, "-m", module, *arguments]
    done = subprocess.run(command, stdout=subprocess.PIPE, cwd=HERE.parent, check=True)
    answer: Answer = json.loads(done.stdout)
    return answer
