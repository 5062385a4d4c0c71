#include "manoscope/inversion/calibrate_wall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/numerics/robust.hpp"
#include "manoscope/wall/fit_law.hpp"

namespace manoscope::inversion {
namespace {

/// The strip's law is a model: each pressure may be off it by this share, and by 1 Pa.
constexpr double kLawError = 1e-3, kLeastError = 1.0;
constexpr double kWorstFit = 1e3;     // chi-square per degree of freedom: off by 3 % of p
constexpr double kSoft = 1e8;         // Pa, between elastomers and stiff walls
constexpr double kShears = 0.02;      // thickness over width
constexpr double kWindow = 0.3;       // half of it, in widths
constexpr double kLeastPreload = 20;  // Pa, whose lopsidedness is looked for

/// Deflections about a place along the channel against the levels' pressures.
wall::HydrostaticData data_about(const calibration::ConstitutiveCurves& curves, double place,
                                 double reach) {
  wall::HydrostaticData data;
  std::vector<double> pressure, sigma_pressure, deflection, sigma;
  const Array1 label = curves.level_uncertainty();
  for (std::size_t k = 0; k < curves.levels.size(); ++k) {
    const Profile& profile = curves.levels[k].profile;
    const Array1 standard = profile.uncertainty.standard();
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (Index ix = 0; ix < profile.x.size(); ++ix) {
      if (profile.flags[ix] != 0 || std::abs(profile.x[ix] - place) > reach) continue;
      sum += profile.zeta[ix];
      squares += standard[ix] * standard[ix];
      count += 1.0;
    }
    if (count == 0.0) continue;
    const double p = curves.level_pressure[static_cast<Index>(k)];
    pressure.push_back(p);
    sigma_pressure.push_back(std::hypot(label[static_cast<Index>(k)], kLawError * p, kLeastError));
    deflection.push_back(sum / count);
    sigma.push_back(std::max(std::sqrt(squares / count), 1e-10));
  }
  const auto array = [](const std::vector<double>& values) {
    return Array1(Eigen::Map<const Array1>(values.data(), static_cast<Index>(values.size())));
  };
  data.pressure = array(pressure);
  data.sigma_pressure = array(sigma_pressure);
  data.deflection = array(deflection);
  data.sigma_deflection = array(sigma);
  return data;
}

/// E of a strip that reaches the deflection at the highest pressure by bending and stretching
/// alone.
Pressure rough_modulus(const wall::HydrostaticData& data, const WallKnowledge& known) {
  Index top = 0;
  data.pressure.maxCoeff(&top);
  const double a = 0.5 * known.width.si(), t = known.thickness.si();
  const double crest = 1.5 * std::abs(data.deflection[top]);
  const double per_modulus =
      (4.0 / 3.0 * t * std::pow(crest, 3) + 2.0 * std::pow(t, 3) * crest) / std::pow(a, 4);
  return Pressure::from_si(data.pressure[top] / std::max(per_modulus, 1e-30));
}

/// Pressure by which data lie beyond a fitted law, each weighted by how well it shows there.
double offset_from(const wall::LawFit& fit, const wall::HydrostaticData& data) {
  const wall::AnyWallLaw law = fit.law();
  double sum = 0.0, weights = 0.0;
  for (Index k = 0; k < data.pressure.size(); ++k) {
    const Pressure p = Pressure::from_si(data.pressure[k]) - fit.preload;
    const double compliance = wall::deflection_compliance(law, p);
    const double off = data.deflection[k] - wall::deflection(law, p).si();
    sum += compliance * off;
    weights += compliance * compliance;
  }
  return sum / weights;
}

}  // namespace

std::optional<CalibratedWall> calibrate_wall(const calibration::ConstitutiveCurves& curves,
                                             const WallKnowledge& known, std::string& reason) {
  const double length = known.length.si(), width = known.width.si();
  try {
    const auto middle = data_about(curves, 0.5 * length, kWindow * width);
    wall::WallSection start;
    start.width = known.width;
    start.thickness = known.thickness;
    start.youngs_modulus = rough_modulus(middle, known);
    start.poisson_ratio =
        known.poisson_ratio.value_or(start.youngs_modulus.si() < kSoft ? 0.49 : 0.25);
    start.shear_correction = known.thickness.si() > kShears * width ? 5.0 / 6.0 : 0.0;
    wall::FitLawOptions options;
    options.preload = true;
    constexpr double kReach = 30.0;
    options.youngs_modulus_range =
        wall::PressureRange{(1.0 / kReach) * start.youngs_modulus, kReach * start.youngs_modulus};
    const wall::LawFit fit = wall::fit_law(wall::LawKind::plate_strip, start, middle, options);
    const wall::FitParameter* modulus = fit.find("youngs_modulus");
    if (!fit.converged || modulus == nullptr || modulus->at_bound ||
        fit.chi2 > kWorstFit * static_cast<double>(fit.n_dof)) {
      reason = fmt::format("no clamped strip answers as mid-channel did: E would be {:.2g} Pa",
                           fit.section.youngs_modulus.si());
      return std::nullopt;
    }
    CalibratedWall found;
    found.wall.length = known.length;
    found.wall.width = known.width;
    found.wall.thickness = fit.section.thickness;
    found.wall.youngs_modulus = fit.section.youngs_modulus;
    found.wall.poisson_ratio = fit.section.poisson_ratio;
    found.wall.prestress = fit.section.prestress;
    found.wall.shear_correction = fit.section.shear_correction;
    found.wall.preload.load = fit.preload;
    if (std::abs(fit.preload.si()) > kLeastPreload) {
      const double before = offset_from(fit, data_about(curves, 0.25 * length, kWindow * width));
      const double behind = offset_from(fit, data_about(curves, 0.75 * length, kWindow * width));
      found.wall.preload.lopsidedness =
          std::clamp(-2.0 * (behind - before) / fit.preload.si(), -1.0, 1.0);
    }
    found.wall.validate();
    return found;
  } catch (const InputError& error) {
    reason = fmt::format("{}: {}", error.where(), error.found());
    return std::nullopt;
  }
}

double end_misfit(const calibration::ConstitutiveCurves& curves, const Array2& model,
                  Length channel_length, Length width) {
  const Array1& x = curves.x;
  const double w = width.si(), length = channel_length.si();
  constexpr double kCounts = 0.3, kFrom = 0.1, kMiddle = 0.25;
  const auto middle_of = [&](Index k, bool measured) {
    std::vector<double> values;
    const Profile& profile = curves.levels[static_cast<std::size_t>(k)].profile;
    for (Index i = 0; i < x.size(); ++i) {
      if (profile.flags[i] != 0 || std::abs(x[i] - 0.5 * length) > kMiddle * length) continue;
      values.push_back(measured ? profile.zeta[i] : model(k, i));
    }
    return values.empty() ? 0.0 : numerics::median(values);
  };
  double largest = 0.0;
  for (Index k = 0; k < model.rows(); ++k) largest = std::max(largest, middle_of(k, true));
  double squares = 0.0, count = 0.0;
  for (Index k = 0; k < model.rows(); ++k) {
    const double measured = middle_of(k, true), modelled = middle_of(k, false);
    if (!(measured > kCounts * largest) || !(modelled > 0.0)) continue;
    const Profile& profile = curves.levels[static_cast<std::size_t>(k)].profile;
    for (Index i = 0; i < x.size(); ++i) {
      const double distance = std::min(x[i], length - x[i]);
      if (profile.flags[i] != 0 || distance < kFrom * w || distance > w) continue;
      const double ratio = (model(k, i) / modelled) / (profile.zeta[i] / measured);
      squares += (ratio - 1.0) * (ratio - 1.0);
      count += 1.0;
    }
  }
  return count > 0.0 ? std::sqrt(squares / count) : 1.0;
}

}  // namespace manoscope::inversion
