"""The commands that look at maps: inspect, convert, formats.

Usage: maps_test.py PROGRAM [unittest arguments]
"""

import json
import pathlib

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
        for name in ("map.gsf", "map.nc", "again.csv", "map.x3p", "map.tif", "map.vti"):
            out = self.folder / name
            run("convert", path, out, *scale, check_code=0)
            if name.endswith(".vti"):  # written only
                self.check_vti(out)
                continue
            [summary] = json.loads(run("inspect", out, "--json", check_code=0).stdout)
            [channel] = summary["channels"]
            self.assertEqual((channel["nx"], channel["ny"], channel["missing"]), (3, 2, 1))
            # 32-bit floats of .gsf keep 24 bits.
            self.assertAlmostEqual(channel["size_x_m"], 6e-6, delta=6e-13)
            self.assertAlmostEqual(channel["size_y_m"], 6e-6, delta=6e-13)
            self.assertAlmostEqual(channel["max"], 6e-9, delta=6e-16)
            self.assertAlmostEqual(channel["mean"], 3.2e-9, delta=3.2e-16)

    def check_vti(self, path):
        text = path.read_bytes()
        self.assertIn(b'<VTKFile type="ImageData"', text)
        self.assertIn(b'WholeExtent="0 2 0 1 0 0"', text)  # 3 x 2 points
        self.assertIn(b'Spacing="2e-06 3e-06 ', text)
        self.assertIn(b'Name="height"', text)

    def test_inspect_tells_what_the_contract_names_in_si_units(self):
        path = self.write_csv_map()
        scale = ["--pitch-x", "2um", "--pitch-y", "3um", "--height-unit", "nm"]
        [summary] = json.loads(run("inspect", path, *scale, "--json", check_code=0).stdout)
        self.assertEqual((summary["file"], summary["format"]), (str(path), "text"))
        [channel] = summary["channels"]
        self.assertLessEqual({"name", "nx", "ny", "pitch_x_m", "pitch_y_m", "size_x_m", "size_y_m",
                              "unit", "missing", "min", "max", "mean", "rms"}, set(channel))
        self.assertEqual(channel["unit"], "m")
        self.assertEqual((channel["nx"], channel["ny"], channel["missing"]), (3, 2, 1))
        # Of 1, 2, 3, 4 and 6 nm: mean 3.2, and squares about it 14.8 in sum. Round-off of sums.
        expected = {"pitch_x_m": 2e-6, "pitch_y_m": 3e-6, "size_x_m": 6e-6, "size_y_m": 6e-6,
                    "min": 1e-9, "max": 6e-9, "mean": 3.2e-9, "rms": (14.8 / 5) ** 0.5 * 1e-9}
        for key, value in expected.items():
            self.assertAlmostEqual(channel[key] / value, 1.0, delta=1e-12, msg=key)

    def test_inspect_says_null_where_a_file_gives_no_scale(self):
        [summary] = json.loads(run("inspect", self.write_csv_map(), "--json").stdout)
        [channel] = summary["channels"]
        self.assertIsNone(channel["pitch_x_m"])
        self.assertIsNone(channel["size_y_m"])
        self.assertEqual(channel["unit"], "")

    def test_inspect_draws_a_small_picture(self):
        path, picture = self.write_csv_map(), self.folder / "map.png"
        done = run("inspect", path, "--preview", picture, check_code=0)
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertNotIn("\x1b[", done.stdout)  # no colours where no terminal is
        run("inspect", path, path, "--preview", picture, check_code=2)

    def test_formats_lists_each_reader_once(self):
        names = [entry["name"] for entry in json.loads(run("formats", "--json").stdout)]
        self.assertEqual(len(names), len(set(names)))
        page = (pathlib.Path(__file__).parents[2] / "docs/formats.md").read_text(encoding="utf-8")
        table = page[page.index("| name |"):].split("\n\n")[0].splitlines()[2:]
        documented = list(dict.fromkeys(row.split("|")[1].strip() for row in table))
        self.assertEqual(names, documented)
        listed = run("formats", check_code=0).stdout
        for name in names:
            self.assertRegex(listed, rf"(?m)^{name} ")


if __name__ == "__main__":
    main()
