// manoscope judge OUT TRUTH: errors, pulls and coverage of a result against a truth.
#include <fmt/format.h>

#include "commands.hpp"
#include "judge_summary.hpp"
#include "manoscope/core/atomic_file.hpp"
#include "manoscope/pipeline/judged_inputs.hpp"
#include "manoscope/report/judged_figures.hpp"
#include "manoscope/results/publication.hpp"
#include "manoscope/results/write.hpp"

namespace manoscope::cli {
namespace {

namespace fs = std::filesystem;

struct JudgeOptions {
  std::optional<Length> start, end;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("start", start, "judge from here on; auto: each run's test section");
    visit("end", end, "judge up to here; auto: each run's test section");
  }
};

/// The verdict as the figures take it.
std::vector<report::JudgedRun> judged_runs(const Verdict& verdict) {
  std::vector<report::JudgedRun> runs;
  for (std::size_t r = 0; r < verdict.runs.size(); ++r) {
    const pipeline::RunJudgement& judged = verdict.runs[r];
    const auto column = [&](const char* name) { return verdict.stations[r].column(name); };
    report::JudgedRun run;
    run.x_start = judged.x_start;
    run.x_end = judged.x_end;
    run.true_pressure = column("true_pressure_Pa");
    run.coverage_68 = judged.reading.coverage_68;
    run.coverage = judged.reading.coverage;
    if (!verdict.split.runs.empty()) {
      run.neighbourhood = column("neighbourhood_Pa");
      run.labels = column("label_error_Pa");
      run.maps = column("map_error_Pa");
      run.curve_shape_and_locality = column("curve_shape_and_locality_error_Pa");
      if (verdict.split.runs[r].summary.locality) {
        run.curve_shape = column("curve_shape_error_Pa");
        run.locality = column("locality_error_Pa");
      }
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

/// Figures that an earlier verdict left in the folder.
std::vector<fs::path> earlier_figures(const fs::path& folder) {
  std::vector<fs::path> names;
  std::error_code none;
  for (fs::directory_iterator file(folder / "figures", none), end; !none && file != end;
       file.increment(none)) {
    const std::string name = file->path().filename().string();
    if (name.rfind("judge_", 0) == 0 && file->path().extension() == ".svg") {
      names.push_back(fs::path("figures") / name);
    }
  }
  return names;
}

/// The tables, judge.json and the figures: all of them or none.
void write_verdict(const Context& context, const fs::path& folder,
                   const results::Measurement& measurement, const Verdict& verdict) {
  const auto figures = report::judged_figures(measurement, judged_runs(verdict));
  results::Publication publication(folder);
  publication.add("judge.csv", pipeline::station_table(verdict.stations));
  publication.add("judge_deflections.csv", deflection_table(verdict));
  publication.add("judge.json", judgement_json(verdict, false));  // judge.csv has the stations
  for (const results::ExtraFile& figure : figures) publication.add(figure.name, figure.bytes);
  publication.publish(earlier_figures(folder));
  if (figures.empty() && !verdict.runs.empty()) {
    remark(context, "note: gnuplot is not installed: no figures were drawn");
  }
  remark(context, fmt::format("judge.csv, judge_deflections.csv, judge.json and {} figure(s) in {}",
                              figures.size(), folder.string()));
}

}  // namespace

void add_judge(Program& program) {
  struct Args {
    fs::path result, truth, folder, stations;
    JudgeOptions options;
    bool every_row = false, other_maps = false;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command("judge", "Hold a result against the truth of its experiment");
  command.positional("result", args->result, "result folder, or its result.nc");
  command.positional("truth", args->truth, "truth.nc or truth.csv, or a folder that holds it");
  command.option("-o,--output", args->folder,
                 "folder for judge.csv, judge_deflections.csv, judge.json and figures/judge_*.svg",
                 false);
  command.options(args->options, "Range");
  command.option("--stations", args->stations, "writes errors station by station to a CSV file",
                 false);
  command.flag("--all", args->every_row, "print the deflection of every run and level");
  command.flag("--other-maps", args->other_maps,
               "judge even if the result was measured from other maps than the truth belongs to");
  command.action([args](const Context& context) {
    const auto measurement = results::read_result(args->result);
    const auto truth = twin::read_truth(args->truth);
    if (!args->other_maps) pipeline::check_same_inputs(measurement, truth);
    const Verdict verdict =
        hold_against(measurement, truth, args->options.start, args->options.end);
    if (!args->stations.empty()) {
      write_file_atomically(args->stations, pipeline::station_table(verdict.stations));
    }
    if (!args->folder.empty()) write_verdict(context, args->folder, measurement, verdict);
    print(context.json ? judgement_json(verdict, true)
                       : split_text(verdict.split) + "\n" +
                             deflection_judgement_text(verdict, args->every_row) + "\n" +
                             judgement_text(verdict) + "\n" + verdict_text(verdict));
  });
}

}  // namespace manoscope::cli
