#include "tests/campaign/run_campaign.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"

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
void keep_finished(const fs::path& file, const std::string& header,
                   const std::set<std::string>& done) {
  std::string kept = header;
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

struct Solved {
  twin::Scenario scenario;
  twin::SolvedScenario mechanics;
};

/// None for a wall that chokes its channel or rises beyond its theory: that is no experiment.
std::optional<Solved> solve(const Campaign& campaign, twin::Scenario scenario, int n_threads) {
  for (;;) {
    try {
      twin::SolvedScenario mechanics = twin::solve_scenario(scenario, n_threads);
      return Solved{std::move(scenario), std::move(mechanics)};
    } catch (const InputError& error) {
      auto next = campaign.gentler ? campaign.gentler(scenario) : std::nullopt;
      std::cerr << fmt::format("{}: {}: {}\n", next ? "made gentler" : "left out", error.where(),
                               error.found());
      if (!next) return std::nullopt;
      scenario = *std::move(next);
    }
  }
}

}  // namespace

void add_campaign_options(CLI::App& app, CampaignOptions& options) {
  app.add_option("-o,--output", options.output, "CSV of the rows")->required();
  app.add_option("--bases", options.bases, "shipped scenarios to vary")->delimiter(',');
  app.add_option("--walls", options.walls, "walls of each");
  app.add_option("--first-wall", options.first_wall, "0: the shipped scenario itself");
  app.add_option("--seeds", options.seeds, "experiments with each wall");
  app.add_option("--first-seed", options.first_seed, "seed of the first");
  app.add_option("--threads", options.threads, "0: all the machine has");
  app.add_option("--scratch", options.scratch,
                 "folder for the experiments while they are measured");
}

void run_campaign(const Campaign& campaign, const CampaignOptions& options) {
  const auto done = members_done(options.output);
  keep_finished(options.output, campaign.header, done);
  fs::create_directories(options.scratch);
  std::ofstream out(options.output, std::ios::app);
  std::mutex guard;
  for (std::uint64_t wall = options.first_wall; wall < options.first_wall + options.walls; ++wall) {
    for (const std::string& base : options.bases) {
      std::vector<Member> members;
      for (std::uint64_t s = 0; s < options.seeds; ++s) {
        const Member member{base, wall, options.first_seed + s};
        if (!done.contains(member.name())) members.push_back(member);
      }
      if (members.empty()) continue;
      const auto solved = solve(campaign, campaign.scenario(base, wall), options.threads);
      if (!solved) continue;
      parallel_for(static_cast<Index>(members.size()), options.threads, [&](Index i) {
        const Member& member = members[static_cast<std::size_t>(i)];
        const std::string rows =
            campaign.rows(member, solved->scenario, solved->mechanics) + member.name() + "done,\n";
        const std::lock_guard lock(guard);
        out << rows << std::flush;
      });
      std::cerr << fmt::format("{} wall {}: {} experiments\n", base, wall, members.size());
    }
  }
}

}  // namespace manoscope::campaign
