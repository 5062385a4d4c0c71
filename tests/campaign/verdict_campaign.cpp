// verdict_campaign: many virtual experiments whose flow model is true, held against it with the
// gap as it is and with a wrong one; one row a run.
//
// Rows go to a CSV file as each experiment ends; tools/verdict_table.py sums it up.
#include <CLI/CLI.hpp>
#include <iostream>

#include "tests/campaign/run_campaign.hpp"
#include "tests/campaign/verdicts.hpp"

int main(int argc, char** argv) {
  namespace campaign = manoscope::campaign;
  campaign::CampaignOptions options;
  options.bases = {"S1", "S2", "S3", "S4", "S5"};
  CLI::App app("Holds virtual experiments whose flow is known against flow models");
  campaign::add_campaign_options(app, options);
  CLI11_PARSE(app, argc, argv);
  try {
    campaign::Campaign verdicts;
    verdicts.header = campaign::kVerdictHeader;
    verdicts.scenario = campaign::verdict_scenario;
    verdicts.gentler = campaign::gentler_scenario;
    verdicts.rows = [&](const campaign::Member& member, const manoscope::twin::Scenario& scenario,
                        const manoscope::twin::SolvedScenario& solved) {
      return campaign::verdict_rows(
          member, campaign::judge_flow(member, scenario, solved, options.scratch));
    };
    campaign::run_campaign(verdicts, options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
