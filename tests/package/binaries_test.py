"""Checks that the binaries are hardened and need no newer libraries than documented. usage: binaries_test.py BUILD"""
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.append(str(ROOT / "scripts"))
from linked_libraries import highest_glibc, libraries_of, packages_of  # noqa: E402

BUILD = pathlib.Path()  # set by the command line
FMU_GLIBC = (2, 34)  # docs/export.md
# The program and the libraries of a Debian release ask for no newer glibc than this (docs/install.md). It may be higher than
# that of the program alone.
GLIBC_OF_LIBRARIES = {"12": (2, 36), "13": (2, 41)}
# Packages whose headers are in every program: the compiler with its standard library, the kernel and glibc.
OF_THE_COMPILER = re.compile(r"libc6-dev|linux-libc-dev|lib(gcc|stdc\+\+)-\d+-dev|libclang-(common-|rt-)?\d+(-dev)?")


def debian_release():
    """Returns "12" on Debian 12."""
    release = re.search(r'^VERSION_ID="?([^"\n]*)', pathlib.Path("/etc/os-release").read_text(), re.MULTILINE)
    return release.group(1) if release else ""


def dpkg(form, packages):
    """Returns a field of each of these Debian packages that is installed."""
    found = subprocess.run(["dpkg-query", "-W", f"-f=${{binary:Package}}\t${{{form}}}\n", *sorted(packages)],
                           capture_output=True, text=True, check=False).stdout
    return {name.partition(":")[0]: value for name, value in (line.split("\t") for line in found.splitlines())}


def parts():
    """Returns the packages of cmake/parts.txt."""
    lines = (ROOT / "cmake" / "parts.txt").read_text().splitlines()
    return {line.split("|")[1] for line in lines if not line.startswith("#")}


def readelf(*arguments):
    return subprocess.run(["readelf", "-W", *map(str, arguments)], capture_output=True, text=True, check=True).stdout


class Binaries(unittest.TestCase):
    def setUp(self):
        self.made = [BUILD / "rigcal", BUILD / "model" / "rigcal_fmu.so", *BUILD.glob("rigcal_mpi.so"),
                     *BUILD.glob("python/rigcal/*.so")]

    def test_no_path_to_libraries_is_built_in(self):
        for path in self.made:
            self.assertNotRegex(readelf("-d", path), r"\((RUNPATH|RPATH)\)", path)

    def test_addresses_of_functions_are_bound_at_the_start_and_then_read_only(self):
        for path in self.made:
            self.assertRegex(readelf("-d", path), r"BIND_NOW|FLAGS_1\).*\bNOW\b", path)
            segments = readelf("-l", path)
            self.assertIn("GNU_RELRO", segments, path)
            self.assertRegex(segments, r"Elf file type is DYN", path)  # position-independent
            self.assertRegex(segments, r"GNU_STACK .* RW ", path)  # not executable

    def test_the_stack_and_writes_to_buffers_are_guarded(self):
        names = readelf("--dyn-syms", BUILD / "rigcal")
        self.assertIn("__stack_chk_fail", names)
        self.assertRegex(names, r"__\w+_chk@GLIBC")

    def test_one_hdf5_library_the_serial_one(self):
        loaded = subprocess.run(["ldd", BUILD / "rigcal"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(len(set(re.findall(r"^\s*(libhdf5(?:_serial|_openmpi|_mpich)?\.so\S*)", loaded, re.M))), 1)
        self.assertNotIn("libmpi", loaded)

    def test_the_library_of_an_fmu_loads_with_an_older_glibc(self):
        highest = highest_glibc(BUILD / "model" / "rigcal_fmu.so")
        self.assertGreaterEqual(highest, (2, 0))
        self.assertLessEqual(highest, FMU_GLIBC, [line for line in
                             readelf("--dyn-syms", BUILD / "model" / "rigcal_fmu.so").splitlines()
                             if any(int(minor) > FMU_GLIBC[1] for minor in re.findall(r"GLIBC_2\.(\d+)", line))])

    def test_the_program_and_its_libraries_need_no_newer_glibc_than_documented(self):
        bound = GLIBC_OF_LIBRARIES.get(debian_release())
        if bound is None:
            self.skipTest("no documented release of Debian")
        libraries = libraries_of(BUILD / "rigcal")
        self.assertGreater(len(libraries), 10)
        for binary in [BUILD / "rigcal", *libraries]:
            self.assertLessEqual(highest_glibc(binary), bound, binary)
        text = (ROOT / "docs" / "install.md").read_text()
        documented = re.search(r"linux-amd64\.tar\.gz` \| any Linux with glibc ([\d.]+) or later", text).group(1)
        self.assertEqual(tuple(map(int, documented.split("."))), GLIBC_OF_LIBRARIES["12"])

    def test_every_library_has_a_notice_that_the_packages_can_take(self):
        if not shutil.which("dpkg-query"):
            self.skipTest("no packages of Debian")
        for library, package in packages_of(libraries_of(BUILD / "rigcal")).items():
            notice = pathlib.Path("/usr/share/doc") / package / "copyright"
            self.assertTrue(notice.is_file() and notice.stat().st_size > 0, library)

    def test_what_is_compiled_in_is_in_the_list_of_parts(self):
        """Headers and static libraries come from packages that parts.txt lists, or belong to a library that is linked.
        The Python module and the library for mpirun are built where they are used, and are in no package."""
        if not shutil.which("dpkg-query"):
            self.skipTest("no packages of Debian")
        ninja = [shutil.which("ninja") or "ninja", "-C", str(BUILD), "-t"]
        dependencies = subprocess.run([*ninja, "deps"], capture_output=True, text=True, check=True).stdout
        command = subprocess.run([*ninja, "commands", "rigcal"], capture_output=True, text=True, check=True).stdout
        built = re.findall(r"^(?!tests/|bench/|python/|\S*rigcal_mpi)\S+: #deps[^\n]*\n((?:    [^\n]*\n)+)", dependencies, re.MULTILINE)
        files = {path for block in built for path in re.findall(r"^    (/usr/\S+)", block, re.MULTILINE)}
        archives = set(re.findall(r"(?<=\s)/usr/\S+\.a\b", command.splitlines()[-1]))
        # Ceres is a static library in Debian 12 and a shared one in Debian 13.
        self.assertNotEqual(any("libceres" in path for path in archives),
                            any("libceres" in str(path) for path in libraries_of(BUILD / "rigcal")))
        self.assertGreater(len(files), 100)
        found = subprocess.run(["dpkg-query", "-S", *sorted(files | archives)], capture_output=True, text=True, check=False).stdout
        packages = {line.partition(":")[0] for line in found.splitlines()}
        packages = {package for package in packages if not OF_THE_COMPILER.fullmatch(package)}
        self.assertGreater(len(packages), 10)
        linked = set(packages_of(libraries_of(BUILD / "rigcal")).values())
        sources = dpkg("source:Package", packages | linked)
        of_linked = {sources[package] for package in linked}
        listed = parts() | {name.split()[0] for needs in dpkg("Depends", parts()).values() if needs for name in needs.split(", ")}
        self.assertEqual({package for package in packages if package not in listed and sources[package] not in of_linked}, set())
        # The archives are compiled in, whatever else of their package is linked.
        self.assertLessEqual(set(packages_of(archives).values()), parts())


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1))
    unittest.main()
