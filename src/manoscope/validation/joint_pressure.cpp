#include "manoscope/validation/joint_pressure.hpp"

#include <Eigen/Cholesky>

#include "manoscope/core/error.hpp"
#include "manoscope/validation/error_table.hpp"
#include "manoscope/validation/pieces.hpp"

namespace manoscope::validation {

inversion::PressureReading joint_pressure(const FlowSetup& setup, flow::FlowModel model,
                                          FlowRate flow_rate, const Profile& state,
                                          const inversion::PressureReading& reading,
                                          const inversion::TestSection& section, Index n_pieces) {
  constexpr double kCoverage = 0.95;
  const WallLine line = wall_line(state, setup.channel.length);
  const ModelledRun run = modelled_run(model, setup, flow_rate, line);
  if (!run.pressure().isFinite().all()) {
    throw InputError("joint pressure", "the march broke down",
                     "Take a flow model that does not march");
  }
  const Matrix pieces = piece_weights(reading, state, section, n_pieces);
  const Index n = reading.x.size(), m = pieces.rows();

  // One table for both: the pressures of the stations, then d.
  Matrix read(n + m, n), modelled = Matrix::Zero(n + m, n);
  read << Matrix::Identity(n, n), pieces;
  for (Index ix = 0; ix < n; ++ix) {
    if (!counts(reading, state, ix)) read(ix, ix) = 0.0;
  }
  modelled.bottomRows(m) = pieces;
  ErrorTable table(n + m);
  add_reading(table, 1.0, read, reading, state);
  add_model(table, -1.0, modelled, run, setup, state);

  const Array1 d = (pieces * reading.pressure.matrix()).array() -
                   (on_line(pieces, line) * run.pressure().matrix()).array();
  const double floor = kResolution * run.pressure().abs().maxCoeff();
  const Matrix covariance = table.covariance();
  const Eigen::LDLT<Matrix> solver(covariance.bottomRightCorner(m, m) +
                                   floor * floor * Matrix::Identity(m, m));
  const Matrix gain = solver.solve(covariance.bottomLeftCorner(m, n)).transpose();

  inversion::PressureReading joint = reading;
  joint.pressure -= (gain * d.matrix()).array();
  joint.uncertainty.modes.clear();
  joint.uncertainty.independent = floor * gain.rowwise().norm().array();
  for (const ErrorMode& mode : table.modes()) {
    joint.uncertainty.modes.push_back(
        {mode.variable, mode.source,
         mode.effect.head(n) - (gain * mode.effect.tail(m).matrix()).array()});
  }
  inversion::form_interval(joint, kCoverage);
  return joint;
}

}  // namespace manoscope::validation
