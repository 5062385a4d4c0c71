#include "manoscope/wall/fit_law.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/wall/fit_law_solver.hpp"

namespace manoscope::wall {
namespace {

constexpr const char* kWhere = "fit of a wall law";
constexpr Index kMostPoints = 500;  // the latent pressures are solved for by a dense matrix

[[noreturn]] void refuse(const std::string& found, const char* mend) {
  throw InputError(kWhere, found, mend);
}

enum class Quantity { youngs_modulus, prestress, thickness, preload };

/// One free parameter as the solver sees it.
struct Free {
  Quantity quantity;
  const char* name;
  bool logarithmic;
  double start, lower, upper;  ///< SI
  double step;                 ///< of a difference, in the solver's variable

  double inner(double si) const { return logarithmic ? std::log(si) : si; }
  double outer(double value) const { return logarithmic ? std::exp(value) : value; }
  /// d(SI)/d(solver's variable).
  double stretch(double si) const { return logarithmic ? si : 1.0; }
};

bool has_prestress(LawKind kind) {
  return kind == LawKind::long_membrane || kind == LawKind::plate_strip ||
         kind == LawKind::circular_membrane || kind == LawKind::square_membrane;
}

std::vector<Free> free_parameters(LawKind kind, const WallSection& start,
                                  const HydrostaticData& data, const FitLawOptions& options) {
  const double modulus = start.youngs_modulus.si(), t = start.thickness.si();
  const double highest = data.pressure.abs().maxCoeff();
  std::vector<Free> made;
  const auto add = [&](Quantity quantity, const char* name, bool logarithmic, double value,
                       double lower, double upper, double step) {
    if (!(lower < upper) || !std::isfinite(lower) || !std::isfinite(upper)) {
      refuse(fmt::format("bounds of {} are {:g} and {:g}", name, lower, upper),
             "Give a lower bound below the upper one");
    }
    if (logarithmic && !(lower > 0.0)) {
      refuse(fmt::format("lower bound of {} is {:g}", name, lower), "Give a positive bound");
    }
    made.push_back(
        Free{quantity, name, logarithmic, std::clamp(value, lower, upper), lower, upper, step});
  };
  const PressureRange e = options.youngs_modulus_range.value_or(
      PressureRange{0.1 * start.youngs_modulus, 10.0 * start.youngs_modulus});
  add(Quantity::youngs_modulus, "youngs_modulus", true, modulus, e.low.si(), e.high.si(), 1e-5);
  if (options.prestress && has_prestress(kind)) {
    WallSection stiffest = start;
    stiffest.youngs_modulus = e.high;
    const Pressure buckled = PlateStrip::buckling_prestress(stiffest);
    const PressureRange s = options.prestress_range.value_or(PressureRange{
        kind == LawKind::plate_strip ? buckled : Pressure{}, std::max(0.02 * e.high, -buckled)});
    // Small against the stresses that the wall feels: its prestress, its buckling stress, and a
    // thousandth of what the largest deflection adds.
    const double rise = 1.5 * data.deflection.abs().maxCoeff() / start.half_width();
    const double felt = std::abs(start.prestress.si()) -
                        PlateStrip::buckling_prestress(start).si() +
                        1e-3 * start.plane_strain_modulus() * rise * rise;
    add(Quantity::prestress, "prestress", false, start.prestress.si(), s.low.si(), s.high.si(),
        1e-4 * felt);
  }
  if (options.thickness) {
    const LengthRange range =
        options.thickness_range.value_or(LengthRange{0.5 * start.thickness, 2.0 * start.thickness});
    add(Quantity::thickness, "thickness", true, t, range.low.si(), range.high.si(), 1e-5);
  }
  if (options.preload) {
    const PressureRange range = options.preload_range.value_or(
        PressureRange{Pressure::from_si(-highest), Pressure::from_si(highest)});
    add(Quantity::preload, "preload", false, 0.0, range.low.si(), range.high.si(), 1e-5 * highest);
  }
  return made;
}

/// A wall and its preload with the values of the free parameters put in.
std::pair<WallSection, Pressure> wall_of(const std::vector<Free>& free, const Array1& theta,
                                         const WallSection& start) {
  WallSection section = start;
  Pressure preload{};
  for (std::size_t j = 0; j < free.size(); ++j) {
    const double value = free[j].outer(theta(static_cast<Index>(j)));
    switch (free[j].quantity) {
      case Quantity::youngs_modulus:
        section.youngs_modulus = Pressure::from_si(value);
        break;
      case Quantity::prestress:
        section.prestress = Pressure::from_si(value);
        break;
      case Quantity::thickness:
        section.thickness = Length::from_si(value);
        break;
      case Quantity::preload:
        preload = Pressure::from_si(value);
        break;
    }
  }
  return {section, preload};
}

/// Covariance, and what the data cannot tell: fills parameters' sigma and determined.
void judge(const Matrix& information, const std::vector<Free>& free, LawFit& fit) {
  const Index k = information.rows();
  Eigen::VectorXd prior(k), scale(k);  // standard deviations of the bounds; d(SI)/d(variable)
  for (Index j = 0; j < k; ++j) {
    const Free& one = free[static_cast<std::size_t>(j)];
    prior(j) = (one.inner(one.upper) - one.inner(one.lower)) / std::sqrt(12.0);
    scale(j) = one.stretch(fit.parameters[static_cast<std::size_t>(j)].value);
  }
  // In units of the bounds' standard deviations: an eigenvalue below 4 leaves its direction wider
  // than half of what they do.
  const Matrix whitened = prior.asDiagonal() * information * prior.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(whitened);
  Eigen::VectorXd unseen = Eigen::VectorXd::Zero(k), variance(k);
  for (Index d = 0; d < k; ++d) {
    const double seen = eigen.eigenvalues()(d);
    const bool lost = !(seen > 4.0);
    fit.n_undetermined += lost ? 1 : 0;
    if (lost) unseen += eigen.eigenvectors().col(d).cwiseAbs2();
    variance(d) = 1.0 / (lost ? 1.0 + std::max(seen, 0.0) : seen);
  }
  const Matrix spread = prior.cwiseProduct(scale).asDiagonal() * eigen.eigenvectors();
  fit.covariance = spread * variance.asDiagonal() * spread.transpose();
  for (Index j = 0; j < k; ++j) {
    FitParameter& one = fit.parameters[static_cast<std::size_t>(j)];
    one.sigma = std::sqrt(fit.covariance(j, j));
    one.determined = unseen(j) < 0.01;  // a tenth of the lost direction's width
  }
}

}  // namespace

void HydrostaticData::validate() const {
  const Index n = pressure.size();
  if (sigma_pressure.size() != n || deflection.size() != n || sigma_deflection.size() != n) {
    refuse(fmt::format("{} pressures, {} of their uncertainties, {} deflections, {} of theirs", n,
                       sigma_pressure.size(), deflection.size(), sigma_deflection.size()),
           "Give four arrays of one length");
  }
  for (Index i = 0; i < n; ++i) {
    if (!std::isfinite(pressure(i)) || !std::isfinite(deflection(i))) {
      refuse(fmt::format("point {} has no finite pressure or deflection", i),
             "Leave out points without a reading");
    }
    if (!std::isfinite(sigma_pressure(i)) || sigma_pressure(i) < 0.0 ||
        !std::isfinite(sigma_deflection(i)) || sigma_deflection(i) <= 0.0) {
      refuse(fmt::format("point {} has an uncertainty that is negative, not finite, or 0 of the "
                         "deflection",
                         i),
             "Give a standard uncertainty above 0 for deflections, 0 or more for pressures");
    }
  }
}

void FitLawOptions::validate() const {
  if (max_iterations < 1) {
    refuse(fmt::format("max_iterations is {}", max_iterations), "Give at least 1");
  }
}

const FitParameter* LawFit::find(const std::string& name) const {
  const auto at = std::find_if(parameters.begin(), parameters.end(),
                               [&](const FitParameter& one) { return one.name == name; });
  return at == parameters.end() ? nullptr : &*at;
}

LawFit fit_law(LawKind kind, const WallSection& start, const HydrostaticData& data,
               const FitLawOptions& options) {
  data.validate();
  options.validate();
  start.validate(kWhere);
  const Index n = data.pressure.size();
  if (n < 2 || n > kMostPoints) {
    refuse(fmt::format("there are {} pressures", n),
           "Give more pressures than parameters, at most 500");
  }
  const std::vector<Free> free = free_parameters(kind, start, data, options);
  const auto k = static_cast<Index>(free.size());
  if (n <= k) {
    refuse(fmt::format("{} pressures for {} parameters", n, k),
           "Measure at more pressures or fix parameters");
  }

  LatentFit problem;
  problem.x = data.pressure;
  problem.sigma_x = data.sigma_pressure;
  problem.y = data.deflection;
  problem.sigma_y = data.sigma_deflection;
  problem.max_iterations = options.max_iterations;
  problem.start.resize(k);
  problem.lower.resize(k);
  problem.upper.resize(k);
  problem.step.resize(k);
  for (Index j = 0; j < k; ++j) {
    const Free& one = free[static_cast<std::size_t>(j)];
    problem.start(j) = one.inner(one.start);
    problem.lower(j) = one.inner(one.lower);
    problem.upper(j) = one.inner(one.upper);
    problem.step(j) = one.step;
  }
  const double highest = data.pressure.abs().maxCoeff();
  problem.curve = [&](const Array1& theta, const Array1& x, Array1& y, Array1& slope) {
    const auto [section, preload] = wall_of(free, theta, start);
    try {
      const AnyWallLaw law = make_wall_law(kind, section);
      y.resize(x.size());
      slope.resize(x.size());
      for (Index i = 0; i < x.size(); ++i) {
        const Pressure p = Pressure::from_si(x(i)) - preload;
        y(i) = deflection(law, p).si();
        slope(i) = deflection_compliance(law, p);
        if (!std::isfinite(slope(i))) {  // a slack membrane at p = 0: its slope over a sigma
          const Pressure step = Pressure::from_si(data.sigma_pressure(i) + 1e-6 * highest);
          slope(i) =
              (deflection(law, p + step) - deflection(law, p - step)).si() / (2.0 * step.si());
        }
      }
    } catch (const InputError&) {
      return false;  // outside the law's range: the solver steps back
    }
    return true;
  };
  make_wall_law(kind, wall_of(free, problem.start, start).first);  // throws where it does not hold
  const LatentAnswer answer = solve_latent_fit(problem);

  LawFit fit;
  fit.kind = kind;
  std::tie(fit.section, fit.preload) = wall_of(free, answer.theta, start);
  for (Index j = 0; j < k; ++j) {
    const Free& one = free[static_cast<std::size_t>(j)];
    FitParameter made;
    made.name = one.name;
    made.value = one.outer(answer.theta(j));
    made.lower = one.lower;
    made.upper = one.upper;
    const double slack = 1e-6 * (problem.upper(j) - problem.lower(j));
    made.at_bound =
        answer.theta(j) < problem.lower(j) + slack || answer.theta(j) > problem.upper(j) - slack;
    fit.parameters.push_back(made);
  }
  fit.converged = answer.converged;
  fit.pressure = answer.x;
  fit.residual = answer.residual;
  fit.chi2 = answer.residual.square().sum();
  fit.n_dof = n - k;
  fit.probability = boost::math::gamma_q(0.5 * static_cast<double>(fit.n_dof), 0.5 * fit.chi2);
  const auto count = static_cast<double>(k), left = static_cast<double>(n - k - 1);
  fit.aicc = left > 0.0 ? fit.chi2 + 2.0 * count + 2.0 * count * (count + 1.0) / left
                        : std::numeric_limits<double>::infinity();
  judge(answer.information, free, fit);
  return fit;
}

}  // namespace manoscope::wall
