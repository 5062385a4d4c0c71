// manoscope simulate --shape SHAPE: Navier-Stokes in a given shape, by a program of its own.
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "commands.hpp"
#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/child_process.hpp"
#include "manoscope/core/error.hpp"
#include "navier_stokes/simulation_options.hpp"
#include "simulate_summary.hpp"

namespace manoscope::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "manoscope-navier-stokes";

/// The solver beside this program, or on PATH.
fs::path find_solver() {
  std::error_code error;
  fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / kProgram;
  if (fs::is_regular_file(beside, error) && ::access(beside.c_str(), X_OK) == 0) return beside;
  if (const auto found = find_program(kProgram)) return *found;
  throw InputError(kProgram, "the program that solves the Navier-Stokes equations is not installed",
                   "Run make simulation, which installs deal.II (tools/install_packages.sh "
                   "navier-stokes) and builds it beside manoscope");
}

/// What the solver says, as JSON.
std::string ask_solver(const std::vector<std::string>& words, const Monitor& monitor) {
  constexpr double kLongest = 30.0 * 86400.0;              // s: whoever waits stops it with Ctrl-C
  constexpr std::size_t kLargest = std::size_t{1} << 30U;  // bytes
  ChildProcess::Options options;
  options.wall_seconds = kLongest;
  // One thread: the sparse solver's BLAS would otherwise take all there are, for little.
  options.environment = {"OMP_NUM_THREADS=1"};
  options.stop_requested = monitor.stop_requested;
  auto solver = ChildProcess::start(words, options);
  if (!solver) throw InputError(words.front(), "cannot be started", "Check its permissions");
  std::string answer = solver->read_all(kLargest);
  const ChildEnd end = solver->wait();
  monitor.checkpoint();
  if (const auto fault = simulation_fault(answer)) throw InputError(*fault);
  if (end.succeeded()) return answer;
  throw InternalError(
      end.signal == SIGKILL
          ? fmt::format("{} was killed: the machine may be short of memory; take "
                        "fewer cells",
                        kProgram)
          : fmt::format("{} ended with exit code {}, signal {}; run it by itself to "
                        "see its message",
                        kProgram, end.exit_code, end.signal));
}

}  // namespace

void add_simulate(Program& program) {
  struct Args {
    fs::path shape, out, vtu;
    navier_stokes::SimulationOptions options;
  };
  auto args = std::make_shared<Args>();
  Command command =
      program.command("simulate", "Solve the Navier-Stokes equations in a given shape");
  command.option(
      "--shape", args->shape,
      "table with the columns x and zeta, the width-averaged deflection, with their units", true);
  command.option("-o,--output", args->out, "writes p(x) and wall shear to a CSV file", false);
  command.option("--vtu", args->vtu, "writes velocity and pressure for ParaView", false);
  command.options(args->options, "Simulation");
  command.action([args](const Context& context) {
    args->options.validate();
    std::vector<std::string> words{find_solver().string(), args->shape.string()};
    for (const OptionInfo& option : list_options(args->options)) {
      words.push_back("--" + option.name);
      words.push_back(option.value);
    }
    if (!args->vtu.empty()) words.insert(words.end(), {"--vtu", args->vtu.string()});
    const std::string answer = ask_solver(words, context.monitor);
    if (!args->out.empty()) write_file_atomically(args->out, simulation_table(answer));
    print(context.json ? answer : simulation_text(answer, context.quiet));
    if (const std::string doubt = simulation_doubt(answer); !doubt.empty()) remark(context, doubt);
    if (!args->out.empty()) remark(context, fmt::format("p(x) in {}", args->out.string()));
  });
}

}  // namespace manoscope::cli
