#!/usr/bin/env python3
"""Tests of install_packages.sh with made-up dpkg-query, apt-get, id and sudo.

python3 tools/install_packages_test.py
"""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parent / "install_packages.sh"
# What the script needs besides the made-up commands.
ORDINARY = ("bash", "env", "awk", "sed", "tr", "dirname", "cat")

LIST = """# a list
[build]  # tools
make
g++   # compiler
[tests]
libgtest-dev
make
[large-ones] optional  # only by name
libdeal.ii-dev
"""


class InstallPackages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.log = self.root / "log"
        self.log.touch()
        self.commands = self.root / "bin"
        self.commands.mkdir()
        for name in ORDINARY:
            (self.commands / name).symlink_to(shutil.which(name))
        (self.root / "list.txt").write_text(LIST)
        self.command("apt-get", f'echo "apt-get $*" >> {self.log}')
        self.user(0)
        self.installed("make")

    def command(self, name, body):
        path = self.commands / name
        path.write_text(f"#!/bin/sh\n{body}\n")
        path.chmod(0o755)

    def user(self, number):
        self.command("id", f"echo {number}")

    def installed(self, *names):
        """dpkg-query as it is: knows these packages, complains of others; g++ was once removed."""
        lines = "; ".join(f"echo 'installed {name}'" for name in names) or "true"
        self.command("dpkg-query", f"{lines}; echo 'config-files g++'; echo unknown >&2; exit 1")

    def run_script(self, *arguments):
        environment = {
            "PATH": str(self.commands),
            "MANOSCOPE_PACKAGE_LIST": str(self.root / "list.txt"),
        }
        return subprocess.run(
            [shutil.which("bash"), str(SCRIPT), *arguments],
            env=environment, capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL,
        )

    def calls(self):
        return self.log.read_text().splitlines()

    def test_lists_the_packages_of_the_groups_each_once(self):
        self.assertEqual(self.run_script("--list").stdout.split(), ["make", "g++", "libgtest-dev"])
        self.assertEqual(self.run_script("--list", "tests").stdout.split(), ["libgtest-dev", "make"])
        self.assertEqual(self.calls(), [])

    def test_an_optional_group_is_taken_by_name_alone(self):
        self.assertNotIn("libdeal.ii-dev", self.run_script("--list").stdout)
        self.assertEqual(self.run_script("--list", "large-ones").stdout.split(), ["libdeal.ii-dev"])

    def test_says_and_does_nothing_where_nothing_is_missing(self):
        self.installed("make", "g++", "libgtest-dev")
        self.user(1000)
        run = self.run_script()
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""))
        self.assertEqual(self.calls(), [])

    def test_installs_only_what_is_missing_of_the_group_asked_for(self):
        run = self.run_script("tests")
        self.assertEqual(run.returncode, 0, run.stderr)
        update, install = self.calls()
        self.assertIn(" update", update)
        self.assertIn("--no-install-recommends", install)
        self.assertTrue(install.endswith(" libgtest-dev"), install)
        self.assertNotIn("make", install)

    def test_a_package_removed_with_its_settings_kept_is_missing(self):
        self.assertEqual(self.run_script("build").returncode, 0)
        self.assertTrue(self.calls()[-1].endswith(" g++"), self.calls())

    def test_goes_through_sudo_where_it_is_not_root(self):
        self.user(1000)
        self.command("sudo", f'echo "sudo $*" >> {self.log}; exec "$@"')
        self.assertEqual(self.run_script("tests").returncode, 0)
        calls = self.calls()
        self.assertEqual(len([call for call in calls if call.startswith("sudo ")]), 2)
        self.assertIn("DEBIAN_FRONTEND=noninteractive", calls[0])
        self.assertEqual(len([call for call in calls if call.startswith("apt-get ")]), 2)

    def test_without_root_and_sudo_it_says_what_to_run(self):
        self.user(1000)
        run = self.run_script("tests")
        self.assertEqual(run.returncode, 1)
        self.assertIn("no sudo", run.stderr)
        self.assertIn("apt-get install --no-install-recommends libgtest-dev", run.stderr)
        self.assertEqual(self.calls(), [])

    def test_without_apt_it_says_what_to_install(self):
        (self.commands / "apt-get").unlink()
        run = self.run_script("tests")
        self.assertEqual(run.returncode, 1)
        self.assertIn("libgtest-dev make", run.stderr)
        self.assertIn("PACKAGES=no", run.stderr)

    def test_a_failed_update_still_tries_the_lists_at_hand(self):
        self.command("apt-get", f'echo "apt-get $*" >> {self.log}; [ "$1" != update ]')
        self.assertEqual(self.run_script("tests").returncode, 0)
        self.assertEqual(len(self.calls()), 2)

    def test_a_failed_installation_is_an_error_that_names_the_packages(self):
        self.command("apt-get", '[ "$1" = update ]')
        run = self.run_script("tests")
        self.assertEqual(run.returncode, 1)
        self.assertIn("libgtest-dev", run.stderr)

    def test_an_unknown_group_is_answered_with_those_there_are(self):
        run = self.run_script("texts")
        self.assertEqual(run.returncode, 1)
        self.assertIn("texts", run.stderr)
        self.assertIn("build tests", run.stderr)


if __name__ == "__main__":
    unittest.main()
