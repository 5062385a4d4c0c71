// coverage_campaign: many virtual experiments, made and measured; one row a run and stretch.
//
// Rows go to a CSV file as each experiment ends. Those that stand there already are not made again,
// so that a campaign can be stopped and gone on with; tools/coverage_table.py sums it up.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "tests/campaign/member.hpp"
#include "tests/campaign/varied_scenario.hpp"

namespace manoscope::campaign {
namespace {

namespace fs = std::filesystem;

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
        const Member& member = members[static_cast<std::size_t>(i)];
        const MeasuredMember measured =
            measure_member(member, scenario, *solved, args.scratch, args.keep);
        const std::string rows = rows_of(member, scenario, measured);
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
