// A result of one run and its truth, for the tests of the judgement.
#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"
#include "manoscope/twin/truth.hpp"

namespace manoscope::pipeline::test_support {

/// The truth falls from 1000 Pa by 100 Pa a millimetre; the reading is 3 Pa too high, 5 Pa at 2 mm,
/// where the test section of 2 to 8 mm begins; zeta is 4 nm too high at every station. Bars of 2 Pa
/// and 2 nm, intervals of 4 Pa either way.
struct JudgedRunCase {
  results::Measurement m;
  twin::Truth truth;

  explicit JudgedRunCase(const std::string& run = "Q5") {
    m.x = Array1::LinSpaced(11, 0.0, 10e-3);
    truth.x = Array1::LinSpaced(8, 0.0, 10e-3);  // other stations: a straight line all the same
    truth.runs.push_back({run, 1000.0 - 1e5 * truth.x, Array1::Zero(8)});
    m.run = {run};
    m.flow_rate = Array1::Ones(1);
    m.test_section = Array2(1, 2);
    m.test_section << 2e-3, 8e-3;
    m.pressure = (1003.0 - 1e5 * m.x).matrix().transpose().array();
    m.pressure(0, 2) += 2.0;
    m.pressure_local = m.pressure;
    m.pressure_uncertainty = Array2::Constant(1, 11, 2.0);
    m.pressure_lower = m.pressure - 4.0;
    m.pressure_upper = m.pressure + 4.0;
    m.deflection = Array2::Constant(1, 11, 4e-9);
    m.deflection_uncertainty = Array2::Constant(1, 11, 2e-9);
  }
};

}  // namespace manoscope::pipeline::test_support
