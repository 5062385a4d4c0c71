#!/usr/bin/env python3
"""Tests of check_docs.py on small made-up projects: python3 tools/check_docs_test.py"""

import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
import check_docs
import test_support

PROGRAM = """#!/bin/sh
if [ "$1" = twin ] && [ "$2" != --help ]; then
  grep -q 'name = "sound"' "$2" || { echo 'name is missing' >&2; exit 2; }
elif [ "$1" = measure ]; then
  echo 'Usage: manoscope measure [OPTIONS] experiment'
  echo '  -o,--output TEXT  where a word such as predict may stand'
else
  echo 'Options:'
  echo '  -h,--help    this text'
  echo '  --threads N  number of threads'
  echo ''
  echo 'Subcommands:'
  echo '  demo         shows the whole chain'
  echo '  measure      measures, without'
  echo '               simulate in a second line'
fi
"""


class CheckDocs(test_support.Folder):
    def setUp(self):
        super().setUp()
        self.write("build/manoscope", PROGRAM).chmod(0o755)
        self.write("Makefile", "BUILD ?= build\nall: program\ndemo test: all\n")
        self.write("docs/flow.md", "# The flow\n\n## In `x` and y, at once\n")

    def faults(self, readme):
        self.write("README.md", readme)
        program = check_docs.Program(self.root / "build" / "manoscope")
        return check_docs.check(self.root, program)

    def assert_one_fault(self, readme, *words):
        self.assert_only_fault(self.faults(readme), *words)

    def test_a_scenario_must_be_one_that_the_program_makes(self):
        sound = '# A\n```toml\nscenario = 1\nname = "sound"\n```\n'
        self.assertEqual(self.faults(sound), [])
        self.assertEqual(self.faults('```toml\nmanoscope = 1\n```\n'), [])  # not a scenario
        self.assert_one_fault(sound.replace("sound", "faulty"), "README.md:3", "name is missing")

    def test_good_links_pass(self):
        self.assertEqual(
            self.faults(
                "# A b\n[a](docs/flow.md) ![b](<docs/flow.md>) [c](https://example.org/x.md)\n"
                "[d](docs/flow.md#in-x-and-y-at-once) [e](#a-b) [f]: `[no](link.md)`\n"
                "[ref]: docs/flow.md\n```\n[g](in-code.md)\n```\n"
            ),
            [],
        )

    def test_a_link_to_nothing_is_found_with_its_line(self):
        self.assert_one_fault("\n[a](docs/none.md)\n", "README.md:2:", "docs/none.md")

    def test_a_missing_picture_is_found_in_markdown_and_html(self):
        self.assert_one_fault("![p(x)](docs/p.svg)\n", "docs/p.svg")
        self.assert_one_fault('<img width="600" src="docs/p.svg">\n', "docs/p.svg")

    def test_a_reference_to_nothing_is_found(self):
        self.assert_one_fault("[a][b]\n\n[b]: docs/none.md\n", "docs/none.md")

    def test_a_fragment_without_its_heading_is_found(self):
        self.assert_one_fault("[a](docs/flow.md#the-wall)\n", "no such heading")

    def test_a_link_out_of_the_project_is_refused(self):
        self.assert_one_fault("[a](../)\n", "outside the project")

    def test_known_commands_pass(self):
        self.assertEqual(
            self.faults(
                "```sh\nmake && build/manoscope demo  # shows\n$ make -j 2 BUILD=b test\n"
                "manoscope measure a \\\n  --output b --threads 2 | less\nmanoscope --version\n```\n"
                "```\nmanoscope weigh\n```\nmanoscope weigh in prose\n"
            ),
            [],
        )

    def test_an_unknown_command_is_found(self):
        self.assert_one_fault("```sh\n\nbuild/manoscope weigh x\n```\n", "README.md:3:", "weigh")

    def test_a_word_of_a_description_is_no_command(self):
        self.assert_one_fault("```sh\nmanoscope simulate x\n```\n", "no command simulate")

    def test_an_unknown_option_is_found_on_a_continued_line(self):
        self.assert_one_fault("```sh\nmanoscope measure a \\\n  --weight 3\n```\n", "--weight")

    def test_an_unknown_target_of_make_is_found_after_another_command(self):
        self.assert_one_fault("```sh\ncd x; make weigh\n```\n", "no target weigh")

    def test_files_of_build_folders_are_not_read(self):
        self.write("build-asan/a.md", "[a](none.md)\n")
        self.assertEqual(self.faults(""), [])

    def test_without_the_program_nothing_is_claimed(self):
        (self.root / "build" / "manoscope").unlink()
        self.assertEqual(check_docs.main([str(self.root)]), 2)


if __name__ == "__main__":
    unittest.main()
