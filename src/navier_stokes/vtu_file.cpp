// Flows as VTK UnstructuredGrid.
//
// Source: "VTK XML file formats", docs.vtk.org. Binary arrays are appended raw, each with its
// length as a little-endian 64-bit integer in front.
#include "vtu_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <string>

#include "manoscope/core/atomic_file.hpp"

namespace manoscope::navier_stokes {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Edges with `order` - 1 more between each two.
std::vector<double> cut(const std::vector<double>& edges, int order) {
  std::vector<double> result{edges.front()};
  for (std::size_t i = 1; i < edges.size(); ++i) {
    for (int k = 1; k <= order; ++k) {
      result.push_back(edges[i - 1] + (edges[i] - edges[i - 1]) * k / order);
    }
  }
  return result;
}

/// The arrays of a file: their heads, and the bytes behind them.
class AppendedData {
 public:
  template <class T>
  std::string array(const std::string& attributes, const std::vector<T>& values) {
    const std::string head = fmt::format("<DataArray {} format=\"appended\" offset=\"{}\"/>\n",
                                         attributes, bytes_.size());
    const std::uint64_t size = values.size() * sizeof(T);
    append(&size, sizeof(size));
    append(values.data(), size);
    return head;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  std::string bytes_;
};

}  // namespace

template <int dim>
void write_vtu(const std::filesystem::path& path, const FlowSolver<dim>& solver,
               const std::array<std::vector<double>, dim>& edges, int order,
               const VtuScales& scales) {
  std::array<std::vector<double>, 3> lines{std::vector<double>{0.0}, {0.0}, {0.0}};
  for (int axis = 0; axis < dim; ++axis) lines[axis] = cut(edges[axis], order);
  const auto n_x = static_cast<std::int64_t>(lines[0].size());
  const auto n_y = static_cast<std::int64_t>(lines[1].size());
  const auto n_z = static_cast<std::int64_t>(lines[2].size());

  std::vector<double> places, velocities, pressures;
  for (const double z : lines[2]) {
    for (const double t : lines[1]) {
      for (const double x : lines[0]) {
        Vector<dim> box{x, t};
        if constexpr (dim == 3) box[2] = z;
        const FlowPoint<dim> point = solver.at(box);
        for (int axis = 0; axis < 3; ++axis) {
          places.push_back(axis < dim ? point.place[axis] * scales.length : 0.0);
          velocities.push_back(axis < dim ? point.velocity[axis] * scales.velocity : 0.0);
        }
        pressures.push_back((point.pressure - scales.zero_pressure) * scales.pressure);
      }
    }
  }

  std::vector<std::int64_t> corners, ends;
  for (std::int64_t k = 0; k < std::max<std::int64_t>(1, n_z - 1); ++k) {
    for (std::int64_t j = 0; j + 1 < n_y; ++j) {
      for (std::int64_t i = 0; i + 1 < n_x; ++i) {
        for (std::int64_t layer = k; layer < k + dim - 1; ++layer) {
          const std::int64_t first = (layer * n_y + j) * n_x + i;
          corners.insert(corners.end(), {first, first + 1, first + n_x + 1, first + n_x});
        }
        ends.push_back(static_cast<std::int64_t>(corners.size()));
      }
    }
  }
  constexpr std::uint8_t kQuadrilateral = 9, kHexahedron = 12;
  const std::vector<std::uint8_t> kinds(ends.size(), dim == 3 ? kHexahedron : kQuadrilateral);

  AppendedData data;
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      pressures.size(), ends.size());
  text +=
      "<Points>\n" + data.array("type=\"Float64\" Name=\"place\" NumberOfComponents=\"3\"", places);
  text += "</Points>\n<Cells>\n" + data.array("type=\"Int64\" Name=\"connectivity\"", corners);
  text += data.array("type=\"Int64\" Name=\"offsets\"", ends);
  text += data.array("type=\"UInt8\" Name=\"types\"", kinds);
  text += "</Cells>\n<PointData Scalars=\"pressure\" Vectors=\"velocity\">\n";
  text += data.array("type=\"Float64\" Name=\"pressure\"", pressures);
  text += data.array("type=\"Float64\" Name=\"velocity\" NumberOfComponents=\"3\"", velocities);
  text += "</PointData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  write_file_atomically(path, text + data.bytes() + "\n</AppendedData>\n</VTKFile>\n");
}

template void write_vtu<2>(const std::filesystem::path&, const FlowSolver<2>&,
                           const std::array<std::vector<double>, 2>&, int, const VtuScales&);
template void write_vtu<3>(const std::filesystem::path&, const FlowSolver<3>&,
                           const std::array<std::vector<double>, 3>&, int, const VtuScales&);

}  // namespace manoscope::navier_stokes
