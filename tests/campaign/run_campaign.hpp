// A campaign: many members made and measured, their rows in a CSV file that is gone on with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/twin/scenario.hpp"
#include "manoscope/twin/solved_scenario.hpp"
#include "tests/campaign/member.hpp"

namespace CLI {
class App;
}

namespace manoscope::campaign {

/// Which members a campaign has, and where they go.
struct CampaignOptions {
  std::vector<std::string> bases;
  std::uint64_t walls = 2, first_wall = 0, seeds = 2, first_seed = 1;
  int threads = 0;  ///< 0: all the machine has
  std::filesystem::path output;
  std::filesystem::path scratch = std::filesystem::temp_directory_path() / "manoscope-campaign";
};

/// Offers every option on the command line; the output is required.
void add_campaign_options(CLI::App& app, CampaignOptions& options);

/// What a campaign does with each member.
struct Campaign {
  std::string header;  ///< of the table: "base,wall,seed,..." and a line end
  std::function<twin::Scenario(const std::string& base, std::uint64_t wall)> scenario;
  /// What to make instead of a scenario whose flow has no answer; none: nothing. May be empty.
  std::function<std::optional<twin::Scenario>(const twin::Scenario&)> gentler;
  /// The rows of one member, written as member.name() + "...". Called from several threads.
  std::function<std::string(const Member&, const twin::Scenario&, const twin::SolvedScenario&)>
      rows;
};

/// Makes and measures every member; those whose rows stand in the output already are not made
/// again, so that a campaign can be stopped and gone on with. A wall that chokes its channel or
/// rises beyond its theory is no experiment: a gentler one takes its place, or it is left out, with
/// a word on standard error.
void run_campaign(const Campaign& campaign, const CampaignOptions& options);

}  // namespace manoscope::campaign
