"""What the machine itself does to a program that must be on time: a thread per core that only sleeps
from millisecond to millisecond, at a real-time priority above all that is measured, where the system
allows it. When it wakes late, no program could have run there: the hypervisor ran something else, the
kernel was busy, or the real-time programs of all users together had used up their share of the second
(sched_rt_runtime_us)."""

import multiprocessing
import os
import time

PERIOD_S, LEAST_S, PRIORITY = 1e-3, 2e-3, 60


def watch(core, begun, ended, pauses):
    os.sched_setaffinity(0, {core})
    first = True
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    except PermissionError:
        first = False
    begun.put(first)
    found, due = [], time.monotonic()
    while not ended.is_set():
        due += PERIOD_S
        time.sleep(max(0.0, due - time.monotonic()))
        now = time.monotonic()
        if now - due > LEAST_S:
            found.append((due, now))
            due = now
    pauses.put(found)


def steal_ms():
    with open("/proc/stat", encoding="ascii") as file:
        return int(file.readline().split()[8]) * 1000 / os.sysconf("SC_CLK_TCK")


class MachinePauses:
    """with MachinePauses() as pauses: ...; then pauses.found, (begin, end) in seconds of
    CLOCK_MONOTONIC, of any core; those of 2 ms and more."""

    def __enter__(self):
        begun, self.ended = multiprocessing.Queue(), multiprocessing.Event()
        self.queue, self.found, self.steal_ms = multiprocessing.Queue(), [], steal_ms()
        self.watchers = [multiprocessing.Process(target=watch,
                                                 args=(core, begun, self.ended, self.queue))
                         for core in os.sched_getaffinity(0)]
        for watcher in self.watchers:
            watcher.start()
        self.is_first = all([begun.get() for _ in self.watchers])
        return self

    def __exit__(self, *_):
        self.ended.set()
        for _ in self.watchers:
            self.found += self.queue.get()
        for watcher in self.watchers:
            watcher.join()
        self.steal_ms = steal_ms() - self.steal_ms

    def excuse(self, begin, end):
        """Whether a pause lies in that time, or has just ended: frames that waited meanwhile get
        their stamps when it is over, and it takes up to as long again to work them off."""
        return any(first < end and begin < last + (last - first) for first, last in self.found)

    def text(self):
        longest = max((end - begin for begin, end in self.found), default=0)
        return (f"{len(self.found)} pauses of the machine, the longest {longest * 1e3:.1f} ms,"
                f" {self.steal_ms:.0f} ms stolen"
                + ("" if self.is_first else " (upper bound: no right to a real-time priority)"))
