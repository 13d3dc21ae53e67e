"""`mpirun -n N rigcal` gives bitwise the same result as one process, and a killed process only loses its current task.
usage: mpi_test.py RIGCAL SOURCE"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

RIGCAL = SOURCE = ""  # set from the command line
# A container may have only the root user, and fewer processors than this test has processes.
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
               "OMPI_MCA_plm_rsh_agent": "/bin/false"}


def command(processes, *arguments):
    launcher = ["mpirun", "-n", str(processes)] if processes else []
    return [*launcher, RIGCAL, *map(str, arguments)]


def run(processes, *arguments):
    return subprocess.run(command(processes, *arguments), capture_output=True, text=True, check=False, env=ENVIRONMENT,
                          timeout=300)


def process_of(rank, launcher):
    """The process that mpirun started as this rank. A process may have children with the same command line, in which it
    reads files, so that the command line does not say which one it is."""
    wanted = f"OMPI_COMM_WORLD_RANK={rank}".encode()
    children = subprocess.run(["pgrep", "-P", str(launcher)], capture_output=True, text=True, check=True).stdout.split()
    (found,) = (pid for pid in children if wanted in pathlib.Path(f"/proc/{pid}/environ").read_bytes().split(b"\0"))
    return int(found)


def comparable(file):
    result = json.loads(file.read_text())
    del result["wall_seconds"]
    del result["provenance"]
    return result


class Processes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        for rig, seed in (("bench_1", 1), ("lab/bench_2", 2), ("lab/bench_3", 3)):
            made = run(0, "synthesize", SOURCE / "docs" / "tutorial" / "known_rig.toml", "--seed", seed, "--out",
                       cls.folder / "rigs" / rig, "--quiet")
            assert made.returncode == 0, made.stderr
        cls.campaign = cls.folder / "rigs" / "bench_1" / "campaign.toml"
        cls.fit = ["fit", cls.campaign, "--starts", 6, "--bootstrap", 40, "--profiles", "--cross-validate", "--quiet",
                   "--threads", 1]
        alone = run(0, *cls.fit, "--out", cls.folder / "alone")
        assert alone.returncode in (0, 1), alone.stderr
        cls.code = alone.returncode
        cls.alone = comparable(cls.folder / "alone" / "fit.json")

    def test_the_bits_of_one_process(self):
        for processes in (2, 3):
            with self.subTest(processes=processes):
                out = self.folder / f"spread_{processes}"
                done = run(processes, *self.fit, "--out", out)
                self.assertEqual(done.returncode, self.code, done.stderr)
                self.assertEqual(comparable(out / "fit.json"), self.alone)
                self.assertEqual({file.name for file in out.iterdir()},
                                 {file.name for file in (self.folder / "alone").iterdir()})

    def test_a_lost_process_costs_what_it_was_at(self):
        out = self.folder / "lost"
        arguments = [*self.fit, "--out", out]
        arguments[arguments.index("--bootstrap") + 1] = 1500  # takes several seconds
        whole = run(0, *arguments[:-1], self.folder / "many")
        self.assertEqual(whole.returncode, self.code, whole.stderr)
        with subprocess.Popen(command(2, *arguments), env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as group:
            kept = out / "checkpoint.tasks"
            deadline = time.monotonic() + 60
            while not (kept.exists() and kept.stat().st_size > 20_000):
                self.assertLess(time.monotonic(), deadline, "nothing was kept")
                self.assertIsNone(group.poll(), "it ended before anything was kept")
                time.sleep(0.002)
            # The leader is paused at once and stays so until mpirun wakes it to end it. So a slow test or a slow mpirun
            # does not leave it the time to finish.
            leader = process_of(0, group.pid)
            os.kill(leader, signal.SIGSTOP)
            self.assertTrue(kept.exists(), "it ended before a process was killed")
            os.kill(process_of(1, group.pid), signal.SIGKILL)
            self.assertNotIn(group.wait(60), (0, self.code))
        # mpirun gives the leader a second. It may write the best so far, as after any signal, but not as if it were all.
        if (out / "fit.json").exists():
            self.assertIn("stopped_in", json.loads((out / "fit.json").read_text()))
        before = kept.stat().st_size
        self.assertGreater(before, 0)
        done = run(2, *arguments, "--resume")
        self.assertEqual(done.returncode, self.code, done.stderr)
        self.assertEqual(comparable(out / "fit.json"), comparable(self.folder / "many" / "fit.json"))
        self.assertFalse(kept.exists())

    def test_rigs_are_spread_too(self):
        out = self.folder / "batch"
        done = run(2, "batch", self.folder / "rigs", "--out", out, "--quiet")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        rigs = json.loads((out / "batch.json").read_text())["rigs"]
        self.assertEqual([rig["rig"] for rig in rigs], ["bench_1", "lab/bench_2", "lab/bench_3"])
        for rig in rigs:
            single = self.folder / "single"
            run(0, "fit", self.folder / "rigs" / rig["rig"] / "campaign.toml", "--out", single, "--quiet")
            self.assertEqual(comparable(out / rig["folder"] / "fit.json"), comparable(single / "fit.json"))

    def test_what_does_not_spread_is_done_once(self):
        done = run(2, "check", self.campaign)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, run(0, "check", self.campaign).stdout)

    def test_an_error_is_said_once(self):
        wrong = self.folder / "wrong.toml"
        wrong.write_text(self.campaign.read_text().replace("[rig]", "[rigg]", 1))
        done = run(2, "fit", wrong, "--out", self.folder / "wrong")
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr.count("wrong.toml"), 1, done.stderr)
        self.assertFalse((self.folder / "wrong").exists())

    def test_without_the_module_several_processes_are_refused(self):
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        shutil.copy(RIGCAL, elsewhere / "rigcal")
        done = subprocess.run(["mpirun", "-n", "2", elsewhere / "rigcal", "check", self.campaign], capture_output=True,
                              text=True, check=False, env=ENVIRONMENT, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("rigcal_mpi.so is missing", done.stderr)


if __name__ == "__main__":
    RIGCAL, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
    del sys.argv[1:]
    if not shutil.which("mpirun"):
        print("skipped: there is no mpirun")
        sys.exit(77)
    unittest.main()
