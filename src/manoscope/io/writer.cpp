#include "manoscope/io/writer.hpp"

#include <fmt/format.h>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"

namespace manoscope::io {

std::string written_formats() { return ".gsf, .nc, .x3p, .tif, .vti, .csv or .txt"; }

std::filesystem::path numbered(const std::filesystem::path& path, int number, int largest) {
  const std::size_t width = fmt::format("{}", largest).size();
  std::filesystem::path result = path;
  result.replace_filename(
      fmt::format("{}-{:0{}}{}", path.stem().string(), number, width, path.extension().string()));
  return result;
}

void write_map(const std::filesystem::path& path, const HeightMap& map, const std::string& title) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".gsf") return write_gsf(path, map, title);
  if (extension == ".nc") return write_netcdf_map(path, map, title);
  if (extension == ".csv" || extension == ".txt") return write_text_map(path, map, title);
  if (extension == ".x3p") return write_x3p(path, map);
  if (extension == ".tif" || extension == ".tiff") return write_tiff_map(path, map, title);
  if (extension == ".vti") return write_vti_map(path, map);
  throw InputError(path.string(),
                   extension.empty() ? std::string("has no extension that names a format")
                                     : fmt::format("no map is written as \"{}\"", extension),
                   "End the name in " + written_formats());
}

}  // namespace manoscope::io
