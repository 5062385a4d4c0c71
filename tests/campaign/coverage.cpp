// coverage_campaign: many virtual experiments, made and measured; one row a run and stretch.
//
// Rows go to a CSV file as each experiment ends. Those that stand there already are not made again,
// so that a campaign can be stopped and gone on with; tools/coverage_table.py sums it up.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>
#include <optional>
#include <set>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/pipeline/judged_stretch.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/twin/experiment_files.hpp"
#include "manoscope/twin/virtual_experiment.hpp"
#include "manoscope/validation/judge.hpp"
#include "tests/campaign/varied_scenario.hpp"

namespace manoscope::campaign {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeader =
    "base,wall,seed,run,stretch,label_noise_Pa,n_levels,n_along,nonlocal,drop_Pa,n_answered,"
    "n_silent,rms_Pa,largest_Pa,mean_Pa,pull_mean,pull_rms,coverage_68,coverage_95,within_band,"
    "budget\n";

struct Stretch {
  const char* name;
  double start, end;  ///< m
};
constexpr Stretch kStretches[] = {
    {"inside", 1.6e-3, 13.9e-3}, {"inlet", 0.3e-3, 1.6e-3}, {"outlet", 13.9e-3, 15.2e-3}};

/// One experiment of a campaign.
struct Member {
  std::string base;
  std::uint64_t wall = 0, seed = 1;

  std::string name() const { return fmt::format("{},{},{},", base, wall, seed); }
  /// Of the random numbers: no two members of a campaign share any.
  std::uint64_t own_seed() const {
    return static_cast<std::uint64_t>(RandomStream(seed, "member " + base, wall).below(1 << 30));
  }
};

/// Members whose rows are complete: the file names each in a closing row.
std::set<std::string> members_done(const fs::path& file) {
  std::set<std::string> done;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const auto at = line.find(",done,");
    if (at != std::string::npos) done.insert(line.substr(0, at + 1));
  }
  return done;
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

std::string rows_of(const Member& member, const twin::Scenario& scenario,
                    const results::Measurement& m, const twin::Truth& truth) {
  std::string rows;
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const std::string& name = m.run[static_cast<std::size_t>(r)];
    const Array1 expected =
        pipeline::interpolate(truth.x, pipeline::find_truth(truth, name).pressure, m.x);
    const double drop = expected[0] - expected[expected.size() - 1];
    const auto front = [&](const char* stretch) {
      return fmt::format("{}{},{},{:.3g},{},{},{},{:.6g},", member.name(), name, stretch,
                         scenario.gauge.noise.si(), scenario.levels.size(), scenario.camera.n_along,
                         std::isnan(m.half_response_wavelength[r]) ? 0 : 1, drop);
    };
    rows += whole_row(front("whole"), m, r, expected);
    for (const Stretch& stretch : kStretches) {
      const Flags1 inside = pipeline::within(m.x, stretch.start, stretch.end);
      const Flags1 answered = pipeline::answers(inside, m.pressure.row(r));
      auto judged =
          validation::judge_reading(answered, m.pressure.row(r), m.pressure_uncertainty.row(r),
                                    m.pressure_lower.row(r), m.pressure_upper.row(r), expected);
      judged.n_silent = (inside != 0).count() - judged.n_answered;
      rows += row(front(stretch.name), judged, "", budget_text(m, r, answered));
    }
    if (std::isfinite(m.extracted_drop[r])) {
      rows += row(front("drop"), judge_drop(m, r, expected), "", "");
    }
  }
  return rows;
}

/// Measures one experiment, written to a folder of its own.
std::string run_member(const Member& member, const twin::Scenario& scenario,
                       const twin::SolvedScenario& solved, const fs::path& scratch, bool keep) {
  const fs::path folder = scratch / fmt::format("{}-{}-{}", member.base, member.wall, member.seed);
  const auto made = twin::record_experiment(scenario, solved, member.own_seed(), 1);
  twin::write_experiment(folder, made, true);
  const auto measured = pipeline::measure(experiment::read_experiment(folder), {}, 1);
  if (!keep) fs::remove_all(folder);
  return rows_of(member, scenario, measured, made.truth) + member.name() + "done,\n";
}

/// Members that a stopped campaign left unfinished lose their rows.
void keep_finished(const fs::path& file, const std::set<std::string>& done) {
  std::string kept = kHeader;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    for (std::size_t at = 0, n = 0; at != std::string::npos; at = line.find(',', at + 1)) {
      if (n++ == 3) {
        if (done.contains(line.substr(0, at + 1))) kept += line + "\n";
        break;
      }
    }
  }
  in.close();
  std::ofstream(file) << kept;
}

/// None for a wall that chokes its channel or rises beyond its theory: that is no experiment.
std::optional<twin::SolvedScenario> solve(const twin::Scenario& scenario, int n_threads) {
  try {
    return twin::solve_scenario(scenario, n_threads);
  } catch (const InputError& error) {
    std::cerr << fmt::format("left out: {}: {}\n", error.where(), error.found());
    return std::nullopt;
  }
}

struct Args {
  std::vector<std::string> bases{"S1", "S2", "S3", "S4", "S5", "S1b"};
  std::uint64_t walls = 2, first_wall = 0, seeds = 2, first_seed = 1;
  int threads = 0;
  bool exact_labels = false, perfect_camera = false, keep = false;
  fs::path output, scratch = fs::temp_directory_path() / "manoscope-campaign";
};

void run(const Args& args) {
  const auto done = members_done(args.output);
  keep_finished(args.output, done);
  fs::create_directories(args.scratch);
  std::ofstream out(args.output, std::ios::app);
  std::mutex guard;
  for (std::uint64_t wall = args.first_wall; wall < args.first_wall + args.walls; ++wall) {
    for (const std::string& base : args.bases) {
      std::vector<Member> members;
      for (std::uint64_t s = 0; s < args.seeds; ++s) {
        const Member member{base, wall, args.first_seed + s};
        if (!done.contains(member.name())) members.push_back(member);
      }
      if (members.empty()) continue;
      twin::Scenario scenario = varied_scenario(base, wall);
      if (args.exact_labels) scenario.gauge.noise = 0.01 * Pa;
      if (args.perfect_camera) scenario.camera = scenario.camera.without_errors();
      const auto solved = solve(scenario, args.threads);
      if (!solved) continue;
      parallel_for(static_cast<Index>(members.size()), args.threads, [&](Index i) {
        const std::string rows = run_member(members[static_cast<std::size_t>(i)], scenario, *solved,
                                            args.scratch, args.keep);
        const std::lock_guard lock(guard);
        out << rows << std::flush;
      });
      std::cerr << fmt::format("{} wall {}: {} experiments\n", base, wall, members.size());
    }
  }
}

}  // namespace
}  // namespace manoscope::campaign

int main(int argc, char** argv) {
  manoscope::campaign::Args args;
  CLI::App app("Makes and measures many virtual experiments whose truth is known");
  app.add_option("-o,--output", args.output, "CSV of errors, pulls and coverage")->required();
  app.add_option("--bases", args.bases, "shipped scenarios to vary")->delimiter(',');
  app.add_option("--walls", args.walls, "walls of each");
  app.add_option("--first-wall", args.first_wall, "0: the shipped scenario itself");
  app.add_option("--seeds", args.seeds, "experiments with each wall");
  app.add_option("--first-seed", args.first_seed, "seed of the first");
  app.add_option("--threads", args.threads, "0: all the machine has");
  app.add_flag("--exact-labels", args.exact_labels, "gauges of 0.01 Pa");
  app.add_flag("--perfect-camera", args.perfect_camera, "no error of the maps");
  app.add_flag("--keep", args.keep, "leave the experiments in the folder of --scratch");
  app.add_option("--scratch", args.scratch, "folder for the experiments while they are measured");
  CLI11_PARSE(app, argc, argv);
  try {
    manoscope::campaign::run(args);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
