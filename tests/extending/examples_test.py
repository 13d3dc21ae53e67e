"""Checks that what each example in docs/extending adds is present and correct.
usage: examples_test.py RIGCAL EXAMPLES EXAMPLE"""
import csv
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

RIGCAL, EXAMPLES, EXAMPLE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]


class Example(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for file in [*(EXAMPLES / EXAMPLE).glob("*.toml"), *(EXAMPLES / EXAMPLE).glob("*.json")]:
            shutil.copy(file, self.folder)

    def run_rigcal(self, *arguments):
        return subprocess.run([RIGCAL, *arguments], cwd=self.folder, capture_output=True, text=True, check=False)

    def simulated(self, condition):
        """Returns the columns of the simulated signals."""
        done = self.run_rigcal("simulate", "campaign.toml", "--out", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.folder / "out" / f"{condition}.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.assertGreater(len(rows), 100)
        return {name: [float(row[name]) for row in rows] for name in rows[0]}


class Triangle(Example):
    def test_drives_the_rig(self):
        signals = self.simulated("triangle")
        for time, reference in zip(signals["time_s"], signals["reference_m"]):
            triangle = 0.02 * 2 / math.pi * math.asin(math.sin(2 * math.pi * 0.5 * time))
            self.assertAlmostEqual(reference, triangle, delta=1e-9)
        # The piston follows with a delay and a smaller amplitude. Half a period later, it is at the
        # opposite position.
        position = dict(zip((round(time, 3) for time in signals["time_s"]), signals["position_m"]))
        self.assertTrue(0.01 < max(position.values()) < 0.02)
        for hundredths in range(300, 400):
            self.assertAlmostEqual(position[hundredths / 100], -position[(hundredths - 100) / 100], delta=5e-6)

    def test_has_a_leak_table(self):
        text = (self.folder / "campaign.toml").read_text(encoding="utf-8")
        (self.folder / "campaign.toml").write_text(text.replace("leakage_coefficient = 0", "leakage_coefficient = 0.3"),
                                                   encoding="utf-8")
        done = self.run_rigcal("leak-table", "campaign.toml", "--targets", "10", "--out", "table")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("triangle", (self.folder / "table" / "leak_table.csv").read_text(encoding="utf-8"))


class FirstOrder(Example):
    def test_moves_as_its_equation_says(self):
        signals = self.simulated("square")
        for time, position in zip(signals["time_s"], signals["position_m"]):
            if time < 1.0:  # 2 V times 0.1 m/(s V), with a lag of 0.05 s
                exact = 0.2 * (time - 0.05 * (1 - math.exp(-time / 0.05)))
                self.assertAlmostEqual(position, exact, delta=1e-5)
        self.assertLess(signals["velocity_m_per_s"][-1], -0.19)  # the command has been -2 V since 1 s

    def test_has_its_parameters_and_no_others(self):
        text = (self.folder / "campaign.toml").read_text(encoding="utf-8")
        (self.folder / "campaign.toml").write_text(text.replace("velocity_lag", "bulk_modulus"), encoding="utf-8")
        done = self.run_rigcal("check", "campaign.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("bulk_modulus", done.stderr)


class Dat(Example):
    def write_run(self, name, last):
        lines = ["# t_s u_V x_mm", *(f"{0.01 * i:.2f}  {i % 7}\t{0.5 * i}" for i in range(50)), last]
        (self.folder / name).write_text("\n".join(lines) + "\n", encoding="utf-8")

    def test_is_read_and_drafted_from(self):
        self.write_run("run_1.dat", "0.5 1 25")
        self.write_run("run_2.dat", "0.5 1 25.1")
        done = self.run_rigcal("average", "campaign.toml", "--out", "mean")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.folder / "mean" / "averaged" / "run.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.assertAlmostEqual(float(rows[-1]["position_m_mean"]), 0.02505, delta=1e-12)
        done = self.run_rigcal("init", ".", "--out", "draft")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('position = { column = "x_mm", unit = "mm" }',
                      (self.folder / "draft" / "campaign.toml").read_text(encoding="utf-8"))

    def test_is_refused_with_its_line(self):
        self.write_run("run_1.dat", "0.5 1 none")
        done = self.run_rigcal("check", "campaign.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("run_1.dat:52:1: 'none' in column 'x_mm' is not a finite number", done.stderr)


class Service(Example):
    def test_is_on_the_page_and_among_the_figures(self):
        done = self.run_rigcal("report", ".", "--figures")
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        for part in ["<title>SERVICED – shake table – Service</title>", '<a href="#service">Service</a>',
                     "Last on 2026-02-17, at 655.5 h: oil changed &amp; filtered.", "service_log --rig 7"]:
            self.assertIn(part, page)
        self.assertTrue((self.folder / "figures" / "service.svg").exists())

    def test_is_refused_with_its_key(self):
        text = (self.folder / "service.json").read_text(encoding="utf-8")
        (self.folder / "service.json").write_text(text.replace("655.5", '"many"'), encoding="utf-8")
        done = self.run_rigcal("report", ".")
        self.assertEqual(done.returncode, 2)
        self.assertIn("key 'entries[1].operating_hours': found \"many\"", done.stderr)

    def test_is_named_where_there_is_nothing(self):
        (self.folder / "service.json").unlink()
        self.assertIn("plan.json or service.json; expected a result folder", self.run_rigcal("report", ".").stderr)


class MeanError(Example):
    def test_is_computed_stored_and_shown(self):
        told = json.loads(self.run_rigcal().stdout)
        self.assertEqual(told["scores"]["mean_error_percent"], 5.0)
        self.assertEqual(told["scores"]["rho2"], 1.0)  # insensitive to a constant error
        self.assertIn("mean_error_percent", told["schema"]["required"])
        self.assertEqual(told["titles"][-1], "Mean error %")
        self.assertEqual(told["cells"][-1], '<data value="5">5</data>')
        self.assertEqual(len(told["titles"]), len(told["cells"]))


if __name__ == "__main__":
    suite = {"triangle": Triangle, "first_order": FirstOrder, "dat": Dat, "service": Service,
             "mean_error": MeanError}[EXAMPLE]
    result = unittest.TextTestRunner().run(unittest.defaultTestLoader.loadTestsFromTestCase(suite))
    sys.exit(0 if result.wasSuccessful() and result.testsRun > 0 else 1)
