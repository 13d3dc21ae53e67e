"""Tries numbers that no rig has: each quantity of a campaign in turn is zero, negative, tiny or huge. Each verb must read or
refuse it, within limits of time and memory. The program itself lists the keys, so new keys are included."""
import concurrent.futures
import os
import re
import resource

from runs import Count, must, run

NUMBERS = ("0", "-1", "1e-300", "1e12", "1e30", "1e300", "-1e300")
WHOLE = ("0", "-1", "1000000000000", "9223372036854775807")
CPU_S = 60
BYTES = 3 << 30

# Tables and their entries. The keys that each table accepts are found at run time, see
# known_keys().
RIG = {
    "": {"schema": '"rigcal.campaign/1"', "name": '"extremes"'},
    "rig": {"model": '"load_pressure"'},
    "rig.parameters": {
        "supply_pressure": '"6.2 MPa"', "mass": '"60 kg"', "leakage_coefficient": "0.0", "stiffness": '"0 N/m"',
        "piston_area": '"633 mm2"', "total_volume": '"468 cm3"', "density": '"850 kg/m3"', "bulk_modulus": '"689 MPa"',
        "discharge_coefficient": "0.6", "area_gradient": '"20 mm"', "leakage_area": '"1 mm2"'},
    "rig.parameters.damping": {"start": '"2000 N s/m"', "lower": '"10 N s/m"', "upper": '"1e5 N s/m"', "fit": "true"},
    "rig.parameters.valve_gain": {"start": '"2e-5 m/V"', "lower": '"1e-6 m/V"', "upper": '"1e-3 m/V"', "fit": "true",
                                  "prior": '"3e-5 m/V"', "prior_sd": '"1e-5 m/V"'},
    "rig.controller": {"type": '"pid"', "kp": '"1000 V/m"'},
    "recording": {"initial": '"record"', "initial_window": '"0.1 s"'},
    "recording.channels.time": {"column": '"t_s"', "unit": '"s"'},
    "recording.channels.reference": {"column": '"ref_mm"', "unit": '"mm"'},
    "recording.channels.position": {"column": '"x_mm"', "unit": '"mm"', "sd": '"0.01 mm"'},
    "recording.channels.load_pressure": {"column": '"pl_bar"', "unit": '"bar"'},
    "acceptance": {"rho2": "0.9"},
    "acceptance.negligible": {},
    "fit": {},
    "simulation": {"max_seconds": "2.0"},
    "diagnosis": {},
    "diagnosis.limits_percent": {},
    "leak_table": {"targets": "[10, 50]"},
    "[leak_table.signal]": {"waveform": '"sine"', "frequency": '"2 Hz"', "amplitude": '"5 mm"'},
    "leak_table.assumptions.density": {"value": '"850 kg/m3"', "source": '"a guess"'},
    "synthetic": {"repeats": "3", "duration": '"2 s"', "sample_rate": '"200 Hz"'},
    "synthetic.noise": {"position": '"0.01 mm"', "load_pressure": '"0.05 bar"'},
    "synthetic.drift": {}, "synthetic.quantisation": {}, "synthetic.ar1_noise": {}, "synthetic.variation": {},
    "[condition]": {"id": '"sine"', "waveform": '"sine"', "frequency": '"2 Hz"', "amplitude": '"5 mm"',
                    "leak_level": '"none"', "use": '"fit"', "repeats": '["records/sine_*.csv"]'},
    "condition.parameters": {},
    "condition.controller": {},
}
OTHER_CONDITIONS = "".join(f"""
[[condition]]
id = "{waveform}"
waveform = "{waveform}"
frequency = "1 Hz"
amplitude = "4 mm"
{more}leak_level = "none"
use = "validate"
repeats = ["records/{waveform}_*.csv"]
""" for waveform, more in (("square", ""), ("chirp", 'end_frequency = "3 Hz"\nsweep_time = "2 s"\n')))
# Waveforms whose frequencies determine the length of a loop.
WAVEFORMS = ("square", "triangle", "chirp")


VERBS = ("check", "average", "simulate", "fit", "validate", "plan", "leak-table", "diagnose", "parity", "synthesize")


def text_of(table=None, key=None, value=None, base=RIG):
    """Returns the campaign with one entry changed or added."""
    text = ""
    for name, entries in base.items():
        changed = {**entries, key: value} if name == table else entries
        if name:
            text += f"\n[{name}]\n"  # "[condition]" is an array of tables
        text += "".join(f"{each} = {content}\n" for each, content in changed.items() if content is not None)
    return text + OTHER_CONDITIONS


def with_waveform(waveform):
    condition = {**RIG["[condition]"], "waveform": f'"{waveform}"'}
    if waveform == "chirp":
        condition |= {"end_frequency": '"3 Hz"', "sweep_time": '"2 s"'}
    return {**RIG, "[condition]": condition}


class Study:
    def __init__(self, rigcal, folder):
        self.rigcal, self.folder = rigcal, folder
        self.twin = folder / "twin"
        base = folder / "base.toml"
        base.write_text(text_of())
        must(rigcal, ["synthesize", base, "--seed", "1", "--out", self.twin, "--quiet"])
        must(rigcal, ["fit", base, "--data", self.twin, "--out", folder / "fit", "--quiet"])
        self.limits_memory = b"__asan_init" not in rigcal.read_bytes()  # AddressSanitizer takes terabytes of address space

    def arguments(self, verb, campaign, out):
        common = [verb, campaign, "--data", self.twin, "--out", out, "--threads", "1", "--quiet"]
        more = {"check": [], "fit": ["--max-time", "3"], "validate": ["--fit", self.folder / "fit" / "fit.json"],
                "diagnose": ["--fit", self.folder / "fit" / "fit.json"],
                "parity": ["--fit", self.folder / "fit" / "fit.json"], "synthesize": ["--seed", "1"]}
        if verb == "synthesize":
            return [verb, campaign, "--out", out, "--seed", "1", "--quiet"]
        return common + more.get(verb, [])

    def limit(self):
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S + 5))
        if self.limits_memory:
            resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))

    def ended(self, verb, text, name):
        campaign = self.folder / f"{name}.toml"
        campaign.write_text(text)
        code, out, err = run(self.rigcal, self.arguments(verb, campaign, self.folder / f"out_{name}"), 20 * CPU_S,
                             preexec_fn=self.limit)
        campaign.unlink()
        return code, err.decode(errors="replace")

    def known_keys(self, table):
        """Returns the keys that a table accepts, from the message about an unknown key."""
        _, message = self.ended("check", text_of(table, "zzz", "1"), "ask")
        found = re.search(r"'zzz'.*\(known: (.*)\)", message)
        names = re.findall(r"[a-z][a-z0-9_]*", found.group(1)) if found else []
        return list(dict.fromkeys([*names, *RIG[table]]))

    def values(self, table, key):
        """Returns the values to try, from the message about a value of a wrong type; none for texts and tables."""
        _, message = self.ended("check", text_of(table, key, "[[[]]]"), "ask")
        if quantity := re.search(r'a text "number unit" such as "1.5 ([^"]*)"', message):
            return [f'"{number} {quantity.group(1)}"' for number in NUMBERS]
        if "a plain number" in message or "number of seconds" in message:
            return [number if "e" in number else f"{number}.0" for number in NUMBERS]
        if "a whole number" in message:
            return list(WHOLE)
        return []


def parameters(rigcal):
    _, out, _ = run(rigcal, ["params", "--json"])
    return list(dict.fromkeys(re.findall(r'"key": "([a-z0-9_]+)"', out.decode())))


def study(rigcal, folder, size):
    tests = Study(rigcal, folder)
    tables = [each for each in RIG if each and each != "rig"]
    of_rig = parameters(rigcal)
    changes = []
    for table in tables:
        known = tests.known_keys(table)
        if table in ("rig.parameters", "rig.controller", "condition.parameters", "condition.controller"):
            known = list(dict.fromkeys(known + of_rig))
        for key in known:
            if f"{table}.{key}" in RIG:
                continue  # a table of its own
            changes += [(RIG, table, key, value) for value in tests.values(table, key)]
    for waveform in WAVEFORMS:
        for key in ("frequency", "end_frequency", "sweep_time"):
            changes += [(with_waveform(waveform), "[condition]", key, f'"{number} {"s" if key == "sweep_time" else "Hz"}"')
                        for number in NUMBERS]
    if len({(table, key) for _, table, key, _ in changes}) < 100:
        raise SystemExit("reliability: extremes: the keys of a campaign could not be found")
    rows = {verb: Count(f"extremes: {verb}") for verb in VERBS}

    def attempt(numbered):
        number, (base, table, key, value), verb = numbered
        return verb, f"{table}.{key} = {value}", tests.ended(verb, text_of(table, key, value, base), f"n{number}")

    runs = [(change, verb) for change in changes for verb in VERBS]
    if size == "small":
        runs = runs[::97]  # coprime to the numbers of verbs and values, so that all combinations occur
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for verb, what, (code, err) in pool.map(attempt, [(k, *each) for k, each in enumerate(runs)]):
            rows[verb].ended(code, what)
            if code == 5 or "bug" in err:
                rows[verb].is_wrong(f"{what}: exit {code}: {err.strip()[-200:]}")
    return list(rows.values())
