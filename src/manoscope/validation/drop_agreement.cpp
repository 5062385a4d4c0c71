#include "manoscope/validation/drop_agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/channel_resistance.hpp"

namespace manoscope::validation {
namespace {

/// The stations of a profile that count, and where they stood in it.
struct GoodStations {
  Array1 x, zeta;
  std::vector<Index> place;
};

GoodStations good_stations(const Profile& state) {
  GoodStations good;
  for (Index ix = 0; ix < state.x.size(); ++ix) {
    if (state.flags[ix] == 0) good.place.push_back(ix);
  }
  const auto n = static_cast<Index>(good.place.size());
  good.x = Array1(n);
  good.zeta = Array1(n);
  for (Index i = 0; i < n; ++i) {
    good.x[i] = state.x[good.place[static_cast<std::size_t>(i)]];
    good.zeta[i] = state.zeta[good.place[static_cast<std::size_t>(i)]];
  }
  return good;
}

/// The good stations with the clamped ends of the wall added where they are not stations already.
GoodStations with_clamped_ends(const Profile& state, double length) {
  const GoodStations good = good_stations(state);
  std::vector<double> x, zeta;
  if (good.x.size() == 0 || good.x[0] > 0.0) {
    x.push_back(0.0);
    zeta.push_back(0.0);
  }
  x.insert(x.end(), good.x.data(), good.x.data() + good.x.size());
  zeta.insert(zeta.end(), good.zeta.data(), good.zeta.data() + good.zeta.size());
  if (x.back() < length) {
    x.push_back(length);
    zeta.push_back(0.0);
  }
  const auto n = static_cast<Index>(x.size());
  return {Eigen::Map<const Array1>(x.data(), n), Eigen::Map<const Array1>(zeta.data(), n), {}};
}

/// Adds d(QR) and d(dp_e) for every error that reaches them.
class Propagation {
 public:
  Propagation(const Profile& state, const inversion::PressureReading& reading,
              const inversion::TestSection& section)
      : state_(state), reading_(reading), section_(section) {}

  Estimate extracted() const {
    Estimate drop;
    const Index first = section_.first, last = section_.last;
    drop.value = reading_.pressure[first] - reading_.pressure[last];
    for (const ErrorMode& mode : reading_.uncertainty.modes) {
      drop.terms.push_back({mode.variable, mode.source, mode.effect[first] - mode.effect[last]});
    }
    for (const Index ix : {first, last}) {
      const double sign = ix == first ? 1.0 : -1.0;
      // A reading over many stations holds its noise in modes: that a few of them are in QR, too,
      // is far below either uncertainty.
      const double all = reading_.uncertainty.independent[ix];
      const double state_part =
          std::min(state_.uncertainty.independent[ix] / reading_.slope[ix], all);
      drop.terms.push_back({flow_noise(ix), "pixel noise", sign * state_part});
      drop.terms.push_back({fmt::format("noise of the curves at station {}", ix), "pixel noise",
                            std::sqrt(std::max(0.0, all * all - state_part * state_part))});
    }
    return drop;
  }

  Estimate resistance(const flow::ResistanceDrop& result, const GoodStations& good,
                      Viscosity viscosity, const FlowUncertainty& uncertainty) const {
    Estimate drop;
    drop.value = result.drop.si();
    for (const ErrorMode& mode : state_.uncertainty.modes) {
      double effect = 0.0;
      for (std::size_t i = 0; i < good.place.size(); ++i) {
        effect += result.zeta_gradient[static_cast<Index>(i)] * mode.effect[good.place[i]];
      }
      drop.terms.push_back({mode.variable, mode.source, effect});
    }
    for (std::size_t i = 0; i < good.place.size(); ++i) {
      const double gradient = result.zeta_gradient[static_cast<Index>(i)];
      if (gradient == 0.0) continue;
      const Index ix = good.place[i];
      drop.terms.push_back(
          {flow_noise(ix), "pixel noise", gradient * state_.uncertainty.independent[ix]});
    }
    drop.terms.push_back(
        {"channel height", "channel height", result.height_gradient * uncertainty.height.si()});
    drop.terms.push_back(
        {"viscosity", "viscosity", drop.value * (uncertainty.viscosity / viscosity)});
    drop.terms.push_back({"flow rate", "flow rate", drop.value * uncertainty.flow_rate});
    return drop;
  }

 private:
  static std::string flow_noise(Index ix) {
    return fmt::format("noise of the flow profile at station {}", ix);
  }

  const Profile& state_;
  const inversion::PressureReading& reading_;
  const inversion::TestSection& section_;
};

}  // namespace

DropAgreement compare_drops(const flow::Channel& channel, const flow::Fluid& fluid,
                            FlowRate flow_rate, const FlowUncertainty& uncertainty,
                            const Profile& state, const inversion::PressureReading& reading,
                            const inversion::TestSection& section) {
  MANO_ASSERT(reading.answered(section.first) && reading.answered(section.last));
  const GoodStations good = good_stations(state);
  const flow::ResistanceDrop result = flow::resistance_drop(
      channel, fluid.viscosity, flow_rate, good.x, good.zeta,
      Length::from_si(state.x[section.first]), Length::from_si(state.x[section.last]));
  const Propagation propagation(state, reading, section);
  DropAgreement agreement;
  agreement.extracted = propagation.extracted();
  agreement.resistance = propagation.resistance(result, good, fluid.viscosity, uncertainty);
  const double variance = std::pow(agreement.extracted.standard_uncertainty(), 2) +
                          std::pow(agreement.resistance.standard_uncertainty(), 2) -
                          2.0 * covariance(agreement.extracted, agreement.resistance);
  const double expanded = kExpansion * std::sqrt(std::max(0.0, variance));
  const double difference = std::abs(agreement.extracted.value - agreement.resistance.value);
  agreement.en_number =
      expanded > 0.0 ? difference / expanded : std::numeric_limits<double>::quiet_NaN();
  return agreement;
}

double mean_reynolds(const flow::Channel& channel, const flow::Fluid& fluid, FlowRate flow_rate,
                     const Profile& state) {
  const GoodStations good = with_clamped_ends(state, channel.length.si());
  return flow::channel_reynolds(channel, fluid, flow_rate, good.x, good.zeta);
}

Pressure channel_resistance_drop(const flow::Channel& channel, const flow::Fluid& fluid,
                                 FlowRate flow_rate, const Profile& state) {
  const GoodStations good = with_clamped_ends(state, channel.length.si());
  return flow::resistance_drop(channel, fluid.viscosity, flow_rate, good.x, good.zeta, Length{},
                               channel.length)
      .drop;
}

Array1 resistance_pressure(const flow::Channel& channel, const flow::Fluid& fluid,
                           FlowRate flow_rate, const Profile& state,
                           const inversion::PressureReading& reading,
                           const inversion::TestSection& section) {
  // Between good stations r is taken as straight, as in the drop itself.
  const GoodStations good = with_clamped_ends(state, channel.length.si());
  const Array1 running =
      flow::running_resistance_drop(channel, fluid.viscosity, flow_rate, good.x, good.zeta);
  const Array1 gap = channel.height.si() + good.zeta;
  const Array1 fall = flow_rate.si() * flow::duct_resistance(fluid.viscosity, channel.width, gap);
  const auto drop_to = [&](double x) {
    const auto* const begin = good.x.data();
    const auto* const end = begin + good.x.size();
    const auto* const above = std::upper_bound(begin + 1, end - 1, x);
    const Index i = above - begin - 1;
    const double step = x - good.x[i], share = step / (good.x[i + 1] - good.x[i]);
    return running[i] + step * (fall[i] + 0.5 * share * (fall[i + 1] - fall[i]));
  };
  const double end_drop = drop_to(state.x[section.last]);
  Array1 pressure(state.x.size());
  for (Index ix = 0; ix < pressure.size(); ++ix) {
    pressure[ix] = reading.pressure[section.last] + (end_drop - drop_to(state.x[ix]));
  }
  return pressure;
}

}  // namespace manoscope::validation
