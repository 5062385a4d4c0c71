// A small experiment of made-up maps on disk, for the tests of this folder.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "manoscope/io/writer.hpp"
#include "tests/support/synthetic_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::serve {

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline const char* const kToml =
    "manoscope = 1\n"
    "name = \"small\"\n"
    "\n"
    "[channel]\n"
    "length = \"1.2 mm\"   # CONFIRM: along the flow\n"
    "width = \"0.3 mm\"\n"
    "height = \"50 um\"\n"
    "\n"
    "[fluid]\n"
    "viscosity = \"1 mPa s\"\n"
    "density = \"998 kg/m3\"\n"
    "\n"
    "[instrument]\n"
    "pressure_noise = \"5 Pa\"\n"
    "\n"
    "[hydrostatic]\n"
    "list = \"hydrostatic.csv\"\n"
    "\n"
    "[flow]\n"
    "list = \"flow.csv\"\n";
inline const char* const kHydrostatic =
    "# by hand\nmap,pressure [Pa],pressure_uncertainty "
    "[Pa]\nh0.gsf,0,0\nh1.gsf,500,\nh2.gsf,1000,\n";
inline const char* const kFlow = "map,flow_rate [mL/min]\nf0.gsf,5\n";

/// The camera and the place of the channel in it.
inline CameraGrid small_camera() { return {150, 60, 10.0 * um, 10.0 * um}; }
inline ChannelFrame small_frame() {
  return test_support::frame_at(1.2 * mm, 0.3 * mm, FlowDirection::plus_columns, false, 0.15 * mm,
                                0.15 * mm);
}

inline void write_map(const std::filesystem::path& path, double crest, double fall = 0.0) {
  std::filesystem::create_directories(path.parent_path());
  RandomStream stream(7, "map");
  const test_support::Bulge bulge{1.2e-3, 0.3e-3, crest, 0.05e-3, fall};
  test_support::MapErrors errors;
  errors.noise = 5e-9;
  io::write_gsf(path,
                test_support::synthetic_map(small_camera(), small_frame(), bulge, errors, stream),
                "height");
}

/// Folder s1 of `top`: what is enough to be measured.
inline void write_experiment_folder(const std::filesystem::path& top) {
  write_text(top / "s1/experiment.toml", kToml);
  write_text(top / "s1/hydrostatic.csv", kHydrostatic);
  write_text(top / "s1/flow.csv", kFlow);
  write_map(top / "s1/h0.gsf", 0.0);
  write_map(top / "s1/h1.gsf", 1e-6);
  write_map(top / "s1/h2.gsf", 2e-6);
  write_map(top / "s1/f0.gsf", 1.5e-6, 0.8);
}

}  // namespace manoscope::serve
