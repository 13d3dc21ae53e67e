"""The runs of rigcal that documents and gallery show, and where their results are kept.

A run is made once for a program, its campaign and its recordings. The results are in build/runs, so that documents, gallery
and the processes of a test share them."""
import contextlib
import fcntl
import hashlib
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parent.parent
RIGS = "datasets/rigs"
VERDICTS = (0, 1)  # 1: a limit in the campaign is not met, which is a result
UNDECIDED = 3  # the records do not allow a diagnosis, which is a result of `diagnose`


class Run(NamedTuple):
    """The arguments of `rigcal`, without --out and --quiet. `recordings` is a folder in {data}; `stands_for` maps
    the names of its files to the names under which the campaign expects them, if these differ. The records of a
    `synthesized` run are made from its campaign."""

    arguments: str
    recordings: str = ""
    stands_for: dict = {}
    synthesized: bool = False


FESTO = f"fit {RIGS}/festo_tp511/campaign.toml"
FESTO_DATA = "festo_tp511_servo_cylinder"
STEPS_1V, STEPS_2V, STEPS_4V = (f"steps_{volts}V_1kHz.csv" for volts in (1, 2, 4))
BENCH = f"fit {RIGS}/martensson_bench/campaign.toml"
BENCH_DATA = "martensson_hydraulic_bench"
BENCH_FREE = "valve_gain,valve_offset,valve_dead_band,external_force"
HOPSAN = f"{RIGS}/hopsan_leaky_servo"
HOPSAN_DATA = "sim_hopsan_leaky_servo"
TABLES = f"{RIGS}/uis_shake_table/campaign.toml"
UTFSM_DATA = "utfsm_mts_servohydraulic_chirp"
CHIRP, SWEEP = "chirp_0A_1kHz.csv", "sweep_15Hz_0A_1kHz.csv"

RUNS = {
    "festo": Run(FESTO, FESTO_DATA),
    "festo_predicts_4V": Run(FESTO, FESTO_DATA, {STEPS_2V: STEPS_4V, STEPS_4V: STEPS_2V}),
    "festo_predicts_1V": Run(FESTO, FESTO_DATA, {STEPS_2V: STEPS_1V, STEPS_1V: STEPS_2V}),
    "utfsm": Run(f"fit {RIGS}/utfsm_mts/campaign.toml", UTFSM_DATA),
    "utfsm_validated": Run(f"validate {RIGS}/utfsm_mts/campaign.toml --fit {{results}}/utfsm/fit.json", UTFSM_DATA),
    "utfsm_exchanged": Run(f"fit {RIGS}/utfsm_mts/campaign.toml", UTFSM_DATA, {CHIRP: SWEEP, SWEEP: CHIRP}),
    "martensson": Run(BENCH, BENCH_DATA),
    "martensson_leak_free": Run(f"{BENCH} --free {BENCH_FREE},laminar_leakage", BENCH_DATA),
    "two_chamber_fit": Run(f"fit {HOPSAN}/two_chamber_fit.toml", HOPSAN_DATA),
    "fit_turbulent": Run(f"fit {HOPSAN}/fit_turbulent.toml", HOPSAN_DATA),
    "fatigue_rig": Run(f"fit {RIGS}/nrc_fatigue_rig/campaign.toml", "nrc_fatigue_rig"),
    "lnec": Run(f"fit {RIGS}/lnec_shake_table/campaign.toml", "lnec_shake_table"),
    "patu": Run(f"fit {RIGS}/patu_lift/campaign.toml", "patu_lift"),
    "excavator_arm_out": Run(f"fit {RIGS}/excavator_dspace/arm_out.toml", "excavator_dspace"),
    "excavator_boom_up": Run(f"fit {RIGS}/excavator_dspace/boom_up.toml", "excavator_dspace"),
    "excavator_arm_in": Run(f"fit {RIGS}/excavator_dspace/arm_in.toml", "excavator_dspace"),
    "excavator_boom_down": Run(f"fit {RIGS}/excavator_dspace/boom_down.toml", "excavator_dspace"),
    "leak_table": Run(f"leak-table {TABLES}"),
    "leak_table_flat": Run(f"leak-table {TABLES} --signals square@10Hz --targets 13.79"),
    "leak_table_more_oil": Run(f'leak-table {TABLES} --set "total_volume=2.46888e-3 m3"'),
    "leak_table_other_rig": Run(f"leak-table {RIGS}/karpenko_sepehri/campaign.toml"),
    "fit_tables": Run(f"fit-tables {TABLES}"),
    "uis": Run(f"fit {TABLES}", synthesized=True),
    "moog": Run(f"diagnose {RIGS}/moog_flotork/campaign.toml", "moog_flotork_rotary_seal_defect"),
    "karpenko": Run(f"explore {RIGS}/karpenko_sepehri/campaign.toml"),
}


class Absent(Exception):
    """The recordings that a run needs are missing."""


class Failed(Exception):
    """A command failed unexpectedly."""


def call(arguments, codes, **environment):
    """Returns what a command prints."""
    done = subprocess.run(arguments, cwd=ROOT, capture_output=True, text=True, check=False, env={**os.environ, **environment})
    if done.returncode not in codes:
        raise Failed(f"exit code {done.returncode}: {shlex.join(map(str, arguments))}\n{done.stderr}")
    return done.stdout


@contextlib.contextmanager
def locked(path):
    with path.open("w", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


class Runs:
    """Makes runs with the program $RIGCAL (default: build/release/rigcal) from the recordings in $RIGCAL_DATA (default:
    ../shared/data) in $RIGCAL_RUNS (default: build/runs). There, NAME is the result of a run, NAME.key what it was made from, and
    NAME.recordings the recordings if they were read under other names."""

    def __init__(self):
        self.rigcal = pathlib.Path(os.environ.get("RIGCAL", ROOT / "build" / "release" / "rigcal")).resolve()
        self.data = pathlib.Path(os.environ.get("RIGCAL_DATA", ROOT.parent / "shared" / "data")).resolve()
        self.folder = pathlib.Path(os.environ.get("RIGCAL_RUNS", ROOT / "build" / "runs")).resolve()
        self.folder.mkdir(parents=True, exist_ok=True)
        self.ended = {}  # for each name, the exception that ended the run, or None

    def make(self, name):
        """Returns the folder with the result. If the run fails, each call raises the same exception."""
        if name not in RUNS:
            raise Failed(f"no run {name}; the table of runs is in {__file__}")
        if name not in self.ended:
            self.ended[name] = None
            try:
                for needed in self.needed(name):
                    self.make(needed)
                key = self.key(name)
                with locked(self.folder / f"{name}.lock"):
                    if not self.is_made(name, key):
                        self.run(name)
                        (self.folder / f"{name}.key").write_text(key, encoding="utf-8")
            except (Absent, Failed) as ended:
                self.ended[name] = ended
        if self.ended[name]:
            raise self.ended[name]
        return self.folder / name

    @staticmethod
    def needed(name):
        """Returns the names of the runs whose results this run reads."""
        return re.findall(r"\{results\}/(\w+)", RUNS[name].arguments)

    def program(self):
        if not self.rigcal.is_file():
            raise Failed(f"{self.rigcal} is not there: scripts/build release")
        return self.rigcal

    def recordings(self, run):
        folder = self.data / run.recordings
        if not folder.is_dir():
            raise Absent(f"no recordings {run.recordings} in {self.data}")
        return folder

    def key(self, name):
        """Returns a key that changes with the program, the campaign's folder, the recordings or a run that is read."""
        run = RUNS[name]
        digest = hashlib.sha256(repr([run, *(self.key(needed) for needed in self.needed(name))]).encode())
        folder = (ROOT / run.arguments.split()[1]).parent
        files = [*folder.rglob("*"), *(self.recordings(run).glob("*") if run.recordings else [])]
        for path in [self.program(), *sorted(files)]:
            if path.is_file():
                digest.update(f"{path.name} {path.stat().st_size}".encode())
                digest.update(path.read_bytes())
        return digest.hexdigest()

    def is_made(self, name, key):
        stamp = self.folder / f"{name}.key"
        return stamp.is_file() and stamp.read_text(encoding="utf-8") == key

    def run(self, name):
        run, out, renamed = RUNS[name], self.folder / name, self.folder / f"{name}.recordings"
        (self.folder / f"{name}.key").unlink(missing_ok=True)
        for old in (out, renamed):
            shutil.rmtree(old, ignore_errors=True)
        verb, campaign, *more = [argument.replace("{results}", str(self.folder)) for argument in shlex.split(run.arguments)]
        if run.stands_for:
            renamed.mkdir()
            for file in self.recordings(run).iterdir():
                (renamed / run.stands_for.get(file.name, file.name)).symlink_to(file.resolve())
        if run.recordings:
            more += ["--data", renamed if run.stands_for else self.recordings(run)]
        with tempfile.TemporaryDirectory() as work:
            if run.synthesized:
                call([self.rigcal, "synthesize", campaign, "--seed", "1", "--out", work, "--quiet"], (0,))
                campaign = f"{work}/campaign.toml"
            call([self.rigcal, verb, campaign, *more, "--out", out, "--quiet"],
                 (*VERDICTS, UNDECIDED) if verb == "diagnose" else VERDICTS)
