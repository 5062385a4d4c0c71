#pragma once

// One station of the march on sections: see section_march.hpp.

#include "manoscope/core/arrays.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/marching.hpp"
#include "manoscope/flow/spectral.hpp"

namespace manoscope::flow {

/// What a section leaves to the lateral pressure. Arrays over the nodes across, sides included.
struct SectionState {
  Array1 gap;          ///< h, m
  Array1 turning;      ///< m = w/u
  Array1 mean_square;  ///< mean of u^2 over the gap, m2/s2
  Array1 shear;        ///< of u on floor and roof together, over eta, 1/s
};

/// Marches the axial velocity on a section, one station at a time. Half the width is used: the roof
/// and the flow are the same on both sides.
///
/// Unknowns are u at the inner nodes (t inner, s without the side), t fastest; walls hold zeros.
class SectionStepper {
 public:
  using Vector = Eigen::VectorXd;

  SectionStepper(const Channel& channel, const Fluid& fluid, double flow_rate, int nodes_across,
                 int degree_up);

  const Array1& across() const { return across_.nodes; }  ///< s in [0, 1]
  const EvenBasis& across_basis() const { return across_; }

  /// Starts at a station.
  /// @param gap      (n_s) m.
  /// @param inertia  part of the fluid's density to march with.
  void start(InletProfile inlet, const Array1& gap, double inertia);

  /// Goes one step on. The convecting velocities are extrapolated, which is of second order.
  /// @param push     (n_s) dp2/dx at the nodes, Pa/m.
  /// @param repeats  times to solve again with the velocities found: rough gaps want one.
  /// @return false if the solution is no number.
  bool step(double step, const Array1& gap, const Array1& push, int repeats);

  double pressure() const { return pressure_; }  ///< P, Pa, 0 at the start
  SectionState state() const;
  /// Mean over the width of the wall shear on the floor and on the roof, Pa.
  double floor_shear() const;
  double roof_shear() const;
  double momentum_factor() const;
  bool separated() const;  ///< flow back somewhere, which was cut off

 private:
  /// Laplacian on the inner nodes under a roof.
  Matrix laplacian(const Array1& gap) const;
  /// Adds the convection of derivative.now * u to the matrix and of the past to the right side.
  void add_convection(const BackwardDerivative& derivative, const Array1& gap,
                      const Matrix& predicted, const Matrix& u_past, const Matrix& flux_past,
                      Matrix& system, Vector& right);
  Array1 depth_mean(const Matrix& u) const;  ///< (n_s - 1)

  double half_width_, full_density_, density_, viscosity_, flow_;
  EvenBasis across_;
  NodalBasis up_;
  Index n_across_, n_up_;                 ///< inner nodes
  Matrix slope_even_, slope_odd_, bend_;  ///< across, inner
  Matrix slope_up_, bend_up_, rise_;      ///< up, inner; rise = integral from the floor
  Array1 mean_up_;                        ///< weights of the mean over the gap, inner
  Matrix to_side_;                        ///< integral from each node to the side, inner
  Array1 gap_, gap_before_;
  Array1 turning_;       ///< w/u over half the width, 1/m
  Matrix u_, u_before_;  ///< (n_up, n_across), m/s
  double pressure_ = 0.0, pressure_before_ = 0.0, previous_step_ = 0.0;
  bool backflow_ = false;
};

}  // namespace manoscope::flow
