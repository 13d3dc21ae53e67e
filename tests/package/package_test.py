"""Checks that `cmake --install` installs all that projects and readers need. usage:
package_test.py BUILD COMPILER"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BUILD = COMPILER = ""  # from the command line


def run(*arguments, **options):
    done = subprocess.run([str(argument) for argument in arguments], capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        raise AssertionError(f"exit code {done.returncode}: {arguments}\n{done.stdout}{done.stderr}")
    return done.stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.prefix = cls.folder / "prefix"
        run("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.rigcal = cls.prefix / "bin" / "rigcal"
        cls.verbs = re.findall(r"^  ([a-z][\w-]*) ", run(cls.rigcal, "--help").partition("Subcommands:")[2], re.MULTILINE)
        cls.options = {verb: re.findall(r"^  (?:-\w,)?(--[\w-]+)", run(cls.rigcal, verb, "--help"), re.MULTILINE)
                       for verb in cls.verbs}

    def test_the_entry_header_and_what_it_includes_are_installed(self):
        include = self.prefix / "include"
        self.assertEqual([path.name for path in include.iterdir()], ["rigcal"])
        included = {include / "rigcal" / "rigcal.hpp"}
        for header in (headers := set(include.rglob("*.hpp"))):
            text = header.read_text()
            self.assertNotRegex(text, r"#include <(toml\+\+|matio|hpdf|zlib|udunits2|openssl|kainjow|CLI)", header)
            for name in re.findall(r'#include "([^"]+)"', text):
                self.assertTrue((include / name).is_file(), f"{header}: {name}")
                included.add(include / name)
        self.assertEqual(headers, included)

    def test_a_project_finds_the_libraries_and_fits(self):
        made = self.folder / "made"
        run(self.rigcal, "synthesize", ROOT / "docs" / "tutorial" / "known_rig.toml", "--seed", "1", "--out", made, "--quiet")
        build = self.folder / "consumer"
        run("cmake", "-S", ROOT / "tests" / "package" / "consumer", "-B", build, "-G", "Ninja",
            f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={COMPILER}", "-DCMAKE_CXX_FLAGS=-O0",
            "-DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=lld")
        run("cmake", "--build", build)
        printed = run(build / "consumer", made / "campaign.toml", self.folder / "results")
        self.assertRegex(printed, r"(?m)^mass 8[45]\.\d+ kg$")  # the true value is 85 kg
        self.assertTrue((self.folder / "results" / "report.html").is_file())
        source = (ROOT / "tests" / "package" / "consumer" / "consumer.cpp").read_text()
        self.assertIn(f"```cpp\n{source}```\n", (ROOT / "docs" / "install.md").read_text())

    def test_the_serial_hdf5_is_linked_where_hdf5_means_a_parallel_one(self):
        source = self.folder / "hdf5"
        source.mkdir()
        (source / "hdf5.pc").write_text("Name: hdf5\nDescription: parallel\nVersion: 1.14.0\nLibs: -lhdf5_openmpi -lmpi\n")
        (source / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(hdf5 LANGUAGES C CXX)\n"
            f"include({ROOT}/cmake/packages.cmake)\n"
            "get_target_property(libraries PkgConfig::hdf5 INTERFACE_LINK_LIBRARIES)\nmessage(STATUS \"linked: ${libraries}\")\n")
        printed = run("cmake", "-S", source, "-B", source / "build", "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={COMPILER}",
                      env={**os.environ, "PKG_CONFIG_PATH": str(source)})
        linked = re.search(r"linked: (.*)", printed).group(1)
        self.assertIn("hdf5", linked)
        self.assertNotRegex(linked, "openmpi|mpi")

    def test_another_minor_version_is_refused(self):
        source = self.folder / "another"
        source.mkdir()
        (source / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(another LANGUAGES CXX)\nfind_package(rigcal 99.0 REQUIRED)\n")
        version = re.search(r"^project\(rigcal VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE).group(1)
        with self.assertRaisesRegex(AssertionError, f"version: {re.escape(version)}"):
            run("cmake", "-S", source, "-B", source / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}")

    def test_nothing_installed_names_the_sources(self):
        for path in (self.prefix / "lib").rglob("*.cmake"):
            self.assertNotIn(str(ROOT), path.read_text(), path)

    def test_campaigns_and_schemas_are_installed(self):
        share = self.prefix / "share" / "rigcal"
        for folder, installed, pattern in (("datasets/rigs", "rigs", "*.toml"), ("docs/schema", "schema", "*.json")):
            names = {path.relative_to(ROOT / folder) for path in (ROOT / folder).rglob(pattern)}
            self.assertEqual(names, {path.relative_to(share / installed) for path in (share / installed).rglob("*.*")})

    def test_the_notices_of_all_parts_are_installed(self):
        parts = [line.split("|") for line in (ROOT / "cmake" / "parts.txt").read_text().splitlines() if not line.startswith("#")]
        folder = self.prefix / "share" / "doc" / "rigcal"
        own = (ROOT / "LICENSE").read_text()
        for name in ("NOTICE", "copyright"):
            text = (folder / name).read_text()
            self.assertEqual(text.startswith(own), name == "copyright")
            for part, package, licence, _ in parts:
                self.assertIn(f"\n  {part}: {licence}; ", text)
                if package.startswith("npm:") or pathlib.Path(f"/usr/share/doc/{package}/copyright").is_file():
                    self.assertIn(f"\n======== {part}\n", text)
            self.assertIn("Leon Sorokin", text)  # the notice of uPlot

    def test_the_spdx_list_names_what_is_linked_and_what_is_compiled_in(self):
        if not shutil.which("dpkg-query"):
            self.skipTest("no packages of Debian")
        made = json.loads(run(sys.executable, ROOT / "scripts" / "spdx_list.py", "1.2.3", "2026-01-02T04:05:06+02:00", "libc6"))
        self.assertEqual((made["spdxVersion"], made["creationInfo"]["created"]), ("SPDX-2.3", "2026-01-02T02:05:06Z"))
        packages = {package["SPDXID"]: package for package in made["packages"]}
        self.assertEqual(len(packages), len(made["packages"]))
        for identifier, package in packages.items():
            self.assertRegex(identifier, r"^SPDXRef-[A-Za-z0-9.-]+$")
            self.assertLessEqual({"name", "versionInfo", "downloadLocation", "licenseDeclared"}, package.keys())
        names = {package["name"]: package for package in packages.values()}
        self.assertEqual(names["uPlot"]["licenseDeclared"], "MIT")
        self.assertIn("pkg:deb/debian/libc6@", names["libc6"]["externalRefs"][0]["referenceLocator"])
        related = {(each["relationshipType"], each["relatedSpdxElement"]) for each in made["relationships"]}
        self.assertIn(("DESCRIBES", "SPDXRef-rigcal"), related)
        self.assertEqual({identifier for _, identifier in related}, set(packages))

    def test_python_imports_the_module(self):
        modules = list(self.prefix.glob("lib/python3*/dist-packages"))
        if not (pathlib.Path(BUILD) / "python" / "rigcal").is_dir():
            self.skipTest("the module was not built")
        self.assertEqual(len(modules), 1)
        self.assertEqual({"__init__.py", "_rigcal.pyi", "errors.py", "notebook.py", "py.typed"},
                         {file.name for file in (modules[0] / "rigcal").iterdir() if file.suffix != ".so"})
        made = self.folder / "for_python"
        printed = run("/usr/bin/python3", "-B", "-c",
                      f"import rigcal; rig = rigcal.load({str(ROOT / 'docs' / 'tutorial' / 'known_rig.toml')!r})\n"
                      f"fit = rigcal.load(rig.synthesize({str(made)!r}, seed=1)).fit()\n"
                      "print(rigcal.__version__, fit.status, fit.parameter('mass').value)",
                      env={"PYTHONPATH": str(modules[0])})
        self.assertRegex(printed, r"^[\d.]+ converged 8[45]\.")  # the true value is 85 kg

    def test_the_manual_tells_every_verb_and_option(self):
        page = (self.prefix / "share" / "man" / "man1" / "rigcal.1").read_text().replace("\\-", "-")
        sections = {section.partition("\n")[0]: section for section in page.split(".SS ")[1:]}
        self.assertEqual(list(sections), self.verbs)
        for verb, options in self.options.items():
            self.assertIn("--json", options)
            for option in options:
                self.assertIn(f"\\fB{option}\\fR", sections[verb])

    def test_the_manual_renders_without_warnings(self):
        if not shutil.which("groff"):
            self.skipTest("no groff")
        page = self.prefix / "share" / "man" / "man1" / "rigcal.1"
        done = subprocess.run(["groff", "-man", "-ww", "-Tutf8", page], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_completions_have_every_verb_and_option(self):
        share = self.prefix / "share"
        for name, long in (("bash-completion/completions/rigcal", "--"), ("zsh/vendor-completions/_rigcal", "--"),
                           ("fish/vendor_completions.d/rigcal.fish", "-l ")):
            text = (share / name).read_text()
            for verb, options in self.options.items():
                self.assertRegex(text, rf"(?m)\b{verb}\b")
                for option in options:
                    self.assertIn(long + option[2:], text)

    def bash_completes(self, *words):
        script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); compopt() { :; }; _rigcal; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        return run("bash", "-c", script, "bash", self.prefix / "share/bash-completion/completions/rigcal", "rigcal",
                   *words).split()

    def test_bash_completes(self):
        self.assertEqual(self.bash_completes("va"), ["validate"])
        self.assertEqual(self.bash_completes("fit", "--boot"), ["--bootstrap"])
        self.assertEqual(self.bash_completes("init", str(ROOT / "LICEN")), [str(ROOT / "LICENSE")])

    def test_completions_are_read_by_their_shells(self):
        for shell, name in (("bash", "bash"), ("zsh", "zsh"), ("fish", "fish")):
            if shutil.which(shell):
                script = self.folder / f"completion.{shell}"
                script.write_text(run(self.rigcal, "--completion", name))
                run(shell, "-n", script)

    def test_an_unknown_shell_is_refused(self):
        for arguments in (["tcsh"], [], ["bash", "zsh"]):
            done = subprocess.run([self.rigcal, "--completion", *arguments], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn("expected bash, zsh, fish", done.stderr)


if __name__ == "__main__":
    BUILD, COMPILER = sys.argv.pop(1), sys.argv.pop(1)
    unittest.main()
