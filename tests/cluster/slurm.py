"""A real Slurm on this machine, of two nodes, in a folder: started, and stopped with all it runs.

slurmctld and two slurmd of Debian's slurm-wlm, and munged, as the user who runs this; only
addresses of the loopback are used. A node can be killed as by a power cut.
"""

import os
import secrets
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from types import TracebackType

import psutil

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "scancel", "sinfo")
NODES = ("n1", "n2")
PATIENCE = 60.0  # s, until the nodes are ready
CONTROLLER = ("slurmctld", "-D", "-i")

CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmctldPort={controller}
SrunPortRange={first}-{last}
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
# Memory is watched and not enforced by the kernel, which needs cgroups.
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=1
JobAcctGatherParams=OverMemoryKill,UsePss
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=sched_interval=5,batch_sched_delay=1
ReturnToService=2
SlurmdTimeout=10
MinJobAge=300
SlurmdParameters=config_overrides
{nodes}
PartitionName=lab Nodes={names} Default=YES MaxTime=12:00:00 DefMemPerCPU=1000
"""


def missing() -> list[str]:
    """The programs that are not installed, of Debian's slurm-wlm and munge."""
    path = f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin"
    return [program for program in PROGRAMS if shutil.which(program, path=path) is None]


class Slurm:
    """Two nodes with so many processors and MB each; `env` is for those who submit jobs."""

    def __init__(self, folder: Path, cpus: int = 1, memory_mb: int = 4000) -> None:
        self.folder = folder
        self._daemons: dict[str, subprocess.Popen[bytes]] = {}  # by node, or by program
        self.restarts = 0  # of a controller that ended by itself
        controller, first, *ports = _free_ports(2 + len(NODES))
        nodes = [
            f"NodeName={name} NodeHostname={socket.gethostname()} NodeAddr=127.0.0.1"
            f" Port={port} CPUs={cpus} RealMemory={memory_mb}"
            for name, port in zip(NODES, ports, strict=True)
        ]
        folder.mkdir(parents=True)
        for name in ("state", "bin", *(f"spool-{node}" for node in NODES)):
            (folder / name).mkdir()
        self.configuration = folder / "slurm.conf"
        self.configuration.write_text(
            CONFIGURATION.format(
                host=socket.gethostname(),
                user=psutil.Process().username(),
                folder=folder,
                controller=controller,
                first=first,
                last=first + 100,
                nodes="\n".join(nodes),
                names=",".join(NODES),
            )
        )
        # A job step gets no SLURM_CONF from the executor, so that srun is told it here.
        srun = folder / "bin/srun"
        program = shutil.which("srun")
        srun.write_text(f'#!/bin/sh\nSLURM_CONF={self.configuration} exec {program} "$@"\n')
        srun.chmod(0o755)
        path = f"{folder}/bin:{os.environ['PATH']}:/usr/sbin"
        self.env = {**os.environ, "SLURM_CONF": str(self.configuration), "PATH": path}

    def __enter__(self) -> "Slurm":
        try:
            key = self.folder / "munge.key"
            key.write_bytes(secrets.token_bytes(1024))
            key.chmod(0o400)
            files = {"key-file": "key", "socket": "socket", "pid-file": "pid", "seed-file": "seed"}
            paths = [f"--{name}={self.folder}/munge.{end}" for name, end in files.items()]
            log = f"--log-file={self.folder}/munge.log"
            self._start("munged", "--foreground", "--force", *paths, log)
            self._start(*CONTROLLER)
            for node in NODES:
                self.start_node(node)
            self._wait()
        except BaseException:
            self._stop()
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._stop()

    def start_node(self, node: str) -> None:
        """Start a node, or one again that was killed."""
        self._start("slurmd", "-D", "-N", node)

    def revive(self) -> None:
        """Start the controller again if it crashed, and do what is then left to an administrator.

        That of version 22.05.8 sometimes crashes when it begins a job of a dead node again. What it
        did last it may have forgotten: then it drains the node and holds the job that is there.
        """
        if self._daemons[CONTROLLER[0]].poll() is not None:
            self._start(*CONTROLLER)
            self.restarts += 1
        if self.restarts:
            for node, state in self.states().items():
                if state.startswith("drain"):
                    self.asked("scontrol", "update", f"NodeName={node}", "State=RESUME")
            for job in self.asked("squeue", "--noheader", "--format=%i %r").splitlines():
                if job.endswith("held"):
                    self.asked("scontrol", "release", job.split()[0])

    def kill(self, node: str) -> int:
        """End a node and all that runs on it at once; the number of processes."""
        daemon = psutil.Process(self._daemons[node].pid)
        processes = [process for step in self._steps(node) for process in (step, *_below(step))]
        ended = _kill([daemon, *_below(daemon), *processes])
        self._daemons[node].wait()
        return ended

    def asked(self, program: str, *arguments: str) -> str:
        """What a program of Slurm answers."""
        command = [program, *arguments]
        done = subprocess.run(command, env=self.env, capture_output=True, text=True, timeout=30)
        return done.stdout

    def states(self) -> dict[str, str]:
        """The state of each node."""
        rows = self.asked("sinfo", "--Node", "--noheader", "--format=%N %t").splitlines()
        return dict(row.split() for row in rows)

    def jobs_on(self, node: str) -> list[str]:
        """The jobs that run there."""
        return self.asked("squeue", "--noheader", "--format=%i", f"--nodelist={node}").split()

    def _start(self, program: str, *arguments: str) -> None:
        name = arguments[-1] if program == "slurmd" else program
        with (self.folder / f"{name}.out").open("ab") as said:
            self._daemons[name] = subprocess.Popen(
                [program, *arguments], env=self.env, stdout=said, stderr=said
            )

    def _wait(self) -> None:
        until = time.monotonic() + PATIENCE
        while set(self.states().values()) != {"idle"} or len(self.states()) != len(NODES):
            ended = [name for name, of in self._daemons.items() if of.poll() is not None]
            if ended or time.monotonic() > until:
                logs = sorted(self.folder.glob("*.out")) + sorted(self.folder.glob("*.log"))
                said = "\n".join(log.read_text("utf-8", "replace")[-2000:] for log in logs)
                raise RuntimeError(f"no Slurm; ended: {ended}; {self.states()}\n{said}")
            time.sleep(0.2)

    def _steps(self, node: str) -> Iterator[psutil.Process]:
        """What runs the steps of jobs on a node: it has left the daemon, but has its log open."""
        log = str(self.folder / f"slurmd-{node}.log")
        for process in psutil.process_iter():
            with suppress(psutil.Error):
                if process.name() == "slurmstepd" and log in {f.path for f in process.open_files()}:
                    yield process

    def _stop(self) -> None:
        for node in NODES:
            _kill([process for step in self._steps(node) for process in (step, *_below(step))])
        for daemon in reversed(self._daemons.values()):
            with suppress(psutil.NoSuchProcess):
                process = psutil.Process(daemon.pid)
                _kill([process, *_below(process)])
            daemon.wait(timeout=10)


def _below(process: psutil.Process) -> list[psutil.Process]:
    try:
        return list(process.children(recursive=True))
    except psutil.NoSuchProcess:
        return []


def _kill(processes: list[psutil.Process]) -> int:
    ended = 0
    for process in dict.fromkeys(processes):
        with suppress(psutil.NoSuchProcess):
            process.kill()
            ended += 1
    return ended


def _free_ports(number: int) -> list[int]:
    sockets = [socket.socket() for _ in range(number)]
    try:
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]
    finally:
        for each in sockets:
            each.close()
