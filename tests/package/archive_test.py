"""Checks what scripts/package puts into the archive. usage: archive_test.py FOLDER (that of the archive, unpacked)"""
import json
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path += [str(ROOT / "scripts"), str(ROOT / "tests" / "package")]
from binaries_test import GLIBC_OF_LIBRARIES, debian_release  # noqa: E402
from linked_libraries import GLIBC, highest_glibc, packages_of  # noqa: E402

TREE = pathlib.Path()  # set by the command line


class Archive(unittest.TestCase):
    def setUp(self):
        self.libraries = sorted((TREE / "lib" / "rigcal").iterdir())
        self.binaries = [TREE / "bin" / "rigcal", *self.libraries]
        self.documents = TREE / "share" / "doc"

    def packages(self):
        """Returns the Debian package of each library in the archive."""
        loaded = subprocess.run(["ldconfig", "-p"], capture_output=True, text=True, check=True).stdout
        paths = {re.search(rf"^\s*{re.escape(library.name)} .* => (\S+)", loaded, re.MULTILINE).group(1): library.name
                 for library in self.libraries}
        return {paths[path]: package for path, package in packages_of(paths).items()}

    def test_it_asks_for_no_newer_glibc_than_documented(self):
        highest = max(map(highest_glibc, self.binaries))
        print("archive: asks for glibc", ".".join(map(str, highest)))
        self.assertLessEqual(highest, GLIBC_OF_LIBRARIES[debian_release()])

    def test_every_library_that_is_needed_is_there(self):
        there = {library.name for library in self.libraries}
        for binary in self.binaries:
            needs = subprocess.run(["readelf", "-dW", binary], capture_output=True, text=True, check=True).stdout
            for name in re.findall(r"\(NEEDED\).*\[(\S+)\]", needs):
                self.assertTrue(name in there or GLIBC.match(name), f"{binary.name} needs {name}")

    def test_every_library_has_a_notice_and_is_in_the_spdx_list(self):
        lists = list((self.documents / "rigcal").glob("rigcal-*.spdx.json"))
        self.assertEqual(len(lists), 1)
        entries = json.loads(lists[0].read_text())["packages"]
        # A part has a name of its own; its package is in the reference.
        listed = {entry["name"] for entry in entries} | {
            name for entry in entries for each in entry.get("externalRefs", ())
            for name in re.findall(r"^pkg:deb/debian/([^@]+)@", each["referenceLocator"])}
        packages = self.packages()
        self.assertGreater(len(packages), 10)
        for library, package in packages.items():
            self.assertGreater((self.documents / package / "copyright").stat().st_size, 0, library)
            self.assertIn(package, listed, library)
        folders = {folder.name for folder in self.documents.iterdir()} - {"rigcal"}
        self.assertEqual(folders - listed, set())
        parts = (ROOT / "cmake" / "parts.txt").read_text().splitlines()
        self.assertEqual({part.partition("|")[0] for part in parts if not part.startswith("#")} - listed, set())


if __name__ == "__main__":
    TREE = pathlib.Path(sys.argv.pop(1))
    unittest.main()
