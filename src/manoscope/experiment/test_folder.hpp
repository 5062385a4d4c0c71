#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>

namespace manoscope::experiment {

/// A folder of its own for one test, removed with everything in it.
class TestFolder {
 public:
  TestFolder() {
    static std::atomic<int> count{0};
    path_ = std::filesystem::temp_directory_path() /
            ("manoscope_experiment_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
  }

 private:
  std::filesystem::path path_;
};

/// The example of the manual, with every section and key; its lines are what the fault tests count.
inline const char* const kFullToml = R"(manoscope = 1
name = "S1"

[channel]
length = "15.5 mm"            # l, along the flow (x)
width  = "1.7 mm"             # w, across (z)
height = "175 um"             # 2 h0
height_uncertainty = "0.5 um"
origin = ["0.4 mm", "0.4 mm"]
flow   = "+columns"
rotation = "0.5 deg"
outward  = "-height"

[wall]
material = "SiN"
thickness = "0.2 um"
youngs_modulus = "250 GPa"
poisson_ratio = 0.23
prestress = "100 MPa"

[fluid]
name = "water"
viscosity = "1.0 mPa s"
density = "998 kg/m3"
viscosity_uncertainty = "0.005 mPa s"

[instrument]
height_noise   = "20 nm"
pressure_noise = "10 Pa"
pressure_gain_uncertainty = 0.002
pressure_zero_uncertainty = "5 Pa"
flow_rate_uncertainty = 0.01
pressure_drop_uncertainty = "4 Pa"
reference = "flat.gsf"

[hydrostatic]
list = "hydrostatic.csv"

[flow]
list = "flow.csv"

[rigid]
inlet  = {length = "5 mm", width = "1.7 mm", height = "175 um", from_reservoir = true, into = "0.3 mm2", round_bends = 2}
outlet = {length = "6 mm", width = "1.7 mm", height = "175 um", height_uncertainty = "0.6 um", from = "1 mm2", into_reservoir = true, mitre_bends = 1}
simulated = [
  {flow_rate = "20 mL/min", drop = "310 Pa", uncertainty = "10 Pa"},
  {flow_rate = "70 mL/min", drop = "1.4 kPa"}]

[inlet]
profile = "uniform"
spread = 0.3
developing_length = "2 mm"
)";

inline const char* const kFullHydrostatic =
    "map,pressure [Pa],pressure_uncertainty [Pa],sequence,direction\n"
    "h00.gsf,0,0,0,up\n"
    "h01.gsf,100,,1,up\n"
    "h02.gsf,2500,12,2,\n"
    "h03.gsf,100,15,3,down\n";

inline const char* const kFullFlow =
    "map,flow_rate [mL/min],pressure_drop [Pa],outlet_pressure [Pa],time [s],run,"
    "pressure_drop_uncertainty [Pa]\n"
    "f00.gsf,5,1420,,,Q5,3\n"
    "f01.gsf,5,1424,30,1.5,Q5,\n"
    "f02.gsf,70,,,,,\n";

/// Writes the full example with maps that are there and not empty.
inline void write_full_example(const TestFolder& folder) {
  folder.write("experiment.toml", kFullToml);
  folder.write("hydrostatic.csv", kFullHydrostatic);
  folder.write("flow.csv", kFullFlow);
  for (const char* map :
       {"flat.gsf", "h00.gsf", "h01.gsf", "h02.gsf", "h03.gsf", "f00.gsf", "f01.gsf", "f02.gsf"}) {
    folder.write(map, "a map");
  }
}

/// `text` with its only or first `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) return "";  // an empty file fails every expectation
  return text.replace(at, from.size(), to);
}

}  // namespace manoscope::experiment
