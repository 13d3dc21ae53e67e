"""Tests which tests untested.py selects, with builds of a small project."""
import pathlib
import subprocess
import tempfile
import unittest

UNTESTED = pathlib.Path(__file__).resolve().parent / "untested.py"
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(small NONE)
enable_testing()
add_test(NAME "a: passes" COMMAND ${CMAKE_COMMAND} -E true)
add_test(NAME "a: must fail" COMMAND ${CMAKE_COMMAND} -E false)
set_tests_properties("a: must fail" PROPERTIES WILL_FAIL ON)
add_test(NAME "a: fails (here)" COMMAND ${CMAKE_COMMAND} -E false)
add_test(NAME "a: skipped without a word" COMMAND ${CMAKE_COMMAND} -E false)
set_tests_properties("a: skipped without a word" PROPERTIES SKIP_RETURN_CODE 1)
add_test(NAME "a: skipped" COMMAND ${CMAKE_COMMAND} -E echo "skipped: no browser")
set_tests_properties("a: skipped" PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped")
add_test(NAME "a: in part" COMMAND ${CMAKE_COMMAND} -E echo "OK (skipped=1)")
add_test(NAME "a: depends on packages" COMMAND ${CMAKE_COMMAND} -E true)
set_tests_properties("a: depends on packages" PROPERTIES LABELS python)
if(MORE)
  add_test(NAME "a: known to one build" COMMAND ${CMAKE_COMMAND} -E true)
endif()
"""
LEFT = ["a: fails (here)", "a: skipped without a word", "a: skipped", "a: in part", "a: depends on packages", "a: known to one build"]


def run(*arguments):
    return subprocess.run(list(map(str, arguments)), capture_output=True, text=True, check=False)


class Untested(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "CMakeLists.txt").write_text(PROJECT)
        self.build, self.other = self.folder / "build", self.folder / "other"
        for build, more in ((self.build, "ON"), (self.other, "OFF")):
            made = run("cmake", "-G", "Ninja", "-S", self.folder, "-B", build, f"-DMORE={more}")
            self.assertEqual(made.returncode, 0, made.stderr)

    def test_what_did_not_pass_in_full_is_left(self):
        run("ctest", "--test-dir", self.other)
        pattern = run(UNTESTED, self.build, self.other).stdout.strip()
        listed = run("ctest", "--test-dir", self.build, "-N", "-R", pattern).stdout
        names = [line.partition(": ")[2] for line in listed.splitlines() if line.startswith("  Test ")]
        self.assertEqual(names, LEFT)

    def test_a_build_without_a_passed_test_is_refused(self):
        self.assertNotEqual(run(UNTESTED, self.build, self.other).returncode, 0)
        run("ctest", "--test-dir", self.other, "-R", "fails")
        self.assertNotEqual(run(UNTESTED, self.build, self.other).returncode, 0)


if __name__ == "__main__":
    unittest.main()
