#include "manoscope/flow/passage_losses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/aperture_loss.hpp"
#include "manoscope/flow/cross_section.hpp"
#include "manoscope/flow/entry_flow.hpp"

namespace manoscope::flow {
namespace {

constexpr const char* kWhere = "rigid passage";
constexpr double kEdgeLoss = 0.1;  // of rho U^2/2, behind the edge of a contraction
constexpr double kDevelopmentShare = 0.1, kExpansionShare = 0.3;
constexpr double kHoleShape = 0.055, kHoleInPlace = 0.3;

/// Standard uncertainty of what lies anywhere within the half width, as likely here as there.
double rectangular(double half_width) { return std::abs(half_width) / std::numbers::sqrt3; }

/// Small over large area of a step, or nothing without one.
std::optional<double> area_ratio(const std::optional<Area>& other, bool reservoir, Area own,
                                 const char* name) {
  if (reservoir) return 0.0;
  if (!other) return std::nullopt;
  const double ratio = own / *other;
  if (ratio > 0.0 && ratio <= 1.0) return ratio;
  throw InputError(kWhere,
                   fmt::format("the section {} it has {:.4g} mm2, its own {:.4g} mm2", name,
                               other->si() * 1e6, own.si() * 1e6),
                   "Give a section at least as large as the passage's, or none");
}

/// Momentum factor of developed flow in a rectangle.
double momentum_factor(const RigidPassage& passage) {
  const bool turned = passage.height > passage.width;
  return solve_cross_section(flat_roof(turned ? passage.height : passage.width,
                                       turned ? passage.width : passage.height))
      .momentum_factor;
}

void check(FlowRate flow_rate, const RigidPassage& passage, const PassageFittings& fittings) {
  const double Q = flow_rate.si();
  if (!(Q > 0.0) || !std::isfinite(Q) || fittings.round_bends < 0 || fittings.mitre_bends < 0) {
    throw InputError(
        kWhere,
        fmt::format("flow rate {:g} mL/min, {} round and {} mitre bends", flow_rate.in(mL_per_min),
                    fittings.round_bends, fittings.mitre_bends),
        "Give a positive flow rate, and numbers of bends that are not negative");
  }
  const Length uncertainty = passage.height_uncertainty;
  if (!(uncertainty >= Length{}) || (uncertainty > Length{} && uncertainty >= passage.height)) {
    throw InputError(kWhere,
                     fmt::format("its height is {:g} um, the uncertainty of that {:g} um",
                                 passage.height.in(um), uncertainty.in(um)),
                     "Give a standard uncertainty from 0 to below the height");
  }
}

/// The flow in one passage, and the parts of its drop as they are added.
class Parts {
 public:
  Parts(const Fluid& fluid, FlowRate flow_rate, const RigidPassage& passage)
      : fluid_(fluid),
        flow_rate_(flow_rate),
        passage_(passage),
        duct_(passage_drop(fluid.viscosity, flow_rate, passage)) {  // checks the sizes
    const double w = passage.width.si(), h = passage.height.si();
    const double diameter = 2.0 * w * h / (w + h), speed = flow_rate.si() / (w * h);
    head_ = 0.5 * fluid.density.si() * speed * speed;
    reynolds_ = speed * diameter / fluid.kinematic_viscosity().si();
    x_plus_ = passage.length.si() / (diameter * reynolds_);
  }

  void duct() {
    const double drop = duct_.si();
    add("duct", "duct", "exact series of a rectangular duct", drop, drop, 0.0);
  }
  void contraction(double ratio) {
    add("contraction", "contraction", "energy balance, Kays (1950)", head_ * (1.0 - ratio * ratio),
        0.0, kEdgeLoss * head_ * (1.0 - ratio));
  }
  void development(double ratio) {
    constexpr double kStep = 1e-3;  // relative; the central difference errs by its square
    const EntryConstants constants = entry_constants(passage_.height / passage_.width);
    const auto drop = [&](double x_plus) {
      return head_ * entry_excess(constants, x_plus) * (1.0 - ratio);
    };
    const double all = drop(x_plus_);
    const double viscous =
        (drop(x_plus_ * (1.0 + kStep)) - drop(x_plus_ * (1.0 - kStep))) / (2.0 * kStep);
    add("development", "development", "Shah (1978)", all, viscous,
        std::hypot(kDevelopmentShare, ratio) * all);
  }
  void expansion(double ratio) {
    // beta of the large section: that of the same shape, as good as known here.
    const double beta = ratio > 0.0 ? momentum_factor(passage_) : 1.0;
    const double back = 2.0 * head_ * ratio * beta * (1.0 - ratio);
    add("expansion", "expansion", "momentum balance, Kays (1950)", -back, 0.0,
        kExpansionShare * back);
  }
  void step(const char* name, double ratio) {
    const double drop =
        aperture_loss(fluid_.viscosity, flow_rate_, passage_.width, passage_.height).si() *
        (1.0 - ratio);
    add(name, "steps", "Roscoe (1949), Weissberg (1962)", drop, drop,
        std::hypot(kHoleShape, kHoleInPlace, ratio) * drop);
  }
  /// @param creeping, inertial  K_1 and K_inf.
  void bends(const char* name, int n, double creeping, double inertial) {
    if (n == 0) return;
    const double viscous = n * head_ * creeping / reynolds_;
    const double drop = viscous + n * head_ * inertial;
    add(name, "bends", "Hooper (1981)", drop, viscous, drop);
  }
  std::vector<PressureTerm> take() && { return std::move(terms_); }

 private:
  void add(const char* name, const char* formula, const char* source, double drop, double viscous,
           double half_width) {
    PressureTerm term;
    term.name = name;
    term.source = source;
    term.formula = formula;
    term.drop = Pressure::from_si(drop);
    term.uncertainty = Pressure::from_si(rectangular(half_width));
    term.by_viscosity = Pressure::from_si(viscous);
    term.by_flow_rate = Pressure::from_si(2.0 * drop - viscous);
    terms_.push_back(std::move(term));
  }

  Fluid fluid_;
  FlowRate flow_rate_;
  RigidPassage passage_;
  Pressure duct_{};
  double head_ = 0.0;  ///< rho U^2/2, Pa
  double reynolds_ = 0.0, x_plus_ = 0.0;
  std::vector<PressureTerm> terms_;
};

std::vector<PressureTerm> parts_of(const Fluid& fluid, FlowRate flow_rate,
                                   const RigidPassage& passage, const PassageFittings& fittings) {
  Parts parts(fluid, flow_rate, passage);
  const Area own = passage.width * passage.height;
  const auto upstream = area_ratio(fittings.from, fittings.from_reservoir, own, "before");
  const auto downstream = area_ratio(fittings.into, fittings.into_reservoir, own, "behind");
  parts.duct();
  if (upstream) {
    parts.contraction(*upstream);
    parts.development(*upstream);
    parts.step("step at the entry", *upstream);
  }
  if (downstream) {
    parts.expansion(*downstream);
    parts.step("step at the exit", *downstream);
  }
  parts.bends("round bends", fittings.round_bends, 800.0, 0.25);
  parts.bends("mitre bends", fittings.mitre_bends, 1000.0, 1.15);
  return std::move(parts).take();
}

}  // namespace

std::vector<PressureTerm> passage_terms(const Fluid& fluid, FlowRate flow_rate,
                                        const RigidPassage& passage,
                                        const PassageFittings& fittings) {
  constexpr double kStep = 1e-4;  // downwards, where a step stays one
  fluid.validate(kWhere);
  check(flow_rate, passage, fittings);
  std::vector<PressureTerm> terms = parts_of(fluid, flow_rate, passage, fittings);
  if (passage.height_uncertainty == Length{}) return terms;
  RigidPassage lower = passage;
  lower.height = (1.0 - kStep) * passage.height;
  const std::vector<PressureTerm> below = parts_of(fluid, flow_rate, lower, fittings);
  const double deviations = kStep * (passage.height / passage.height_uncertainty);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    terms[i].height_effect = (1.0 / deviations) * (terms[i].drop - below[i].drop);
  }
  return terms;
}

}  // namespace manoscope::flow
