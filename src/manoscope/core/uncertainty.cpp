#include "manoscope/core/uncertainty.hpp"

#include <cmath>
#include <map>

#include "manoscope/core/error.hpp"

namespace manoscope {

Array1 Uncertainty::standard() const {
  Array1 variance = independent.square();
  for (const ErrorMode& mode : modes) {
    MANO_ASSERT(mode.effect.size() == variance.size());
    variance += mode.effect.square();
  }
  return variance.sqrt();
}

Matrix Uncertainty::covariance() const {
  const Index n = independent.size();
  Matrix effects(n, static_cast<Index>(modes.size()));
  for (Index j = 0; j < effects.cols(); ++j) {
    effects.col(j) = modes[static_cast<std::size_t>(j)].effect.matrix();
  }
  Matrix result = Matrix::Zero(n, n);
  result.selfadjointView<Eigen::Lower>().rankUpdate(effects);  // half the work of a product
  result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
  result.diagonal() += independent.square().matrix();
  return result;
}

double Uncertainty::covariance(const Array1& a, const Array1& b) const {
  double sum = (a * b * independent.square()).sum();
  for (const ErrorMode& mode : modes) sum += (a * mode.effect).sum() * (b * mode.effect).sum();
  return sum;
}

double Estimate::standard_uncertainty() const {
  const double variance = manoscope::covariance(*this, *this);
  return std::isnan(variance) ? variance : std::sqrt(std::max(0.0, variance));
}

double covariance(const Estimate& a, const Estimate& b) {
  std::map<std::string, double> effects;
  for (const Estimate::Term& term : a.terms) effects[term.variable] += term.effect;
  std::map<std::string, double> shared;
  for (const Estimate::Term& term : b.terms) {
    if (effects.contains(term.variable)) shared[term.variable] += term.effect;
  }
  double sum = 0.0;
  for (const auto& [variable, effect] : shared) sum += effects.at(variable) * effect;
  return sum;
}

}  // namespace manoscope
