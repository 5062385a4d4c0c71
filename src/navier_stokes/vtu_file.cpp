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
#include "processes.hpp"

namespace manoscope::navier_stokes {
namespace {

static_assert(std::endian::native == std::endian::little);

/// The arrays of a file: their heads, and the bytes behind them.
class AppendedData {
 public:
  template <class T>
  std::string array(const std::string& attributes, const std::vector<T>& values) {
    std::string head = fmt::format("<DataArray {} format=\"appended\" offset=\"{}\"/>\n",
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

constexpr const char* kHead =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" "
    "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n";

template <int dim>
std::string piece_text(const FlowPiece<dim>& piece, const VtuScales& scales) {
  std::vector<double> places, velocities, pressures;
  for (const FlowPoint<dim>& point : piece.points) {
    for (int axis = 0; axis < 3; ++axis) {
      places.push_back(axis < dim ? point.place[axis] * scales.length : 0.0);
      velocities.push_back(axis < dim ? point.velocity[axis] * scales.velocity : 0.0);
    }
    pressures.push_back((point.pressure - scales.zero_pressure) * scales.pressure);
  }
  std::vector<std::int64_t> corners, ends;
  for (const auto& cell : piece.cells) {
    for (std::size_t layer = 0; layer < cell.size(); layer += 4) {
      for (const std::size_t k : {0, 1, 3, 2}) {  // VTK goes around
        corners.push_back(static_cast<std::int64_t>(cell[layer + k]));
      }
    }
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  constexpr std::uint8_t kQuadrilateral = 9, kHexahedron = 12;
  const std::vector<std::uint8_t> kinds(ends.size(), dim == 3 ? kHexahedron : kQuadrilateral);

  AppendedData data;
  std::string text = fmt::format(kHead, "UnstructuredGrid");
  text += fmt::format("<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
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
  return text + data.bytes() + "\n</AppendedData>\n</VTKFile>\n";
}

/// Text inside the quotes of an attribute.
std::string attribute(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

/// The file that names the pieces of several processes.
std::string index_text(const std::vector<std::string>& pieces) {
  std::string text = fmt::format(kHead, "PUnstructuredGrid");
  text +=
      "<PUnstructuredGrid GhostLevel=\"0\">\n"
      "<PPoints>\n<PDataArray type=\"Float64\" Name=\"place\" NumberOfComponents=\"3\"/>\n"
      "</PPoints>\n<PPointData Scalars=\"pressure\" Vectors=\"velocity\">\n"
      "<PDataArray type=\"Float64\" Name=\"pressure\"/>\n"
      "<PDataArray type=\"Float64\" Name=\"velocity\" NumberOfComponents=\"3\"/>\n"
      "</PPointData>\n";
  for (const std::string& piece : pieces) {
    text += fmt::format("<Piece Source=\"{}\"/>\n", attribute(piece));
  }
  return text + "</PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

template <int dim>
std::filesystem::path write_vtu(const std::filesystem::path& path, const FlowSolver<dim>& solver,
                                const VtuScales& scales) {
  const Processes& processes = Processes::all();
  const bool alone = processes.size() == 1;
  const auto piece_name = [&](int rank) {
    return fmt::format("{}_{}.vtu", path.stem().string(), rank);
  };
  auto index = std::filesystem::path(path).replace_extension(".pvtu");
  together(processes.comm(), [&] {
    const auto piece = alone ? path : path.parent_path() / piece_name(processes.rank());
    write_file_atomically(piece, piece_text(solver.piece(), scales));
  });
  if (alone) return path;
  // After all pieces are there: it names them.
  together(processes.comm(), [&] {
    if (!processes.is_lead()) return;
    std::vector<std::string> pieces;
    for (int rank = 0; rank < processes.size(); ++rank) pieces.push_back(piece_name(rank));
    write_file_atomically(index, index_text(pieces));
  });
  return index;
}

template std::filesystem::path write_vtu<2>(const std::filesystem::path&, const FlowSolver<2>&,
                                            const VtuScales&);
template std::filesystem::path write_vtu<3>(const std::filesystem::path&, const FlowSolver<3>&,
                                            const VtuScales&);

}  // namespace manoscope::navier_stokes
