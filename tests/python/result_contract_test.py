#!/usr/bin/env python3
"""Checks a result.nc against the contract of the result file, as a user would open it.

Usage: result_contract_test.py RESULT.nc | RESULT_FOLDER

Opens the file with xarray (default engine, one line), again with h5netcdf, and checks every name,
type, dimension, unit and attribute, the tables beside it, and what the numbers promise each other.
Prints every fault and exits with 1 if there is one.
"""

import pathlib
import re
import sys

import numpy as np
import xarray

# name: (dimensions, unit); float64, names that stay.
CONTRACT = {
    "x": (("x",), "m"),
    "flow_rate": (("run",), "m3 s-1"),
    "level_pressure": (("level",), "Pa"),
    "static_deflection": (("level", "x"), "m"),
    "static_deflection_uncertainty": (("level", "x"), "m"),
    "deflection": (("run", "x"), "m"),
    "deflection_uncertainty": (("run", "x"), "m"),
    "pressure": (("run", "x"), "Pa"),
    "pressure_uncertainty": (("run", "x"), "Pa"),
    "pressure_lower": (("run", "x"), "Pa"),
    "pressure_upper": (("run", "x"), "Pa"),
    "pressure_covariance": (("run", "x", "x_other"), "Pa2"),
    "test_section": (("run", "bound"), "m"),
    "extracted_drop": (("run",), "Pa"),
    "extracted_drop_uncertainty": (("run",), "Pa"),
    "resistance_drop": (("run",), "Pa"),
    "resistance_drop_uncertainty": (("run",), "Pa"),
    "reynolds": (("run",), "1"),
}
# Ours besides the contract; the same promise.
ADDED = {
    "x_other": (("x_other",), "m"),
    "level_pressure_uncertainty": (("level",), "Pa"),
    "level_estimate": (("level",), "Pa"),
    "level_estimate_uncertainty": (("level",), "Pa"),
    "crest_deflection": (("level",), "m"),
    "crest_deflection_uncertainty": (("level",), "m"),
    "pressure_variance": (("budget_source", "run", "x"), "Pa2"),
    "crossing_x": (("crossing",), "m"),
    "crossing_x_uncertainty": (("crossing",), "m"),
    "crossing_pressure": (("crossing",), "Pa"),
    "channel_resistance_drop": (("run",), "Pa"),
    "resistance_pressure": (("run", "x"), "Pa"),
    "transducer_drop": (("run",), "Pa"),
    "parasitic_drop": (("run",), "Pa"),
    "en_number": (("run",), "1"),
    "map_pressure": (("map",), "Pa"),
    "map_tilt_x": (("map",), "1"),
    "map_tilt_z": (("map",), "1"),
    "map_noise": (("map",), "m"),
    "map_missing": (("map",), "1"),
    "map_spikes": (("map",), "1"),
    "map_shift": (("map",), "m"),
    "map_shift_uncertainty": (("map",), "m"),
    "map_shift_across": (("map",), "m"),
    "map_shift_across_uncertainty": (("map",), "m"),
    "map_rotation": (("map",), "rad"),
    "map_rotation_uncertainty": (("map",), "rad"),
    "map_mended": (("map",), "1"),
    "map_unmended": (("map",), "1"),
    "map_rim_bend": (("map",), "m"),
    "map_rim_bend_uncertainty": (("map",), "m"),
    "response_x": (("response_x",), "m"),
    "response_z": (("response_z",), "m"),
    "wall_response": (("response_z", "response_x"), "m"),
    "channel_length": ((), "m"),
    "channel_width": ((), "m"),
    "channel_height": ((), "m"),
    "channel_height_uncertainty": ((), "m"),
    "viscosity": ((), "Pa s"),
    "viscosity_uncertainty": ((), "Pa s"),
    "flow_rate_uncertainty": (("run",), "m3 s-1"),
    "density": ((), "kg m-3"),
    "coverage": ((), "1"),
    "extracted_drop_variance": (("budget_source", "run"), "Pa2"),
    "left_out_x": (("left_out_x",), "m"),
    "left_out_error": (("level", "left_out_x"), "Pa"),
    "left_out_uncertainty": (("level", "left_out_x"), "Pa"),
    "left_out_mean_error": (("level",), "Pa"),
    "left_out_mean_uncertainty": (("level",), "Pa"),
    "section_x": (("section_x",), "m"),
    "section_z": (("section_z",), "m"),
    "shape_chi_square": (("map", "section_x"), "1"),
    "shape_dof": (("map", "section_x"), "1"),
    "shape_misfit": (("map", "section_z", "section_x"), "m"),
    "shape_reduced_chi_square": (("map",), "1"),
    "shape_p_value": (("map",), "1"),
    "shape_worst": (("map", "bound"), "m"),
    "shape_reading_shift": (("map",), "Pa"),
    "repeat_scatter": (("repeat",), "Pa"),
    "repeat_chi_square": (("repeat",), "1"),
    "repeat_dof": (("repeat",), "1"),
    "repeat_p_value": (("repeat",), "1"),
}
LABELS = {"run": ("run",), "budget_source": ("budget_source",), "map": ("map",),
          "repeat": ("repeat",)}
FLAGS = {"no_data": 1, "out_of_calibration": 2, "ambiguous": 4, "insensitive": 8,
         "outside_test_section": 16}
NO_ANSWER = 1 | 2 | 4 | 8
ANCILLARY = {"pressure": {"pressure_uncertainty", "pressure_flags"},
             "deflection": {"deflection_uncertainty"},
             "static_deflection": {"static_deflection_uncertainty"},
             "extracted_drop": {"extracted_drop_uncertainty"},
             "resistance_drop": {"resistance_drop_uncertainty"}}
ATTRIBUTES = ["Conventions", "title", "source", "history", "experiment", "inputs", "settings",
              "warnings"]
PRESSURE_COLUMNS = ("run,flow_rate_m3_s,x_m,pressure_Pa,pressure_uncertainty_Pa,pressure_lower_Pa,"
                    "pressure_upper_Pa,deflection_m,flags")
DROPS_COLUMNS = ("run,flow_rate_m3_s,reynolds,x_start_m,x_end_m,extracted_drop_Pa,"
                 "extracted_drop_uncertainty_Pa,resistance_drop_Pa,resistance_drop_uncertainty_Pa,"
                 "transducer_drop_Pa,parasitic_drop_Pa,en_number")

faults = []


def expect(condition, message):
    if not condition:
        faults.append(message)


def check_variable(ds, name, dims, unit):
    if name not in ds.variables:
        faults.append(f"{name}: missing")
        return
    v = ds[name]
    expect(v.dims == dims, f"{name}: dimensions {v.dims}, expected {dims}")
    expect(v.dtype == np.float64, f"{name}: type {v.dtype}, expected float64")
    expect(v.attrs.get("units") == unit, f"{name}: units {v.attrs.get('units')!r}, expected {unit!r}")


def check_structure(ds):
    for name, (dims, unit) in {**CONTRACT, **ADDED}.items():
        check_variable(ds, name, dims, unit)
    for name, dims in LABELS.items():
        if name not in ds.variables:
            faults.append(f"{name}: missing")
            continue
        expect(ds[name].dims == dims, f"{name}: dimensions {ds[name].dims}, expected {dims}")
        expect(all(isinstance(label, str) for label in ds[name].values.tolist()),
               f"{name}: holds no strings but {ds[name].dtype}")
    for name in ds.variables:
        for attribute in ("units", "long_name"):
            expect(ds[name].attrs.get(attribute), f"{name}: no attribute {attribute}")
    for name, wanted in ANCILLARY.items():
        found = set(ds[name].attrs.get("ancillary_variables", "").split())
        expect(wanted <= found, f"{name}: ancillary_variables lack {wanted - found}")
        expect(found <= set(ds.variables), f"{name}: ancillary_variables name what is not there")
    for name in ATTRIBUTES:
        expect(isinstance(ds.attrs.get(name), str), f"global attribute {name}: missing or no text")
    expect(ds.attrs.get("Conventions", "").startswith("CF-"), "Conventions does not name CF")
    expect("x" in ds.coords and "run" in ds.coords, "x and run are not coordinates")


def check_flags(ds):
    v = ds["pressure_flags"]
    expect(v.dims == ("run", "x"), f"pressure_flags: dimensions {v.dims}")
    expect(v.dtype == np.uint8, f"pressure_flags: type {v.dtype}, expected uint8 (bits)")
    masks = np.atleast_1d(v.attrs.get("flag_masks", [])).tolist()
    names = v.attrs.get("flag_meanings", "").split()
    expect(dict(zip(names, masks)) == FLAGS and len(masks) == len(names),
           f"pressure_flags: flag_meanings {names}, flag_masks {masks}")
    expect(np.asarray(v.attrs.get("flag_masks")).dtype == v.dtype,
           "pressure_flags: flag_masks are not of the variable's type")
    expect(v.attrs.get("standard_name") == "status_flag", "pressure_flags: standard_name")


def check_numbers(ds):
    """What the numbers promise each other."""
    x = ds.x.values
    expect(np.all(np.isfinite(x)) and np.all(np.diff(x) > 0), "x: does not ascend")
    p, flags = ds.pressure.values, ds.pressure_flags.values
    missing = (flags & NO_ANSWER) != 0
    expect(np.array_equal(np.isnan(p), missing),
           f"pressure: NaN and flags disagree at {np.sum(np.isnan(p) != missing)} stations")
    u = ds.pressure_uncertainty.values
    expect(np.all(u[~missing] > 0), "pressure_uncertainty: not positive where there is a pressure")
    with np.errstate(invalid="ignore"):
        inside = (ds.pressure_lower.values <= p) & (p <= ds.pressure_upper.values)
    expect(np.all(inside | missing), "pressure lies outside its own coverage interval")
    for i, label in enumerate(ds.run.values.tolist()):
        good = ~missing[i]
        c = ds.pressure_covariance.values[i][np.ix_(good, good)]
        expect(np.allclose(c, c.T, rtol=1e-12, atol=0), f"covariance of {label}: not symmetric")
        # Two ways of adding the same variances: round-off of some hundred terms.
        expect(np.allclose(np.diag(c), u[i][good] ** 2, rtol=1e-9, atol=0),
               f"covariance of {label}: diagonal is not the squared uncertainty")
        if good.any():
            smallest = np.linalg.eigvalsh(c).min()
            expect(smallest >= -1e-9 * np.trace(c),
                   f"covariance of {label}: negative variance {smallest:g} Pa2")
        budget = ds.pressure_variance.values[:, i, :][:, good].sum(axis=0)
        expect(np.allclose(budget, u[i][good] ** 2, rtol=1e-6, atol=0),
               f"budget of {label}: sources do not add up to the squared uncertainty")
        start, end = ds.test_section.values[i]
        outside = (x < start) | (x > end)
        if np.isfinite([start, end]).all():
            expect(np.all(flags[i][outside] & 16), f"{label}: stations outside the test section "
                   "are not flagged")
    expect(np.all(np.diff(ds.level_pressure.values) > 0), "level_pressure: does not ascend")
    n_run = ds.sizes["run"]
    expect(np.all((ds.crossing_run.values >= 0) & (ds.crossing_run.values < n_run)),
           "crossing_run: names no run")


def check_inputs(ds):
    lines = ds.attrs["inputs"].splitlines()
    for line in lines:
        expect(re.fullmatch(r".+\s[0-9a-f]{64}", line), f"inputs: {line!r} is not `name  sha256`")
    expect(len(lines) >= ds.sizes["map"], f"inputs: {len(lines)} lines for {ds.sizes['map']} maps")


def check_tables(folder, ds):
    for name, columns, rows in (("pressure.csv", PRESSURE_COLUMNS, ds.sizes["run"] * ds.sizes["x"]),
                                ("drops.csv", DROPS_COLUMNS, ds.sizes["run"])):
        path = folder / name
        if not path.is_file():
            faults.append(f"{name}: missing beside result.nc")
            continue
        lines = path.read_text(encoding="utf-8").splitlines()
        # drops.csv has more columns behind those of the contract.
        head = lines[0].split(",") if lines else []
        promised = columns.split(",")
        held = head[:len(promised)] if name == "drops.csv" else head
        expect(held == promised, f"{name}: header {lines[:1]}")
        expect(len(lines) == rows + 1, f"{name}: {len(lines) - 1} rows, expected {rows}")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    path = pathlib.Path(sys.argv[1])
    if path.is_dir():
        path = path / "result.nc"
    ds = xarray.open_dataset(path)  # as the manual says: one line, default engine
    check_structure(ds)
    if not faults:
        check_flags(ds)
        check_numbers(ds)
        check_inputs(ds)
    if path.name == "result.nc":
        check_tables(path.parent, ds)
    with xarray.open_dataset(path, engine="h5netcdf") as other:  # read through h5py
        expect(set(other.variables) == set(ds.variables), "h5netcdf sees other variables")
        expect(np.array_equal(other.pressure.values, ds.pressure.values, equal_nan=True),
               "h5netcdf reads other pressures")
    for fault in faults:
        print(f"FAULT {path}: {fault}")
    print(f"{path}: {len(faults)} faults, {len(ds.variables)} variables, "
          + ", ".join(f"{size} {name}" for name, size in ds.sizes.items()))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
