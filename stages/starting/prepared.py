"""A process that has loaded all packages, and forks for every stage that is asked for.

To load pandas, scipy and matplotlib takes most stages longer than their work does; so it is done
once for a run, and not for every stage. Who asks, and how: `ask.py`, beside this file.
"""

import gc
import json
import os
import runpy
import selectors
import socket
import subprocess
import sys
import traceback
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

ROOT = Path(__file__).parents[2]
LONGEST = 1 << 20  # byte of a request


def begin(place: Path) -> subprocess.Popen[bytes]:
    """Start it, to be asked at a socket; it ends with whoever has begun it."""
    with socket.socket(socket.AF_UNIX) as door:
        door.bind(str(place))
        door.listen()  # from now on; who comes while packages are loaded waits
        command = [sys.executable, "-m", "stages.starting.prepared", str(door.fileno())]
        return subprocess.Popen(command, stdin=subprocess.PIPE, pass_fds=[door.fileno()])


def serve(door: socket.socket) -> None:
    """Fork a process for every request, until the standard input ends."""
    with door, selectors.DefaultSelector() as ready:
        code = _code()
        _load()
        ready.register(sys.stdin, selectors.EVENT_READ)
        ready.register(door, selectors.EVENT_READ)
        while True:
            for key, _ in ready.select():
                if key.fileobj is sys.stdin:
                    return Path(door.getsockname()).unlink(missing_ok=True)
                if key.fileobj is door:
                    caller, _ = door.accept()
                    # A table is marked with the code as it is now; if that is not what was loaded,
                    # the caller is left to run the stage by itself.
                    if _code() != code:
                        caller.close()
                        continue
                    child, ended = _forked(caller)
                    ready.register(ended, selectors.EVENT_READ, (child, caller))
                else:
                    ready.unregister(key.fileobj)
                    _tell(key.fd, *key.data)


def _code() -> dict[Path, int]:
    """When each file of the stages was last changed, ns."""
    return {path: path.stat().st_mtime_ns for path in (ROOT / "stages").rglob("*.py")}


def _load() -> None:
    """Import what the stages import. They themselves are left out, to be run as programs."""
    for path in sorted((ROOT / "stages").glob("[a-z]*.py")):
        import_module(f"stages.{path.stem}")
        del sys.modules[f"stages.{path.stem}"]
    with suppress(OSError):  # without Pango
        import_module("weasyprint")
    gc.freeze()  # what is loaded stays, so no stage need look for garbage in it


def _forked(caller: socket.socket) -> tuple[int, int]:
    """The process that does what the caller asks, and what can be read when it has ended."""
    ended, held = os.pipe()
    child = os.fork()
    if child == 0:
        _work(caller)
    os.close(held)
    return child, ended


def _tell(ended: int, child: int, caller: socket.socket) -> None:
    """Tell a caller with which code its stage has ended."""
    os.close(ended)
    _, status = os.waitpid(child, 0)
    code = os.waitstatus_to_exitcode(status)
    with caller, suppress(OSError):  # who has asked may be gone
        caller.sendall(bytes([code if code >= 0 else 128 - code]))  # as a shell tells a signal


def _work(caller: socket.socket) -> NoReturn:
    """Run the stage as `python -m` would, in the caller's folder and with its output."""
    code = 1
    try:
        request = _request(caller)
        os.chdir(request["folder"])
        sys.argv = [str(ROOT / "stages" / f"{request['stage']}.py"), *request["arguments"]]
        runpy.run_module(f"stages.{request['stage']}", run_name="__main__", alter_sys=True)
        code = 0
    except SystemExit as end:
        if isinstance(end.code, str):
            sys.stderr.write(f"{end.code}\n")
        else:
            code = end.code or 0
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _request(caller: socket.socket) -> dict[str, Any]:
    """What is asked; standard output and error are the caller's from now on."""
    text, outputs, _, _ = socket.recv_fds(caller, LONGEST, 2)
    for own, its in zip((1, 2), outputs, strict=True):
        os.dup2(its, own)
    while more := caller.recv(LONGEST):
        text += more
    request: dict[str, Any] = json.loads(text)
    return request


if __name__ == "__main__":
    serve(socket.socket(fileno=int(sys.argv[1])))
