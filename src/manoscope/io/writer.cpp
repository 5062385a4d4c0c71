#include "manoscope/io/writer.hpp"

#include <fmt/format.h>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"

namespace manoscope::io {

void write_map(const std::filesystem::path& path, const HeightMap& map, const std::string& title) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".gsf") return write_gsf(path, map, title);
  if (extension == ".nc") return write_netcdf_map(path, map, title);
  if (extension == ".csv" || extension == ".txt") return write_text_map(path, map, title);
  throw InputError(path.string(),
                   extension.empty() ? std::string("has no extension that names a format")
                                     : fmt::format("no map is written as \"{}\"", extension),
                   "End the name in .gsf, .nc, .csv or .txt");
}

}  // namespace manoscope::io
