"""Every name in the last column of docs/glossary.md occurs in the sources, so that the glossary stays up to date."""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ["common", "model", "metrics", "datasets", "calib", "diagnosis", "report", "apps"]


def names():
    """(line number, name) of each `name` in the last column."""
    for number, line in enumerate((ROOT / "docs" / "glossary.md").read_text().splitlines(), 1):
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("|") and len(cells) == 3:
            for name in re.findall("`([^`]+)`", cells[2]):
                yield number, name


class Glossary(unittest.TestCase):
    def test_names_stand_in_the_sources(self):
        text = "\n".join(path.read_text() for folder in FOLDERS for path in (ROOT / folder).rglob("*.[ch]pp"))
        found = list(names())
        self.assertGreater(len(found), 30)
        for number, name in found:
            with self.subTest(line=number, name=name):
                if "/" in name:
                    self.assertTrue((ROOT / name).is_dir() or (ROOT / f"{name}.hpp").is_file())
                else:
                    for part in re.findall(r"\w+", name):
                        self.assertRegex(text, rf"\b{part}\b")


if __name__ == "__main__":
    sys.exit(unittest.main())
