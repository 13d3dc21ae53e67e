"""Tries numbers that no rig has: each quantity of a campaign in turn is zero, negative, tiny or huge. Each verb must read or
refuse it, within limits of time and memory. The program itself lists the keys, so new keys are included."""
import concurrent.futures
import json
import os
import re
import resource
import shutil

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
    "averaging": {}, "considered": {}, "between_days": {},
    "report": {"number": '"2026-1"'},
    "[report.sensor]": {"channel": '"position"', "uncertainty": '"0.002 mm (k = 2)"'},
    "acceptance": {"rho2": "0.9"},
    "acceptance.position": {"rho2": "0.95"},
    "acceptance.negligible": {},
    "fit": {},
    "simulation": {"max_seconds": "2.0"},
    "diagnosis": {},
    "diagnosis.limits_percent": {},
    "design": {"stroke": '["-6 mm", "8 mm"]', "duration": '"1 s"', "sample_rate": '"100 Hz"', "family": '"multisine"', "evaluations": "4"},
    "leak_table": {"targets": "[10]"},
    "[leak_table.signal]": {"waveform": '"sine"', "frequency": '"2 Hz"', "amplitude": '"5 mm"', "printed": '["0.5"]'},
    "leak_table.assumptions.kp": {"value": '"1000 V/m"', "source": '"a guess"', "fit": "true", "start": '"990 V/m"',
                                  "lower": '"900 V/m"', "upper": '"1100 V/m"'},
    "leak_table.assumptions.density": {"value": '"850 kg/m3"', "source": '"a guess"'},
    "synthetic": {"repeats": "3", "duration": '"2 s"', "sample_rate": '"200 Hz"'},
    "synthetic.noise": {"position": '"0.01 mm"', "load_pressure": '"0.05 bar"'},
    "synthetic.drift": {}, "synthetic.quantisation": {}, "synthetic.ar1_noise": {}, "synthetic.variation": {},
    "[condition]": {"id": '"sine"', "waveform": '"sine"', "frequency": '"2 Hz"', "amplitude": '"5 mm"',
                    "leak_level": '"none"', "use": '"fit"', "repeats": '["records/sine_*.csv"]'},
    "condition.parameters": {},
    "condition.controller": {},
}
# The plants that a rig may have beside the first. Their parameters are tried, the other tables are those of any rig.
NO_CONTROLLER = {"type": '"none"'}
RECORDS = {"repeats": "3", "duration": '"2 s"', "sample_rate": '"200 Hz"'}
VALVE = {"density": '"850 kg/m3"', "bulk_modulus": '"500 MPa"', "discharge_coefficient": "0.6", "area_gradient": '"20 mm"',
         "leakage_coefficient": "0.0", "leakage_area": '"1 mm2"', "tank_pressure": '"1 bar"'}
CHAMBERS = {"recording.channels.time": RIG["recording.channels.time"],
            "recording.channels.pressure_a": {"column": '"pA_bar"', "unit": '"bar"', "sd": '"0.1 bar"'},
            "recording.channels.pressure_b": {"column": '"pB_bar"', "unit": '"bar"', "sd": '"0.1 bar"'}}
TWO_CHAMBER = {
    "": RIG[""], "rig": {"model": '"two_chamber"'},
    "rig.parameters": {
        "damping": '"300 N s/m"', "stiffness": '"0 N/m"', "area_a": '"200 mm2"', "area_b": '"120 mm2"', "stroke": '"200 mm"',
        "dead_volume_a": '"20 cm3"', "dead_volume_b": '"30 cm3"', "supply_pressure": '"44 bar"', **VALVE},
    "rig.parameters.mass": {"start": '"6 kg"', "lower": '"1 kg"', "upper": '"50 kg"', "fit": "true"},
    "rig.parameters.valve_gain": {"start": '"5e-6 m/V"', "lower": '"1e-6 m/V"', "upper": '"2e-5 m/V"', "fit": "true"},
    "rig.controller": NO_CONTROLLER, **CHAMBERS,
    "recording.channels.command": {"column": '"u_V"', "unit": '"V"'},
    "recording.channels.position": {"column": '"x_mm"', "unit": '"mm"', "sd": '"0.02 mm"'},
    "simulation": {"max_seconds": "2.0"},
    "synthetic": RECORDS, "synthetic.noise": {"position": '"0.02 mm"', "pressure_a": '"0.1 bar"', "pressure_b": '"0.1 bar"'},
    "[condition]": {"id": '"square"', "waveform": '"square"', "frequency": '"1 Hz"', "amplitude": '"1 V"', "use": '"fit"',
                    "repeats": '["records/square_*.csv"]'},
}
LINKAGE = {
    "": RIG[""], "rig": {"model": '"linkage"'},
    "rig.parameters": {
        "lever": '"0.3 m/rad"', "lower_stop": '"-1 rad"', "upper_stop": '"1 rad"', "stop_stiffness": '"1e7 N m/rad"',
        "area_a": '"4000 mm2"', "area_b": '"2400 mm2"', "dead_volume_a": '"1 L"', "dead_volume_b": '"1 L"',
        "supply_pressure": '"200 bar"', "valve_gain": '"1e-5 m/V"', **VALVE},
    "rig.parameters.inertia": {"start": '"400 kg m2"', "lower": '"100 kg m2"', "upper": '"1000 kg m2"', "fit": "true"},
    "rig.parameters.joint_damping": {"start": '"500 N m s/rad"', "lower": '"10 N m s/rad"', "upper": '"5000 N m s/rad"',
                                     "fit": "true"},
    "rig.controller": NO_CONTROLLER, **CHAMBERS,
    "recording.channels.command": {"column": '"u_V"', "unit": '"V"'},
    "recording.channels.angle": {"column": '"a_deg"', "unit": '"deg"', "sd": '"0.05 deg"'},
    "simulation": {"max_seconds": "2.0"},
    "synthetic": RECORDS, "synthetic.noise": {"angle": '"0.05 deg"', "pressure_a": '"0.1 bar"', "pressure_b": '"0.1 bar"'},
    "[condition]": {"id": '"square"', "waveform": '"square"', "frequency": '"1 Hz"', "amplitude": '"1 V"', "use": '"fit"',
                    "repeats": '["records/square_*.csv"]'},
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
# Tables of names, texts and switches.
WITHOUT_NUMBERS = ("averaging", "report")
# Tables of parameters, and whether these are gains.
OF_PARAMETERS = {"rig.parameters": False, "condition.parameters": False, "rig.controller": True, "condition.controller": True}
# Waveforms whose frequencies determine the length of a loop.
WAVEFORMS = ("square", "triangle", "chirp")


VERBS = ("check", "average", "simulate", "fit", "validate", "plan", "leak-table", "diagnose", "parity", "synthesize", "explore",
         "export fmu", "fit-tables", "plan --design", "batch")
# Verbs for the plants of which only the parameters are tried.
VERBS_OF_PLANTS = ("check", "simulate", "fit", "validate", "plan", "synthesize", "explore", "export fmu")


def text_of(table=None, key=None, value=None, base=RIG):
    """Returns the campaign with one entry changed or added."""
    text = ""
    for name, entries in base.items():
        changed = {**entries, key: value} if name == table else entries
        if name:
            text += f"\n[{name}]\n"  # "[condition]" is an array of tables
        text += "".join(f"{each} = {content}\n" for each, content in changed.items() if content is not None)
    return text + (OTHER_CONDITIONS if base["rig"] == RIG["rig"] else "")


def with_waveform(waveform):
    condition = {**RIG["[condition]"], "waveform": f'"{waveform}"'}
    if waveform == "chirp":
        condition |= {"end_frequency": '"3 Hz"', "sweep_time": '"2 s"'}
    return {**RIG, "[condition]": condition}


class Study:
    """Runs of one rig, with records and a fit of it."""

    def __init__(self, rigcal, folder, small, base=RIG):
        folder.mkdir(exist_ok=True)
        self.rigcal, self.folder, self.small, self.base = rigcal, folder, small, base
        self.twin = folder / "twin"
        rig, base = base, folder / "base.toml"
        base.write_text(text_of(base=rig))
        must(rigcal, ["synthesize", base, "--seed", "1", "--out", self.twin, "--quiet"])
        must(rigcal, ["fit", base, "--data", self.twin, "--out", folder / "fit", "--quiet"])
        self.limits_memory = b"__asan_init" not in rigcal.read_bytes()  # AddressSanitizer takes terabytes of address space
        of_plants = parameters(rigcal)
        self.parameters = {each["key"]: each for each in of_plants[rig["rig"]["model"].strip('"')]}
        self.of_any_plant = {each["key"] for rows in of_plants.values() for each in rows}

    def arguments(self, verb, campaign, out):
        if verb == "batch":
            rigs = campaign.with_suffix("")
            (rigs / "rig").mkdir(parents=True)
            (rigs / "rig" / "records").symlink_to(self.twin / "records")
            shutil.copy(campaign, rigs / "rig" / "campaign.toml")
            return [verb, rigs, "--out", out, "--threads", "1", "--quiet", "--max-time", "3", "--diagnose"]
        common = [*verb.split()[:1 if "--" in verb else 2], campaign, "--data", self.twin, "--out", out, "--threads", "1",
                  "--quiet"]
        more = {"check": [], "fit": ["--max-time", "3"], "validate": ["--fit", self.folder / "fit" / "fit.json"],
                "diagnose": ["--fit", self.folder / "fit" / "fit.json"],
                "parity": ["--fit", self.folder / "fit" / "fit.json"],
                "plan --design": ["--design", "damping,valve_gain"], "synthesize": ["--seed", "1"]}
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
        shutil.rmtree(campaign.with_suffix(""), ignore_errors=True)
        return code, err.decode(errors="replace")

    def known_keys(self, table):
        """Returns the keys that a table accepts, from the message about an unknown key."""
        _, message = self.ended("check", text_of(table, "zzz", "1", self.base), "ask")
        found = re.search(r"'zzz'.*\(known: (.*)\)", message)
        names = re.findall(r"[a-z][a-z0-9_]*", found.group(1)) if found else []
        return list(dict.fromkeys([*names, *self.base[table]]))

    def values(self, table, key):
        """Returns the values to try: of a parameter by its unit, else by the message about a value of a wrong type. There are
        none for texts, tables and the parameters of other tables or plants."""
        if table in OF_PARAMETERS and key in self.of_any_plant:
            row = self.parameters.get(key)
            if not row or (row["kind"] == "controller") != OF_PARAMETERS[table]:
                return []
            return in_unit(row["unit"])
        if (table, key) == ("[report.sensor]", "uncertainty"):  # a text with two numbers
            return [f'"{number} {rest}"' for number in NUMBERS for rest in ("mm (k = 2)", "% (k = 2)")] + [
                f'"0.002 mm (k = {number})"' for number in NUMBERS]
        _, message = self.ended("check", text_of(table, key, "[[[]]]", self.base), f"ask_{table.strip('[]')}_{key}")
        if quantity := re.search(r'text "number unit" such as "1.5 ([^"]*)"', message):
            return in_unit(quantity.group(1))
        if "a plain number" in message or "number of seconds" in message:
            return in_unit("1")
        if "a whole number" in message:
            return list(WHOLE)
        return []


def in_unit(unit):
    """Returns every number in a unit, or as a plain number where the unit is 1."""
    if unit == "1":
        return [number if "e" in number else f"{number}.0" for number in NUMBERS]
    return [f'"{number} {unit}"' for number in NUMBERS]


def parameters(rigcal):
    """Returns the parameters of each plant as the program lists them."""
    _, out, _ = run(rigcal, ["params", "--json"])
    return json.loads(out)


def changes_of(study, pairs):
    """Returns a change for each value of each (table, key). Asking for the kind of a key takes a run, and most of the time of a
    small study. A sanitized program takes ten times as long; a sixth of the keys are asked for."""
    if study.small and not study.limits_memory:
        pairs = pairs[::6]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        values = pool.map(lambda pair: study.values(*pair), pairs)
    return [(study, study.base, table, key, value) for (table, key), own in zip(pairs, values) for value in own]


def study(rigcal, folder, size):
    small = size == "small"
    tests = Study(rigcal, folder, small)
    tables = [each for each in RIG if each and each != "rig"]
    pairs = []
    for table in tables:
        known = tests.known_keys(table)
        if table in OF_PARAMETERS:
            known = list(dict.fromkeys([*known, *tests.parameters]))
        pairs += [(table, key) for key in known if f"{table}.{key}" not in RIG]  # those are tables of their own
    changes = changes_of(tests, pairs)
    for waveform in WAVEFORMS:
        for key in ("frequency", "end_frequency", "sweep_time"):
            changes += [(tests, with_waveform(waveform), "[condition]", key, f'"{number} {"s" if key == "sweep_time" else "Hz"}"')
                        for number in NUMBERS]
    asked_for_all = not small or tests.limits_memory
    if asked_for_all and len({(table, key) for _, _, table, key, _ in changes}) < 100:
        raise SystemExit("reliability: extremes: the keys of a campaign could not be found")
    for table in tables:
        # A table without numbers would be one whose keys were not found.
        if asked_for_all and not any(changed == table for _, _, changed, _, _ in changes) and table not in WITHOUT_NUMBERS:
            raise SystemExit(f"reliability: extremes: no number of [{table}] is tried")
    runs = [(change, verb) for change in changes for verb in VERBS]
    for model, base in (("two_chamber", TWO_CHAMBER), ("linkage", LINKAGE)):
        plant = Study(rigcal, folder / model, small, base)
        keys = [key for key in plant.parameters if f"rig.parameters.{key}" not in base]
        tried = changes_of(plant, [("rig.parameters", key) for key in keys] +
                           [(table, "start") for table in base if table.startswith("rig.parameters.")])
        if asked_for_all and len(tried) < 100:
            raise SystemExit(f"reliability: extremes: the parameters of {model} could not be found")
        runs += [(change, verb) for change in tried for verb in VERBS_OF_PLANTS]
    rows = {verb: Count(f"extremes: {verb}") for verb in VERBS}

    def attempt(numbered):
        number, (rig, base, table, key, value), verb = numbered
        return verb, f"{table}.{key} = {value}", rig.ended(verb, text_of(table, key, value, base), f"n{number}")

    if small:
        runs = runs[::193]  # coprime to the numbers of verbs and values, so that all combinations occur
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for verb, what, (code, err) in pool.map(attempt, [(k, *each) for k, each in enumerate(runs)]):
            rows[verb].ended(code, what)
            if code == 5 or "bug" in err:
                rows[verb].is_wrong(f"{what}: exit {code}: {err.strip()[-200:]}")
    return list(rows.values())
