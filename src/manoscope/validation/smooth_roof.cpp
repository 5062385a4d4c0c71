#include "manoscope/validation/smooth_roof.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/validation/end_layers.hpp"

namespace manoscope::validation {
namespace {

constexpr Index kFewestStretches = 8;

/// Departures of all stretches that tell them.
struct Departures {
  std::vector<double> x;
  std::vector<Eigen::VectorXd> value, sigma;  ///< (n_departures) m
};

/// Even departures that so many cells across tell, with some to spare for chi-square.
Index even_departures(Index n_cells) { return std::clamp<Index>(3 * n_cells / 8, 3, 6); }

/// Edges of the cells across, s.
Array1 edges_across(const CrossSections& sections, double width) {
  const Index n = sections.z.size();
  const double step = (sections.z[n - 1] - sections.z[0]) / static_cast<double>(n - 1);
  return 2.0 / width *
         Array1::LinSpaced(n + 1, sections.z[0] - 0.5 * step, sections.z[n - 1] + 0.5 * step);
}

/// Weight of a cell in a least-squares fit, 1/m; 0 where it does not count.
double weight_of(const CrossSections& sections, Index b, Index j) {
  constexpr double kFinest = 1e-12;  // m: noise of an ideal camera, which is none
  return sections.flags(b, j) == 0 ? 1.0 / std::max(sections.sigma(b, j), kFinest) : 0.0;
}

/// Level and departures of every stretch by least squares over its cells.
/// @param means  (n_cells, 1 + n_departures) of the modes over the cells.
Departures fit_stretches(const CrossSections& sections, const Matrix& means, double length) {
  const Index n = means.cols() - 1;
  Departures found;
  for (Index j = 0; j < sections.x.size(); ++j) {
    if (sections.x[j] <= 0.0 || sections.x[j] >= length) continue;
    Eigen::VectorXd weight(means.rows());
    for (Index b = 0; b < weight.size(); ++b) weight[b] = weight_of(sections, b, j);
    if ((weight.array() > 0.0).count() < n + 2) continue;
    const Matrix design = weight.asDiagonal() * means;
    const Eigen::LDLT<Matrix> factors(Matrix(design.transpose() * design));
    constexpr double kLeastPivot = 1e-10;  // cells missing on one side: nothing tells some modes
    if (!(factors.vectorD().minCoeff() > kLeastPivot * factors.vectorD().maxCoeff())) continue;
    const Eigen::VectorXd value =
        factors.solve(design.transpose() * weight.cwiseProduct(sections.zeta.col(j).matrix()));
    const Eigen::VectorXd variance = factors.solve(Matrix::Identity(n + 1, n + 1)).diagonal();
    found.x.push_back(sections.x[j]);
    found.value.emplace_back(value.tail(n));
    found.sigma.emplace_back(variance.tail(n).cwiseSqrt());
  }
  return found;
}

/// One departure along the flow, 0 at the clamped ends.
numerics::SmoothingSpline spline_of(const Departures& found, Index k, double window,
                                    const flow::Channel& channel) {
  const auto n = static_cast<Index>(found.x.size());
  numerics::NoisyValues data{Array1::Zero(n + 2), Array1::Zero(n + 2), Array1::Zero(n + 2),
                             Array1::Zero(n + 2)};
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    data.x[i + 1] = found.x[at];
    data.y[i + 1] = found.value[at][k];
    data.sigma[i + 1] = found.sigma[at][k];
    data.window[i + 1] = window;
  }
  data.x[n + 1] = channel.length.si();
  constexpr double kClampedShare = 1e-3;  // a clamped end is known far better than any stretch
  data.sigma[0] = data.sigma[n + 1] = kClampedShare * data.sigma.segment(1, n).mean();
  const Array1 positions = data.x;
  return {std::move(data), knots_at(positions), end_bends(positions, channel.width),
          std::max(2.0 * channel.height.si(), 2.0 * window)};
}

/// (n_sections) By how much the splines' freedom lowers the mean of the squared rests of each
/// stretch over the noise: 2 S_jj - sum over i of S_ji^2 of each, S its weights over the stretch.
/// For departures that are orthogonal over the cells and noise that is the same in all stretches.
Array1 freedom_of(const std::vector<numerics::SmoothingSpline>& splines, const Departures& found,
                  const Array1& low, const Array1& middle, const Array1& high) {
  Array1 freedom = Array1::Zero(middle.size());
  for (const numerics::SmoothingSpline& spline : splines) {
    const Matrix weights = 0.5 * (spline.weights(low) + spline.weights(high));
    Index i = 1;  // the first datum is the clamped end
    for (const double x : found.x) {
      const auto j = std::find(middle.begin(), middle.end(), x) - middle.begin();
      freedom[j] +=
          2.0 * weights(j, i++) - weights.row(j).segment(1, weights.cols() - 2).squaredNorm();
    }
  }
  return freedom;
}

}  // namespace

std::optional<SmoothRoof> SmoothRoof::through(const SmoothShape& along,
                                              const CrossSections& sections,
                                              const flow::Channel& channel,
                                              const flow::WallShape& shape) {
  if (sections.empty() || sections.x.size() < kFewestStretches) return std::nullopt;
  const Index n_even = even_departures(sections.z.size());
  SmoothRoof roof(along, channel, AcrossModes(shape, n_even, n_even - 1));
  const Matrix means = roof.modes_.means(edges_across(sections, channel.width.si()));
  const Departures found = fit_stretches(sections, means, channel.length.si());
  if (static_cast<Index>(found.x.size()) < kFewestStretches) return std::nullopt;
  const Index n_x = sections.x.size();
  roof.window_ = (sections.x[n_x - 1] - sections.x[0]) / static_cast<double>(n_x - 1);
  for (Index k = 0; k < roof.modes_.size(); ++k) {
    roof.splines_.push_back(spline_of(found, k, roof.window_, channel));
  }
  const auto [low, high] = roof.within_stretches(sections.x);
  const Array1 freedom = freedom_of(roof.splines_, found, low, sections.x, high);
  roof.middle_ = roof.judge(sections, means, freedom, false);
  roof.ends_ = roof.judge(sections, means, freedom, true);
  return roof;
}

bool SmoothRoof::near_end(double x) const {
  const double reach = 0.5 * channel_.width.si();
  return x < reach || x > channel_.length.si() - reach;
}

std::pair<Array1, Array1> SmoothRoof::within_stretches(const Array1& x) const {
  const double reach = window_ / (2.0 * std::numbers::sqrt3);
  return {(x - reach).max(0.0), (x + reach).min(channel_.length.si())};
}

SmoothRoof::Judged SmoothRoof::judge(const CrossSections& sections, const Matrix& means,
                                     const Array1& freedom, bool ends) const {
  const auto [low, high] = within_stretches(sections.x);
  const Matrix smooth = 0.5 * (departures(low) + departures(high));
  double taken = 0.0, noise = 0.0, misfit = 0.0, fitted = 0.0;
  Index n_cells = 0;
  for (Index j = 0; j < sections.x.size(); ++j) {
    if (near_end(sections.x[j]) != ends) continue;
    Eigen::VectorXd weight(means.rows());
    for (Index b = 0; b < weight.size(); ++b) weight[b] = weight_of(sections, b, j);
    const Eigen::VectorXd rest =
        sections.zeta.col(j).matrix() - means.rightCols(modes_.size()) * smooth.row(j).transpose();
    const Eigen::VectorXd g = weight.cwiseProduct(means.col(0));
    if (!(g.squaredNorm() > 0.0)) continue;
    const double level = g.dot(weight.cwiseProduct(rest)) / g.squaredNorm();
    fitted += 1.0 + freedom[j];
    for (Index b = 0; b < weight.size(); ++b) {
      if (weight[b] == 0.0) continue;
      const double off = rest[b] - level * means(b, 0);
      taken += off * off;
      noise += 1.0 / (weight[b] * weight[b]);
      misfit += std::pow(off * weight[b], 2);
      ++n_cells;
    }
  }
  const auto n = static_cast<double>(n_cells);
  if (n <= fitted) return {};
  return {std::sqrt(taken / n), std::sqrt(noise / n), std::sqrt(misfit / (n - fitted))};
}

Matrix SmoothRoof::departures(const Array1& x) const {
  Matrix result(x.size(), modes_.size());
  for (Index k = 0; k < modes_.size(); ++k) {
    result.col(k) = splines_[static_cast<std::size_t>(k)].value(x).matrix();
  }
  return result;
}

Matrix SmoothRoof::departures_standard(const Array1& x) const {
  // What the departures miss is taken for more noise (Birge's ratio).
  Array1 more(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    more[i] = std::max(1.0, near_end(x[i]) ? ends_.misfit : middle_.misfit);
  }
  Matrix result(x.size(), modes_.size());
  for (Index k = 0; k < modes_.size(); ++k) {
    result.col(k) = (more * splines_[static_cast<std::size_t>(k)].standard(x)).matrix();
  }
  return result;
}

Array2 SmoothRoof::sum(const Array1& x, const Array1& z, Index n_departures) const {
  const Matrix across = modes_.at(2.0 / channel_.width.si() * z);
  return (along_.zeta(x).matrix() * across.col(0).transpose() +
          departures(x).leftCols(n_departures) * across.middleCols(1, n_departures).transpose())
      .array();
}

Array2 SmoothRoof::standard(const Array1& x, const Array1& z) const {
  const Matrix across = modes_.at(2.0 / channel_.width.si() * z);
  const Matrix squares = across.cwiseAbs2();
  return (along_.standard(x).square().matrix() * squares.col(0).transpose() +
          departures_standard(x).cwiseAbs2() * squares.rightCols(modes_.size()).transpose())
      .array()
      .sqrt();
}

Length SmoothRoof::mean_square_root(Index first, Index n, bool of_standard) const {
  constexpr Index kStations = 401;  // ten a width in the longest channels
  const Array1 x = Array1::LinSpaced(kStations, 0.0, channel_.length.si());
  const Matrix values = of_standard ? departures_standard(x) : departures(x);
  return Length::from_si(
      std::sqrt(values.middleCols(first, n).squaredNorm() / static_cast<double>(kStations)));
}

Length SmoothRoof::departure() const { return mean_square_root(0, modes_.n_even(), false); }
Length SmoothRoof::odd() const { return mean_square_root(modes_.n_even(), modes_.n_odd(), false); }
Length SmoothRoof::odd_standard() const {
  return mean_square_root(modes_.n_even(), modes_.n_odd(), true);
}

}  // namespace manoscope::validation
