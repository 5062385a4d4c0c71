#pragma once

#include <map>
#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/validation/flow_setup.hpp"

namespace manoscope::validation {

/// Effects of named error variables of unit variance on n numbers: covariance by bookkeeping.
///
/// The same name is the same error, as in ErrorMode: what a reading and a flow model share cancels
/// or adds up by itself when their effects go into one table.
class ErrorTable {
 public:
  explicit ErrorTable(Index n) : n_(n) {}

  /// Adds to the effect of a variable, in the unit of the numbers per standard deviation.
  void add(const std::string& variable, const std::string& source, const Array1& effect);
  /// (n, n) sum of effect effect^T.
  Matrix covariance() const;
  /// sum_i weight_i number_i, by variable.
  Estimate combine(double value, const Array1& weights) const;
  const std::vector<ErrorMode>& modes() const { return modes_; }

 private:
  Index n_;
  std::map<std::string, std::size_t> rows_;
  std::vector<ErrorMode> modes_;
};

/// Name of the error variable that is the noise of one station of a run's profile.
std::string flow_noise(Index station);

/// Which errors of a model go into a table.
struct ModelErrors {
  bool gap_and_fluid = true;  ///< 2 h0, and viscosity and flow rate as told below
  bool viscosity = true, flow_rate = true;
  bool model = true;  ///< stated error of the model and inlet profile
};

/// Adds the errors of weighted sums of a reading, factor * weights * p.
///
/// @param weights  (m, n_x) on the stations of the reading; 0 where it has no answer.
/// @param state    the profile that was read: its noise is an error of its own, since a flow model
///                 has it, too.
void add_reading(ErrorTable& table, double factor, const Matrix& weights,
                 const inversion::PressureReading& reading, const Profile& state);

/// Adds the errors of the same sums of a model's pressure.
///
///   zeta: state's noise and modes through dp_i/d zeta_j;  "channel height", "viscosity", "flow
///   rate";  "flow model <name>": its stated error times p - p_out, and "..., bend": the same error
///   in the middle, 4 s(1 - s) with s = p/p_in;  "inlet profile"
///
/// @param weights  (m, n_x) on the stations of the profile; 0 at stations that do not count.
void add_model(ErrorTable& table, double factor, const Matrix& weights, const ModelledRun& run,
               const FlowSetup& setup, const Profile& state, const ModelErrors& which = {});

/// The weights on the points of a line.
Matrix on_line(const Matrix& weights, const WallLine& line);

}  // namespace manoscope::validation
