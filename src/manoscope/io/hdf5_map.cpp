// Maps in plain HDF5 and in MATLAB's version 7.3. In the process that reads HDF5 alone.
//
// Neither says what is a map: every array of numbers that can be one is offered (array_maps.hpp).
// MATLAB writes its arrays by columns, names the class of each in MATLAB_class, structs as groups,
// and what cells refer to below #refs#. Source: MathWorks, "MAT-File Versions"; the attributes as
// every such file has them.
#include <algorithm>
#include <array>
#include <string_view>

#include "manoscope/core/error.hpp"
#include "manoscope/io/array_maps.hpp"
#include "manoscope/io/hdf5_file.hpp"
#include "manoscope/io/hdf5_formats.hpp"

namespace manoscope::io {
namespace {

/// A number class of MATLAB that measures something; one byte a pixel is a picture or a mask.
bool is_matlab_number(const std::string& name) {
  static constexpr std::array<std::string_view, 8> kNames{"double", "single", "int16", "uint16",
                                                          "int32",  "uint32", "int64", "uint64"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

template <class Number>
std::optional<Number> first_of(std::initializer_list<std::optional<Number>> found) {
  for (const auto& one : found) {
    if (one) return one;
  }
  return std::nullopt;
}

std::vector<Channel> parse(const std::filesystem::path& path, const ReadOptions& options,
                           bool matlab) {
  const Hdf5File file(path);
  std::vector<NamedArray> arrays;
  for (const Hdf5File::Dataset& set : file.datasets()) {
    if (!set.numeric || set.elsewhere || set.bytes_per_value < 2) continue;
    if (set.path.starts_with("#")) continue;
    if (matlab && !is_matlab_number(file.text_attribute(set.path, "MATLAB_class").value_or(""))) {
      continue;
    }
    NamedArray array;
    array.name = set.path;
    array.shape = set.shape;
    array.by_columns = matlab;
    for (const char* name : {"units", "unit", "Units", "Unit"}) {
      if (array.unit.empty()) array.unit = file.text_attribute(set.path, name).value_or("");
    }
    array.fill = first_of<double>({file.number_attribute(set.path, "_FillValue"),
                                   file.number_attribute(set.path, "missing_value")});
    array.settings = file.settings(set.path);
    array.read = [&file, set](std::optional<std::uint64_t> frame, double* values) {
      file.read(set, frame, values);
    };
    arrays.push_back(std::move(array));
  }
  return array_channels(arrays, options, path.string());
}

}  // namespace

std::vector<Channel> parse_hdf5(const std::filesystem::path& path, const ReadOptions& options) {
  return parse(path, options, false);
}

std::vector<Channel> parse_matlab_hdf5(const std::filesystem::path& path,
                                       const ReadOptions& options) {
  return parse(path, options, true);
}

}  // namespace manoscope::io
