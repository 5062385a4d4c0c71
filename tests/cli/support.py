"""What the tests of the command line share."""

import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

# The program is the first word after the name of the test.
PROGRAM = sys.argv.pop(1)

# Head of a scenario whose wall is told by a formula and seen by a small camera: a moment's work.
TAUT_MEMBRANE = """scenario = 1
name = "taut"
[channel]
length = "8 mm"
width = "1 mm"
height = "100 um"
[wall]
law = "tapered_membrane"
thickness = "0.3 um"
youngs_modulus = "250 GPa"
poisson_ratio = 0.23
prestress = "50 MPa"
[camera]
n_along = 400
n_across = 40
noise = "5 nm"
shift = "6.4 um"
blobs = 0.0
"""


def run(*arguments, cwd=None, check_code=None):
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, text=True, encoding="utf-8",
                          capture_output=True, stdin=subprocess.DEVNULL, timeout=300)
    if check_code is not None:
        assert done.returncode == check_code, (done.returncode, done.stdout, done.stderr)
    return done


def hashes(folder):
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


class Folder(unittest.TestCase):
    """A folder of its own for every test."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="manoscope_cli_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)


class DemoFolder(unittest.TestCase):
    """One demo, in self.out, serves all tests of a class: they only look at it."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="manoscope_cli_"))
        cls.out = cls.folder / "demo"
        cls.done = run("demo", "-o", cls.out, check_code=0)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def renamed(self, name):
        """A copy of the demo's experiment under another name."""
        other = self.folder / name
        shutil.copytree(self.out / "experiment", other)
        path = other / "experiment.toml"
        path.write_text(re.sub(r'(?m)^name = .*$', f'name = "{name}"', path.read_text()))
        return other


def main():
    unittest.main(module="__main__")
