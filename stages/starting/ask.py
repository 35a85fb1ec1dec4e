"""Ask the prepared process to run a stage; where there is none, run it here.

    python -I -S ask.py <socket> <stage> <arguments of the stage>

It loads nothing but Python's own modules, so it starts in hundredths of a second.
"""

import contextlib
import json
import os
import socket
import sys
from pathlib import Path

place, stage, *arguments = sys.argv[1:]
request = {"stage": stage, "arguments": arguments, "folder": str(Path.cwd())}
code = b""
with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX) as prepared:
    prepared.connect(place)
    socket.send_fds(prepared, [b" "], [1, 2])  # standard output and error
    prepared.sendall(json.dumps(request).encode())
    prepared.shutdown(socket.SHUT_WR)
    code = prepared.recv(1)
if not code:
    os.execv(sys.executable, [sys.executable, "-m", f"stages.{stage}", *arguments])
sys.exit(code[0])
