"""What is on the disk if the power goes at any moment (docs/reliability.md).

A run's calls are written down (disk_journal.cpp), and each beginning of that list is played against the
worst file system that keeps its word: what has been synced is there. Of the writes to a file since, any
may be missing or torn. Of the changes of names in a folder since it was synced, any number of the last
may be missing."""

import os
import random
import unittest

import numpy as np
from program import OK, ProgramTest

SEED = 1
RANDOM_STATES = 12
FAST = ("--set", "camera.AcquisitionFrameRate=0", "--buffers", "1024")
RUNS = {"out.stipple": ("emulate", "light.npy"),
        "live.stipple": ("capture", "live", "replay:light.npy", *FAST),
        "out.strec": ("capture", "record", "replay:light.npy", *FAST),
        "out.npy": ("decode", "clip.stipple", "--method", "naive"),
        "out.mp4": ("decode", "clip.stipple", "--method", "naive"),
        "out": ("decode", "clip.stipple", "--method", "naive"),
        "light.json": ("info", "clip.stipple")}


class Item:
    """A file or folder: what is on the disk, and what has been done to it since."""

    def __init__(self, durable):
        self.durable, self.since = durable, []

    def now(self):
        return self.after(len(self.since))

    def after(self, changes):
        """The names of a folder after so many of the changes."""
        value = self.durable
        for change in self.since[:changes]:
            value = change(value)
        return value

    def torn(self, part):
        """The bytes of a file after the part `part()` of each change."""
        value = self.durable
        for change in self.since:
            value = change(value, part())
        return value

    def sync(self):
        self.durable, self.since = self.now(), []


def written(offset, data):
    def change(old, part=1.0):
        there = data[:round(part * len(data))]
        return old[:offset].ljust(offset, b"\0") + there + old[offset + len(there):] if there else old
    return change


def cut(size):
    return lambda old, part=1.0: old[:size].ljust(size, b"\0") if part > 0.5 else old


def linked(name, inode):
    return lambda names: names | {name: inode}


def removed(name):
    return lambda names: {other: inode for other, inode in names.items() if other != name}


def renamed(old, new):
    return lambda names: removed(old)(names) | {new: names[old]}


def exchanged(a, b):
    return lambda names: names | {a: names[b], b: names[a]}


class Disk:
    """Names and contents of a folder, by inode, and what a crash may leave of them."""

    def __init__(self, root):
        self.items = {}
        self.root = self.take(root)

    def take(self, path):
        """All that is there is on the disk."""
        inode = path.stat().st_ino
        self.items[inode] = Item({one.name: self.take(one) for one in path.iterdir()} if path.is_dir()
                                 else path.read_bytes())
        return inode

    def folder_of(self, path):
        inode, (*folders, name) = self.root, [part for part in path.split("/") if part != "."]
        for folder in folders:
            inode = self.items[inode].now()[folder]
        return self.items[inode], name

    def do(self, line):
        call, *words = line.split("\t")[:-1]
        if call in ("create", "mkdir"):
            folder, name = self.folder_of(words[1])
            self.items[int(words[0])] = Item(b"" if call == "create" else {})
            folder.since.append(linked(name, int(words[0])))
        elif call == "write":
            self.items[int(words[0])].since.append(written(int(words[1]), bytes.fromhex(words[2])))
        elif call == "cut":
            self.items[int(words[0])].since.append(cut(int(words[1])))
        elif call == "sync":
            self.items[int(words[0])].sync()
        elif call == "remove":
            folder, name = self.folder_of(words[0])
            folder.since.append(removed(name))
        else:
            (folder, old), (_, new) = self.folder_of(words[0]), self.folder_of(words[1])
            folder.since.append({"rename": renamed, "exchange": exchanged}[call](old, new))

    def after_crash(self, inode, names, writes):
        """`names` says how many of the changes of a folder are there, `writes` which part of one of a file."""
        item = self.items[inode]
        if isinstance(item.durable, bytes):
            return item.torn(writes)
        there = item.after(names(len(item.since)))
        return {name: self.after_crash(one, names, writes) for name, one in there.items()}

    def now(self):
        return self.after_crash(self.root, lambda last: last, lambda: 1)

    def crashes(self, rng):
        for names in (lambda last: last, lambda last: 0):
            for writes in (lambda: 1, lambda: 0):
                yield self.after_crash(self.root, names, writes)
        for _ in range(RANDOM_STATES):
            yield self.after_crash(self.root, lambda last: rng.randint(0, last),
                                   lambda: rng.choice((0, rng.random(), 1)))


class PowerLossTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write_array("light.npy", np.random.default_rng(SEED).random((6, 16, 24)))
        self.succeed("emulate", "light.npy", "-o", "clip.stipple")

    def journal(self, output, *options):
        """The disk before a run, and what the run does to it."""
        disk = Disk(self.folder)
        journal = self.folder.parent / f"{self.folder.name}.journal"
        self.addCleanup(journal.unlink, missing_ok=True)
        journal.unlink(missing_ok=True)
        write = ("--json", output) if output.endswith(".json") else ("-o", output)
        done = self.run_program(*RUNS[output], *write, *options, env=os.environ | {
            "LD_PRELOAD": os.environ["DISK_JOURNAL_LIBRARY"], "DISK_JOURNAL": str(journal)})
        self.assertEqual(done.returncode, OK, done.stderr)
        return disk, journal.read_text().splitlines()

    def losses(self, output, *options):
        """Crashes that lose something: (calls before it, what is then under the name)."""
        disk, calls = self.journal(output, *options)
        old, whole = disk.now().get(output), Disk(self.folder).now()
        rng = random.Random(SEED)
        found, states = [], 0
        for count in range(len(calls) + 1):
            for state in disk.crashes(rng):
                states += 1
                legal = [whole[output]] if count == len(calls) else [old, whole[output]]
                if state.get(output) not in legal:
                    found.append((count, state.get(output)))
            if count < len(calls):
                disk.do(calls[count])
        # The list of calls has all that was written.
        self.assertEqual(disk.now(), whole)
        return found, states

    def test_the_output_before_or_the_new_one_is_whole(self):
        crashes = 0
        for output in RUNS:
            for options in ([], ["--force"]):
                with self.subTest(output, options=options):
                    found, states = self.losses(output, *options)
                    self.assertEqual(found[:3], [])
                    crashes += states
        print(f"{crashes} crashes")

    def test_without_syncs_it_is_not(self):
        for output in RUNS:
            for options in (["--no-sync"], ["--no-sync", "--force"]):
                with self.subTest(output, options=options):
                    self.assertNotEqual(self.losses(output, *options)[0], [])


if __name__ == "__main__":
    unittest.main()
