#include "manoscope/validation/error_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::validation {
namespace {

Array1 times(const Matrix& weights, const Array1& values) {
  return (weights * values.matrix()).array();
}

}  // namespace

std::string flow_noise(Index station) {
  return fmt::format("noise of the flow profile at station {}", station);
}

void ErrorTable::add(const std::string& variable, const std::string& source, const Array1& effect) {
  MANO_ASSERT(effect.size() == n_);
  if ((effect == 0.0).all()) return;
  const auto [place, is_new] = rows_.try_emplace(variable, modes_.size());
  if (is_new) {
    modes_.push_back({variable, source, effect});
  } else {
    modes_[place->second].effect += effect;
  }
}

Matrix ErrorTable::covariance() const { return Uncertainty{Array1::Zero(n_), modes_}.covariance(); }

Estimate ErrorTable::combine(double value, const Array1& weights) const {
  Estimate estimate;
  estimate.value = value;
  for (const ErrorMode& mode : modes_) {
    estimate.terms.push_back({mode.variable, mode.source, (weights * mode.effect).sum()});
  }
  return estimate;
}

void add_reading(ErrorTable& table, double factor, const Matrix& weights,
                 const inversion::PressureReading& reading, const Profile& state) {
  for (const ErrorMode& mode : reading.uncertainty.modes) {
    table.add(mode.variable, mode.source, factor * times(weights, mode.effect));
  }
  for (Index ix = 0; ix < reading.x.size(); ++ix) {
    const double all = reading.uncertainty.independent[ix];
    if (!(all > 0.0) || (weights.col(ix).array() == 0.0).all()) continue;
    // A reading over many stations holds its noise in modes: that a few of them are in the model,
    // too, is far below either uncertainty.
    const double own = state.uncertainty.independent[ix] / reading.slope[ix];
    const double part = std::isfinite(own) ? std::min(own, all) : 0.0;
    table.add(flow_noise(ix), "pixel noise", factor * part * weights.col(ix).array());
    table.add(fmt::format("noise of the curves at station {}", ix), "pixel noise",
              factor * std::sqrt(std::max(0.0, all * all - part * part)) * weights.col(ix).array());
  }
}

Matrix on_line(const Matrix& weights, const WallLine& line) {
  Matrix result = Matrix::Zero(weights.rows(), line.x.size());
  for (Index i = 0; i < line.x.size(); ++i) {
    const Index ix = line.station[static_cast<std::size_t>(i)];
    if (ix != kClampedEnd) result.col(i) = weights.col(ix);
  }
  return result;
}

void add_model(ErrorTable& table, double factor, const Matrix& weights, const ModelledRun& run,
               const FlowSetup& setup, const Profile& state, const ModelErrors& which) {
  const Matrix onto = on_line(weights, run.line);
  const flow::FlowSensitivity& sensitivity = run.sensitivity;
  const Matrix by_zeta = onto * sensitivity.by_zeta;  // (m, n_line)
  const Index n = run.line.x.size();
  Array1 effect(n);
  for (const ErrorMode& mode : state.uncertainty.modes) {
    for (Index i = 0; i < n; ++i) {
      const Index ix = run.line.station[static_cast<std::size_t>(i)];
      effect[i] = ix == kClampedEnd ? 0.0 : mode.effect[ix];
    }
    table.add(mode.variable, mode.source, factor * times(by_zeta, effect));
  }
  for (Index i = 0; i < n; ++i) {
    const Index ix = run.line.station[static_cast<std::size_t>(i)];
    if (ix == kClampedEnd) continue;
    table.add(flow_noise(ix), "pixel noise",
              factor * state.uncertainty.independent[ix] * by_zeta.col(i).array());
  }
  if (which.gap_and_fluid) {
    const FlowUncertainty& u = setup.uncertainty;
    table.add("channel height", "channel height",
              factor * u.height.si() * times(onto, sensitivity.by_height));
    if (which.viscosity) {
      table.add(
          "viscosity", "viscosity",
          factor * (u.viscosity / setup.fluid.viscosity) * times(onto, sensitivity.by_viscosity));
    }
    if (which.flow_rate) {
      table.add("flow rate", "flow rate",
                factor * u.flow_rate * times(onto, sensitivity.by_flow_rate));
    }
  }
  if (which.model) {
    const std::string name(flow::flow_model_info(sensitivity.modelled.model).name);
    table.add("flow model " + name, "flow model",
              factor * run.error.standard() * times(onto, run.pressure()));
    // The greatest error along x may as well lie inside as at the inlet.
    const double inlet = run.pressure()[0];
    if (inlet != 0.0) {
      const Array1 share = run.pressure() / inlet;
      table.add("flow model " + name + ", bend", "flow model",
                factor * run.error.standard() * inlet * times(onto, 4.0 * share * (1.0 - share)));
    }
    table.add("inlet profile", "inlet profile", factor * times(onto, run.inlet_effect));
  }
}

}  // namespace manoscope::validation
