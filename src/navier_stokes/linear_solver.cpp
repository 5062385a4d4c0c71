#include "linear_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

[[noreturn]] void give_up(const std::string& what) {
  throw InternalError("linear solver of the flow: " + what);
}

/// Names of the controls from the MUMPS 5.5 users' guide.
class DirectSolver final : public LinearSolver {
 public:
  using LinearSolver::LinearSolver;

 private:
  static constexpr int kOrdering = 7, kMetis = 5, kRoom = 14;
  static constexpr int kRightHandSide = 20, kDistributed = 10;
  static constexpr int kNoRoom = -9, kSingular = -10;
  /// Of integers and reals for its analysis, and of anything.
  static constexpr int kNoMemory[] = {-5, -7, -13};

  bool prepare(Mat matrix, bool again) override {
    constexpr int kTries = 4;
    for (int i = 0; i < kTries; ++i) {
      const int verdict = factorise(matrix, again || i > 0);
      if (verdict >= 0) return true;
      if (verdict == kSingular) return false;
      if (std::find(std::begin(kNoMemory), std::end(kNoMemory), verdict) != std::end(kNoMemory)) {
        throw InputError("linear solver of the flow", "its factors do not fit into memory",
                         "Take fewer cells, or --solver iterative, which needs less");
      }
      if (verdict != kNoRoom) give_up(fmt::format("MUMPS ends with {}", verdict));
      room_ *= 2;
    }
    give_up("MUMPS does not find room for its factors");
  }

  /// @return what MUMPS says of it: below 0 it is a fault.
  int factorise(Mat matrix, bool anew) {
    PC pc = nullptr;
    check_petsc(KSPGetPC(ksp(), &pc));
    if (anew) check_petsc(PCReset(pc));
    check_petsc(KSPSetOperators(ksp(), matrix, matrix));
    check_petsc(KSPSetType(ksp(), KSPPREONLY));
    check_petsc(PCSetType(pc, PCLU));
    check_petsc(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
    check_petsc(PCFactorSetUpMatSolverType(pc));
    Mat factors = nullptr;
    check_petsc(PCFactorGetMatrix(pc, &factors));
    check_petsc(MatMumpsSetIcntl(factors, kOrdering, kMetis));
    check_petsc(MatMumpsSetIcntl(factors, kRightHandSide, kDistributed));
    check_petsc(MatMumpsSetIcntl(factors, kRoom, room_));
    const PetscErrorCode code = PCSetUp(pc);
    PetscInt verdict = 0;
    check_petsc(MatMumpsGetInfog(factors, 1, &verdict));
    if (verdict >= 0) check_petsc(code);
    return static_cast<int>(verdict);
  }

  int room_ = 40;  // % of room beside what the analysis expects
};

}  // namespace

void check_petsc(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  give_up(fmt::format("PETSc ends with {}: {}", static_cast<int>(code), text ? text : ""));
}

LinearSolver::LinearSolver(MPI_Comm comm, double tolerance) : tolerance_(tolerance) {
  check_petsc(KSPCreate(comm, &ksp_));
}

LinearSolver::~LinearSolver() {
  VecDestroy(&rest_);
  VecDestroy(&step_);
  KSPDestroy(&ksp_);
}

void LinearSolver::refine(Mat matrix, Vec right, Vec x) {
  double size = 0.0, left = 0.0;
  check_petsc(VecNorm(right, NORM_2, &size));
  check_petsc(VecSet(x, 0.0));
  residual_ = 0.0;
  n_iterations_ = 0;
  if (size == 0.0) return;
  check_petsc(VecCopy(right, rest_));
  constexpr int kRefinements = 2;
  for (int i = 0; i <= kRefinements; ++i) {
    check_petsc(KSPSolve(ksp_, rest_, step_));
    PetscInt n = 0;
    check_petsc(KSPGetIterationNumber(ksp_, &n));
    n_iterations_ += static_cast<int>(n);
    check_petsc(VecAXPY(x, 1.0, step_));
    check_petsc(MatMult(matrix, x, rest_));
    check_petsc(VecAYPX(rest_, -1.0, right));
    check_petsc(VecNorm(rest_, NORM_2, &left));
    residual_ = left / size;
    if (residual_ <= tolerance_) return;
  }
}

bool LinearSolver::solve(Mat matrix, Vec right, Vec x) {
  if (rest_ == nullptr) {
    check_petsc(VecDuplicate(right, &rest_));
    check_petsc(VecDuplicate(right, &step_));
  }
  // An analysis looks at values, too: one made for others may fail where a new one does not.
  for (const bool again : {false, true}) {
    if (!prepare(matrix, again)) continue;
    refine(matrix, right, x);
    if (residual_ <= tolerance_) return true;
  }
  return false;
}

std::unique_ptr<LinearSolver> direct_solver(MPI_Comm comm, double tolerance) {
  return std::make_unique<DirectSolver>(comm, tolerance);
}

}  // namespace manoscope::navier_stokes
