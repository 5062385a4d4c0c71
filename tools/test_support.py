"""What the tests of the scripts share."""

import pathlib
import subprocess
import sys
import tempfile
import unittest


class Folder(unittest.TestCase):
    """A folder of its own for every test, with files of its making."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def assert_only_fault(self, faults, *words):
        self.assertEqual(len(faults), 1, faults)
        for word in words:
            self.assertIn(word, faults[0])


class CampaignTable(Folder):
    """A script beside this one that sums up campaign.csv."""

    script, columns = "", ""

    def campaign(self, *rows):
        self.write("campaign.csv", self.columns + "".join(rows))

    def ask(self, *options, fails=False):
        program = pathlib.Path(__file__).with_name(self.script)
        done = subprocess.run([sys.executable, program, self.root / "campaign.csv", *options],
                              text=True, capture_output=True, check=False)
        self.assertEqual(done.returncode != 0, fails, done.stderr)
        return done.stderr if fails else done.stdout

    def page_between(self, begin, end):
        """The page after --page has replaced what stood between its markers."""
        page = self.write("page.md", f"above\n{begin}\nstale\n{end}\nbelow\n")
        self.ask("--page", str(page))
        text = page.read_text(encoding="utf-8")
        self.assertTrue(text.startswith("above\n") and text.endswith("\nbelow\n"))
        self.assertNotIn("stale", text)
        return text
