#include "manoscope/validation/infer_flow.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/numerics/chi_square.hpp"
#include "manoscope/validation/error_table.hpp"

namespace manoscope::validation {
namespace {

constexpr double kSettled = 1e-6;     // relative change of the value: far below any uncertainty
constexpr double kFar = 0.05;         // of the logarithm: derivatives are good to a tenth of that
constexpr double kLongestStep = 0.7;  // of the logarithm: a factor of two

enum class Unknown { flow_rate, viscosity };

struct Trial {
  FlowSetup setup;
  FlowRate flow_rate{};
};

class Fit {
 public:
  Fit(Unknown unknown, flow::FlowModel model, const Profile& state,
      const inversion::PressureReading& reading, const Matrix& pieces)
      : unknown_(unknown), model_(model), state_(state), reading_(reading), pieces_(pieces) {
    read_ = (pieces * reading.pressure.matrix()).array();
  }

  /// Solves for the unknown from where the trial stands, and leaves it at the answer.
  ///
  /// Newton's method on the weighted sum of the differences, whose slope the weights make 1; the
  /// weights, which cost derivatives in every zeta, are formed anew only where the unknown has gone
  /// far since.
  InferredFlow solve(Trial& trial, const WallLine& line, int most_steps) const {
    InferredFlow found;
    ModelledRun run = modelled_run(model_, trial.setup, trial.flow_rate, line);
    Array1 weights = best_weights(trial.setup, run);
    double gone = 0.0;
    for (found.steps = 1; found.steps <= most_steps; ++found.steps) {
      if (!run.pressure().isFinite().all()) break;
      const double change = (weights * difference(line, run.pressure())).sum();
      if (!std::isfinite(change)) break;
      if (std::abs(change) < kSettled) return finish(found, trial, run, weights);
      const double step = std::clamp(change, -kLongestStep, kLongestStep);
      scale(trial, std::exp(step));
      gone += step;
      if (std::abs(gone) > kFar) {
        run = modelled_run(model_, trial.setup, trial.flow_rate, line);
        weights = best_weights(trial.setup, run);
        gone = 0.0;
      } else {
        run.sensitivity.modelled = flow::pressure_along(
            model_, flow_case(trial.setup, trial.flow_rate, line), *trial.setup.tables);
      }
    }
    throw InputError(
        "flow from the deflection",
        fmt::format("the model \"{}\" found no {} that meets the reading, last at {:.4g} mL/min",
                    flow::flow_model_info(model_).name,
                    unknown_ == Unknown::flow_rate ? "flow rate" : "viscosity",
                    trial.flow_rate.in(mL_per_min)),
        "Check gap, viscosity and the direction of x, or take a model that does not march");
  }

  void scale(Trial& trial, double factor) const {
    if (unknown_ == Unknown::flow_rate) {
      trial.flow_rate = factor * trial.flow_rate;
    } else {
      trial.setup.fluid.viscosity = factor * trial.setup.fluid.viscosity;
    }
  }
  const Array1& read() const { return read_; }

 private:
  Array1 on_pieces(const WallLine& line, const Array1& pressure) const {
    return (on_line(pieces_, line) * pressure.matrix()).array();
  }
  Array1 difference(const WallLine& line, const Array1& pressure) const {
    return read_ - on_pieces(line, pressure);
  }
  /// Change of the pieces with the logarithm of the unknown, Pa.
  Array1 gradient(const ModelledRun& run) const {
    return on_pieces(run.line, unknown_ == Unknown::flow_rate ? run.sensitivity.by_flow_rate
                                                              : run.sensitivity.by_viscosity);
  }
  ErrorTable errors(const FlowSetup& setup, const ModelledRun& run,
                    const ModelErrors& which) const {
    ErrorTable table(pieces_.rows());
    add_reading(table, 1.0, pieces_, reading_, state_);
    add_model(table, -1.0, pieces_, run, setup, state_, which);
    return table;
  }
  double floor() const { return kResolution * read_.abs().maxCoeff(); }

  Array1 best_weights(const FlowSetup& setup, const ModelledRun& run) const {
    ModelErrors which;
    which.gap_and_fluid = which.model = false;
    const Index n = pieces_.rows();
    const Matrix covariance =
        errors(setup, run, which).covariance() + floor() * floor() * Matrix::Identity(n, n);
    const Eigen::VectorXd g = gradient(run).matrix();
    const Eigen::VectorXd towards = Eigen::LDLT<Matrix>(covariance).solve(g);
    return (towards / g.dot(towards)).array();
  }

  InferredFlow finish(InferredFlow found, const Trial& trial, const ModelledRun& run,
                      const Array1& weights) const {
    ModelErrors which;
    which.flow_rate = unknown_ != Unknown::flow_rate;
    which.viscosity = unknown_ != Unknown::viscosity;
    const ErrorTable table = errors(trial.setup, run, which);
    const double value =
        unknown_ == Unknown::flow_rate ? trial.flow_rate.si() : trial.setup.fluid.viscosity.si();
    found.value = table.combine(value, value * weights);
    found.weights = (weights.matrix().transpose() * pieces_).transpose().array();
    // Least chi-square with every error in it, the unknown free: one degree of freedom less.
    const Array1 d = difference(run.line, run.pressure()), g = gradient(run);
    const Index n = d.size();
    const Eigen::LDLT<Matrix> solver(table.covariance() +
                                     floor() * floor() * Matrix::Identity(n, n));
    const Eigen::VectorXd along = solver.solve(g.matrix());
    const double slope = along.dot(d.matrix());
    found.fit.value =
        d.matrix().dot(solver.solve(d.matrix())) - slope * slope / along.dot(g.matrix());
    found.fit.dof = static_cast<double>(n - 1);
    if (n > 1) {
      found.fit.value = std::max(0.0, found.fit.value);
      found.fit.tail = numerics::chi_square_tail(found.fit.value, found.fit.dof);
    } else {
      found.fit = {};
    }
    return found;
  }

  Unknown unknown_;
  flow::FlowModel model_;
  const Profile& state_;
  const inversion::PressureReading& reading_;
  Matrix pieces_;
  Array1 read_;
};

InferredFlow infer(Unknown unknown, Trial trial, flow::FlowModel model, const Profile& state,
                   const inversion::PressureReading& reading, const inversion::TestSection& section,
                   const InferFlowOptions& options) {
  options.validate();
  const WallLine line = wall_line(state, trial.setup.channel.length);
  trial.setup.tables = tables_for(trial.setup, line.zeta);
  const Matrix pieces = piece_weights(reading, state, section, options.pieces);
  const Fit fit(unknown, model, state, reading, pieces);
  if (!(fit.read()[0] > 0.0)) {
    throw InputError(
        "flow from the deflection",
        fmt::format("the pressure changes by {:.4g} Pa along the test section", -fit.read()[0]),
        "Let x run along the flow; without a falling pressure there is no flow to find");
  }
  // Eq. (4) is linear in both unknowns: its answer is where the search starts.
  const flow::ModelledPressure start =
      flow::pressure_along(flow::FlowModel::paper, flow_case(trial.setup, trial.flow_rate, line));
  fit.scale(trial, fit.read()[0] / (on_line(pieces, line) * start.pressure.matrix())(0));
  if (flow::flow_model_info(model).needs_forward_flow) {
    // Costly ones begin where a cheap one ends.
    Fit(unknown, flow::FlowModel::momentum, state, reading, pieces)
        .solve(trial, line, options.most_steps);
  }
  return fit.solve(trial, line, options.most_steps);
}

}  // namespace

void InferFlowOptions::validate() const {
  if (pieces < 2) {
    throw InputError("--pieces", fmt::format("is {}", pieces), "Give a number of 2 or more");
  }
  if (most_steps < 1) {
    throw InputError("--most-steps", fmt::format("is {}", most_steps),
                     "Give a number of 1 or more");
  }
}

InferredFlow infer_flow_rate(const FlowSetup& setup, flow::FlowModel model, const Profile& state,
                             const inversion::PressureReading& reading,
                             const inversion::TestSection& section,
                             const InferFlowOptions& options) {
  // Any flow rate serves to scale from.
  return infer(Unknown::flow_rate, {setup, 1.0 * mL_per_min}, model, state, reading, section,
               options);
}

InferredFlow infer_viscosity(const FlowSetup& setup, flow::FlowModel model, FlowRate flow_rate,
                             const Profile& state, const inversion::PressureReading& reading,
                             const inversion::TestSection& section,
                             const InferFlowOptions& options) {
  if (!(flow_rate.si() > 0.0)) {
    throw InputError("viscosity from the deflection",
                     fmt::format("the flow rate is {:g} mL/min", flow_rate.in(mL_per_min)),
                     "Give a positive flow rate, with x along the flow");
  }
  return infer(Unknown::viscosity, {setup, flow_rate}, model, state, reading, section, options);
}

}  // namespace manoscope::validation
