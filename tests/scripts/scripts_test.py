"""Runs every script in scripts/ and docs/, unless another test does. usage: scripts_test.py RIGCAL

The scripts run in a copy of the tree, with the tested program. Programs that install, build or measure for hours are
replaced by ones that only print their arguments.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DATA = pathlib.Path(os.environ.get("RIGCAL_DATA", ROOT.parent / "shared" / "data"))
RIGCAL = pathlib.Path("rigcal")  # from the command line
ELSEWHERE = {
    "build": ".ci/run",
    "lint": ".ci/run",
    "package": ".ci/run",
    "docs": "scripts/lint",
    "gallery": "tests/docs/pages_test.py",
    "docs-numbers": "tests/docs/numbers_test.py",
    "prose": "tests/docs/prose_test.py",
    "mutation-study": "tests/CMakeLists.txt",
    "performance-job": "scripts/performance",
    "reliability": "tests/CMakeLists.txt",
    "threads": "scripts/test",
}
ECHO = '#!/bin/sh\necho "$(basename "$0") $*"\n'


def make_program(path, text=ECHO):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)


class Scripts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = pathlib.Path(folder.name) / "tree"
        shutil.copytree(ROOT / "scripts", self.tree / "scripts", ignore=shutil.ignore_patterns("__pycache__"))
        for name in ("setup", "build"):
            make_program(self.tree / "scripts" / name)
        for name in ("datasets", "tests"):
            (self.tree / name).symlink_to(ROOT / name)
        release = self.tree / "build" / "release"
        for name in ("speed", "coverage_study", "days_study", "design_study", "diagnosis_study", "posterior_study"):
            make_program(release / "bench" / f"rigcal_{name}")
        (release / "rigcal").symlink_to(RIGCAL)
        self.programs = self.tree / "programs"  # comes first in PATH
        self.programs.mkdir()

    def run_script(self, name, *arguments, fails=False):
        """Returns the output of a script, or its standard error if it must fail."""
        path = f"{self.programs}:{os.environ['PATH']}"
        environment = {key: value for key, value in os.environ.items() if key != "RIGCAL"} | {"PATH": path}
        done = subprocess.run([self.tree / "scripts" / name, *arguments], cwd=self.tree, capture_output=True, text=True,
                              check=False, env=environment)
        self.assertEqual(done.returncode != 0, fails, done.stdout + done.stderr)
        return done.stderr if fails else done.stdout

    def test_coverage_study(self):
        self.assertEqual(self.run_script("coverage-study", "7", "2"), "rigcal_coverage_study 7 2\n")

    def test_days_study(self):
        self.assertEqual(self.run_script("days-study", "7", "9201", "2"), "rigcal_days_study 7 9201 2\n")

    def test_demo(self):
        printed = self.run_script("demo")
        self.assertIn("setup \nbuild release --target rigcal\n", printed)
        for name in ("truth.json", "fit.json", "validation.json", "report.html", "validation/report.html"):
            self.assertTrue((self.tree / "demo" / name).is_file(), name)

    def test_live(self):
        if "no live pages" in subprocess.run([RIGCAL, "--version"], capture_output=True, text=True, check=True).stdout:
            self.skipTest("this program was built without the model for pages")
        make_program(self.programs / "xdg-open", "#!/bin/sh\necho \"$1\" >opened\n")
        os.environ["DISPLAY"] = ":7"  # a display that does not exist
        self.addCleanup(os.environ.pop, "DISPLAY", None)
        page = self.tree / "live" / "explore.html"
        for arguments in ((), ("datasets/rigs/karpenko_sepehri/campaign.toml",)):
            printed = self.run_script("live", *arguments)
            self.assertEqual(printed, f"setup \nbuild release --target rigcal\n{page}\n")
            self.assertIn("Karpenko" if arguments else "UIS", page.read_text())
            self.assertEqual((self.tree / "opened").read_text(), f"{page}\n")

    def test_design_study(self):
        self.assertEqual(self.run_script("design-study", "7", "2", "10"), "rigcal_design_study 7 2 10\n")

    def test_diagnosis_study(self):
        printed = self.run_script("diagnosis-study", "3", "4", "50")
        self.assertIn("rigcal_diagnosis_study coverage 50\n", printed)
        self.assertIn("rigcal_diagnosis_study classes 3 4\n", printed)
        self.assertIn("rigcal_diagnosis_study smallest 3 3 disturbed\n", printed)

    def test_posterior_study(self):
        self.assertEqual(self.run_script("posterior-study", "7", "2", "1", "ranks.txt"),
                         "rigcal_posterior_study 7 2 1 ranks.txt\n")

    def test_fuzz(self):
        for name in ("mat", "csv"):
            make_program(self.tree / "build" / "ci" / "tests" / "fuzz" / f"{name}_fuzz",
                         '#!/bin/sh\necho "$*"\necho "stat::number_of_executed_units: 7"\n')
        self.assertIn("mat: 7 executions, nothing found\n", self.run_script("fuzz", "2", "mat"))
        log = (self.tree / "build" / "ci" / "fuzz" / "found" / "mat.log").read_text()
        self.assertIn("-max_total_time=120 ", log)
        self.assertIn(" build/ci/fuzz/corpus/mat tests/fuzz/corpus/mat\n", log)
        self.assertIn("build ci --target mat_fuzz csv_fuzz\n", self.run_script("fuzz", "--seconds", "5", "mat", "csv"))

    def test_fuzz_that_finds_something(self):
        make_program(self.tree / "build" / "ci" / "tests" / "fuzz" / "mat_fuzz", "#!/bin/sh\nexit 77\n")
        done = subprocess.run([self.tree / "scripts" / "fuzz", "1", "mat"], cwd=self.tree, capture_output=True, text=True,
                              check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("mat: found something, see build/ci/fuzz/found/mat.log", done.stderr)

    def test_fuzz_for_seconds(self):
        program = self.tree / "build" / "ci" / "tests" / "fuzz" / "csv_fuzz"
        make_program(program, "#!/bin/sh\necho stat::number_of_executed_units: 12\n")
        printed = self.run_script("fuzz", "--seconds", "1", "csv")
        self.assertEqual(printed, "build ci --target csv_fuzz\ncsv: 12 executions, nothing found\n")
        make_program(program, "#!/bin/sh\necho ERROR: found\nexit 77\n")
        self.assertIn("csv: found something", self.run_script("fuzz", "--seconds", "1", "csv", fails=True))

    def test_minimum_study(self):
        campaign = "excavator_dspace/boom_up_two_records.toml"
        if not (DATA / campaign).is_file():
            self.skipTest(f"no {campaign} in {DATA}")
        self.assertIn("1 of 1 campaigns end within", self.run_script("minimum-study", DATA, campaign))
        self.assertIn("no campaign unknown.toml", self.run_script("minimum-study", DATA, "unknown.toml", fails=True))

    def test_paper_figures(self):
        if not shutil.which("gnuplot"):
            make_program(self.programs / "gnuplot", "#!/bin/sh\nfor n in 5 8 9 10 11; do cp figure$n.csv figure$n.svg; done\n")
        self.assertIn("setup --figures\n", self.run_script("paper-figures", "figures"))
        for number in (5, 8, 9, 10, 11):
            self.assertGreater((self.tree / "figures" / f"figure{number}.svg").stat().st_size, 0)
            header, first, *_ = (self.tree / "figures" / f"figure{number}.csv").read_text().splitlines()
            self.assertEqual(len(first.split(",")), len(header.split(",")))

    def test_paper_figures_without_gnuplot(self):
        make_program(self.programs / "gnuplot", "#!/bin/sh\nexit 1\n")
        self.assertIn("setup \n", self.run_script("paper-figures", "--csv", "figures"))
        self.assertEqual(len(list((self.tree / "figures").iterdir())), 5)

    def test_performance(self):
        document = self.tree / "docs" / "quality.md"
        document.parent.mkdir()
        document.write_text("above\n<!-- scripts/performance -->\nold\n<!-- end -->\nbelow\n<!-- end -->\n")
        make_program(self.tree / "scripts" / "performance-job")
        self.assertTrue(self.run_script("performance", "3").endswith("performance-job --recorded\nperformance-job \nperformance-job --conditions\nperformance-job --page\n"))
        self.assertEqual(document.read_text(),
                         "above\n<!-- scripts/performance -->\nrigcal_speed 3\n<!-- end -->\nbelow\n<!-- end -->\n")
        self.assertTrue(self.run_script("performance", "--job", "1", "2").endswith("performance-job 1 2\n"))
        self.assertIn("scripts/performance [rounds]", self.run_script("performance", "--jop", fails=True))
        document.write_text("no block\n")
        self.assertIn("docs/quality.md has no block", self.run_script("performance", "3", fails=True))
        self.assertEqual(document.read_text(), "no block\n")

    def test_report_performance(self):
        printed = self.run_script("report-performance")
        self.assertIn("conditions: 24, samples each: 30000\n", printed)
        self.assertRegex(printed, r"written in [\d.]+ s of CPU, \d{7} bytes\nopens")

    def test_resume_study(self):
        self.assertTrue(self.run_script("resume-study", "2", "3").endswith("killed 2 times: the same\n"))

    def test_setup(self):
        # Runs on an unknown system.
        shutil.copy(ROOT / "scripts" / "setup", self.tree / "scripts" / "setup")
        system = self.tree / "os-release"
        system.write_text("ID=fedora\nVERSION_CODENAME=\n")
        make_program(self.programs / "dpkg-query", "#!/bin/sh\nexit 1\n")
        for name in ("apt-get", "sudo", "npm"):
            make_program(self.programs / name, "#!/bin/sh\necho must not be called\n")
        done = subprocess.run([self.tree / "scripts" / "setup"], capture_output=True, text=True, check=False, cwd=self.tree,
                              env=os.environ | {"PATH": f"{self.programs}:{os.environ['PATH']}", "OS_RELEASE": str(system)})
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        for package in ("g++", "libceres-dev", "zlib1g-dev", "catch2"):
            self.assertIn(f"\n  {package}\n", done.stderr)

    def test_start_study(self):
        records = DATA / "sim_hopsan_leaky_servo"
        if not records.is_dir():
            self.skipTest(f"no recordings in {records}")
        self.assertIn("1 of 1 starts end within", self.run_script("start-study", records, "1"))

    @unittest.skipUnless(shutil.which("git"), "git is not installed")
    def test_tag_version(self):
        def git(*arguments):
            return subprocess.run(["git", *arguments], cwd=self.tree, capture_output=True, text=True, check=True).stdout

        def commit(version, section):
            (self.tree / "CMakeLists.txt").write_text(f"project(rigcal VERSION {version} LANGUAGES CXX)\n")
            (self.tree / "CHANGELOG.md").write_text(f"# Changelog\n\n## {section}\n\n- New.\n\n## 0.0.1\n\n- Old.\n")
            git("add", "-f", "CMakeLists.txt", "CHANGELOG.md")
            git("commit", "-qm", section)

        git("init", "-q")
        (self.tree / ".git" / "info" / "exclude").write_text("*\n")
        git("config", "user.name", "nobody")
        git("config", "user.email", "nobody@localhost")
        commit("0.2.0", "0.2.0")
        self.assertIn(f"v0.2.0 is {git('rev-parse', 'HEAD')}", self.run_script("tag-version"))
        self.assertEqual(git("tag", "-l", "--format=%(contents)", "v0.2.0").strip(), "## 0.2.0\n\n- New.")
        self.assertIn("v0.2.0 is there already", self.run_script("tag-version", fails=True))
        commit("0.3.0", "0.2.0")
        self.assertIn("begins with '0.2.0', CMakeLists.txt says 0.3.0", self.run_script("tag-version", "--check", fails=True))
        commit("0.3.0", "0.3.0")
        (self.tree / "CHANGELOG.md").write_text("## 0.3.0\n")
        self.assertIn("not committed", self.run_script("tag-version", fails=True))
        self.assertEqual(self.run_script("tag-version", "--check"), "")
        self.assertIn("found '--chek'", self.run_script("tag-version", "--chek", fails=True))

    def test_the_version_has_its_section(self):
        subprocess.run([ROOT / "scripts" / "tag-version", "--check"], check=True)

    def test_test(self):
        make_program(self.programs / "ctest")
        for name in ("threads", "fuzz"):
            make_program(self.tree / "scripts" / name)
        sanitizers = "\nthreads \n== fuzz: build, test\nfuzz --seconds 10\n"
        for arguments, presets in (([], ["release"]), (["--sanitizers"], ["ci"]), (["--all"], ["release", "ci"])):
            printed = self.run_script("test", *arguments)
            self.assertEqual(printed.endswith(sanitizers), "ci" in presets, printed)
            for preset in ("release", "ci"):
                self.assertEqual(f"build {preset}\n== {preset}: test\nctest --preset {preset} -j" in printed, preset in presets)
        self.assertIn("found '--al'; expected nothing, --sanitizers or --all", self.run_script("test", "--al", fails=True))

    def test_every_script_has_a_test(self):
        tested = {name[5:].replace("_", "-") for name in dir(self) if name.startswith("test_")}
        for path in (ROOT / "scripts").iterdir():
            if not os.access(path, os.X_OK) or path.is_dir() or path.name in tested:
                continue
            self.assertIn(path.name, ELSEWHERE)
            self.assertIn(path.name, (ROOT / ELSEWHERE[path.name]).read_text())

    def test_every_script_of_the_documents_prints_a_block(self):
        blocks = "".join(re.findall("^<!-- numbers: .*\n", "".join(path.read_text() for path in ROOT.glob("docs/*.md")), re.M))
        scripts = [path for path in ROOT.glob("docs/**/*") if path.is_file() and os.access(path, os.X_OK)]
        self.assertTrue(scripts)
        for path in scripts:
            self.assertIn(f"<!-- numbers: {path.relative_to(ROOT)} ", blocks)


if __name__ == "__main__":
    RIGCAL = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
