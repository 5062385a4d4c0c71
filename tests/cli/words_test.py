"""The words of the command line: help, slips, exit codes.

Usage: words_test.py PROGRAM [unittest arguments]
"""

import os
import re
import subprocess

from support import Folder, PROGRAM, run, main


class Words(Folder):
    def test_help_and_version_are_answers(self):
        self.assertIn("measure", run("--help", check_code=0).stdout)
        self.assertRegex(run("--version", check_code=0).stdout, r"^manoscope \d+\.\d+\.\d+ \(")

    def test_every_command_explains_itself_with_its_common_options(self):
        commands = re.findall(r"^  ([a-z]+) ", run("--help", check_code=0).stdout, re.M)
        for known in ("demo", "init", "check", "inspect", "convert", "formats", "measure", "judge",
                      "report", "serve", "twin"):
            self.assertIn(known, commands)
        for command in commands:
            text = run(command, "--help", check_code=0).stdout
            for option in ("--threads", "--seed", "--quiet", "--json", "--progress"):
                self.assertIn(option, text, command)

    def test_a_slip_in_a_command_is_the_users_and_is_answered_with_the_near_word(self):
        done = run("mesure", check_code=2)
        self.assertIn('did you mean "measure"', done.stderr)
        self.assertEqual(done.stdout, "")
        run(check_code=2)
        run("measure", check_code=2)
        run("measure", "x", "-o", "y", "--no-such-option", check_code=2)

    def test_a_length_without_unit_is_refused(self):
        done = run("measure", "x", "-o", "y", "--shift-uncertainty", "5", check_code=2)
        self.assertIn("has no unit", done.stderr)

    def test_a_missing_experiment_is_named(self):
        done = run("measure", self.folder / "absent", "-o", self.folder / "out", check_code=2)
        self.assertIn("absent", done.stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_output_that_cannot_be_written_is_an_error(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("this machine has no /dev/full")
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "formats"], stdout=full, stderr=subprocess.PIPE,
                                  text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("standard output", done.stderr)


if __name__ == "__main__":
    main()
