"""Checks that the binaries are hardened and need no newer libraries than documented. usage: binaries_test.py BUILD"""
import pathlib
import re
import subprocess
import sys
import unittest

BUILD = pathlib.Path()  # set by the command line
FMU_GLIBC = (2, 34)  # docs/export.md


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
        needs = readelf("-V", BUILD / "model" / "rigcal_fmu.so")
        versions = {tuple(map(int, found.split("."))) for found in re.findall(r"GLIBC_([\d.]+)", needs)}
        self.assertTrue(versions)
        self.assertLessEqual(max(versions), FMU_GLIBC, [line for line in
                             readelf("--dyn-syms", BUILD / "model" / "rigcal_fmu.so").splitlines()
                             if any(int(minor) > FMU_GLIBC[1] for minor in re.findall(r"GLIBC_2\.(\d+)", line))])


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1))
    unittest.main()
