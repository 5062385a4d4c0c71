// Maps as VTK ImageData (.vti), for ParaView and VTK.
//
// Source: "VTK XML file formats", docs.vtk.org. A point lies at the centre of its pixel, y counted
// down the rows as in our NetCDF files. Binary arrays are appended raw, each with its length as a
// little-endian 64-bit integer in front.
#include <fmt/format.h>

#include <bit>
#include <limits>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {
namespace {

void append_little(std::uint64_t value, std::string& bytes) {
  for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(value >> shift & 0xffU);
}

}  // namespace

void write_vti_map(const std::filesystem::path& path, const HeightMap& map) {
  const CameraGrid& grid = map.grid();
  const auto n = static_cast<std::uint64_t>(map.height().size());
  const std::string extent = fmt::format("0 {} 0 {} 0 0", grid.nx - 1, grid.ny - 1);
  std::string bytes = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<ImageData WholeExtent=\"{0}\" Origin=\"{1} {2} 0\" Spacing=\"{3} {4} 1\">\n"
      "<Piece Extent=\"{0}\">\n<PointData Scalars=\"height\">\n"
      "<DataArray type=\"Float64\" Name=\"height\" format=\"appended\" offset=\"0\"/>\n"
      "<DataArray type=\"UInt8\" Name=\"flags\" format=\"appended\" offset=\"{5}\"/>\n"
      "</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_",
      extent, 0.5 * grid.pitch_x.si(), 0.5 * grid.pitch_y.si(), grid.pitch_x.si(),
      grid.pitch_y.si(), 8 + 8 * n);
  bytes.reserve(bytes.size() + 9 * n + 64);
  append_little(8 * n, bytes);
  for (Index i = 0; i < map.height().size(); ++i) {
    const double height = map.flags().data()[i] == 0 ? map.height().data()[i]
                                                     : std::numeric_limits<double>::quiet_NaN();
    append_little(std::bit_cast<std::uint64_t>(height), bytes);
  }
  append_little(n, bytes);
  for (Index i = 0; i < map.flags().size(); ++i) {
    bytes += static_cast<char>(map.flags().data()[i]);
  }
  bytes += "\n</AppendedData>\n</VTKFile>\n";
  write_file_atomically(path, bytes);
}

}  // namespace manoscope::io
