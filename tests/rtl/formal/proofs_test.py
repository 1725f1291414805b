"""Yosys and ABC prove what parts of the chip do, for every input (docs/rtl.md, Proofs)."""

import re
import shutil
import subprocess
import tempfile
import time
import unittest
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
RTL = HERE.parents[2] / "rtl"
SEQUENCER = ["chip_control", "schedule_banks", "scan_scheduler", "slot_sequencer", "scan_queue", "deadline_table",
             "next_due", "row_scanner"]
# Designs with states, as circuits of one-bit registers and gates, in which those without reset begin with any value.
CIRCUIT = ("prep -flatten; async2sync; memory_map; opt -full; setundef -undriven -anyseq; chformal -cover -remove; "
           "techmap; opt; dffunmap; abc -g AND -fast; opt_clean; write_aiger -I -B -zinit proof.aig")
PROVED = re.compile("Property proved|No output asserted in [0-9]+ frames|SAT proof finished.*SUCCESS")


@dataclass
class Proof:
    """`clocks`: from reset on; 0: all time. Without states: by the SAT solver of Yosys."""

    top: str
    parts: list
    clocks: int = 0
    has_states: bool = True

    def commands(self, sources):
        read = f"read_verilog -sv -formal -DSTIPPLE_ASSERT {' '.join(sources)}; hierarchy -check -top {self.top}; "
        if not self.has_states:
            return [["yosys", "-p", read + "prep -flatten; opt -full; sat -prove-asserts -verify"]]
        engine = f"bmc3 -F {self.clocks} -T 600" if self.clocks else "scorr; pdr -T 600"
        return [["yosys", "-q", "-p", read + CIRCUIT],
                ["yosys-abc", "-c", f"read_aiger proof.aig; fold; strash; {engine}"]]


PROOFS = [
    Proof("next_due_proof", ["next_due"], has_states=False),
    Proof("crc32c_proof", ["crc32c"], has_states=False),
    Proof("fifo_proof", ["fifo"]),
    Proof("column_scan_proof", ["column_scan", "next_due"]),
    Proof("row_scanner_proof", ["row_scanner", "next_due"]),
    Proof("packet_sender_proof", ["packet_sender", "fifo", "crc32c"], clocks=20),
    Proof("sequencer_proof", SEQUENCER, clocks=12),
]
# Faults, each of which makes a proof fail: part, proof, text, and what it becomes.
FAULTS = [
    ("next_due", "next_due_proof", "~pending + 1'b1", "~pending"),
    ("crc32c", "crc32c_proof", "32'h82F6_3B78", "32'h82F6_3B79"),
    ("fifo", "fifo_proof", "pushed - popped) ==", "pushed - popped) >"),
    ("column_scan", "column_scan_proof", "pending & ~begun", "pending"),
    ("row_scanner", "row_scanner_proof", "select ? pending & ~first", "1'b0 ? pending & ~first"),
    ("packet_sender", "packet_sender_proof", "m_axis_tvalid = has_packet &&", "m_axis_tvalid = m_axis_tready &&"),
    ("slot_sequencer", "sequencer_proof", "is_swapping ? '1 : next_rows", "next_rows"),
    ("slot_sequencer", "sequencer_proof", "counted >= slot_clocks &&", "counted > slot_clocks &&"),
    ("slot_sequencer", "sequencer_proof", "waits & ~rows_done;", "waits & ~rows_done & '0;"),
    ("schedule_banks", "sequencer_proof", "slot_start ? next_bank : active", "next_bank"),
    ("scan_queue", "sequencer_proof", "late + (BITS + 1)'(pop)", "late + (BITS + 1)'(pop) + (BITS + 1)'(pop && push)"),
    ("chip_control", "sequencer_proof", "!is_idle && !(slot_start && is_swapping) &&", "!is_idle &&"),
]


@unittest.skipUnless(shutil.which("yosys") and shutil.which("yosys-abc"), "yosys (packages yosys, berkeley-abc) is not installed")
class ProofsTest(unittest.TestCase):
    def prove(self, proof, part="", old="", new=""):
        """What the solvers say, of a chip in whose `part` the text `old` has become `new`."""
        with tempfile.TemporaryDirectory() as folder:
            files = [HERE / f"{proof.top}.sv", *(RTL / f"{name}.sv" for name in proof.parts)]
            for path in files:
                text = path.read_text()
                if path.stem == part:
                    self.assertEqual(text.count(old), 1, f"{part}: {old}")
                    text = text.replace(old, new)
                (Path(folder) / path.name).write_text(text)
            for command in proof.commands([path.name for path in files]):
                text = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                      text=True, timeout=700, check=False).stdout
        return text

    def test_proofs_hold(self):
        for proof in PROOFS:
            with self.subTest(proof.top):
                begin = time.monotonic()
                self.assertRegex(self.prove(proof)[-3000:], PROVED)
                reach = f"{proof.clocks} clocks" if proof.clocks else "all time"
                print(f"{proof.top:22}{reach:12}{time.monotonic() - begin:6.1f} s", flush=True)

    def test_faults_are_found(self):
        proofs = {proof.top: proof for proof in PROOFS}
        for part, top, old, new in FAULTS:
            with self.subTest(f"{part}: {new}"):
                self.assertRegex(self.prove(proofs[top], part, old, new),
                                 "was asserted in frame|proof did fail")


if __name__ == "__main__":
    unittest.main()
