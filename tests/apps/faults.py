"""Runs the program again and again, with another call that fails each time (faulty_calls.cpp)."""

import errno
import os
import signal
import struct
import subprocess
from dataclasses import dataclass

from program import PROGRAM

# As faulty_calls.cpp has them.
KINDS = ("any", "open", "read", "write", "sync", "rename", "cut", "remove", "memory", "map", "thread")
KILL, SHORT = -1, -2


@dataclass(frozen=True)
class Fault:
    """The `number`-th call of a kind fails with an error number, and all later ones if it lasts."""
    kind: str = "any"
    number: int = 0
    error: int = 0
    lasting: bool = False
    min_bytes: int = 0  # of memory: smaller pieces never fail

    def __str__(self):
        error = {KILL: "kill", SHORT: "short"}.get(self.error) or errno.errorcode.get(self.error, "none")
        return f"{self.kind} {self.number} {error}{' and on' if self.lasting else ''} >={self.min_bytes}"


@dataclass
class Outcome:
    code: int  # exit code, or minus the signal
    said: str  # on standard error
    calls: dict  # by kind


class FaultyProgram:
    """A command line that can be run with faults. It is loaded once, so that a run takes little time."""

    def __init__(self, folder, arguments):
        self.said = open(folder.parent / f"{folder.name}.said", "w+b")
        orders, self.orders = os.pipe()
        self.reports, reports = os.pipe()
        self.process = subprocess.Popen(
            [PROGRAM, *map(str, arguments)], cwd=folder, pass_fds=(orders, reports), stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=self.said,
            env=os.environ | {"LD_PRELOAD": os.environ["FAULTY_CALLS_LIBRARY"], "FAULT_ORDERS": str(orders),
                              "FAULT_REPORTS": str(reports)})
        os.close(orders)
        os.close(reports)

    def run(self, fault=Fault()):
        os.ftruncate(self.said.fileno(), 0)
        self.said.seek(0)
        os.write(self.orders, struct.pack("5i", KINDS.index(fault.kind), fault.number, fault.error,
                                          fault.lasting, fault.min_bytes))
        report = struct.unpack(f"{1 + len(KINDS)}i", os.read(self.reports, 4 * (1 + len(KINDS))))
        self.said.seek(0)
        return Outcome(os.waitstatus_to_exitcode(report[0]), self.said.read().decode(),
                       dict(zip(KINDS, report[1:])))

    def close(self):
        os.close(self.orders)
        os.close(self.reports)
        self.process.wait(timeout=60)
        os.unlink(self.said.name)
        self.said.close()
