#include "sparse_direct.hpp"

#include <dmumps_c.h>
#include <fmt/format.h>
#include <mpi.h>
#include <umfpack.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {

std::vector<double> SparseMatrix::times(const std::vector<double>& x) const {
  std::vector<double> y(static_cast<std::size_t>(size()), 0.0);
  for (int row = 0; row < size(); ++row) {
    double sum = 0.0;
    for (int k = row_start[row]; k < row_start[row + 1]; ++k) sum += value[k] * x[column[k]];
    y[row] = sum;
  }
  return y;
}

class SparseDirect::Factors {
 public:
  virtual ~Factors() = default;
  /// Factorises; the pattern is that of the last call unless `new_pattern`.
  virtual void factorise(const SparseMatrix& matrix, bool new_pattern) = 0;
  virtual std::vector<double> solve(const SparseMatrix& matrix, const std::vector<double>& b) = 0;

  bool has_pattern_of(const SparseMatrix& matrix) const {
    return n_ == matrix.size() && n_entries_ == matrix.column.size();
  }
  void remember_pattern(const SparseMatrix& matrix) {
    n_ = matrix.size();
    n_entries_ = matrix.column.size();
  }

 private:
  int n_ = -1;
  std::size_t n_entries_ = 0;
};

namespace {

[[noreturn]] void give_up(const std::string& what) {
  throw InternalError("sparse direct solver: " + what);
}

/// MPI for as long as the program runs; MUMPS asks for it even on one process.
void start_mpi() {
  int started = 0;
  MPI_Initialized(&started);
  if (started != 0) return;
  if (MPI_Init(nullptr, nullptr) != MPI_SUCCESS) give_up("MPI does not start");
  std::atexit([] {
    int ended = 0;
    MPI_Finalized(&ended);
    if (ended == 0) MPI_Finalize();
  });
}

/// MUMPS, a multifrontal LU. Source: P. R. Amestoy, I. S. Duff, J. Koster & J.-Y. L'Excellent, SIAM
/// J. Matrix Anal. Appl. 23 (2001) 15; names of its controls from the MUMPS 5.5 users' guide.
class MumpsFactors final : public SparseDirect::Factors {
 public:
  MumpsFactors() {
    start_mpi();
    mumps_.par = 1;
    mumps_.sym = 0;
    mumps_.comm_fortran = MPI_Comm_c2f(MPI_COMM_SELF);
    call(kStart);
    for (const int stream : {1, 2, 3, 4}) control(stream) = 0;  // prints nothing
    constexpr int kMetis = 5;
    control(7) = kMetis;
    control(14) = 40;  // % of room beside what the analysis expects
  }
  ~MumpsFactors() override {
    mumps_.job = kEnd;
    dmumps_c(&mumps_);
  }
  MumpsFactors(const MumpsFactors&) = delete;
  MumpsFactors& operator=(const MumpsFactors&) = delete;

  void factorise(const SparseMatrix& matrix, bool new_pattern) override {
    if (new_pattern) set_pattern(matrix);
    values_ = matrix.value;
    mumps_.a = values_.data();
    if (new_pattern) call(kAnalyse);
    constexpr int kTries = 4, kNoRoom = -9;
    for (int i = 0; i < kTries; ++i) {
      mumps_.job = kFactorise;
      dmumps_c(&mumps_);
      if (mumps_.infog[0] != kNoRoom) break;
      control(14) *= 2;
    }
    check();
  }

  std::vector<double> solve(const SparseMatrix&, const std::vector<double>& b) override {
    std::vector<double> x = b;
    mumps_.rhs = x.data();
    call(kSolve);
    return x;
  }

 private:
  static constexpr int kStart = -1, kEnd = -2, kAnalyse = 1, kFactorise = 2, kSolve = 3;

  int& control(int number) { return mumps_.icntl[number - 1]; }
  void set_pattern(const SparseMatrix& matrix) {
    rows_.clear();
    columns_.clear();
    for (int row = 0; row < matrix.size(); ++row) {
      for (int k = matrix.row_start[row]; k < matrix.row_start[row + 1]; ++k) {
        rows_.push_back(row + 1);
        columns_.push_back(matrix.column[k] + 1);
      }
    }
    mumps_.n = matrix.size();
    mumps_.nnz = static_cast<MUMPS_INT8>(rows_.size());
    mumps_.irn = rows_.data();
    mumps_.jcn = columns_.data();
  }
  void call(int job) {
    mumps_.job = job;
    dmumps_c(&mumps_);
    check();
  }
  void check() const {
    if (mumps_.infog[0] < 0) {
      give_up(fmt::format("MUMPS ends with {} ({}); -13 is want of memory", mumps_.infog[0],
                          mumps_.infog[1]));
    }
  }

  DMUMPS_STRUC_C mumps_{};
  std::vector<int> rows_, columns_;
  std::vector<double> values_;
};

/// UMFPACK, a multifrontal LU. Source: T. A. Davis, ACM Trans. Math. Softw. 30 (2004) 196.
class UmfpackFactors final : public SparseDirect::Factors {
 public:
  UmfpackFactors() = default;
  ~UmfpackFactors() override {
    umfpack_di_free_numeric(&numeric_);
    umfpack_di_free_symbolic(&symbolic_);
  }
  UmfpackFactors(const UmfpackFactors&) = delete;
  UmfpackFactors& operator=(const UmfpackFactors&) = delete;

  // Rows stand where UMFPACK expects columns: it factorises the transpose.
  void factorise(const SparseMatrix& matrix, bool new_pattern) override {
    const int n = matrix.size();
    if (new_pattern) {
      umfpack_di_free_symbolic(&symbolic_);
      check(umfpack_di_symbolic(n, n, matrix.row_start.data(), matrix.column.data(),
                                matrix.value.data(), &symbolic_, nullptr, nullptr));
    }
    umfpack_di_free_numeric(&numeric_);
    check(umfpack_di_numeric(matrix.row_start.data(), matrix.column.data(), matrix.value.data(),
                             symbolic_, &numeric_, nullptr, nullptr));
  }

  std::vector<double> solve(const SparseMatrix& matrix, const std::vector<double>& b) override {
    std::vector<double> x(b.size());
    check(umfpack_di_solve(UMFPACK_At, matrix.row_start.data(), matrix.column.data(),
                           matrix.value.data(), x.data(), b.data(), numeric_, nullptr, nullptr));
    return x;
  }

 private:
  static void check(int status) {
    if (status != UMFPACK_OK) {
      give_up(fmt::format("UMFPACK ends with {}; -1 is want of memory", status));
    }
  }

  void* symbolic_ = nullptr;
  void* numeric_ = nullptr;
};

double norm(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

}  // namespace

SparseDirect::SparseDirect(SparseLibrary library) {
  if (library == SparseLibrary::mumps) {
    factors_ = std::make_unique<MumpsFactors>();
  } else {
    factors_ = std::make_unique<UmfpackFactors>();
  }
}

SparseDirect::~SparseDirect() = default;

std::vector<double> SparseDirect::solve(const SparseMatrix& matrix,
                                        const std::vector<double>& right_hand_side) {
  const double size = norm(right_hand_side);
  MANO_ASSERT(matrix.row_start.size() == right_hand_side.size() + 1);
  std::vector<double> x(right_hand_side.size(), 0.0);
  residual_ = 0.0;
  if (size == 0.0) return x;
  // An analysis looks at values, too: one made for others may fail where a new one does not.
  for (const bool analysed : {factors_->has_pattern_of(matrix), false}) {
    factors_->factorise(matrix, !analysed);
    factors_->remember_pattern(matrix);
    std::fill(x.begin(), x.end(), 0.0);
    std::vector<double> rest = right_hand_side;
    constexpr int kRefinements = 2;
    for (int i = 0; i <= kRefinements; ++i) {
      const std::vector<double> step = factors_->solve(matrix, rest);
      for (std::size_t k = 0; k < x.size(); ++k) x[k] += step[k];
      rest = matrix.times(x);
      for (std::size_t k = 0; k < x.size(); ++k) rest[k] = right_hand_side[k] - rest[k];
      residual_ = norm(rest) / size;
      if (residual_ <= kResidual) return x;
    }
    if (!analysed) break;
  }
  give_up(fmt::format("the residual stays at {:.2g} of the right-hand side", residual_));
}

}  // namespace manoscope::navier_stokes
