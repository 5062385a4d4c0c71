#pragma once

#include "linear_solver.hpp"

namespace manoscope::navier_stokes {

/// Flexible GMRES with a block-triangular preconditioner, for systems too large to factorise.
///
///   [F  B^T]        F: the momentum equation, incomplete factors of level 1, with overlap
///   [B   0 ]        S = -B F^-1 B^T: pressure convection-diffusion, S^-1 ~ -(1 + K^-1 T) M^-1
///
/// with mass M, transport T and stiffness K of PressureOperators, K^-1 a cycle of algebraic
/// multigrid. Source: H. Elman, D. Silvester & A. Wathen, Finite Elements and Fast Iterative
/// Solvers (2014), ch. 9. The drag of the walls in T is ours: it is what Cahouet & Chabard (Int. J.
/// Numer. Methods Fluids 8 (1988) 869) do for drag by unsteadiness, and keeps the number of steps
/// from growing with the length of the channel. Channels are a few cells wide and high: factors of
/// level 1 act on F as its inverse does, where a multigrid cycle stalls on its convection.
///
/// Validity: with an open side and the grad-div term, whose weight the number of steps lives on.
class BlockSolver final : public LinearSolver {
 public:
  BlockSolver(MPI_Comm comm, const FlowBlocks& blocks);
  ~BlockSolver() override;

  /// Of the next systems; matrices of all degrees of freedom, that stay with the caller.
  /// @param grad_div  weight of the grad-div term.
  void set_pressure_operators(Mat mass, Mat stiffness, Mat transport, double grad_div);

 private:
  bool prepare(Mat matrix, bool again) override;
  static PetscErrorCode apply_schur(PC pc, Vec right, Vec result);

  IS velocity_ = nullptr, pressure_ = nullptr;
  Mat mass_ = nullptr, stiffness_ = nullptr, transport_ = nullptr;
  KSP mass_solver_ = nullptr, stiffness_solver_ = nullptr;
  Vec between_ = nullptr, mass_part_ = nullptr;
  double grad_div_ = 0.0;
  bool is_ready_ = false;
};

}  // namespace manoscope::navier_stokes
