#pragma once

#include <petscksp.h>

#include <memory>
#include <vector>

namespace manoscope::navier_stokes {

/// Degrees of freedom of this process by what they are.
struct FlowBlocks {
  int n_components = 0;
  std::vector<int> velocity;  ///< those of one node behind each other
  std::vector<int> pressure;
};

/// Solves the indefinite systems of a flow, on all processes, and checks every answer.
///
/// A solution counts where |b - A x| <= tolerance |b| in the 2-norm, after at most two steps of
/// refinement: the libraries' own verdict is no proof (UMFPACK 5.7 has called a solution of a
/// three-dimensional Stokes matrix good whose residual was 87 |b|).
class LinearSolver {
 public:
  LinearSolver(MPI_Comm comm, double tolerance);
  virtual ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// x of A x = b. The pattern of A stays that of the first call.
  /// @return false if the matrix is singular or the residual stays too large; x is then of no use.
  ///         All processes answer the same.
  /// @throws InputError if memory does not suffice, InternalError if the library gives up.
  [[nodiscard]] bool solve(Mat matrix, Vec right, Vec x);

  double residual() const { return residual_; }       ///< |b - A x| / |b| of the last solution
  int n_iterations() const { return n_iterations_; }  ///< of the last solution

 protected:
  /// Makes ready for this matrix; `again` after a solution that failed.
  /// @return false if that cannot be done, or not in another way than before.
  virtual bool prepare(Mat matrix, bool again) = 0;
  KSP ksp() const { return ksp_; }

 private:
  void refine(Mat matrix, Vec right, Vec x);

  KSP ksp_ = nullptr;
  Vec rest_ = nullptr, step_ = nullptr;
  double tolerance_, residual_ = 0.0;
  int n_iterations_ = 0;
};

/// MUMPS through PETSc. Source: P. R. Amestoy, I. S. Duff, J. Koster & J.-Y. L'Excellent, SIAM J.
/// Matrix Anal. Appl. 23 (2001) 15.
std::unique_ptr<LinearSolver> direct_solver(MPI_Comm comm, double tolerance = 1e-9);

/// Throws InternalError where a call of PETSc failed.
void check_petsc(PetscErrorCode code);

}  // namespace manoscope::navier_stokes
