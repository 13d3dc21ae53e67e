"""Checks that scripts/prose finds what it is meant to find, and nothing else. usage:
prose_test.py"""
import importlib.machinery
import importlib.util
import pathlib
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WORDS = "one two three four five six seven eight nine ten " * 3  # the maximum length of a sentence


def prose():
    loader = importlib.machinery.SourceFileLoader("prose", str(ROOT / "scripts" / "prose"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("prose", loader))
    loader.exec_module(module)
    return module


class Documents(unittest.TestCase):
    def places(self, text):
        """Returns the numbers of the lines with a violation."""
        return [line for line, _ in prose().problems_of_document(text)]

    def test_a_sentence_has_thirty_words_at_most(self):
        self.assertEqual(self.places(f"Short.\n\n{WORDS.strip()}.\n"), [])
        self.assertEqual(self.places(f"Short.\n\n{WORDS}more.\n"), [3])
        self.assertEqual(self.places(f"- item\n- {WORDS}more.\n"), [2])
        self.assertEqual(self.places(f"| cell | {WORDS}more |\n"), [1])

    def test_where_a_sentence_ends(self):
        half = " ".join(WORDS.split()[:15])
        for end in (".", ".**", ".)", "?"):
            self.assertEqual(self.places(f"{half}{end} Then {half}."), [], end)
        for no_end in ("e.g.", ",", "1.5"):
            self.assertEqual(self.places(f"{half} {no_end} Then {half}."), [1], no_end)

    def test_a_list_of_code_is_one_word(self):
        names = ", ".join(f"`key_{number}`" for number in range(40))
        self.assertEqual(self.places(f"It has {names} and `last`.\n"), [])
        self.assertEqual(self.places(f"It has {names.replace('`,', '` x,')}.\n"), [1])

    def test_blocks_of_code_are_no_prose(self):
        self.assertEqual(self.places(f"Text:\n\n    a_name {WORDS}more\n\nText.\n"), [])
        self.assertEqual(self.places(f"```\na_name {WORDS}more\n```\n"), [])
        self.assertEqual(self.places("- item\n\n    a_name in its second paragraph\n"), [3])

    def test_names_and_units(self):
        self.assertEqual(self.places("The `bulk_modulus` is 3 m³/Pa or 5 µm.\n"), [])
        self.assertEqual(self.places("The mass m<sub>2</sub> adds to m.\n"), [])
        for words in ("The bulk_modulus rises.", "It is 3 m3/Pa.", "It is 5 um thick.", "It is 2 cm2."):
            self.assertEqual(self.places(f"{words}\n"), [1], words)


class Sources(unittest.TestCase):
    def places(self, path, text):
        return [line for line, _ in prose().problems_of_source(pathlib.Path(path), text)]

    def test_comments_and_docstrings_do_not_continue_their_name(self):
        self.assertEqual(self.places("calib/fit.hpp", "int n;  ///< of the fit\nint m;  ///< number of fits\n"), [1])
        self.assertEqual(self.places("python/fits.cpp", 'int n;\n(a, "Of the solver.")\n(a, "Steps of it.")\n'), [2])
        self.assertEqual(self.places("report/page.cpp", '(a, "Of the solver.")\n'), [])

    def test_messages_avoid_overused_verbs(self):
        self.assertEqual(self.places("calib/fit.cpp", 'fail("nothing tells them apart");\n'), [1])
        self.assertEqual(self.places("tests/calib/fit_test.cpp", 'fail("nothing tells them apart");\n'), [])


if __name__ == "__main__":
    unittest.main()
