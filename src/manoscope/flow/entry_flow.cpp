#include "manoscope/flow/entry_flow.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

constexpr std::array<double, 4> kRatio{0.0, 0.2, 0.5, 1.0};
constexpr std::array<EntryConstants, 4> kTable{{{24.000, 0.674, 0.000029},
                                                {19.071, 0.931, 0.000076},
                                                {15.548, 1.28, 0.00021},
                                                {14.227, 1.43, 0.00029}}};

}  // namespace

EntryConstants entry_constants(double gap_over_width) {
  if (!(gap_over_width > 0.0) || !std::isfinite(gap_over_width)) {
    throw InputError("developing flow", fmt::format("gap over width is {:g}", gap_over_width),
                     "Give a positive ratio");
  }
  const double ratio = gap_over_width > 1.0 ? 1.0 / gap_over_width : gap_over_width;
  EntryConstants result{0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < kRatio.size(); ++k) {  // Lagrange
    double weight = 1.0;
    for (std::size_t j = 0; j < kRatio.size(); ++j) {
      if (j != k) weight *= (ratio - kRatio[j]) / (kRatio[k] - kRatio[j]);
    }
    result.friction_reynolds += weight * kTable[k].friction_reynolds;
    result.incremental_drop += weight * kTable[k].incremental_drop;
    result.curvature += weight * kTable[k].curvature;
  }
  return result;
}

double entry_excess(const EntryConstants& constants, double x_plus) {
  if (!(x_plus > 0.0)) return 0.0;
  // 1/(1 + C/x^2), written for small x.
  const double square = x_plus * x_plus;
  const double developed = square / (square + constants.curvature);
  return (1.0 - developed) *
             (13.76 * std::sqrt(x_plus) - 4.0 * constants.friction_reynolds * x_plus) +
         developed * constants.incremental_drop;
}

Array1 entry_drop(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate,
                  Length width, Length upstream) {
  fluid.validate("developing flow");
  if (!(flow_rate.si() > 0.0) || !std::isfinite(flow_rate.si()) || !(upstream.si() >= 0.0)) {
    throw InputError("developing flow",
                     fmt::format("flow rate {:g} mL/min, {:g} mm of duct upstream",
                                 flow_rate.in(mL_per_min), upstream.in(mm)),
                     "Give a positive flow rate and a length that is not negative");
  }
  const double nu = fluid.kinematic_viscosity().si();
  const auto stretched = [&](Index i) {  // 1/(Dh Re)
    const double diameter = sections.hydraulic_diameter(i);
    return nu * sections.area(i) / (flow_rate.si() * diameter * diameter);
  };
  const Index n = sections.x.size();
  Array1 drop(n);
  drop(0) = 0.0;
  double x_plus = upstream.si() * stretched(0);
  for (Index i = 1; i < n; ++i) {
    const double ratio = 0.5 * (sections.mean_gap(i) + sections.mean_gap(i - 1)) / width.si();
    const EntryConstants constants = entry_constants(ratio);
    const double next =
        x_plus + 0.5 * (stretched(i) + stretched(i - 1)) * (sections.x(i) - sections.x(i - 1));
    const double speed =
        flow_rate.si() * 0.5 * (1.0 / sections.area(i) + 1.0 / sections.area(i - 1));
    drop(i) = drop(i - 1) + 0.5 * fluid.density.si() * speed * speed *
                                (entry_excess(constants, next) - entry_excess(constants, x_plus));
    x_plus = next;
  }
  return drop;
}

}  // namespace manoscope::flow
