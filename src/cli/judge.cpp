// manoscope judge OUT TRUTH: errors, pulls and coverage of a result against a truth.
#include "manoscope/pipeline/judge.hpp"
#include "commands.hpp"
#include "manoscope/results/write.hpp"
#include "summary.hpp"

namespace manoscope::cli {
namespace {

struct JudgeOptions {
  std::optional<Length> start, end;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("start", start, "judge from here on; auto: each run's test section");
    visit("end", end, "judge up to here; auto: each run's test section");
  }
};

}  // namespace

void add_judge(Program& program) {
  struct Args {
    std::filesystem::path result, truth;
    JudgeOptions options;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command("judge", "Hold a result against the truth of its experiment");
  command.positional("result", args->result, "result folder, or its result.nc");
  command.positional("truth", args->truth, "truth.csv, or a folder that holds it");
  command.options(args->options, "Range");
  command.action([args](const Context& context) {
    const auto judgements =
        pipeline::judge(results::read_result(args->result), twin::read_truth(args->truth),
                        args->options.start, args->options.end);
    print(context.json ? judgement_json(judgements) : judgement_text(judgements));
  });
}

}  // namespace manoscope::cli
