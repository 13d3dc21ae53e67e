"""Checks that scripts/docs-numbers compares, writes and skips blocks. usage: numbers_test.py"""
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
STALE = "Text.\n\n<!-- numbers: echo 7 of 9 -->\n\n6 of 9\n\n<!-- end of numbers -->\n\nMore text.\n"


def document_with(command, body="\n"):
    return f"<!-- numbers: {command} -->\n{body}<!-- end of numbers -->\n"


class Numbers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.document = self.folder / "document.md"

    def numbers(self, text, *options, **environment):
        """Returns exit code, standard output and error, and the document afterwards."""
        self.document.write_text(text)
        done = subprocess.run([ROOT / "scripts" / "docs-numbers", *options, self.document], capture_output=True, text=True,
                              check=False, env={**os.environ, "RIGCAL_DATA": str(self.folder), "RIGCAL_RUNS": str(self.folder / "runs"), **environment})
        return done.returncode, done.stdout, done.stderr, self.document.read_text()

    def test_a_stale_block_is_shown_and_stays(self):
        code, shown, _, left = self.numbers(STALE)
        self.assertEqual(code, 1)
        self.assertIn("\n-6 of 9\n+7 of 9\n", shown)
        self.assertEqual(left, STALE)

    def test_a_written_block_is_what_its_command_prints(self):
        code, _, _, left = self.numbers(STALE, "--write")
        self.assertEqual((code, left), (0, STALE.replace("6 of 9", "7 of 9")))
        self.assertEqual(self.numbers(left)[:2], (0, ""))

    def test_the_last_digit_of_a_decimal_may_differ_by_one(self):
        printed = "echo x = 12.34 to -0.50e-3, 7 of 9"
        for shown, code in (("x = 12.35 to -0.51e-3, 7 of 9", 0), ("x = 12.33 to -0.49e-3, 7 of 9", 0),
                            ("x = 12.36 to -0.50e-3, 7 of 9", 1), ("x = 12.34 to -0.50e-4, 7 of 9", 1),
                            ("x = 12.3 to -0.50e-3, 7 of 9", 1), ("x = 12.34 to 0.50e-3, 7 of 9", 1),
                            ("x = 12.34 to -0.50e-3, 6 of 9", 1), ("y = 12.34 to -0.50e-3, 7 of 9", 1)):
            text = document_with(printed, f"\n{shown}\n\n")
            self.assertEqual(self.numbers(text)[0], code, shown)
            self.assertEqual(self.numbers(text, "--write")[3] == text, code == 0, shown)

    def test_a_fence_stays(self):
        text = document_with("echo 7", "\n```text\n6\n```\n\n")
        self.assertEqual(self.numbers(text, "--write")[3], text.replace("6", "7"))

    def test_a_document_without_blocks_stays(self):
        text = "6 of 9, between `<!-- numbers: COMMAND -->` and `<!-- end of numbers -->`\n"
        self.assertEqual(self.numbers(text, "--write"), (0, "", "", text))

    def test_absent_recordings_are_skipped(self):
        text = document_with("ls {data}/unknown_rig", "\nkept\n\n")
        code, _, told, left = self.numbers(text, "--write")
        self.assertEqual((code, left), (0, text))
        self.assertIn("skipped: no recordings unknown_rig", told)

    def test_recordings_that_are_there_are_read(self):
        (self.folder / "rig").mkdir()
        (self.folder / "rig" / "record.csv").touch()
        self.assertIn("\nrecord.csv\n", self.numbers(document_with("ls {data}/rig"), "--write")[3])

    def test_runs_whose_recordings_are_absent_are_skipped(self):
        code, _, told, _ = self.numbers(document_with("ls {results}/festo") + document_with("ls {results}/festo"))
        self.assertEqual(code, 0)
        self.assertEqual(told.count("skipped: no recordings festo_tp511_servo_cylinder"), 2)

    def test_what_fails_is_no_number(self):
        for command, words in (("false", "exit code 1"), ("ls {results}/unknown", "no run unknown")):
            code, _, told, left = self.numbers(document_with(command), "--write")
            self.assertEqual((code, left), (2, document_with(command)))
            self.assertIn(words, told)

    def program(self, exit_code):
        """Makes a substitute for rigcal, which creates the --out folder and exits with this
        code."""
        program = self.folder / f"program_{exit_code}"
        program.write_text(f'#!/bin/sh\nwhile [ "$1" != --out ]; do shift; done\nmkdir "$2"\nexit {exit_code}\n')
        program.chmod(0o755)
        return str(program)

    def test_a_verdict_is_a_result_and_a_failure_none(self):
        for ends, wanted in ((0, 0), (1, 0), (2, 2), (3, 2), (4, 2)):
            code, _, told, _ = self.numbers(document_with("ls {results}/leak_table"), "--write", RIGCAL=self.program(ends))
            self.assertEqual(code, wanted, told)

    def test_a_run_is_made_again_only_for_another_program(self):
        program = self.folder / "program"
        for text, shown in (("one", "one"), ("one", "one"), ("two", "two")):
            program.write_text(f'#!/bin/sh\nwhile [ "$1" != --out ]; do shift; done\nmkdir "$2"\necho {text} > "$2/told"\necho >> {self.folder}/calls\n')
            program.chmod(0o755)
            left = self.numbers(document_with("cat {results}/leak_table/told"), "--write", RIGCAL=str(program))[3]
            self.assertIn(f"\n{shown}\n", left)
        self.assertEqual((self.folder / "calls").read_text(), "\n\n")

    def test_a_block_needs_its_end(self):
        for text in ("<!-- numbers: echo 7 -->\n6\n", "6\n<!-- end of numbers -->\n"):
            self.assertEqual(self.numbers(text)[0], 2)

    def test_scratch_is_empty_for_every_block(self):
        block = document_with("sh -c 'ls {scratch}; touch {scratch}/left'")
        self.assertNotIn("left\n", self.numbers(block + block, "--write")[3].replace("/left", ""))


if __name__ == "__main__":
    unittest.main()
