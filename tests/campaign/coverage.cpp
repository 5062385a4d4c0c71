// coverage_campaign: many virtual experiments, made and measured; one row a run and stretch.
//
// Rows go to a CSV file as each experiment ends; tools/coverage_table.py sums it up.
#include <CLI/CLI.hpp>
#include <iostream>

#include "tests/campaign/member.hpp"
#include "tests/campaign/run_campaign.hpp"
#include "tests/campaign/varied_scenario.hpp"

namespace manoscope::campaign {
namespace {

struct Args {
  CampaignOptions campaign;
  bool exact_labels = false, perfect_camera = false, keep = false;
};

void run(const Args& args) {
  Campaign campaign;
  campaign.header = kHeader;
  campaign.scenario = [&](const std::string& base, std::uint64_t wall) {
    twin::Scenario scenario = varied_scenario(base, wall);
    if (args.exact_labels) scenario.gauge.noise = 0.01 * Pa;
    if (args.perfect_camera) scenario.camera = scenario.camera.without_errors();
    return scenario;
  };
  campaign.rows = [&](const Member& member, const twin::Scenario& scenario,
                      const twin::SolvedScenario& solved) {
    return rows_of(member, scenario,
                   measure_member(member, scenario, solved, args.campaign.scratch, args.keep));
  };
  run_campaign(campaign, args.campaign);
}

}  // namespace
}  // namespace manoscope::campaign

int main(int argc, char** argv) {
  manoscope::campaign::Args args;
  args.campaign.bases = {"S1", "S2", "S3", "S4", "S5", "S1b"};
  CLI::App app("Makes and measures many virtual experiments whose truth is known");
  manoscope::campaign::add_campaign_options(app, args.campaign);
  app.add_flag("--exact-labels", args.exact_labels, "gauges of 0.01 Pa");
  app.add_flag("--perfect-camera", args.perfect_camera, "no error of the maps");
  app.add_flag("--keep", args.keep, "leave the experiments in the folder of --scratch");
  CLI11_PARSE(app, argc, argv);
  try {
    manoscope::campaign::run(args);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
