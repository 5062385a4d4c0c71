#include "manoscope/results/simulation_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <variant>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/netcdf_handle.hpp"
#include "manoscope/results/simulation_schema.hpp"
#include "manoscope/results/write.hpp"

namespace manoscope::results {
namespace {

namespace fs = std::filesystem;
using io::NetcdfFile;
using S = Simulation;

constexpr const char* kFolder = "simulation";

Index length_of(const Simulation& s, std::string_view dimension) {
  if (dimension == "x") return s.x.size();
  if (dimension == "variant") return static_cast<Index>(s.variant.size());
  return static_cast<Index>(s.error_source.size());
}

/// The numbers of an entry, slowest dimension first.
struct Numbers {
  const Simulation& s;
  std::vector<double> operator()(double S::*member) const { return {s.*member}; }
  std::vector<double> operator()(Array1 S::*member) const {
    return {(s.*member).begin(), (s.*member).end()};
  }
  std::vector<double> operator()(Array2 S::*member) const {
    return {(s.*member).data(), (s.*member).data() + (s.*member).size()};
  }
  std::vector<double> operator()(std::vector<Array2> S::*member) const {
    std::vector<double> all;
    for (const Array2& layer : s.*member)
      all.insert(all.end(), layer.data(), layer.data() + layer.size());
    return all;
  }
  std::vector<double> operator()(std::string S::*) const { return {}; }
  std::vector<double> operator()(std::vector<std::string> S::*) const { return {}; }
};

void write_entry(NetcdfFile& file, const SimulationVariable& entry,
                 const std::map<std::string, int>& ids, const Simulation& s) {
  std::vector<int> dimensions;
  std::size_t size = 1;
  for (const char* name : entry.dimensions) {
    dimensions.push_back(ids.at(name));
    size *= static_cast<std::size_t>(length_of(s, name));
  }
  const int id = entry.is_text() ? file.define_string(entry.name, dimensions)
                                 : file.define_double(entry.name, dimensions);
  file.put_attribute(id, "units", std::string(entry.units));
  file.put_attribute(id, "long_name", std::string(entry.long_name));
  if (const auto* text = std::get_if<std::string S::*>(&entry.member)) {
    file.write(id, std::vector<std::string>{s.**text});
  } else if (const auto* texts = std::get_if<std::vector<std::string> S::*>(&entry.member)) {
    file.write(id, s.**texts);
  } else {
    const std::vector<double> numbers = std::visit(Numbers{s}, entry.member);
    if (numbers.size() != size) {
      throw InternalError(fmt::format("simulation variable {} has {} numbers, its dimensions {}",
                                      entry.name, numbers.size(), size));
    }
    file.write(id, numbers.data());
  }
}

[[noreturn]] void refuse(const fs::path& path, const std::string& found) {
  throw InputError(path.string(), found,
                   "Delete the file, or run manoscope simulate again with the same run");
}

void read_entry(const NetcdfFile& file, const fs::path& path, const SimulationVariable& entry,
                std::map<std::string, std::size_t>& lengths, Simulation& s) {
  const auto found = file.variable(entry.name);
  if (!found) refuse(path, fmt::format("has no variable {}", entry.name));
  const std::vector<std::string> expected(entry.dimensions.begin(), entry.dimensions.end());
  constexpr std::size_t kMost = std::size_t{1} << 24U;  // numbers; no simulation comes near
  if (found->dimensions != expected || found->numeric == entry.is_text() || found->size() > kMost) {
    refuse(path, fmt::format("variable {} is not what manoscope simulate writes", entry.name));
  }
  for (std::size_t axis = 0; axis < expected.size(); ++axis) {
    const auto [known, added] = lengths.emplace(expected[axis], found->shape[axis]);
    if (!added && known->second != found->shape[axis]) {
      refuse(path, fmt::format("variable {} disagrees with the other lengths", entry.name));
    }
  }
  const auto n = [&](std::size_t axis) { return static_cast<Index>(found->shape[axis]); };
  if (const auto* text = std::get_if<std::string S::*>(&entry.member)) {
    s.** text = file.read_strings(*found).at(0);
    return;
  }
  if (const auto* texts = std::get_if<std::vector<std::string> S::*>(&entry.member)) {
    s.** texts = file.read_strings(*found);
    return;
  }
  const std::vector<double> numbers = file.read_doubles(*found);
  if (const auto* number = std::get_if<double S::*>(&entry.member)) {
    s.** number = numbers.at(0);
  } else if (const auto* list = std::get_if<Array1 S::*>(&entry.member)) {
    s.** list = Eigen::Map<const Array1>(numbers.data(), n(0));
  } else if (const auto* table = std::get_if<Array2 S::*>(&entry.member)) {
    s.** table = Eigen::Map<const Array2>(numbers.data(), n(0), n(1));
  } else {
    auto& layers = s.*std::get<std::vector<Array2> S::*>(entry.member);
    for (Index i = 0; i < n(0); ++i) {
      layers.emplace_back(Eigen::Map<const Array2>(numbers.data() + i * n(1) * n(2), n(1), n(2)));
    }
  }
}

/// A label as a name that every file system takes.
std::string file_name(const std::string& label) {
  std::string name;
  for (const char c : label) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain =
        std::isalnum(byte) != 0 || c == '-' || c == '_' || (c == '.' && !name.empty());
    name += plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return name;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return;
  throw InputError(folder.string(), "cannot be made: " + error.message(),
                   "Check the permissions of the result folder");
}

}  // namespace

fs::path simulation_file(const std::string& run, int dim) {
  return fs::path(kFolder) / fmt::format("{}_{}d.nc", file_name(run), dim);
}

fs::path write_simulation(const fs::path& folder, const Simulation& simulation) {
  fs::path target = folder / simulation_file(simulation.run, static_cast<int>(simulation.dim));
  make_folder(target.parent_path());
  AtomicFile whole(target);
  {
    auto file = NetcdfFile::create(whole.temporary(), target);
    std::map<std::string, int> ids;
    for (const char* name : {"x", "variant", "error_source"}) {
      ids[name] =
          file.define_dimension(name, static_cast<std::size_t>(length_of(simulation, name)));
    }
    for (const SimulationVariable& entry : simulation_variables())
      write_entry(file, entry, ids, simulation);
    file.close();
  }
  whole.commit();
  return target;
}

Simulation read_simulation(const fs::path& path) {
  const auto file = [&] {
    try {
      return NetcdfFile::open(path);
    } catch (const InputError& error) {
      refuse(path, error.found());
    }
  }();
  Simulation simulation;
  std::map<std::string, std::size_t> lengths;
  for (const SimulationVariable& entry : simulation_variables())
    read_entry(file, path, entry, lengths, simulation);
  if (simulation.dim != 2.0 && simulation.dim != 3.0) {
    refuse(path, fmt::format("is of {:g} dimensions", simulation.dim));
  }
  return simulation;
}

StoredSimulations read_simulations(const fs::path& folder, const Measurement& measurement) {
  StoredSimulations stored;
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder / kFolder, error)) {
    if (entry.path().extension() == ".nc") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& path : files) {
    Simulation one = read_simulation(path);
    const auto leave = [&](const char* why) {
      stored.left_out.push_back(
          fmt::format("{} is left out: {}; run manoscope simulate again", path.string(), why));
    };
    const auto run = std::find(measurement.run.begin(), measurement.run.end(), one.run);
    if (run == measurement.run.end() || one.inputs != measurement.inputs ||
        one.experiment != measurement.experiment) {
      leave("it was made of other maps or another experiment file");
      continue;
    }
    const double read = measurement.extracted_drop[run - measurement.run.begin()];
    constexpr double kSame = 1e-9;  // round-off of another number of threads is less
    if (std::isfinite(read) != std::isfinite(one.extracted_drop) ||
        std::abs(read - one.extracted_drop) > kSame * std::abs(read)) {
      leave("it was held against a reading with other settings");
      continue;
    }
    stored.simulations.push_back(std::move(one));
  }
  return stored;
}

void check_result_of(const fs::path& folder, const std::string& experiment,
                     const std::string& inputs) {
  const Measurement measurement = read_result(folder);
  if (measurement.experiment == experiment && measurement.inputs == inputs) return;
  throw InputError(
      folder.string(),
      measurement.inputs == inputs
          ? "holds the result of another version of the experiment file"
          : fmt::format("holds the result of other maps, \"{}\"", measurement.title),
      "Give the folder that manoscope measure wrote of this experiment, or measure again");
}

void check_result_of(const fs::path& folder, const std::string& experiment) {
  if (read_result(folder).experiment == experiment) return;
  throw InputError(folder.string(), "holds the result of another version of the experiment file",
                   "Give the folder that manoscope measure wrote of it, or measure again");
}

fs::path write_passages(const fs::path& folder, const std::string& table) {
  fs::path target = folder / kFolder / "passages.csv";
  make_folder(target.parent_path());
  write_file_atomically(target, table);
  return target;
}

}  // namespace manoscope::results
