#include "manoscope/calibration/shape_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "manoscope/calibration/shape_nodes.hpp"
#include "manoscope/numerics/chi_square.hpp"

namespace manoscope::calibration {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Index kFewestBins = 8;
constexpr double kNonlocal = 0.1;  // of (w/pi)^2 times the difference of curvatures
constexpr Index kReach = 2;        // stretches to either side, of that difference
constexpr double kOfLevels = 3.0;  // of what interpolants differ by, where a level is left out
constexpr double kChance = 1e-3;   // of a misfit whose size is told
constexpr double kSure = 1e-6;     // of a level's own fault

double rms(const BinVector& values) {
  return values.norm() / std::sqrt(static_cast<double>(values.size()));
}

BinVector pick(const Array2& values, const std::vector<Index>& bins, Index j) {
  BinVector picked(static_cast<Index>(bins.size()));
  for (Index i = 0; i < picked.size(); ++i) {
    picked[i] = values(bins[static_cast<std::size_t>(i)], j);
  }
  return picked;
}

}  // namespace

/// The levels, and which of them are taken at which stretch.
struct CalibratedShapes::Maps {
  std::vector<SurveyedMap> levels;
  Flags2 trusted;  ///< (n_levels, n_x), 1 where a level is taken
  double width;

  /// One stretch of a map, how it is compared, and with which levels.
  struct Comparison {
    StretchShape shape;
    std::vector<Index> bins, nodes;
    std::vector<double> weight;
  };

  const SurveyedMap& level(Index k) const { return levels[static_cast<std::size_t>(k)]; }
  const CrossSections& cells(Index k) const { return *level(k).map.sections; }

  std::vector<ShapeLevel> levels_at(Index j, Index except) const;
  /// @param except  a level that does not take part; -1: none.
  std::optional<Comparison> compare(const SurveyedMap& run, Index j, Index except) const;
  void interpolate(const CrossSections& run, Index j, Comparison& comparison) const;
  double allowance(const SurveyedMap& run, Index j, const Comparison& comparison,
                   Index except) const;
  double nonlocal_allowance(const SurveyedMap& run, Index j) const;
  double along_allowance(const SurveyedMap& run, Index j, const Comparison& comparison) const;
  double compliance(const Comparison& comparison, Index j) const;
  double chance_of_level(Index k, Index j) const;
  Index culprit(Index suspect, Index j);
  void leave_out_faults();
  ShapeMisfit judge(const SurveyedMap& run, Index except) const;
};

std::vector<ShapeLevel> CalibratedShapes::Maps::levels_at(Index j, Index except) const {
  std::vector<ShapeLevel> list;
  for (Index k = 0; k < static_cast<Index>(levels.size()); ++k) {
    if (k == except || trusted(k, j) == 0 || std::isnan(level(k).average[j])) continue;
    list.push_back({k, level(k).average[j]});
  }
  return list;
}

std::optional<CalibratedShapes::Maps::Comparison> CalibratedShapes::Maps::compare(
    const SurveyedMap& run, Index j, Index except) const {
  if (std::isnan(run.average[j])) return std::nullopt;
  Comparison result;
  result.nodes = shape_nodes(levels_at(j, except), run.average[j]);
  if (result.nodes.empty()) return std::nullopt;
  const CrossSections& own = *run.map.sections;
  for (Index b = 0; b < own.z.size(); ++b) {
    bool good = own.flags(b, j) == 0;
    for (const Index k : result.nodes) good = good && cells(k).flags(b, j) == 0;
    if (good) result.bins.push_back(b);
  }
  if (static_cast<Index>(result.bins.size()) < kFewestBins) return std::nullopt;
  interpolate(own, j, result);
  if (except >= 0) result.shape.smooth *= kOfLevels;
  result.shape.smooth = std::hypot(result.shape.smooth, allowance(run, j, result, except));
  return result;
}

/// The shape that the nodes give a map's average over the bins that all share.
void CalibratedShapes::Maps::interpolate(const CrossSections& run, Index j,
                                         Comparison& comparison) const {
  const std::vector<Index>& bins = comparison.bins;
  const auto n = static_cast<Index>(bins.size());
  const BinVector zeta = pick(run.zeta, bins, j);
  std::vector<double> averages;
  for (const Index k : comparison.nodes) averages.push_back(pick(cells(k).zeta, bins, j).mean());
  const NodeWeights weights = node_weights(averages, zeta.mean());
  comparison.weight = weights.weight;
  StretchShape& shape = comparison.shape;
  BinVector model = BinVector::Zero(n), low = model, high = model;
  BinVector variance = pick(run.sigma, bins, j).cwiseAbs2();
  shape.phi = model;
  BinVector whole = BinVector::Zero(run.z.size());
  for (std::size_t i = 0; i < comparison.nodes.size(); ++i) {
    const CrossSections& node = cells(comparison.nodes[i]);
    const BinVector of_node = pick(node.zeta, bins, j);
    whole += weights.weight[i] * level(comparison.nodes[i]).whole.col(j).matrix();
    model += weights.weight[i] * of_node;
    shape.phi += weights.growth[i] * of_node;
    low += weights.other_low[i] * of_node;
    high += weights.other_high[i] * of_node;
    variance += std::pow(weights.weight[i], 2) * pick(node.sigma, bins, j).cwiseAbs2();
  }
  const BinVector slope = slope_across(whole, run.z[1] - run.z[0]);
  const double half = 0.5 * width;
  shape.z = shape.slope = BinVector(n);
  for (Index i = 0; i < n; ++i) {
    shape.z[i] = run.z[bins[static_cast<std::size_t>(i)]] / half;
    shape.slope[i] = half * slope[bins[static_cast<std::size_t>(i)]];
  }
  constexpr double kLeastVariance = 1e-24;  // m2: maps without any noise still have round-off
  shape.residual = zeta - model;
  shape.sigma = variance.cwiseMax(kLeastVariance).cwiseSqrt();
  shape.smooth = std::max(rms(low), rms(high));
}

double CalibratedShapes::Maps::allowance(const SurveyedMap& run, Index j,
                                         const Comparison& comparison, Index except) const {
  // Hydrostatic maps stand under uniform pressure, like those they are compared with.
  const double nonlocal = except < 0 ? nonlocal_allowance(run, j) : 0.0;
  return std::hypot(nonlocal, along_allowance(run, j, comparison));
}

double CalibratedShapes::Maps::nonlocal_allowance(const SurveyedMap& run, Index j) const {
  const Index n = run.average.size();
  double widest = 0.0;
  for (Index i = std::max<Index>(0, j - kReach); i <= std::min(n - 1, j + kReach); ++i) {
    if (std::isnan(run.average[i]) || std::isnan(run.curvature[i])) continue;
    const std::vector<Index> nodes = shape_nodes(levels_at(i, -1), run.average[i]);
    if (nodes.empty()) continue;
    std::vector<double> averages;
    for (const Index k : nodes) averages.push_back(level(k).average[i]);
    const std::vector<double> weight = node_weights(averages, run.average[i]).weight;
    double difference = run.curvature[i];
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      difference -= weight[k] * level(nodes[k]).curvature[i];
    }
    if (!std::isnan(difference)) widest = std::max(widest, std::abs(difference));
  }
  return kNonlocal * std::pow(width / std::numbers::pi, 2) * widest;
}

/// What the map's place along the flow may do to the shape of one average: root mean square of the
/// even, smooth part of (d zeta / dx - phi d average / dx) times the distance.
double CalibratedShapes::Maps::along_allowance(const SurveyedMap& run, Index j,
                                               const Comparison& comparison) const {
  double shift = run.map.shift, variance = std::pow(run.map.shift_uncertainty, 2);
  for (std::size_t k = 0; k < comparison.nodes.size(); ++k) {
    const ShapedMap& node = level(comparison.nodes[k]).map;
    shift -= comparison.weight[k] * node.shift;
    variance += std::pow(comparison.weight[k] * node.shift_uncertainty, 2);
  }
  const CrossSections& own = *run.map.sections;
  const Index before = std::max<Index>(0, j - 1), after = std::min(own.x.size() - 1, j + 1);
  BinVector change = BinVector::Zero(comparison.shape.phi.size());
  BinVector known = change;
  for (Index i = 0; i < change.size(); ++i) {
    const Index b = comparison.bins[static_cast<std::size_t>(i)];
    if (after == before || own.flags(b, before) != 0 || own.flags(b, after) != 0) continue;
    change[i] = (own.zeta(b, after) - own.zeta(b, before)) / (own.x[after] - own.x[before]);
    known[i] = 1.0;
  }
  const double rise = known.sum() > 0.0 ? change.sum() / known.sum() : 0.0;
  change -= rise * known.cwiseProduct(comparison.shape.phi);
  const auto even = even_polynomials(comparison.shape.z);
  const auto n = static_cast<double>(change.size());
  return (even.transpose() * change / n).norm() * std::hypot(shift, std::sqrt(variance));
}

/// d average / dp over the levels of the interpolation, m/Pa; 0 where the labels do not tell it.
double CalibratedShapes::Maps::compliance(const Comparison& comparison, Index j) const {
  const SurveyedMap& low = level(comparison.nodes.front());
  const SurveyedMap& high = level(comparison.nodes.back());
  const double step = high.map.pressure - low.map.pressure;
  return step > 0.0 ? (high.average[j] - low.average[j]) / step : 0.0;
}

/// Chance of a level's misfit among the others at one stretch; 1 where it is not compared.
double CalibratedShapes::Maps::chance_of_level(Index k, Index j) const {
  if (trusted(k, j) == 0) return 1.0;
  const auto comparison = compare(level(k), j, k);
  if (!comparison) return 1.0;
  const StretchMisfit misfit = stretch_misfit(comparison->shape);
  return misfit.dof > 0.0 ? numerics::chi_square_tail(misfit.chi_square, misfit.dof) : 1.0;
}

/// Of a level and those that it was compared with, the one without which the levels about it agree
/// best.
Index CalibratedShapes::Maps::culprit(Index suspect, Index j) {
  constexpr Index kAbout = 4;
  constexpr double kLeast = 1e-300;
  const auto n = static_cast<Index>(levels.size());
  std::vector<Index> suspects = compare(level(suspect), j, suspect)->nodes;
  suspects.insert(suspects.begin(), suspect);
  Index found = suspect;
  double best = -std::numeric_limits<double>::infinity();
  for (const Index k : suspects) {
    trusted(k, j) = 0;
    double agreement = 0.0;
    for (Index i = std::max<Index>(0, suspect - kAbout); i < std::min(n, suspect + kAbout + 1);
         ++i) {
      agreement += std::log10(std::max(kLeast, chance_of_level(i, j)));
    }
    trusted(k, j) = 1;
    if (agreement > best) {
      best = agreement;
      found = k;
    }
  }
  return found;
}

void CalibratedShapes::Maps::leave_out_faults() {
  const auto n = static_cast<Index>(levels.size());
  for (Index j = 0; j < trusted.cols(); ++j) {
    for (Index n_left_out = 0; n_left_out < n / 4; ++n_left_out) {
      Index worst = -1;
      double least = kSure;
      for (Index k = 0; k < n; ++k) {
        const double chance = chance_of_level(k, j);
        if (chance >= least) continue;
        least = chance;
        worst = k;
      }
      if (worst < 0) break;
      trusted(culprit(worst, j), j) = 0;
    }
  }
}

ShapeMisfit CalibratedShapes::Maps::judge(const SurveyedMap& run, Index except) const {
  const CrossSections& own = *run.map.sections;
  const Index n = own.x.size();
  ShapeMisfit misfit;
  misfit.chi_square = misfit.dof = misfit.reading_shift = Array1::Constant(n, kNan);
  misfit.residual = Array2::Constant(own.z.size(), n, kNan);
  for (Index j = 0; j < n; ++j) {
    const auto comparison = compare(run, j, except);
    if (!comparison) continue;
    const StretchShape& shape = comparison->shape;
    const StretchMisfit found = stretch_misfit(shape);
    if (!(found.dof > 1.0)) continue;
    misfit.chi_square[j] = found.chi_square;
    misfit.dof[j] = found.dof;
    for (Index i = 0; i < shape.residual.size(); ++i) {
      misfit.residual(comparison->bins[static_cast<std::size_t>(i)], j) = shape.residual[i];
    }
    misfit.reading_shift[j] = 0.0;
    const double per_pascal = compliance(*comparison, j);
    const bool by_chance = numerics::chi_square_tail(found.chi_square, found.dof) > kChance;
    if (by_chance || !(per_pascal > 0.0)) continue;
    misfit.reading_shift[j] = std::max(std::abs(moved_average(shape)), found.excess) / per_pascal;
  }
  return misfit;
}

CalibratedShapes::CalibratedShapes(const std::vector<ShapedMap>& levels, double width)
    : maps_(std::make_unique<Maps>()) {
  for (const ShapedMap& level : levels) maps_->levels.push_back(survey(level, width));
  maps_->width = width;
  const Index n_x = levels.empty() ? 0 : levels.front().sections->x.size();
  maps_->trusted = Flags2::Ones(static_cast<Index>(levels.size()), n_x);
  maps_->leave_out_faults();
}

CalibratedShapes::~CalibratedShapes() = default;
CalibratedShapes::CalibratedShapes(CalibratedShapes&&) noexcept = default;
CalibratedShapes& CalibratedShapes::operator=(CalibratedShapes&&) noexcept = default;

ShapeMisfit CalibratedShapes::misfit(const ShapedMap& map) const {
  return maps_->judge(survey(map, maps_->width), -1);
}

ShapeMisfit CalibratedShapes::misfit_of_level(Index level) const {
  return maps_->judge(maps_->level(level), level);
}

}  // namespace manoscope::calibration
