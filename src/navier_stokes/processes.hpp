#pragma once

#include <mpi.h>

#include <functional>
#include <vector>

namespace manoscope::navier_stokes {

/// The processes that solve one flow together: those that `mpirun` started, or this one alone.
///
/// MPI and PETSc run from the first use to the end of the program.
class Processes {
 public:
  static const Processes& all();

  MPI_Comm comm() const { return MPI_COMM_WORLD; }
  MPI_Comm alone() const { return MPI_COMM_SELF; }  ///< for what each process solves by itself
  int rank() const { return rank_; }
  int size() const { return size_; }
  bool is_lead() const { return rank_ == 0; }

  /// Sums over the processes.
  std::vector<double> sum(std::vector<double> parts) const;
  double sum(double part) const { return sum(std::vector<double>{part}).front(); }
  double largest(double part) const;

 private:
  Processes();

  int rank_ = 0, size_ = 1;
};

/// Does the work of each process of `comm`; where it throws on one, all throw what the first of
/// them met. The work itself must not wait for other processes.
void together(MPI_Comm comm, const std::function<void()>& work);

}  // namespace manoscope::navier_stokes
