"""Checks that scripts/docs runs the commands in a document, and finds broken links. usage:
site_test.py"""
import importlib.machinery
import importlib.util
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def console(*lines, shown=None):
    before = f"<!-- shown: {shown} -->\n" if shown else ""
    return before + "".join(f"{line}\n" for line in ("```console", *lines, "```"))


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def docs(self, *arguments):
        """Returns exit code, standard output and error."""
        done = subprocess.run([ROOT / "scripts" / "docs", *arguments], capture_output=True, text=True, check=False,
                              env={**os.environ, "RIGCAL": "/bin/true"})
        return done.returncode, done.stdout, done.stderr


class Shown(Folder):
    def check(self, text, option="--check"):
        document = self.folder / "document.md"
        document.write_text(text)
        return *self.docs(option, document), document.read_text()

    def test_what_a_command_prints_is_compared(self):
        code, shown, _, left = self.check("Text.\n" + console("$ echo 7", "6"))
        self.assertEqual(code, 1)
        self.assertIn("\n-6\n+7\n", shown)
        self.assertIn("\n6\n", left)
        self.assertEqual(self.check(console("$ echo 7", "7"))[0], 0)

    def test_the_last_digit_may_differ_by_one(self):
        for printed, code in (("1.23", 0), ("1.24", 0), ("1.25", 1), ("1.2", 1)):
            self.assertEqual(self.check(console(f"$ echo {printed}", "1.23"))[0], code)

    def test_output_is_written(self):
        text = console("$ echo 7 8", "$ echo 9", "old")
        self.assertEqual(self.check(text, "--write")[3], console("$ echo 7 8", "7 8", "$ echo 9", "9"))

    def test_commands_share_a_folder_and_some_are_not_shown(self):
        text = "<!-- run: echo 5 > kept -->\n" + console("$ cat kept", "5") + console("$ ls", "kept")
        self.assertEqual(self.check(text)[:2], (0, ""))

    def test_part_of_the_output_is_shown(self):
        text = console("$ seq 9", "1", "2", "...", shown="1,2p")
        self.assertEqual(self.check(text)[:2], (0, ""))

    def test_what_fails_is_no_output(self):
        for ending, wanted in ((0, 0), (1, 0), (2, 2), (127, 2)):
            self.assertEqual(self.check(console(f"$ exit {ending}"))[0], wanted)

    def test_keys_are_those_of_the_campaign(self):
        for line, wanted in (("rho2 = 0.99", 0), ("rho2 = 0.5", 2)):
            self.assertEqual(self.check(f"```toml\n{line}\n```\n")[0], wanted)


class Links(Folder):
    def problems(self, **pages):
        for name, text in pages.items():
            (self.folder / f"{name}.html").write_text(text)
        code, shown, _ = self.docs("--links", self.folder)
        self.assertEqual(code, 1 if shown else 0)
        return shown

    def test_links_within_the_site(self):
        self.assertEqual(self.problems(a='<a href="b.html#x">b</a><a href="#">top</a>', b='<p id="x">'), "")
        self.assertEqual(self.problems(a='<a href="c.html">c</a>'), "a.html: no c.html\n")
        self.assertEqual(self.problems(a='<a href="b.html#y">b</a>'), "a.html: no place b.html#y\n")
        self.assertEqual(self.problems(a='<img src="p.png">'), "a.html: no p.png\n")

    def test_links_out_are_not_followed_but_nothing_is_fetched_from_there(self):
        self.assertEqual(self.problems(a='<a href="https://example.org/">e</a>'), "")
        for tag in ('<script src="https://example.org/s.js">', '<link href="//example.org/s.css">'):
            self.assertIn("a.html: fetches ", self.problems(a=tag))


class Navigation(unittest.TestCase):
    def test_every_document_is_in_it(self):
        navigation = (ROOT / "mkdocs.yml").read_text()
        for path in (ROOT / "docs").glob("*.md"):  # decisions have a page of their own
            self.assertIn(f": {path.relative_to(ROOT / 'docs')}\n", navigation)


class Gallery(unittest.TestCase):
    def test_every_shipped_rig_is_in_it(self):
        loader = importlib.machinery.SourceFileLoader("gallery", str(ROOT / "scripts" / "gallery"))
        gallery = importlib.util.module_from_spec(importlib.util.spec_from_loader("gallery", loader))
        loader.exec_module(gallery)
        shown = {pathlib.PurePath(gallery.RUNS[entry.run].arguments.split()[1]).parent.name for entry in gallery.ENTRIES}
        self.assertEqual(shown, {path.name for path in (ROOT / "datasets" / "rigs").iterdir()})
        for entry in gallery.ENTRIES:
            self.assertTrue(entry.document == "" or (ROOT / "docs" / entry.document).is_file(), entry)

    def test_without_recordings_a_rig_is_left_out(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([ROOT / "scripts" / "gallery", "--out", folder, "--without-pictures", "festo"], capture_output=True,
                                  text=True, check=False, env={**os.environ, "RIGCAL": "/bin/true", "RIGCAL_DATA": folder, "RIGCAL_RUNS": f"{folder}/runs"})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("gallery: without festo: no recordings festo_tp511_servo_cylinder in ", done.stderr)
            self.assertEqual((pathlib.Path(folder) / "gallery.json").read_text(), "[]")


if __name__ == "__main__":
    unittest.main()
