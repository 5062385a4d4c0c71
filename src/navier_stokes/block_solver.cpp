#include "block_solver.hpp"

#include <algorithm>

namespace manoscope::navier_stokes {
namespace {

/// Newton's iteration squares what is left of its step: far less than the step needs no care.
constexpr double kTolerance = 1e-6;

/// How each part is solved, in PETSc's words. The step of GMRES below the tolerance leaves room for
/// the difference of its own norm and the true one.
constexpr const char* kSettings =
    "-flow_ksp_type fgmres -flow_ksp_gmres_restart 300 -flow_ksp_rtol 5e-7 -flow_ksp_max_it 300 "
    "-flow_pc_type fieldsplit -flow_pc_fieldsplit_type schur "
    "-flow_pc_fieldsplit_schur_fact_type upper "
    "-flow_fieldsplit_u_ksp_type preonly -flow_fieldsplit_u_pc_type asm "
    "-flow_fieldsplit_u_sub_pc_type ilu -flow_fieldsplit_u_sub_pc_factor_levels 1 "
    "-flow_fieldsplit_p_ksp_type preonly "
    "-flow_mass_ksp_type chebyshev -flow_mass_pc_type jacobi -flow_mass_ksp_max_it 4 "
    "-flow_mass_ksp_chebyshev_esteig 0,0.5,0,1.1 "
    "-flow_stiffness_ksp_type preonly -flow_stiffness_pc_type hypre ";

IS index_set(MPI_Comm comm, const std::vector<int>& indices, int block) {
  IS set = nullptr;
  check_petsc(ISCreateGeneral(comm, static_cast<PetscInt>(indices.size()), indices.data(),
                              PETSC_COPY_VALUES, &set));
  check_petsc(ISSetBlockSize(set, block));
  return set;
}

KSP part_solver(MPI_Comm comm, const char* prefix) {
  KSP solver = nullptr;
  check_petsc(KSPCreate(comm, &solver));
  check_petsc(KSPSetOptionsPrefix(solver, prefix));
  check_petsc(KSPSetFromOptions(solver));
  return solver;
}

}  // namespace

BlockSolver::BlockSolver(MPI_Comm comm, const FlowBlocks& blocks) : LinearSolver(comm, kTolerance) {
  check_petsc(PetscOptionsInsertString(nullptr, kSettings));
  velocity_ = index_set(comm, blocks.velocity, blocks.n_components);
  pressure_ = index_set(comm, blocks.pressure, 1);
  mass_solver_ = part_solver(comm, "flow_mass_");
  stiffness_solver_ = part_solver(comm, "flow_stiffness_");
}

BlockSolver::~BlockSolver() {
  for (KSP* solver : {&mass_solver_, &stiffness_solver_}) KSPDestroy(solver);
  for (Mat* matrix : {&mass_, &stiffness_, &transport_}) MatDestroy(matrix);
  for (IS* set : {&velocity_, &pressure_}) ISDestroy(set);
  for (Vec* part : {&between_, &mass_part_}) VecDestroy(part);
}

void BlockSolver::set_pressure_operators(Mat mass, Mat stiffness, Mat transport, double grad_div) {
  const auto take = [this](Mat from, Mat& part) {
    const MatReuse reuse = part == nullptr ? MAT_INITIAL_MATRIX : MAT_REUSE_MATRIX;
    check_petsc(MatCreateSubMatrix(from, pressure_, pressure_, reuse, &part));
  };
  take(mass, mass_);
  take(stiffness, stiffness_);
  take(transport, transport_);
  grad_div_ = grad_div;
  check_petsc(KSPSetOperators(mass_solver_, mass_, mass_));
  check_petsc(KSPSetOperators(stiffness_solver_, stiffness_, stiffness_));
  if (between_ == nullptr) check_petsc(MatCreateVecs(mass_, &between_, &mass_part_));
}

bool BlockSolver::prepare(Mat matrix, bool again) {
  if (again) return false;  // it knows one way
  check_petsc(KSPSetOperators(ksp(), matrix, matrix));
  if (is_ready_) return true;
  is_ready_ = true;
  check_petsc(KSPSetOptionsPrefix(ksp(), "flow_"));
  PC pc = nullptr;
  check_petsc(KSPGetPC(ksp(), &pc));
  check_petsc(PCSetType(pc, PCFIELDSPLIT));
  check_petsc(PCFieldSplitSetIS(pc, "u", velocity_));
  check_petsc(PCFieldSplitSetIS(pc, "p", pressure_));
  check_petsc(PCFieldSplitSetSchurPre(pc, PC_FIELDSPLIT_SCHUR_PRE_SELF, nullptr));
  check_petsc(KSPSetFromOptions(ksp()));
  check_petsc(KSPSetUp(ksp()));
  KSP* parts = nullptr;
  PetscInt n = 0;
  check_petsc(PCFieldSplitSchurGetSubKSP(pc, &n, &parts));
  PC schur = nullptr;
  check_petsc(KSPGetPC(parts[1], &schur));
  check_petsc(PCSetType(schur, PCSHELL));
  check_petsc(PCShellSetContext(schur, this));
  check_petsc(PCShellSetApply(schur, apply_schur));
  check_petsc(PetscFree(parts));
  return true;
}

PetscErrorCode BlockSolver::apply_schur(PC pc, Vec right, Vec result) {
  // PETSc calls this: a fault goes back as a number, for no exception crosses its frames.
  void* context = nullptr;
  PetscErrorCode code = PCShellGetContext(pc, &context);
  if (code != 0) return code;
  auto& self = *static_cast<BlockSolver*>(context);
  // -(1 + gamma + K^-1 T) M^-1
  code = KSPSolve(self.mass_solver_, right, self.mass_part_);
  if (code == 0) code = MatMult(self.transport_, self.mass_part_, self.between_);
  if (code == 0) code = KSPSolve(self.stiffness_solver_, self.between_, result);
  if (code == 0) code = VecAXPBY(result, -1.0 - self.grad_div_, -1.0, self.mass_part_);
  return code;
}

}  // namespace manoscope::navier_stokes
