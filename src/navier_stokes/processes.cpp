#include "processes.hpp"

#include <petscsys.h>

#include <array>
#include <cstdlib>
#include <exception>
#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

enum Fault : int { interrupted, input, internal, none };

/// What one process tells the others of its fault.
struct Report {
  int fault = Fault::none;
  std::array<std::string, 3> words;
};

Report watch(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return {Fault::input, {error.where(), error.found(), error.mend()}};
  } catch (const Interrupted&) {
    return {Fault::interrupted, {}};
  } catch (const std::bad_alloc&) {
    return {Fault::internal, {"out of memory: take fewer cells", "", ""}};
  } catch (const std::exception& error) {
    return {Fault::internal, {error.what(), "", ""}};
  }
  return {};
}

[[noreturn]] void rethrow(const Report& report) {
  switch (report.fault) {
    case Fault::input:
      throw InputError(report.words[0], report.words[1], report.words[2]);
    case Fault::interrupted:
      throw Interrupted();
    default:
      throw InternalError(report.words[0]);
  }
}

}  // namespace

Processes::Processes() {
  // A fault of PETSc is an exception of ours; signals and the user's own settings are not its
  // business.
  PetscOptionsSetValue(nullptr, "-no_signal_handler", "1");
  PetscOptionsSetValue(nullptr, "-skip_petscrc", "1");
  if (PetscInitializeNoArguments() != 0) throw InternalError("PETSc does not start");
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  std::atexit([] { PetscFinalize(); });
  MPI_Comm_rank(comm(), &rank_);
  MPI_Comm_size(comm(), &size_);
}

const Processes& Processes::all() {
  static const Processes kAll;
  return kAll;
}

std::vector<double> Processes::sum(std::vector<double> parts) const {
  MPI_Allreduce(MPI_IN_PLACE, parts.data(), static_cast<int>(parts.size()), MPI_DOUBLE, MPI_SUM,
                comm());
  return parts;
}

double Processes::largest(double part) const {
  MPI_Allreduce(MPI_IN_PLACE, &part, 1, MPI_DOUBLE, MPI_MAX, comm());
  return part;
}

void together(MPI_Comm comm, const std::function<void()>& work) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  Report report = watch(work);
  const int mine = report.fault == Fault::none ? size : rank;
  int first = size;
  MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, comm);
  if (first == size) return;
  MPI_Bcast(&report.fault, 1, MPI_INT, first, comm);
  for (std::string& text : report.words) {
    int length = static_cast<int>(text.size());
    MPI_Bcast(&length, 1, MPI_INT, first, comm);
    text.resize(static_cast<std::size_t>(length));
    MPI_Bcast(text.data(), length, MPI_CHAR, first, comm);
  }
  rethrow(report);
}

}  // namespace manoscope::navier_stokes
