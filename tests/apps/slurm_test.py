"""The job array of docs/scaling.md on a Slurm of one controller and two nodes, all on this machine."""

import os
import pwd
import random
import re
import shutil
import socket
import subprocess
import time
import unittest
from pathlib import Path

from program import PROGRAM, ProgramTest, project_path

COMMANDS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "scancel", "squeue")
SECONDS = 120  # for what should take some

CONFIGURATION = """
ClusterName=stipple
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool_%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd_%n.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SchedulerParameters=sched_min_interval=0,sched_interval=1,batch_sched_delay=0,bf_interval=1
InactiveLimit=0
KillWait=2
MinJobAge=300
NodeName=first NodeHostname={host} NodeAddr=127.0.0.1 Port={first} CPUs=4 RealMemory=100
NodeName=second NodeHostname={host} NodeAddr=127.0.0.1 Port={second} CPUs=4 RealMemory=100
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def paths():
    """Daemons lie where a user's PATH does not look."""
    return os.pathsep.join([str(Path(PROGRAM).parent), os.environ["PATH"], "/usr/sbin", "/sbin"])


class SlurmTest(ProgramTest):
    def setUp(self):
        super().setUp()
        missing = [name for name in COMMANDS if shutil.which(name, path=paths()) is None]
        if missing:
            self.skipTest(f"no {', '.join(missing)}: install slurm-wlm and munge")
        self.cluster = self.folder / "cluster"
        (self.cluster / "state").mkdir(parents=True)
        controller, first, second = free_ports(3)
        (self.cluster / "slurm.conf").write_text(CONFIGURATION.format(
            host=socket.gethostname().split(".")[0], user=pwd.getpwuid(os.getuid()).pw_name, folder=self.cluster,
            controller=controller, first=first, second=second))
        self.environment = os.environ | {"PATH": paths(), "SLURM_CONF": str(self.cluster / "slurm.conf")}
        key = self.cluster / "munge.key"
        key.write_bytes(os.urandom(64))
        key.chmod(0o600)
        self.start("munged", "--foreground", "--force", f"--socket={self.cluster}/munge.socket", f"--key-file={key}",
                   f"--pid-file={self.cluster}/munge.pid", f"--log-file={self.cluster}/munge.log",
                   f"--seed-file={self.cluster}/munge.seed")
        self.wait(lambda: (self.cluster / "munge.socket").exists(), "munged")
        self.start("slurmctld", "-D")
        for node in ("first", "second"):
            self.start("slurmd", "-D", "-N", node)
        self.wait(lambda: self.told("sinfo", "-h", "-o", "%D %t") == "2 idle", "two idle nodes")

    def start(self, name, *arguments):
        log = open(self.cluster / f"{name}{arguments[-1]}.out".replace("/", "_")[-60:], "wb")
        self.addCleanup(log.close)
        daemon = subprocess.Popen([shutil.which(name, path=paths()), *arguments], env=self.environment, stdout=log,
                                  stderr=subprocess.STDOUT, cwd=self.cluster)
        self.addCleanup(self.stop, daemon)

    def stop(self, daemon):
        daemon.terminate()
        try:
            daemon.wait(timeout=10)
        except subprocess.TimeoutExpired:
            daemon.kill()
            daemon.wait()

    def told(self, *command):
        done = subprocess.run(command, env=self.environment, cwd=self.folder, capture_output=True, text=True,
                              timeout=SECONDS)
        return done.stdout.strip()

    def wait(self, condition, what):
        deadline = time.monotonic() + SECONDS
        while not condition():
            if time.monotonic() > deadline:
                logs = "\n".join(f"{path.name}: {path.read_text(errors='replace')[-2000:]}"
                                 for path in sorted(self.cluster.glob("*.out")))
                self.fail(f"{what} did not come within {SECONDS} s\n{self.told('scontrol', 'show', 'job')}\n{logs}")
            time.sleep(0.05)

    def submit(self, script):
        done = subprocess.run(["sh", "-e"], input=script, env=self.environment, cwd=self.folder, capture_output=True,
                              text=True, timeout=SECONDS)
        self.assertEqual(done.returncode, 0, done.stderr)
        job = re.search(r"Submitted batch job (\d+)", done.stdout)[1]
        self.addCleanup(self.told, "scancel", job)
        return job

    def windows(self):
        return sorted(self.folder.glob("windows/window_*.npy"))

    def expect_bytes_of_one_run(self, stream, method):
        self.succeed("decode", stream, "-o", "whole.npy", "--method", method)
        self.succeed("join", "windows", "-o", "joined.npy")
        self.assertEqual((self.folder / "joined.npy").read_bytes(), (self.folder / "whole.npy").read_bytes())

    def test_the_array_of_the_page_makes_the_bytes_of_one_run(self):
        page = project_path("docs/scaling.md").read_text()
        script = re.search(r"(?m)^    sbatch(?:.*\n)(?:^    .*\n)*", page)[0]
        self.assertIn("--requeue", script)
        self.write_stream("film.stipple", slots=900, rows=16, cols=16)
        job = self.submit(script)
        self.wait(lambda: not self.told("squeue", "-h", "-j", job), "the end of the array")
        self.assertEqual(len(self.windows()), 19)
        self.expect_bytes_of_one_run("film.stipple", "fast")

    def test_a_task_that_was_killed_goes_on_when_it_is_requeued(self):
        self.write_stream("film.stipple", slots=2400, rows=24, cols=32)
        seed = random.randrange(1000)
        enough = random.Random(seed).randrange(2, 8)
        job = self.submit("sbatch --array=1-2 --requeue --wrap 'stipple decode film.stipple -o windows --method fast "
                          "--threads 1 --part $SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT'")
        self.wait(lambda: len(self.windows()) >= enough, "the first windows")
        self.told("scancel", "--full", "--signal=KILL", f"{job}_1")
        self.wait(lambda: "JobState=CANCELLED" in self.told("scontrol", "show", "job", f"{job}_1"), "the killed task")
        kept = {path: path.stat().st_mtime_ns for path in self.windows()}
        self.assertLess(len(kept), 50, f"nothing was left to do, seed {seed}")
        self.told("scontrol", "requeue", f"{job}_1")
        self.wait(lambda: not self.told("squeue", "-h", "-j", job), "the end of the requeued task")
        self.assertEqual(len(self.windows()), 50)
        for path, written in kept.items():
            self.assertEqual(path.stat().st_mtime_ns, written, f"{path.name} was decoded again, seed {seed}")
        self.expect_bytes_of_one_run("film.stipple", "fast")


if __name__ == "__main__":
    unittest.main()
