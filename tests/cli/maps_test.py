"""The commands that look at maps: inspect, convert, formats.

Usage: maps_test.py PROGRAM [unittest arguments]
"""

import json

from support import Folder, run, main


class Maps(Folder):
    def write_csv_map(self):
        path = self.folder / "map.csv"
        path.write_text("1,2,3\n4,nan,6\n")
        return path

    def test_a_matrix_without_scale_is_refused_with_the_option_that_adds_it(self):
        path = self.write_csv_map()
        done = run("convert", path, self.folder / "map.gsf", check_code=2)
        self.assertIn("--height-unit", done.stderr)
        done = run("convert", path, self.folder / "map.gsf", "--height-unit", "nm", check_code=2)
        self.assertIn("--pitch-x", done.stderr)
        self.assertFalse((self.folder / "map.gsf").exists())

    def test_convert_and_inspect_keep_the_numbers(self):
        path = self.write_csv_map()
        scale = ["--pitch-x", "2um", "--pitch-y", "3um", "--height-unit", "nm"]
        for name in ("map.gsf", "map.nc", "again.csv", "map.x3p", "map.tif"):
            out = self.folder / name
            run("convert", path, out, *scale, check_code=0)
            [summary] = json.loads(run("inspect", out, "--json", check_code=0).stdout)
            [channel] = summary["channels"]
            self.assertEqual((channel["nx"], channel["ny"], channel["missing"]), (3, 2, 1))
            # 32-bit floats of .gsf keep 24 bits.
            self.assertAlmostEqual(channel["size_x_m"], 6e-6, delta=6e-13)
            self.assertAlmostEqual(channel["size_y_m"], 6e-6, delta=6e-13)
            self.assertAlmostEqual(channel["max"], 6e-9, delta=6e-16)
            self.assertAlmostEqual(channel["mean"], 3.2e-9, delta=3.2e-16)

    def test_inspect_draws_a_small_picture(self):
        path, picture = self.write_csv_map(), self.folder / "map.png"
        done = run("inspect", path, "--preview", picture, check_code=0)
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertNotIn("\x1b[", done.stdout)  # no colours where no terminal is
        run("inspect", path, path, "--preview", picture, check_code=2)

    def test_formats_lists_each_reader_once(self):
        names = [entry["name"] for entry in json.loads(run("formats", "--json").stdout)]
        self.assertEqual(len(names), len(set(names)))
        self.assertIn("gsf", names)


if __name__ == "__main__":
    main()
