// manoscope-navier-stokes SHAPE.csv --height H --width W --flow-rate Q: one flow, as JSON.
//
// manoscope-navier-stokes --passage inlet --length L ...: one rigid passage.
//
// A program of its own: deal.II and PETSc bring MPI and some 250 libraries, which `manoscope` does
// not load. `manoscope simulate` starts it, alone or under mpirun.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flow_json.hpp"
#include "flow_simulation.hpp"
#include "given_wall.hpp"
#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/core/options.hpp"
#include "manoscope/core/provenance.hpp"
#include "passage_options.hpp"
#include "processes.hpp"

namespace manoscope::navier_stokes {
namespace {

template <class Options>
struct CommandLine {
  std::string shape;
  SimulationFiles files;
  Options options;
};

template <class Options>
void list(const Options& options) {
  for (const OptionInfo& option : list_options(options)) {
    fmt::print("  --{} {}: {} [{}]\n", option.name, option.kind, option.help, option.value);
  }
}

void help() {
  fmt::print(
      "usage: manoscope-navier-stokes SHAPE --height H --width W --flow-rate Q [OPTION "
      "VALUE]...\n\n"
      "Steady laminar flow below the wall whose deflection SHAPE tells (columns x, zeta; of a map "
      "x, z, zeta), as JSON.\n"
      "  --vtu FILE         writes velocity and pressure for ParaView\n"
      "  --checkpoint FILE  keeps the state there, and goes on from it\n");
  list(SimulationOptions{});
  fmt::print(
      "\nusage: manoscope-navier-stokes --passage inlet|outlet --length L --width W --height H\n"
      "       --channel-width W --channel-height H --flow-rate Q [OPTION VALUE]...\n\n"
      "The same of a rigid passage before or behind a channel: its drop, as JSON.\n");
  list(PassageOptions{});
}

template <class Options>
CommandLine<Options> read_words(const std::vector<std::string>& words) {
  CommandLine<Options> line;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.rfind("--", 0) != 0) {
      if (!line.shape.empty()) {
        throw InputError(word, "is a second shape", "Simulate one shape at a time");
      }
      line.shape = word;
      continue;
    }
    if (i + 1 == words.size()) throw InputError(word, "has no value", "Give one behind it");
    const std::string& value = words[++i];
    if (word == "--vtu") {
      line.files.vtu = value;
    } else if (word == "--checkpoint") {
      line.files.checkpoint = value;
    } else {
      set_option(line.options, word.substr(2), value, word);
    }
  }
  return line;
}

CommandLine<SimulationOptions> read_channel_words(const std::vector<std::string>& words) {
  auto line = read_words<SimulationOptions>(words);
  if (line.shape.empty()) {
    throw InputError("command line", "no shape is named",
                     "Name a table with the columns x and zeta, or x, z and zeta; see --help");
  }
  line.options.validate();
  if (line.options.inlet == "both") {
    throw InputError("--inlet", "both are two flows, and this program solves one",
                     "Run manoscope simulate with an experiment, or choose developed or uniform");
  }
  return line;
}

SimulatedChannel channel_of(const GivenWall& wall, const SimulationOptions& options) {
  SimulatedChannel channel;
  channel.channel = {Length::from_si(wall.length()), options.width, options.height};
  channel.zeta = wall.zeta(options);
  channel.fluid = {options.viscosity, options.density};
  channel.flow_rate = options.flow_rate;
  channel.lead_in = options.lead_in;
  channel.lead_out = options.lead_out;
  channel.lead_in_slips = options.lead_in_slips;
  channel.inlet =
      options.inlet == "uniform" ? flow::InletProfile::uniform : flow::InletProfile::developed;
  return channel;
}

/// Of this process at its largest.
double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

/// MPI looks for a network and starts a daemon even for one process: 0.3 s. What the user has set
/// stays.
void make_mpi_start_alone() {
  for (const char* sign : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"}) {
    if (std::getenv(sign) != nullptr) return;
  }
  for (const auto& [name, value] : {std::pair{"OMPI_MCA_ess_singleton_isolated", "1"},
                                    {"OMPI_MCA_pml", "ob1"},
                                    {"OMPI_MCA_btl", "self"}}) {
    setenv(name, value, 0);
  }
}

void print_answer(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) {
    throw InputError("standard output", "cannot be written",
                     "Check the disk or the pipe it goes to");
  }
}

/// Prints the answer, and takes the checkpoints away that led to it.
template <class Print>
void answer(std::chrono::steady_clock::time_point start, const SimulationFiles& files,
            const Print& text) {
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  const Processes& processes = Processes::all();
  const Effort effort{processes.size(), taken.count(), processes.sum(peak_megabytes())};
  together(processes.comm(), [&] {
    if (!processes.is_lead()) return;
    print_answer(text(effort));
    if (files.checkpoint.empty()) return;
    for (const char* end : {"", ".coarse", ".part", ".coarse.part"}) {
      std::filesystem::remove(std::filesystem::path(files.checkpoint) += end);
    }
  });
}

/// Before the work, not behind it: a picture that cannot be written.
void check(const SimulationFiles& files) {
  if (Processes::all().is_lead() && !files.vtu.empty()) const AtomicFile probe(files.vtu);
}

void run_channel(const std::vector<std::string>& words) {
  const auto start = std::chrono::steady_clock::now();
  CommandLine<SimulationOptions> line;
  std::optional<GivenWall> wall;
  together(Processes::all().comm(), [&] {
    line = read_channel_words(words);
    check(line.files);
    wall.emplace(read_shape_table(line.shape), line.options);
  });
  const Array1 stations = Array1::LinSpaced(line.options.stations, 0.0, wall->length());
  SimulatedFlow flow =
      simulate(channel_of(*wall, line.options), stations, line.options.mesh, line.files);
  flow.x += wall->start();
  answer(start, line.files,
         [&](const Effort& effort) { return flow_json(flow, effort, wall->note(line.options)); });
}

void run_passage(const std::vector<std::string>& words) {
  const auto start = std::chrono::steady_clock::now();
  CommandLine<PassageOptions> line;
  SimulatedPassage passage;
  together(Processes::all().comm(), [&] {
    line = read_words<PassageOptions>(words);
    check(line.files);
    if (!line.shape.empty()) {
      throw InputError(line.shape, "is a shape, and a passage has none", "Leave it out");
    }
    passage = passage_of(line.options);
  });
  const PassageFlow flow = simulate_passage(passage, line.options.mesh, line.files);
  answer(start, line.files, [&](const Effort& effort) { return passage_json(flow, effort); });
}

void run(const std::vector<std::string>& words) {
  const bool passage = std::find(words.begin(), words.end(), "--passage") != words.end();
  passage ? run_passage(words) : run_channel(words);
}

/// Tells whoever reads standard output, at once: a process that ends with a fault may take the
/// others with it.
void tell(const std::string& json, const std::string& text) {
  std::fwrite(json.data(), 1, json.size(), stdout);
  std::fflush(stdout);
  fmt::print(stderr, "manoscope-navier-stokes: {}\n", text);
}

void tell_fault(const std::string& text) {
  tell(fault_json(text), fmt::format("fault of the program: {}", text));
}

}  // namespace
}  // namespace manoscope::navier_stokes

int main(int argc, char** argv) {
  using namespace manoscope;
  constexpr int kOurFault = 1, kUsersFault = 2;
  const std::vector<std::string> words(argv + 1, argv + argc);
  for (const std::string& word : words) {
    if (word == "--help" || word == "-h") {
      navier_stokes::help();
      return 0;
    }
    if (word == "--version") {
      fmt::print("manoscope-navier-stokes {} ({})\n", program_version(), source_revision());
      return 0;
    }
  }
  navier_stokes::make_mpi_start_alone();
  // Faults are the same on every process; one that is not ends the others, too.
  const auto& processes = navier_stokes::Processes::all();
  try {
    navier_stokes::run(words);
    return 0;
  } catch (const InputError& error) {
    if (processes.is_lead()) {
      navier_stokes::tell(navier_stokes::error_json(error), fmt::format("error: {}", error.what()));
    }
    return kUsersFault;
  } catch (const std::bad_alloc&) {
    navier_stokes::tell_fault("out of memory: take fewer cells");
  } catch (const std::exception& error) {
    navier_stokes::tell_fault(error.what());
  }
  if (processes.size() > 1) MPI_Abort(processes.comm(), kOurFault);
  return kOurFault;
}
