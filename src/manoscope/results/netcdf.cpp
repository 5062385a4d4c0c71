#include "manoscope/results/netcdf.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <netcdf.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <type_traits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/netcdf_handle.hpp"
#include "manoscope/results/schema.hpp"

namespace manoscope::results {
namespace {

using io::NetcdfFile;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::string_view kConventions = "CF-1.10";
constexpr std::size_t kLargestChunk = std::size_t{1} << 23;     // bytes
constexpr std::size_t kLargestVariable = std::size_t{1} << 34;  // bytes; no measurement comes near
constexpr int kDeflateLevel =
    1;  // higher levels gain under 1 % on random mantissas, at twice the time
// Object headers of HDF5 hold attributes up to 64 kB; longer texts are kept as variable-length
// strings.
constexpr std::size_t kLongestPlainText = 32000;

/// Lines of a text; a line that holds a break would come back as two, so breaks become blanks.
std::string as_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (std::string line : lines) {
    std::replace(line.begin(), line.end(), '\n', ' ');
    text += (text.empty() ? "" : "\n") + line;
  }
  return text;
}

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

void put_global_text(NetcdfFile& file, std::string_view name, const std::string& text) {
  if (text.size() <= kLongestPlainText) {
    file.put_attribute(NetcdfFile::kGlobal, std::string(name), text);
    return;
  }
  const char* value = text.c_str();
  file.check(nc_put_att_string(file.id(), NC_GLOBAL, std::string(name).c_str(), 1, &value), name);
}

// ---- writing ----

int define_dimension(NetcdfFile& file, std::string_view name, std::size_t length) {
  if (length > 0) return file.define_dimension(std::string(name), length);
  // "None" can only be written as an unlimited dimension without entries.
  int id = 0;
  file.check(nc_def_dim(file.id(), std::string(name).c_str(), NC_UNLIMITED, &id), name);
  return id;
}

int define(NetcdfFile& file, const Variable& variable, const std::vector<int>& dimensions) {
  const std::string name(variable.name);
  return std::visit(
      [&](auto member) {
        using Value = std::remove_cvref_t<decltype(std::declval<Measurement>().*member)>;
        if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
          return file.define_string(name, dimensions);
        } else if constexpr (std::is_same_v<Value, std::vector<int>>) {
          return file.define_int(name, dimensions);
        } else if constexpr (std::is_same_v<Value, Flags2>) {
          return file.define_ubyte(name, dimensions);
        } else {
          return file.define_double(name, dimensions);
        }
      },
      variable.member);
}

bool is_float(const Variable& variable) {
  return !std::holds_alternative<std::vector<std::string> Measurement::*>(variable.member) &&
         !std::holds_alternative<std::vector<int> Measurement::*>(variable.member) &&
         !std::holds_alternative<Flags2 Measurement::*>(variable.member);
}

bool is_coordinate(const Variable& variable) {
  return variable.dimensions.size() == 1 && variable.dimensions.front() == variable.name;
}

/// The number that tells the entries of a run or level apart, besides their label or index.
std::string auxiliary_coordinates(const Variable& variable) {
  for (const auto& [dimension, coordinate] :
       {std::pair{"run", "flow_rate"}, std::pair{"level", "level_pressure"}}) {
    const auto& names = variable.dimensions;
    if (names.size() > 1 && std::find(names.begin(), names.end(), dimension) != names.end()) {
      return coordinate;
    }
  }
  return {};
}

void put_attributes(NetcdfFile& file, int id, const Variable& variable) {
  file.put_attribute(id, "units", std::string(variable.units));
  file.put_attribute(id, "long_name", std::string(variable.long_name));
  if (!variable.standard_name.empty()) {
    file.put_attribute(id, "standard_name", std::string(variable.standard_name));
  }
  if (!variable.ancillary_variables.empty()) {
    file.put_attribute(id, "ancillary_variables", std::string(variable.ancillary_variables));
  }
  if (const auto names = auxiliary_coordinates(variable); !names.empty()) {
    file.put_attribute(id, "coordinates", names);
  }
  if (variable.name == "x") file.put_attribute(id, "axis", std::string("X"));
  if (std::holds_alternative<Flags2 Measurement::*>(variable.member)) {
    std::vector<unsigned char> masks;
    std::vector<std::string_view> names;
    for (const FlagName& flag : kReadingFlags) {
      masks.push_back(flag.bit);
      names.push_back(flag.name);
    }
    file.put_attribute(id, "flag_masks", masks);
    file.put_attribute(id, "flag_meanings", fmt::format("{}", fmt::join(names, " ")));
  }
}

/// Chunks that hold one layer (all but the slowest dimension), or part of it where it is long.
void set_layout(NetcdfFile& file, int id, const Variable& variable,
                const std::vector<std::size_t>& shape) {
  const std::size_t rank = shape.size();
  if (rank < 2 || std::count(shape.begin(), shape.end(), std::size_t{0}) > 0) return;
  std::vector<std::size_t> chunk = shape;
  if (rank == 3) chunk[0] = 1;
  const std::size_t row_bytes = 8 * chunk[rank - 1];
  chunk[rank - 2] = std::clamp<std::size_t>(kLargestChunk / row_bytes, 1, chunk[rank - 2]);
  file.check(nc_def_var_chunking(file.id(), id, NC_CHUNKED, chunk.data()), variable.name);
  file.check(nc_def_var_deflate(file.id(), id, 1, 1, kDeflateLevel), variable.name);
}

/// Writes layer by layer, so that no second copy of a whole stack is needed.
template <class Layer>
void write_stack(NetcdfFile& file, int id, std::string_view name, const std::vector<Layer>& stack) {
  for (std::size_t layer = 0; layer < stack.size(); ++layer) {
    if (stack[layer].size() == 0) continue;
    const RowMajor values = stack[layer];
    const std::array<std::size_t, 3> start{layer, 0, 0};
    const std::array<std::size_t, 3> count{1, static_cast<std::size_t>(values.rows()),
                                           static_cast<std::size_t>(values.cols())};
    file.check(nc_put_vara_double(file.id(), id, start.data(), count.data(), values.data()), name);
  }
}

struct WriteValues {
  NetcdfFile& file;
  int id;
  std::string_view name;
  const Measurement& m;

  void operator()(double Measurement::*member) const { file.write(id, &(m.*member)); }
  void operator()(std::vector<Matrix> Measurement::*member) const {
    write_stack(file, id, name, m.*member);
  }
  void operator()(std::vector<Array2> Measurement::*member) const {
    write_stack(file, id, name, m.*member);
  }
  void operator()(std::vector<std::string> Measurement::*member) const {
    if (!(m.*member).empty()) file.write(id, m.*member);
  }
  void operator()(auto member) const {
    if ((m.*member).size() != 0) file.write(id, (m.*member).data());
  }
};

// ---- reading ----

const char* const kReadMend = "Give the result folder, or the result.nc, of a finished measurement";

/// A copy of the values in the shape that the file gives them.
struct ReadValues {
  const NetcdfFile& file;
  const NetcdfFile::Variable& variable;
  Measurement& m;

  Index length(std::size_t axis) const { return static_cast<Index>(variable.shape[axis]); }

  void operator()(double Measurement::*member) const {
    m.*member = file.read_doubles(variable).at(0);
  }
  void operator()(Array1 Measurement::*member) const {
    const auto values = file.read_doubles(variable);
    m.*member = Eigen::Map<const Array1>(values.data(), length(0));
  }
  void operator()(Array2 Measurement::*member) const {
    const auto values = file.read_doubles(variable);
    m.*member = Eigen::Map<const Array2>(values.data(), length(0), length(1));
  }
  void operator()(Flags2 Measurement::*member) const {
    const auto values = file.read_ints(variable);
    using Ints = Eigen::Array<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    m.*member = Eigen::Map<const Ints>(values.data(), length(0), length(1)).cast<FlagBits>();
  }
  void operator()(std::vector<std::string> Measurement::*member) const {
    m.*member = file.read_strings(variable);
  }
  void operator()(std::vector<int> Measurement::*member) const {
    m.*member = file.read_ints(variable);
  }
  void operator()(std::vector<Matrix> Measurement::*member) const { read_stack(m.*member); }
  void operator()(std::vector<Array2> Measurement::*member) const { read_stack(m.*member); }

  template <class Layer>
  void read_stack(std::vector<Layer>& stack) const {
    const auto values = file.read_doubles(variable);
    stack.clear();
    for (Index layer = 0; layer < length(0); ++layer) {
      const double* first = values.data() + layer * length(1) * length(2);
      stack.emplace_back(Eigen::Map<const RowMajor>(first, length(1), length(2)));
    }
  }
};

/// Refuses a variable whose type, dimensions or lengths are not those of the schema.
void check_variable(const std::filesystem::path& path, const Variable& expected,
                    const NetcdfFile::Variable& found,
                    std::map<std::string, std::size_t>& lengths) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(path.string(), fmt::format("variable {} {}", expected.name, what), kReadMend);
  };
  if (!std::equal(expected.dimensions.begin(), expected.dimensions.end(), found.dimensions.begin(),
                  found.dimensions.end())) {
    refuse(fmt::format("has dimensions ({}) instead of ({})", fmt::join(found.dimensions, ", "),
                       fmt::join(expected.dimensions, ", ")));
  }
  const bool text =
      std::holds_alternative<std::vector<std::string> Measurement::*>(expected.member);
  if (found.numeric == text) refuse(text ? "holds no text" : "holds no numbers");
  if (found.size() > kLargestVariable / sizeof(double)) {
    refuse(fmt::format("claims {} values", found.size()));
  }
  for (std::size_t axis = 0; axis < found.shape.size(); ++axis) {
    const auto [known, added] = lengths.emplace(found.dimensions[axis], found.shape[axis]);
    if (!added && known->second != found.shape[axis]) refuse("disagrees with the other lengths");
  }
}

}  // namespace

void write_netcdf(const std::filesystem::path& path, const std::filesystem::path& shown_as,
                  const Measurement& measurement, const std::vector<std::string>& files) {
  check_shapes(measurement);
  auto file = NetcdfFile::create(path, shown_as);
  file.put_attribute(NetcdfFile::kGlobal, "Conventions", std::string(kConventions));
  for (const GlobalText& text : global_texts()) {
    put_global_text(file, text.name, measurement.*text.member);
  }
  put_global_text(file, "warnings", as_lines(measurement.warnings));
  put_global_text(file, "files", as_lines(files));

  std::map<std::string_view, std::pair<int, std::size_t>> ids;  // dimension: id, length
  for (const Dimension& dimension : dimensions()) {
    const auto length = static_cast<std::size_t>(dimension.length(measurement));
    ids[dimension.name] = {define_dimension(file, dimension.name, length), length};
  }
  std::vector<int> variable_ids;
  for (const Variable& variable : variables()) {
    std::vector<int> dimension_ids;
    std::vector<std::size_t> shape;
    for (const auto name : variable.dimensions) {
      dimension_ids.push_back(ids.at(name).first);
      shape.push_back(ids.at(name).second);
    }
    const int id = define(file, variable, dimension_ids);
    set_layout(file, id, variable, shape);
    if (is_float(variable) && !is_coordinate(variable)) file.fill_with_nan(id);
    put_attributes(file, id, variable);
    variable_ids.push_back(id);
  }
  const int other = file.define_double("x_other", {ids.at("x_other").first});
  file.put_attribute(other, "units", std::string("m"));
  file.put_attribute(other, "long_name", std::string("the stations of x, second index"));

  for (std::size_t i = 0; i < variable_ids.size(); ++i) {
    const Variable& variable = variables()[i];
    std::visit(WriteValues{file, variable_ids[i], variable.name, measurement}, variable.member);
  }
  if (measurement.x.size() != 0) file.write(other, measurement.x.data());
  file.close();
}

namespace {

Measurement read_contents(const NetcdfFile& file, const std::filesystem::path& path) {
  Measurement measurement;
  for (const GlobalText& text : global_texts()) {
    const auto found = file.text_attribute(NetcdfFile::kGlobal, std::string(text.name));
    if (!found) {
      throw InputError(path.string(), fmt::format("has no attribute {}", text.name), kReadMend);
    }
    measurement.*text.member = *found;
  }
  measurement.warnings =
      split_lines(file.text_attribute(NetcdfFile::kGlobal, "warnings").value_or(""));
  std::map<std::string, std::size_t> lengths{{"bound", 2}};
  for (const Variable& variable : variables()) {
    const auto found = file.variable(std::string(variable.name));
    if (!found) {
      throw InputError(path.string(), fmt::format("has no variable {}", variable.name), kReadMend);
    }
    check_variable(path, variable, *found, lengths);
    std::visit(ReadValues{file, *found, measurement}, variable.member);
  }
  if (lengths.at("x") != lengths.at("x_other")) {
    throw InputError(path.string(), "dimensions x and x_other differ in length", kReadMend);
  }
  for (const int run : measurement.crossing_run) {
    if (run < 0 || static_cast<std::size_t>(run) >= measurement.run.size()) {
      throw InputError(path.string(), fmt::format("crossing_run names run {}", run), kReadMend);
    }
  }
  return measurement;
}

/// The version in a `source` "manoscope 0.1.0 (revision)", or "" if it is not of that form.
std::string version_in(const std::string& source) {
  constexpr std::string_view kProgram = "manoscope ";
  return source.rfind(kProgram, 0) == 0 ? source.substr(kProgram.size()) : std::string();
}

}  // namespace

Measurement read_netcdf(const std::filesystem::path& path) {
  const auto file = NetcdfFile::open(path);
  try {
    return read_contents(file, path);
  } catch (const InputError& error) {
    const std::string here = fmt::format("{} ({})", program_version(), source_revision());
    const std::string there =
        version_in(file.text_attribute(NetcdfFile::kGlobal, "source").value_or(""));
    if (there.empty() || there == here) throw;
    throw InputError(path.string(),
                     fmt::format("written by another version of manoscope ({}, this is {}): it {}",
                                 there, here, error.found()),
                     "Measure again with this version");
  }
}

std::optional<std::string> title_in(const std::filesystem::path& path) {
  try {
    return NetcdfFile::open(path).text_attribute(NetcdfFile::kGlobal, "title");
  } catch (const InputError&) {
    return std::nullopt;  // not one of ours, or damaged
  }
}

std::vector<std::string> published_files(const std::filesystem::path& path) {
  try {
    const auto file = NetcdfFile::open(path);
    return split_lines(file.text_attribute(NetcdfFile::kGlobal, "files").value_or(""));
  } catch (const InputError&) {
    return {};  // not one of ours, or damaged: there is nothing known to withdraw
  }
}

}  // namespace manoscope::results
