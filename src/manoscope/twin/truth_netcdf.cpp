#include "manoscope/twin/truth_netcdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/netcdf_handle.hpp"

namespace manoscope::twin {
namespace {

using io::NetcdfFile;

constexpr const char* kMend = "Give a truth.nc as `manoscope twin` writes it";

/// Defines and writes variables one by one.
class Writer {
 public:
  Writer(NetcdfFile& file) : file_(file) {}

  void numbers(const std::string& name, const std::vector<int>& dimensions, const char* units,
               const char* long_name, const std::vector<double>& values,
               const char* coordinates = nullptr) {
    const int id = file_.define_double(name, dimensions);
    file_.put_attribute(id, "units", std::string(units));
    file_.put_attribute(id, "long_name", std::string(long_name));
    if (coordinates != nullptr) file_.put_attribute(id, "coordinates", std::string(coordinates));
    if (dimensions.size() > 1) file_.compress(id);
    file_.write(id, values.data());
  }
  void texts(const std::string& name, int dimension, const char* long_name,
             const std::vector<std::string>& values) {
    const int id = file_.define_string(name, {dimension});
    file_.put_attribute(id, "long_name", std::string(long_name));
    file_.write(id, values);
  }

 private:
  NetcdfFile& file_;
};

/// One number of every item.
template <class Item, class Get>
std::vector<double> each(const std::vector<Item>& items, Get get) {
  std::vector<double> values;
  for (const Item& item : items) values.push_back(get(item));
  return values;
}

/// One curve of every item, one behind the other.
template <class Item>
std::vector<double> rows(const std::vector<Item>& items, Array1 Item::*curve) {
  std::vector<double> values;
  for (const Item& item : items) {
    const Array1& row = item.*curve;
    values.insert(values.end(), row.data(), row.data() + row.size());
  }
  return values;
}

/// What snapped on the way to each level or run: `name`_snaps, _snap_jump and _snap_position.
template <class Item>
void write_snaps(Writer& writer, const std::string& name, int dimension, const char* since,
                 const std::vector<Item>& items) {
  const auto write = [&](const char* what, const char* units, const char* long_name, auto get) {
    writer.numbers(name + what, {dimension}, units,
                   fmt::format("{} since {}", long_name, since).c_str(),
                   each(items, [&](const Item& item) { return get(item.snaps); }));
  };
  write("_snaps", "1", "number of snap-throughs of the wall",
        [](const SnapTruth& snaps) { return static_cast<double>(snaps.n); });
  write("_snap_jump", "m", "furthest jump of the width-averaged deflection in a snap-through",
        [](const SnapTruth& snaps) { return snaps.jump; });
  write("_snap_position", "m", "where the wall jumped furthest",
        [](const SnapTruth& snaps) { return snaps.at; });
}

void write_runs(Writer& writer, const Truth& truth, const std::vector<RunScalars>& scalars, int x,
                int run) {
  std::vector<std::string> labels;
  for (const RunTruth& each_run : truth.runs) labels.push_back(each_run.run);
  writer.texts("run", run, "run", labels);
  const auto scalar = [&](const char* name, const char* units, const char* long_name, auto get) {
    writer.numbers(name, {run}, units, long_name, each(scalars, get));
  };
  scalar("flow_rate", "m3 s-1", "mean flow rate",
         [](const RunScalars& s) { return s.flow_rate.si(); });
  writer.numbers("pressure", {run, x}, "Pa", "true gauge pressure at the mean flow rate",
                 rows(truth.runs, &RunTruth::pressure), "flow_rate");
  writer.numbers("deflection", {run, x}, "m", "true width-averaged deflection under flow",
                 rows(truth.runs, &RunTruth::deflection), "flow_rate");
  scalar("inlet_pressure", "Pa", "gauge pressure at x = 0",
         [](const RunScalars& s) { return s.inlet.si(); });
  scalar("outlet_pressure", "Pa", "gauge pressure at the channel's end",
         [](const RunScalars& s) { return s.outlet.si(); });
  scalar("parasitic_drop", "Pa", "pressure drop of the rigid passages",
         [](const RunScalars& s) { return s.parasitic.si(); });
  scalar("transducer_drop", "Pa", "pressure drop as the transducer read it, with its noise",
         [](const RunScalars& s) { return s.transducer_reading.si(); });
  scalar("largest_deflection", "m", "largest width-averaged deflection along the channel",
         [](const RunScalars& s) { return s.largest_deflection.si(); });
  scalar("reynolds", "1", "channel-averaged Reynolds number 2Q / (nu (w + 2h))",
         [](const RunScalars& s) { return s.reynolds; });
  scalar("speed_index", "1", "largest flow speed along the channel over that of the wall's waves",
         [](const RunScalars& s) { return s.speed_index; });
  write_snaps(writer, "run", run, "the run before", truth.runs);
}

void write_levels(Writer& writer, const Truth& truth, int x, int level) {
  std::vector<std::string> maps;
  for (const LevelTruth& one : truth.levels) maps.push_back(one.map);
  writer.numbers("level_pressure", {level}, "Pa", "true hydrostatic gauge pressure",
                 each(truth.levels, [](const LevelTruth& l) { return l.pressure.si(); }));
  writer.numbers("level_label", {level}, "Pa", "hydrostatic gauge pressure as the gauge read it",
                 each(truth.levels, [](const LevelTruth& l) { return l.label.si(); }));
  writer.texts("level_map", level, "file name of the map", maps);
  writer.numbers("static_deflection", {level, x}, "m",
                 "true width-averaged deflection under level_pressure",
                 rows(truth.levels, &LevelTruth::deflection), "level_pressure");
  const bool has_compliance =
      std::all_of(truth.levels.begin(), truth.levels.end(),
                  [](const LevelTruth& l) { return l.compliance.size() > 0; });
  if (has_compliance) {
    writer.numbers("static_compliance", {level, x}, "m Pa-1",
                   "derivative of static_deflection with respect to the uniform pressure",
                   rows(truth.levels, &LevelTruth::compliance), "level_pressure");
  }
  write_snaps(writer, "level", level, "the level before", truth.levels);
}

/// Whole variables of known shape.
class Reader {
 public:
  Reader(const NetcdfFile& file, std::filesystem::path path)
      : file_(file), path_(std::move(path)) {}

  bool has(const char* name) const { return file_.variable(name).has_value(); }
  std::vector<double> numbers(const char* name, const std::vector<std::string>& dimensions) const {
    const auto variable = find(name, dimensions);
    if (!variable.numeric) refuse(fmt::format("variable \"{}\" holds no numbers", name));
    std::vector<double> values = file_.read_doubles(variable);
    for (const double value : values) {
      if (!std::isfinite(value)) refuse(fmt::format("variable \"{}\" is not finite", name));
    }
    return values;
  }
  std::vector<std::string> texts(const char* name,
                                 const std::vector<std::string>& dimensions) const {
    return file_.read_strings(find(name, dimensions));
  }
  [[noreturn]] void refuse(const std::string& found) const {
    throw InputError(path_.string(), found, kMend);
  }

 private:
  NetcdfFile::Variable find(const char* name, const std::vector<std::string>& dimensions) const {
    auto variable = file_.variable(name);
    if (!variable) refuse(fmt::format("no variable \"{}\"", name));
    if (variable->dimensions != dimensions) {
      refuse(fmt::format("variable \"{}\" has other dimensions", name));
    }
    return *std::move(variable);
  }

  const NetcdfFile& file_;
  std::filesystem::path path_;
};

Array1 row(const std::vector<double>& values, std::size_t index, Index n) {
  return Eigen::Map<const Array1>(values.data() + index * static_cast<std::size_t>(n), n);
}

/// Snaps into items that have them; a file without them leaves none.
template <class Item>
void read_snaps(const Reader& reader, const std::string& name, std::vector<Item>& items) {
  if (!reader.has((name + "_snaps").c_str())) return;
  const auto get = [&](const char* what) { return reader.numbers((name + what).c_str(), {name}); };
  const auto n = get("_snaps"), jump = get("_snap_jump"), at = get("_snap_position");
  for (std::size_t i = 0; i < items.size(); ++i) {
    items[i].snaps = {static_cast<int>(n[i]), jump[i], at[i]};
  }
}

}  // namespace

void write_truth_netcdf(const std::filesystem::path& path, const Truth& truth,
                        const std::vector<RunScalars>& scalars, const TruthHeader& header) {
  MANO_ASSERT(scalars.size() == truth.runs.size());
  AtomicFile target(path);
  NetcdfFile file = NetcdfFile::create(target.temporary(), path);
  file.put_attribute(NetcdfFile::kGlobal, "Conventions", std::string("CF-1.10"));
  file.put_attribute(NetcdfFile::kGlobal, "title",
                     "Truth of the virtual experiment " + header.name);
  file.put_attribute(NetcdfFile::kGlobal, "experiment_name", header.name);
  file.put_attribute(NetcdfFile::kGlobal, "inputs", header.inputs);
  file.put_attribute(NetcdfFile::kGlobal, "seed", fmt::format("{}", header.seed));
  if (header.flow_model != TruthHeader{}.flow_model) {
    file.put_attribute(NetcdfFile::kGlobal, "flow_model", header.flow_model);
    file.put_attribute(NetcdfFile::kGlobal, "inlet_profile", header.inlet_profile);
  }
  Writer writer(file);
  const int x = file.define_dimension("x", static_cast<std::size_t>(truth.x.size()));
  const int x_id = file.define_double("x", {x});
  file.put_attribute(x_id, "units", std::string("m"));
  file.put_attribute(x_id, "long_name",
                     std::string("distance from the channel's inlet edge along the flow"));
  file.put_attribute(x_id, "axis", std::string("X"));
  file.write(x_id, truth.x.data());
  const auto size = [](const char* name, Length length, Writer& to) {
    to.numbers(name, {}, "m", "true size", {length.si()});
  };
  size("channel_length", header.channel.length, writer);
  size("channel_width", header.channel.width, writer);
  size("channel_height", header.channel.height, writer);
  if (!truth.runs.empty()) {
    write_runs(writer, truth, scalars, x, file.define_dimension("run", truth.runs.size()));
  }
  if (!truth.levels.empty()) {
    write_levels(writer, truth, x, file.define_dimension("level", truth.levels.size()));
  }
  file.close();
  target.commit();
}

Truth read_truth_netcdf(const std::filesystem::path& path) {
  const NetcdfFile file = NetcdfFile::open(path);
  const Reader reader(file, path);
  Truth truth;
  const std::vector<double> x = reader.numbers("x", {"x"});
  if (x.size() < 2) reader.refuse("fewer than two stations");
  truth.x = row(x, 0, static_cast<Index>(x.size()));
  if (std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) != x.end()) {
    reader.refuse("x does not grow");
  }
  const auto text = [&](const char* name) {
    return file.text_attribute(NetcdfFile::kGlobal, name).value_or("");
  };
  truth.name = text("experiment_name");
  truth.inputs = text("inputs");
  if (reader.has("run")) {
    const auto labels = reader.texts("run", {"run"});
    const auto pressure = reader.numbers("pressure", {"run", "x"});
    const auto deflection = reader.numbers("deflection", {"run", "x"});
    for (std::size_t i = 0; i < labels.size(); ++i) {
      truth.runs.push_back(
          {labels[i], row(pressure, i, truth.x.size()), row(deflection, i, truth.x.size()), {}});
    }
    read_snaps(reader, "run", truth.runs);
  }
  if (reader.has("level_map")) {
    const auto maps = reader.texts("level_map", {"level"});
    const auto pressure = reader.numbers("level_pressure", {"level"});
    const auto label = reader.numbers("level_label", {"level"});
    const auto deflection = reader.numbers("static_deflection", {"level", "x"});
    for (std::size_t i = 0; i < maps.size(); ++i) {
      truth.levels.push_back({maps[i], Pressure::from_si(pressure[i]), Pressure::from_si(label[i]),
                              row(deflection, i, truth.x.size())});
    }
    if (reader.has("static_compliance")) {
      const auto compliance = reader.numbers("static_compliance", {"level", "x"});
      for (std::size_t i = 0; i < maps.size(); ++i) {
        truth.levels[i].compliance = row(compliance, i, truth.x.size());
      }
    }
    read_snaps(reader, "level", truth.levels);
  }
  return truth;
}

}  // namespace manoscope::twin
