#include "checkpoint.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <system_error>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

namespace fs = std::filesystem;

struct Header {
  char magic[8] = {'M', 'A', 'N', 'O', 'F', 'L', 'O', 'W'};
  std::uint64_t problem = 0;  ///< tells problems apart
  double reached = 0.0;
  std::uint64_t grad_div = 0;
};

/// FNV-1a over the bits of numbers.
class Fingerprint {
 public:
  void add(double value) {
    auto bits = std::bit_cast<std::uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte, bits >>= 8)
      sum_ = (sum_ ^ (bits & 0xFFU)) * 0x100000001B3U;
  }
  std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xCBF29CE484222325U;
};

/// Visits the charts of all corners of the lattice.
template <int dim, class Visit>
void for_corners(const Edges<dim>& edges, const Visit& visit) {
  for (const double x : edges[0]) {
    for (const double t : edges[1]) {
      if constexpr (dim == 2) {
        visit(Vector<2>{x, t});
      } else {
        for (const double z : edges[2]) visit(Vector<3>{x, t, z});
      }
    }
  }
}

/// Of the mesh, its shape and what drives the flow.
template <int dim>
std::uint64_t fingerprint(const FlowProblem<dim>& problem) {
  Fingerprint print;
  for (const double number : {static_cast<double>(problem.order), problem.reynolds,
                              problem.inlet_flow.value_or(0.0), problem.slip_before}) {
    print.add(number);
  }
  for (const auto& edges : problem.edges) {
    print.add(static_cast<double>(edges.size()));
    for (const double edge : edges) print.add(edge);
  }
  for (const auto& side : problem.sides) print.add(static_cast<double>(side.condition));
  for_corners<dim>(problem.edges, [&](const Vector<dim>& chart) {
    const Vector<dim> place = problem.place(chart);
    for (const double number : place) print.add(number);
    for (std::size_t side = 0; side < problem.sides.size(); ++side) {
      const auto& edges = problem.edges[side / 2];
      const double end = side % 2 == 0 ? edges.front() : edges.back();
      if (problem.sides[side].condition != SideCondition::velocity || chart[side / 2] != end)
        continue;
      for (const double number : problem.sides[side].velocity(place)) print.add(number);
    }
  });
  return print.value();
}

/// The nodes of one field: those of polynomials of degree `order` on the lattice's cells.
template <int dim>
class NodePlanes {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;

  NodePlanes(const Discrete& discrete, int order, int n_components)
      : discrete_(discrete), order_(order), n_components_(n_components) {
    plane_ = static_cast<std::size_t>(n_components);
    for (int axis = 1; axis < dim; ++axis) plane_ *= n_nodes(axis);
    const auto [first, last] = discrete.mesh.own_columns();
    first_ = first * order;
    values_.assign(plane_ * static_cast<std::size_t>((last - first) * order + 1), 0.0);
  }

  /// Numbers of the file: of all planes, and of those before the first of this process.
  std::size_t size() const { return plane_ * n_nodes(0); }
  std::size_t before() const { return plane_ * static_cast<std::size_t>(first_); }
  std::vector<double>& values() { return values_; }
  /// The plane it shares with the process on its left, which writes it.
  std::size_t n_shared() const { return first_ == 0 ? 0 : plane_; }

  /// Visits (place in values(), degree of freedom) of every value of this process's cells.
  template <class Visit>
  void for_values(const Visit& visit) const {
    const auto& element = discrete_.element;
    std::vector<typename Discrete::DofIndex> indices(element.n_dofs_per_cell());
    for (const auto& cell : discrete_.dofs.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      cell->get_dof_indices(indices);
      const auto index = discrete_.mesh.index_of(cell);
      for (unsigned int i = 0; i < indices.size(); ++i) {
        const auto component = static_cast<int>(element.system_to_component_index(i).first);
        const bool is_velocity = component < dim;
        if (is_velocity != (n_components_ == dim)) continue;
        visit(place(index, element.unit_support_point(i)) + (is_velocity ? component : 0),
              indices[i]);
      }
    }
  }

 private:
  std::size_t n_nodes(int axis) const {
    return static_cast<std::size_t>(order_) *
               static_cast<std::size_t>(discrete_.mesh.n_cells(axis)) +
           1;
  }
  std::size_t place(const CellIndex<dim>& index, const dealii::Point<dim>& unit) const {
    std::size_t number = 0;
    for (int axis = 0; axis < dim; ++axis) {
      // Support points are not even from order 3 on, but ascend: their number in the cell is that
      // of the even one nearest.
      const int node = index[axis] * order_ + static_cast<int>(std::lround(unit[axis] * order_));
      number = axis == 0 ? static_cast<std::size_t>(node - first_)
                         : number * n_nodes(axis) + static_cast<std::size_t>(node);
    }
    return number * static_cast<std::size_t>(n_components_);
  }

  const Discrete& discrete_;
  int order_, n_components_, first_ = 0;
  std::size_t plane_ = 1;
  std::vector<double> values_;
};

/// A file that all processes share: each makes every call, whatever became of its own before, and
/// good() tells once all have come to the same place.
class SharedFile {
 public:
  SharedFile(const Processes& processes, const fs::path& path, int mode) : processes_(processes) {
    good_ =
        MPI_File_open(processes.comm(), path.c_str(), mode, MPI_INFO_NULL, &file_) == MPI_SUCCESS;
    opened_ = good();
  }
  ~SharedFile() {
    if (opened_) MPI_File_close(&file_);
  }
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  /// Whether all went well on all processes.
  bool good() const { return all(good_); }
  /// Whether something is so on all processes.
  bool all(bool here) const { return processes_.largest(here ? 0.0 : 1.0) == 0.0; }

  void write(std::size_t offset, const void* data, std::size_t size) {
    if (!opened_) return;
    MPI_Status status;
    const int code = MPI_File_write_at_all(file_, static_cast<MPI_Offset>(offset), data,
                                           static_cast<int>(size), MPI_BYTE, &status);
    good_ = code == MPI_SUCCESS && count(status) == size && good_;
  }
  void read(std::size_t offset, void* data, std::size_t size) {
    if (!opened_) return;
    MPI_Status status;
    const int code = MPI_File_read_at_all(file_, static_cast<MPI_Offset>(offset), data,
                                          static_cast<int>(size), MPI_BYTE, &status);
    good_ = code == MPI_SUCCESS && count(status) == size && good_;
  }
  std::size_t size() const {
    MPI_Offset bytes = 0;
    if (opened_) MPI_File_get_size(file_, &bytes);
    return static_cast<std::size_t>(bytes);
  }
  /// Cuts off what another run left behind.
  void resize(std::size_t size) {
    if (!opened_) return;
    const int code = MPI_File_set_size(file_, static_cast<MPI_Offset>(size));
    good_ = code == MPI_SUCCESS && good_;
  }
  void flush() {
    if (!opened_) return;
    const int code = MPI_File_sync(file_);
    good_ = code == MPI_SUCCESS && good_;
  }

 private:
  static std::size_t count(const MPI_Status& status) {
    int n = 0;
    MPI_Get_count(&status, MPI_BYTE, &n);
    return static_cast<std::size_t>(n);
  }

  const Processes& processes_;
  MPI_File file_ = MPI_FILE_NULL;
  bool good_ = false, opened_ = false;
};

template <int dim>
std::array<NodePlanes<dim>, 2> fields(const typename FlowSolver<dim>::Discrete& discrete) {
  const int order = discrete.problem.order;
  return {NodePlanes<dim>(discrete, order, dim), NodePlanes<dim>(discrete, order - 1, 1)};
}

/// Of a whole file, bytes.
template <int dim>
std::size_t size_of(const std::array<NodePlanes<dim>, 2>& parts) {
  return sizeof(Header) + (parts[0].size() + parts[1].size()) * sizeof(double);
}

}  // namespace

template <int dim>
void write_checkpoint(const fs::path& path, const typename FlowSolver<dim>::Discrete& discrete,
                      const Progress& progress) {
  const Processes& processes = discrete.processes;
  const fs::path beside = fs::path(path) += ".part";
  bool good = false;
  {
    SharedFile file(processes, beside, MPI_MODE_CREATE | MPI_MODE_WRONLY);
    auto parts = fields<dim>(discrete);
    file.resize(size_of<dim>(parts));
    Header header;
    header.problem = fingerprint<dim>(discrete.problem);
    header.reached = progress.reached;
    header.grad_div = progress.grad_div ? 1 : 0;
    file.write(0, &header, processes.is_lead() ? sizeof(header) : 0);
    std::size_t offset = sizeof(header);
    for (NodePlanes<dim>& field : parts) {
      std::vector<double>& values = field.values();
      field.for_values([&](std::size_t place, auto dof) { values[place] = discrete.state[dof]; });
      const std::size_t skip = field.n_shared();
      file.write(offset + (field.before() + skip) * sizeof(double), values.data() + skip,
                 (values.size() - skip) * sizeof(double));
      offset += field.size() * sizeof(double);
    }
    file.flush();
    good = file.good();
  }
  if (!good) {
    std::error_code ignored;
    if (processes.is_lead()) fs::remove(beside, ignored);
    throw InputError(path.string(), "cannot be written",
                     "Check the folder, its permissions and the room on the disk; the checkpoint "
                     "before it is kept");
  }
  together(processes.comm(), [&] {
    if (processes.is_lead()) fs::rename(beside, path);
  });
}

template <int dim>
std::optional<Progress> read_checkpoint(const fs::path& path,
                                        typename FlowSolver<dim>::Discrete& discrete) {
  const Processes& processes = discrete.processes;
  // All must come to the same answer, whatever they see of a shared disk.
  if (processes.largest(fs::exists(path) ? 0.0 : 1.0) > 0.0) return std::nullopt;
  SharedFile file(processes, path, MPI_MODE_RDONLY);
  Header header;
  header.magic[0] = '?';
  file.read(0, &header, sizeof(header));
  MPI_Bcast(&header, sizeof(header), MPI_BYTE, 0, processes.comm());
  auto parts = fields<dim>(discrete);
  const bool ours = std::memcmp(header.magic, Header().magic, sizeof(header.magic)) == 0;
  if (ours && !file.all(header.problem == fingerprint<dim>(discrete.problem))) return std::nullopt;
  const bool whole = file.all(ours && file.size() == size_of<dim>(parts));
  if (whole) {
    std::size_t offset = sizeof(header);
    for (NodePlanes<dim>& field : parts) {
      std::vector<double>& values = field.values();
      file.read(offset + field.before() * sizeof(double), values.data(),
                values.size() * sizeof(double));
      field.for_values([&](std::size_t place, auto dof) {
        if (discrete.owned.is_element(dof)) discrete.state(dof) = values[place];
      });
      offset += field.size() * sizeof(double);
    }
  }
  const bool good = file.good();
  if (!whole || !good) {
    throw InputError(path.string(), "is no whole checkpoint of a flow",
                     "Remove the file to begin anew");
  }
  discrete.state.update_ghost_values();
  return Progress{header.reached, header.grad_div != 0};
}

template void write_checkpoint<2>(const fs::path&, const FlowSolver<2>::Discrete&, const Progress&);
template void write_checkpoint<3>(const fs::path&, const FlowSolver<3>::Discrete&, const Progress&);
template std::optional<Progress> read_checkpoint<2>(const fs::path&, FlowSolver<2>::Discrete&);
template std::optional<Progress> read_checkpoint<3>(const fs::path&, FlowSolver<3>::Discrete&);

}  // namespace manoscope::navier_stokes
