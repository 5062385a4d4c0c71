#include "manoscope/pipeline/assemble.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/flags.hpp"
#include "manoscope/pipeline/test_experiment.hpp"

namespace manoscope::pipeline {
namespace {

using results::Measurement;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The second run lies partly beyond the levels and is short of a whole patch of pixels.
Measurement troubled() {
  twin::Scenario scenario = small_scenario();
  scenario.levels.resize(13);
  TestExperiment test(scenario);
  HeightMap& map = test.map("f00.gsf");
  Flags2 flags = map.flags();
  flags.middleCols(100, 6).setConstant(PixelFlag::no_data);
  map = HeightMap(map.grid(), map.height(), flags);
  return test.measure();
}

TEST(StoreRuns, AnswersValueBarsAndCovarianceTogetherOrNotAtAll) {
  const Measurement m = troubled();
  Index n_silent = 0;
  for (Index r = 0; r < 2; ++r) {
    const Matrix& covariance = m.pressure_covariance[static_cast<std::size_t>(r)];
    for (Index ix = 0; ix < m.x.size(); ++ix) {
      const bool silent = (m.pressure_flags(r, ix) & ReadingFlag::no_answer) != 0;
      n_silent += silent;
      for (const Array2* field :
           {&m.pressure, &m.pressure_uncertainty, &m.pressure_lower, &m.pressure_upper}) {
        EXPECT_EQ(std::isnan((*field)(r, ix)), silent);
      }
      for (const Array2& variance : m.pressure_variance) {
        EXPECT_EQ(std::isnan(variance(r, ix)), silent);
      }
      EXPECT_EQ(std::isnan(covariance(ix, ix)), silent);
      const bool no_data = (m.pressure_flags(r, ix) & ReadingFlag::no_data) != 0;
      EXPECT_EQ(std::isnan(m.deflection(r, ix)), no_data);
      EXPECT_EQ(std::isnan(m.deflection_uncertainty(r, ix)), no_data);
    }
  }
  EXPECT_GT(n_silent, 20);
}

TEST(StoreRuns, BudgetAddsUpToTheUncertainty) {
  const Measurement m = troubled();
  ASSERT_EQ(m.budget_source.size(), m.pressure_variance.size());
  for (const char* source : {"pixel noise", "leveling", "pressure labels", "registration"}) {
    EXPECT_EQ(std::count(m.budget_source.begin(), m.budget_source.end(), source), 1) << source;
  }
  for (Index r = 0; r < 2; ++r) {
    for (Index ix = 0; ix < m.x.size(); ++ix) {
      if (std::isnan(m.pressure(r, ix))) continue;
      double sum = 0.0;
      for (const Array2& variance : m.pressure_variance) sum += variance(r, ix);
      const double expected = m.pressure_uncertainty(r, ix) * m.pressure_uncertainty(r, ix);
      EXPECT_NEAR(sum / expected, 1.0, 1e-12);
      EXPECT_NEAR(m.pressure_covariance[static_cast<std::size_t>(r)](ix, ix) / expected, 1.0,
                  1e-12);
    }
  }
}

TEST(StoreRuns, DropsBelongToTheTestSection) {
  const Measurement m = troubled();
  for (Index r = 0; r < 2; ++r) {
    Index first = -1, last = -1;
    for (Index ix = 0; ix < m.x.size(); ++ix) {
      if (m.x[ix] == m.test_section(r, 0)) first = ix;
      if (m.x[ix] == m.test_section(r, 1)) last = ix;
      const bool outside = m.x[ix] < m.test_section(r, 0) || m.x[ix] > m.test_section(r, 1);
      EXPECT_EQ((m.pressure_flags(r, ix) & ReadingFlag::outside_test_section) != 0, outside);
    }
    ASSERT_GE(first, 0);
    ASSERT_GT(last, first);
    EXPECT_DOUBLE_EQ(m.extracted_drop[r], m.pressure(r, first) - m.pressure(r, last));
    EXPECT_NEAR(m.resistance_drop[r],
                m.resistance_pressure(r, first) - m.resistance_pressure(r, last), 1e-8);
    EXPECT_EQ(m.resistance_pressure(r, last), m.pressure(r, last));
    EXPECT_GT(m.channel_resistance_drop[r], m.resistance_drop[r]);
  }
}

TEST(StoreCalibration, HasCrestsOfAParabola) {
  TestExperiment test;
  const Measurement m = test.measure();
  const Index middle = m.x.size() / 2;
  for (Index k = 0; k < m.level_pressure.size(); ++k) {
    if (std::isnan(m.static_deflection(k, middle))) continue;
    // The twin's section is a parabola: its crest is 3/2 of its mean, but for noise of 10 nm and
    // the 0.2 % of a trapezoid rule on 43 pixels.
    EXPECT_NEAR(m.crest_deflection[k], 1.5 * m.static_deflection(k, middle),
                50e-9 + 3e-3 * std::abs(m.crest_deflection[k]));
    if (k == 0) continue;
    EXPECT_GT(m.level_pressure[k], m.level_pressure[k - 1]);
  }
}

/// Mean of a picture across the channel at a station, by the rows inside it; NaN if one is missing.
double mean_across(const MapPicture& picture, double x, double width) {
  Index ix = 0;
  (picture.x - x).abs().minCoeff(&ix);
  double sum = 0.0, n = 0.0;
  for (Index iz = 0; iz < picture.z.size(); ++iz) {
    if (std::abs(picture.z[iz]) > 0.5 * width) continue;
    const auto count = picture.counts(iz, ix);
    if (count == MapPicture::kMissing) return kNan;
    sum += count * picture.step;
    n += 1.0;
  }
  return sum / n;
}

TEST(StoreMapConditions, KeepsAPictureOfEveryMapThatTheProfilesAgreeWith) {
  const Measurement m = troubled();
  ASSERT_EQ(m.map_picture.size(), m.map.size());
  Index n_compared = 0, n_missing = 0;
  for (std::size_t i = 0; i < m.map.size(); ++i) {
    const int run = m.map_run[i];
    EXPECT_EQ(std::isnan(m.map_pressure[static_cast<Index>(i)]), run >= 0) << m.map[i];
    EXPECT_NEAR(m.map_picture[i].step, 10e-9, 1e-9) << m.map[i];  // half of 20 nm, as measured
    if (run < 0) continue;
    for (Index ix = m.x.size() / 4; ix < 3 * m.x.size() / 4; ++ix) {
      const double mean = mean_across(m.map_picture[i], m.x[ix], m.channel_width);
      n_missing += std::isnan(mean);
      if (std::isnan(mean) || std::isnan(m.deflection(run, ix))) continue;
      ++n_compared;
      // Up to half a row is lost or gained at either side, of some 40, where the wall is clamped;
      // and the map may have been moved by a fraction of a pixel since.
      EXPECT_NEAR(mean, m.deflection(run, ix), 0.03 * std::abs(m.deflection(run, ix)) + 20e-9);
    }
  }
  EXPECT_GT(n_compared, 100);
  EXPECT_GT(n_missing, 3);  // the patch without data
}

}  // namespace
}  // namespace manoscope::pipeline
