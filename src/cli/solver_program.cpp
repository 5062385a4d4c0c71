#include "solver_program.hpp"

#include <fmt/format.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): mkstemp
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <vector>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/child_process.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/core/options.hpp"
#include "navier_stokes/passage_options.hpp"
#include "simulate_summary.hpp"

namespace manoscope::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kProgram = "manoscope-navier-stokes";

/// The solver beside this program, or on PATH; empty if there is none.
fs::path solver_path() {
  std::error_code error;
  fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / kProgram;
  if (fs::is_regular_file(beside, error) && ::access(beside.c_str(), X_OK) == 0) return beside;
  return find_program(kProgram).value_or("");
}

fs::path find_solver() {
  if (fs::path found = solver_path(); !found.empty()) return found;
  throw InputError(kProgram, "the program that solves the Navier-Stokes equations is not installed",
                   "Run make simulation, which installs deal.II and builds it beside manoscope");
}

/// A file for the solver to read, gone with the object.
class ShapeFile {
 public:
  explicit ShapeFile(const pipeline::GivenFlow& flow) {
    std::string name = (fs::temp_directory_path() / "manoscope-shape-XXXXXX").string();
    const int file = ::mkstemp(name.data());
    if (file < 0) {
      throw InputError(fs::temp_directory_path().string(), "no file can be made there",
                       "Set TMPDIR to a folder with free space");
    }
    ::close(file);
    path_ = name;
    try {
      write_file_atomically(path_, flow.z.size() > 0 ? map_text(flow) : profile_text(flow));
    } catch (...) {
      remove();
      throw;
    }
  }
  ~ShapeFile() { remove(); }
  ShapeFile(const ShapeFile&) = delete;
  ShapeFile& operator=(const ShapeFile&) = delete;
  const fs::path& path() const { return path_; }

 private:
  void remove() const {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  static std::string profile_text(const pipeline::GivenFlow& flow) {
    std::string text = "x [m],zeta [m]\n";
    for (Index i = 0; i < flow.x.size(); ++i) {
      text += fmt::format("{:.17g},{:.17g}\n", flow.x[i], flow.zeta[i]);
    }
    return text;
  }
  static std::string map_text(const pipeline::GivenFlow& flow) {
    std::string text = "x [m],z [m],zeta [m]\n";
    for (Index i = 0; i < flow.x.size(); ++i) {
      for (Index k = 0; k < flow.z.size(); ++k) {
        text += fmt::format("{:.17g},{:.17g},{:.17g}\n", flow.x[i], flow.z[k], flow.roof(i, k));
      }
    }
    return text;
  }

  fs::path path_;
};

Array1 list(const json& object, const char* name) {
  const auto values = object.at(name).get<std::vector<double>>();
  return Eigen::Map<const Array1>(values.data(), static_cast<Index>(values.size()));
}

pipeline::SolvedFlow parsed(const std::string& answer) {
  const json object = json::parse(answer);
  pipeline::SolvedFlow solved;
  solved.x = list(object, "x_m");
  solved.gap = list(object, "gap_m");
  solved.mean_pressure = list(object, "mean_pressure_Pa");
  solved.coarse_mean_pressure = list(object, "coarse_mean_pressure_Pa");
  solved.mean_pressure_uncertainty = list(object, "mean_pressure_numerical_uncertainty_Pa");
  solved.wall_pressure = list(object, "wall_pressure_Pa");
  solved.floor_pressure = list(object, "floor_pressure_Pa");
  solved.wall_shear = list(object, "wall_shear_Pa");
  solved.floor_shear = list(object, "floor_shear_Pa");
  solved.drop = object.at("drop_Pa").get<double>();
  solved.drop_uncertainty = object.at("drop_numerical_uncertainty_Pa").get<double>();
  solved.coarse_drop = object.at("coarse_drop_Pa").get<double>();
  solved.converged = object.at("converged").get<bool>();
  solved.n_unknowns = object.at("unknowns").get<double>();
  solved.seconds = object.at("seconds").get<double>();
  solved.peak_memory = 1e6 * object.at("peak_MB").get<double>();
  return solved;
}

template <class Options>
void add_words(const Options& options, std::vector<std::string>& words) {
  for (const OptionInfo& option : list_options(options)) {
    words.push_back("--" + option.name);
    words.push_back(option.value);
  }
}

/// The words that start the solver, without its options.
std::vector<std::string> start_of(const SolverRun& run) {
  constexpr int kMostProcesses = 100000;
  if (run.processes < 1 || run.processes > kMostProcesses) {
    throw InputError("--processes", fmt::format("{} is out of range", run.processes),
                     fmt::format("Choose from 1 to {}", kMostProcesses));
  }
  const std::string solver = find_solver().string();
  if (run.processes == 1) return {solver};
  const auto mpirun = find_program("mpirun");
  if (!mpirun) {
    throw InputError("--processes", "mpirun is not installed",
                     "Install openmpi-bin, or leave it at 1");
  }
  // More processes than cores are slow, and what the user asks for.
  std::vector<std::string> words{*mpirun, "-n", std::to_string(run.processes), "--oversubscribe"};
  if (::geteuid() == 0) words.emplace_back("--allow-run-as-root");
  words.push_back(solver);
  return words;
}

void add_files(const SolverRun& run, std::vector<std::string>& words) {
  if (!run.vtu.empty()) words.insert(words.end(), {"--vtu", run.vtu.string()});
  if (!run.checkpoint.empty()) {
    words.insert(words.end(), {"--checkpoint", run.checkpoint.string()});
  }
}

/// What the program answers to a command line.
std::string answer_of(const std::vector<std::string>& words, const Monitor& monitor) {
  constexpr double kLongest = 30.0 * 86400.0;              // s: whoever waits stops it with Ctrl-C
  constexpr std::size_t kLargest = std::size_t{1} << 30U;  // bytes
  ChildProcess::Options started;
  started.wall_seconds = kLongest;
  // One thread: the sparse solver's BLAS would otherwise take all there are, for little.
  started.environment = {"OMP_NUM_THREADS=1"};
  started.stop_requested = monitor.stop_requested;
  started.grace_seconds = 10.0;  // mpirun ends its processes and removes their files
  auto solver = ChildProcess::start(words, started);
  if (!solver) throw InputError(words.front(), "cannot be started", "Check its permissions");
  std::string answer = solver->read_all(kLargest);
  const ChildEnd end = solver->wait();
  monitor.checkpoint();
  if (const auto fault = simulation_fault(answer)) throw InputError(*fault);
  if (end.succeeded()) return answer;
  if (const auto fault = solver_fault(answer)) {
    throw InternalError(fmt::format("{}: {}", kProgram, *fault));
  }
  constexpr int kKilledUnderMpirun = 128 + SIGKILL;
  throw InternalError(
      end.signal == SIGKILL || end.exit_code == kKilledUnderMpirun
          ? fmt::format("{} was killed: the machine may be short of memory; take "
                        "fewer cells",
                        kProgram)
          : fmt::format("{} ended with exit code {}, signal {}; run it by itself to "
                        "see its message",
                        kProgram, end.exit_code, end.signal));
}

}  // namespace

void require_solver() { static_cast<void>(find_solver()); }
bool has_solver() { return !solver_path().empty(); }

std::string ask_solver(const fs::path& shape, const navier_stokes::SimulationOptions& options,
                       const SolverRun& run, const Monitor& monitor) {
  std::vector<std::string> words = start_of(run);
  words.push_back(shape.string());
  add_words(options, words);
  add_files(run, words);
  return answer_of(words, monitor);
}

pipeline::SolvedFlow solve_flow(const pipeline::GivenFlow& flow,
                                navier_stokes::SimulationOptions options, const SolverRun& run,
                                const Monitor& monitor) {
  options.height = flow.channel.height;
  options.width = flow.channel.width;
  options.flow_rate = flow.flow_rate;
  options.viscosity = flow.fluid.viscosity;
  options.density = flow.fluid.density;
  options.inlet = flow.inlet == flow::InletProfile::uniform ? "uniform" : "developed";
  options.wall_shape = flow.z.size() > 0 ? "map" : navier_stokes::wall_shape_text(flow.wall_shape);
  options.mesh.dim = flow.dim;
  const ShapeFile shape(flow);
  return parsed(ask_solver(shape.path(), options, run, monitor));
}

pipeline::SolvedPassage solve_passage(const pipeline::GivenPassage& passage,
                                      const navier_stokes::MeshOptions& options,
                                      const SolverRun& run, const Monitor& monitor) {
  navier_stokes::PassageOptions asked;
  asked.passage = passage.is_inlet ? "inlet" : "outlet";
  asked.given.channel = passage.channel;
  asked.given.passage = passage.passage;
  asked.given.beyond_width = passage.beyond_width;
  asked.given.beyond_height = passage.beyond_height;
  asked.given.port = passage.port;
  asked.port_side = passage.port_at_side ? "side" : "top";
  asked.given.fluid = passage.fluid;
  asked.given.flow_rate = passage.flow_rate;
  asked.mesh = options;
  asked.mesh.dim = 3;
  std::vector<std::string> words = start_of(run);
  add_words(asked, words);
  add_files(run, words);
  const json object = json::parse(answer_of(words, monitor));
  pipeline::SolvedPassage solved;
  solved.drop = object.at("drop_Pa").get<double>();
  solved.drop_uncertainty = object.at("drop_numerical_uncertainty_Pa").get<double>();
  solved.converged = object.at("converged").get<bool>();
  solved.n_unknowns = object.at("unknowns").get<double>();
  solved.seconds = object.at("seconds").get<double>();
  solved.peak_memory = 1e6 * object.at("peak_MB").get<double>();
  return solved;
}

}  // namespace manoscope::cli
