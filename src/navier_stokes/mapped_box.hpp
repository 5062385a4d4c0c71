#pragma once

#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <exception>
#include <functional>
#include <mutex>
#include <vector>

namespace manoscope::navier_stokes {

/// Keeps, of the exceptions that several threads meet, that of the lowest place (x, z).
class FirstFault {
 public:
  using Place = std::array<double, 2>;

  template <class Work>
  void watch(const Place& place, const Work& work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (fault_ && !(place < place_)) return;
      fault_ = std::current_exception();
      place_ = place;
    }
  }
  /// Throws what was kept, if anything was.
  void rethrow() const {
    if (fault_) std::rethrow_exception(fault_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr fault_;
  Place place_{};
};

/// Box of cells below a roof: (x, t[, z]) is carried to (x, t h(x, z)[, z]).
///
/// The triangulation is that of the box, t in [0, 1]; the mapping, of the given polynomial degree,
/// holds the shape. Cells are numbered with x running fastest, then t, then z. Sides carry the
/// boundary ids 2 a (low end of axis a) and 2 a + 1 (high end).
template <int dim>
struct MappedBox {
  /// @param edges  positions of the cells' ends along x, t and z; ascending, at least two each.
  /// @param gap    h(x, z); z is 0 in two dimensions. Asked from several threads at once.
  /// @throws what `gap` throws at the lowest place.
  MappedBox(const std::array<std::vector<double>, dim>& edges,
            const std::function<double(double x, double z)>& gap, int degree)
      : mapping(degree) {
    std::vector<std::vector<double>> steps(dim);
    dealii::Point<dim> low, high;
    for (int axis = 0; axis < dim; ++axis) {
      for (std::size_t i = 1; i < edges[axis].size(); ++i) {
        steps[axis].push_back(edges[axis][i] - edges[axis][i - 1]);
      }
      low[axis] = edges[axis].front();
      high[axis] = edges[axis].back();
    }
    dealii::GridGenerator::subdivided_hyper_rectangle(triangulation, steps, low, high, true);
    // deal.II asks from several threads, and ends the program if an exception leaves one of them.
    FirstFault fault;
    mapping.initialize(
        dealii::MappingQ<dim>(1), triangulation,
        [&](const auto&, const dealii::Point<dim>& chart) {
          dealii::Point<dim> place = chart;
          const double z = dim == 3 ? chart[2] : 0.0;
          fault.watch({chart[0], z}, [&] { place[1] *= gap(chart[0], z); });
          return place;
        },
        false);
    fault.rethrow();
  }

  dealii::Triangulation<dim> triangulation;
  dealii::MappingQCache<dim> mapping;
};

}  // namespace manoscope::navier_stokes
