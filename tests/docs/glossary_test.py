"""Checks that every name in the last column of docs/glossary.md occurs in the sources, so that
the glossary stays up to date."""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ["common", "model", "metrics", "datasets", "calib", "diagnosis", "report", "apps"]


def names():
    """Yields (line number, name) for each `name` in the last column."""
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


    def test_the_two_main_words_are_defined_as_the_model_has_them(self):
        rows = {cells[0].strip(): cells[1] for line in (ROOT / "docs" / "glossary.md").read_text().splitlines()
                if line.startswith("|") and len(cells := line.strip("|").split("|")) == 3}
        specification = (ROOT / "model" / "plant" / "parameter_values.hpp").read_text()
        meaning = re.search(r'"leakage_coefficient", "C_leak", "1", "([^;"]+)', specification).group(1)
        self.assertIn(meaning.split(" of ")[0], rows["leakage coefficient"])  # a discharge coefficient
        self.assertNotIn("per unit", rows["leakage coefficient"])
        self.assertRegex(rows["share"], "fraction of the servo flow")


if __name__ == "__main__":
    sys.exit(unittest.main())
