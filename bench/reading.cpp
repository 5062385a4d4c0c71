// Our side of the benchmark of the reading: one run's p(x), station by station, with its whole
// covariance, from a finished calibration. Obeys compare.py line by line, as reading.py does.
//
// bench_reading INPUTS.json writes the calibration and the run there; then on standard input
//   read         read the run
//   save FILE    write what the last reading gave, as JSON
// Each line is answered by one JSON line: wall and processor seconds, peak resident memory.
#include <malloc.h>

#include <cstdio>

#include "calibration_inputs.hpp"
#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "worker.hpp"

namespace manoscope::bench {
namespace {

using calibration::ConstitutiveCurves;

std::vector<double> list(const Array1& values) { return {values.begin(), values.end()}; }

/// The effects of a profile's shared errors, and on which station-independent noise they sit.
nlohmann::json as_json(const Profile& profile) {
  nlohmann::json modes = nlohmann::json::array();
  for (const ErrorMode& mode : profile.uncertainty.modes) modes.push_back(list(mode.effect));
  return {{"zeta_m", list(profile.zeta)},
          {"noise_m", list(profile.uncertainty.independent)},
          {"modes_m", modes}};
}

nlohmann::json inputs_of(const ConstitutiveCurves& curves, const Profile& run) {
  nlohmann::json levels = nlohmann::json::array(), effects = nlohmann::json::array();
  for (const calibration::Level& level : curves.levels) levels.push_back(as_json(level.profile));
  for (Index k = 0; k < curves.label_effect.rows(); ++k) {
    effects.push_back(list(curves.label_effect.row(k)));
  }
  return {{"x_m", list(curves.x)},
          {"levels", levels},
          {"level_pressure_Pa", list(curves.level_pressure)},
          {"label_effect_Pa", effects},
          {"scale_Pa", calibration::fit_pressure_scale(curves.estimated_levels()).unit()},
          {"run", as_json(run)}};
}

void obey_all(const std::string& inputs_file) {
  const ConstitutiveCurves curves = calibration::fit_curves(calibration_levels());
  const Profile run = profile_at(12000.0, "f00");
  std::ofstream(inputs_file) << inputs_of(curves, run);
  inversion::PressureReading reading;
  Matrix covariance;
  obey_lines([&](const std::string& line) {
    if (line == "read") {
      reading = inversion::read_pressure(curves, run);
      covariance = reading.uncertainty.covariance();
      return;
    }
    const Array1 diagonal = covariance.diagonal(), middle = covariance.row(covariance.rows() / 2);
    std::ofstream(line.substr(line.find(' ') + 1))
        << nlohmann::json{{"pressure_Pa", list(reading.pressure)},
                          {"variance_Pa2", list(diagonal)},
                          {"covariance_with_middle_Pa2", list(middle)}};
  });
}

}  // namespace
}  // namespace manoscope::bench

int main(int argc, char** argv) try {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // as the program does, see src/cli/main.cpp
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  if (argc != 2) throw std::runtime_error("usage: bench_reading INPUTS.json");
  manoscope::bench::obey_all(argv[1]);
  return 0;
} catch (const std::exception& failure) {
  std::fprintf(stderr, "bench_reading: %s\n", failure.what());
  return 1;
}
