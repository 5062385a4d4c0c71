#include "tests/campaign/member.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/random.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/pipeline/judged_stretch.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/twin/experiment_files.hpp"
#include "manoscope/twin/virtual_experiment.hpp"

namespace manoscope::campaign {
namespace {

/// The truth of a run at the stations of the result.
Array1 true_pressure(const MeasuredMember& member, Index run) {
  const results::Measurement& m = member.measurement;
  const auto& truth = pipeline::find_truth(member.truth, m.run[static_cast<std::size_t>(run)]);
  return pipeline::interpolate(member.truth.x, truth.pressure, m.x);
}

Flags1 answered_in(const results::Measurement& m, Index run, const Stretch& stretch) {
  return pipeline::answers(pipeline::within(m.x, stretch.start, stretch.end), m.pressure.row(run));
}

/// @param within_band  1 or 0; empty where the row is of no band.
std::string row(const std::string& front, const validation::Judgement& judged,
                const std::string& within_band, const std::string& budget) {
  return front + fmt::format("{},{},{:.4g},{:.4g},{:.4g},{:.4f},{:.4f},{:.4f},{:.4f},{},{}\n",
                             judged.n_answered, judged.n_silent, judged.rms, judged.largest,
                             judged.mean, judged.pull_mean, judged.pull_rms, judged.coverage_68,
                             judged.coverage, within_band, budget);
}

/// Mean variance by source, Pa2, over the stations that count: "source=variance;...".
std::string budget_text(const results::Measurement& m, Index r, const Flags1& answered) {
  std::string text;
  const double n = std::max<double>(1.0, static_cast<double>((answered != 0).count()));
  for (std::size_t s = 0; s < m.budget_source.size(); ++s) {
    double sum = 0.0;
    for (Index i = 0; i < answered.size(); ++i) {
      if (answered[i] != 0) sum += m.pressure_variance[s](r, i);
    }
    text += fmt::format("{}={:.3g};", m.budget_source[s], sum / n);
  }
  return text;
}

/// The drop over the test section as the user is told it, as one reading.
validation::Judgement judge_drop(const results::Measurement& m, Index r, const Array1& truth) {
  Array1 section(2);
  section << m.test_section(r, 0), m.test_section(r, 1);
  const Array1 p = pipeline::interpolate(m.x, truth, section);
  const auto one = [](double value) { return Array1::Constant(1, value); };
  const double u = m.extracted_drop_uncertainty[r], half = 1.959964 * u;
  return validation::judge_reading(Flags1::Ones(1), one(m.extracted_drop[r]), one(u),
                                   one(m.extracted_drop[r] - half), one(m.extracted_drop[r] + half),
                                   one(p[0] - p[1]));
}

/// All answered stations, and whether the simultaneous band holds every one of them.
std::string whole_row(const std::string& front, const results::Measurement& m, Index r,
                      const Array1& truth) {
  const Array1 p = m.pressure.row(r), u = m.pressure_uncertainty.row(r);
  const Flags1 answered = pipeline::answers(Flags1::Ones(p.size()), p);
  const auto judged = validation::judge_reading(answered, p, u, m.pressure_lower.row(r),
                                                m.pressure_upper.row(r), truth);
  const Array1 off = (p - truth).abs() - m.pressure_band_factor[r] * u;
  const bool within = (answered == 0 || off <= 0.0).all();
  return row(front, judged, within ? "1" : "0", "");
}

}  // namespace

const char* const kHeader =
    "base,wall,seed,run,stretch,label_noise_Pa,n_levels,n_along,nonlocal,drop_Pa,n_answered,"
    "n_silent,rms_Pa,largest_Pa,mean_Pa,pull_mean,pull_rms,coverage_68,coverage_95,within_band,"
    "budget\n";

std::string Member::name() const { return fmt::format("{},{},{},", base, wall, seed); }

std::uint64_t Member::own_seed() const {
  return static_cast<std::uint64_t>(RandomStream(seed, "member " + base, wall).below(1 << 30));
}

WrittenMember write_member(const Member& member, const twin::Scenario& scenario,
                           const twin::SolvedScenario& solved,
                           const std::filesystem::path& scratch) {
  const auto folder = scratch / fmt::format("{}-{}-{}", member.base, member.wall, member.seed);
  const auto made = twin::record_experiment(scenario, solved, member.own_seed(), 1);
  twin::write_experiment(folder, made, true);
  return {folder, made.truth, made.scalars};
}

MeasuredMember measure_member(const Member& member, const twin::Scenario& scenario,
                              const twin::SolvedScenario& solved,
                              const std::filesystem::path& scratch, bool keep) {
  const WrittenMember written = write_member(member, scenario, solved, scratch);
  pipeline::MeasureOptions options;
  options.flow.flow_models = false;  // they do not touch p(x)
  MeasuredMember measured{
      pipeline::measure(experiment::read_experiment(written.folder), options, 1), written.truth};
  if (!keep) std::filesystem::remove_all(written.folder);
  return measured;
}

validation::Judgement judge_stretch(const MeasuredMember& member, Index run,
                                    const Stretch& stretch) {
  const results::Measurement& m = member.measurement;
  auto judged = validation::judge_reading(
      answered_in(m, run, stretch), m.pressure.row(run), m.pressure_uncertainty.row(run),
      m.pressure_lower.row(run), m.pressure_upper.row(run), true_pressure(member, run));
  const Index n_inside = (pipeline::within(m.x, stretch.start, stretch.end) != 0).count();
  judged.n_silent = n_inside - judged.n_answered;
  return judged;
}

std::string rows_of(const Member& member, const twin::Scenario& scenario,
                    const MeasuredMember& measured) {
  const results::Measurement& m = measured.measurement;
  std::string rows;
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const Array1 expected = true_pressure(measured, r);
    const double drop = expected[0] - expected[expected.size() - 1];
    const auto front = [&](const char* stretch) {
      return fmt::format("{}{},{},{:.3g},{},{},{},{:.6g},", member.name(),
                         m.run[static_cast<std::size_t>(r)], stretch, scenario.gauge.noise.si(),
                         scenario.levels.size(), scenario.camera.n_along,
                         std::isnan(m.half_response_wavelength[r]) ? 0 : 1, drop);
    };
    rows += whole_row(front("whole"), m, r, expected);
    for (const Stretch& stretch : kStretches) {
      rows += row(front(stretch.name), judge_stretch(measured, r, stretch), "",
                  budget_text(m, r, answered_in(m, r, stretch)));
    }
    if (std::isfinite(m.extracted_drop[r])) {
      rows += row(front("drop"), judge_drop(m, r, expected), "", "");
    }
  }
  return rows;
}

}  // namespace manoscope::campaign
