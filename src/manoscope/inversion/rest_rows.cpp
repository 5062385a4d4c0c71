#include "manoscope/inversion/rest_rows.hpp"

#include <cmath>

namespace manoscope::inversion {

using calibration::ConstitutiveCurves;

RestRows::RestRows(const ConstitutiveCurves& curves, const std::vector<EndZone>& zones,
                   const GaugeErrors& gauge)
    : curves_(curves), zones_(zones) {
  const auto n_levels = static_cast<Index>(curves.levels.size());
  const Index n_labels = curves.label_effect.cols();
  labels_.resize(n_levels, n_labels + 2);
  Eigen::VectorXd share(n_levels);
  for (Index k = 0; k < n_levels; ++k) {
    share[k] = curves.levels[static_cast<std::size_t>(k)].gauge_share;
  }
  labels_ << curves.label_effect, gauge.gain * curves.level_pressure.matrix(),
      gauge.zero.si() * (curves.label_response * share);
  Index next = labels_.cols();
  for (const auto& level : curves.levels) {
    for (const ErrorMode& mode : level.profile.uncertainty.modes) {
      if (column_.try_emplace(mode.variable, next).second) ++next;
    }
  }
  for (const EndZone& zone : zones) {
    noise_column_.push_back(next);
    doubt_column_.push_back(next + n_levels);
    next += n_levels + static_cast<Index>(zone.curve.knots().size()) - 1;
    auto& effects = far_.emplace_back();
    const auto n = static_cast<double>(zone.curve.stations().size());
    for (Index k = 0; k < n_levels; ++k) {
      const Uncertainty& of = curves.levels[static_cast<std::size_t>(k)].profile.uncertainty;
      auto& list = effects.emplace_back();
      double squares = 0.0;
      for (const Index ix : zone.curve.stations()) squares += std::pow(of.independent[ix], 2);
      list.emplace_back(noise_column_.back() + k, std::sqrt(squares) / n);
      for (const ErrorMode& mode : of.modes) {
        double sum = 0.0;
        for (const Index ix : zone.curve.stations()) sum += mode.effect[ix];
        list.emplace_back(column_.at(mode.variable), sum / n);
      }
    }
  }
  n_shared_ = next;
}

std::optional<RestRows::Window> RestRows::ask(const EndZone& zone, const WeakWindow& window,
                                              Index level) const {
  const auto n_levels = static_cast<Index>(curves_.levels.size());
  const auto& knots = zone.curve.knots();
  const Array1& zeta = curves_.levels[static_cast<std::size_t>(level)].profile.zeta;
  Window asked{curves_.level_pressure[level], Eigen::VectorXd::Zero(window.size()),
               Eigen::VectorXd::Zero(n_levels), Eigen::VectorXd::Zero(n_levels),
               Eigen::VectorXd::Zero(static_cast<Index>(knots.size()) - 1)};
  for (Index i = 0; i < window.size(); ++i) {
    const double weight = window.mean[i], here = zeta[window.first + i];
    if (weight == 0.0) continue;
    const FreeCurve::Point point = zone.curve.at_deflection(here);
    if (std::isnan(point.pressure)) return std::nullopt;
    asked.target -= weight * point.pressure;
    asked.own[i] = weight * point.stiffness;
    const auto [below, share] = zone.curve.place(here);
    asked.doubt[static_cast<Index>(below)] -= weight * point.doubt;
    for (const auto& [knot, part] : {std::pair{below, 1.0 - share}, {below + 1, share}}) {
      const auto& levels = knots[knot].levels;
      const double each = part / static_cast<double>(levels.size());
      for (const Index k : levels) {
        asked.label[k] += weight * each;
        asked.shift[k] += asked.own[i] * each;
      }
    }
  }
  return asked;
}

std::vector<bool> RestRows::smooth_windows(Index level) const {
  constexpr double kLeastNoise = 1e-9;  // m: what is smoother counts as smooth
  const Profile& profile = curves_.levels[static_cast<std::size_t>(level)].profile;
  std::vector<double> roughness;
  for (const EndZone& zone : zones_) {
    for (const WeakWindow& window : zone.windows[static_cast<std::size_t>(level)]) {
      roughness.push_back(window.roughness(
          profile.zeta.segment(window.first, window.size()),
          profile.uncertainty.independent.segment(window.first, window.size()).max(kLeastNoise)));
    }
  }
  return not_rough(roughness);
}

void RestRows::add_effects(std::size_t zone, const WeakWindow& window, const Window& asked,
                           Index level, Index row, CurvatureRows& rows) const {
  const Uncertainty& own = curves_.levels[static_cast<std::size_t>(level)].profile.uncertainty;
  auto target = rows.target_effect.row(row);
  auto curvature = rows.curvature_effect.row(row);
  Eigen::VectorXd label = -asked.label;
  label[level] += 1.0;
  target.head(labels_.cols()) = label.transpose() * labels_;
  for (Index k = 0; k < label.size(); ++k) {
    if (asked.shift[k] == 0.0) continue;
    for (const auto& [column, effect] : far_[zone][static_cast<std::size_t>(k)]) {
      target[column] += asked.shift[k] * effect;
    }
  }
  target.segment(doubt_column_[zone], asked.doubt.size()) = asked.doubt.transpose();
  for (const ErrorMode& mode : own.modes) {
    const Index column = column_.at(mode.variable);
    target[column] -= asked.own.dot(mode.effect.segment(window.first, window.size()).matrix());
    curvature[column] += window.curvature_of(mode.effect);
  }
  const auto noise = own.independent.segment(window.first, window.size());
  target.segment(n_shared_ + window.first, window.size()) =
      -(asked.own.array() * noise).transpose();
  curvature.segment(n_shared_ + window.first, window.size()) =
      (window.curvature * noise).transpose();
}

CurvatureRows RestRows::rows(Index level) const {
  const Array1& zeta = curves_.levels[static_cast<std::size_t>(level)].profile.zeta;
  std::vector<std::pair<std::size_t, const WeakWindow*>> windows;
  std::vector<Window> answers;
  const std::vector<bool> passed = smooth_windows(level);
  std::size_t place = 0;
  for (std::size_t z = 0; z < zones_.size(); ++z) {
    for (const WeakWindow& window : zones_[z].windows[static_cast<std::size_t>(level)]) {
      if (!passed[place++]) continue;
      auto asked = ask(zones_[z], window, level);
      if (!asked) continue;
      windows.emplace_back(z, &window);
      answers.push_back(std::move(*asked));
    }
  }
  const auto n = static_cast<Index>(windows.size());
  const Index n_errors = n_shared_ + curves_.x.size();
  CurvatureRows rows{Eigen::VectorXd(n),        Eigen::VectorXd(n),       Matrix(n, 0), {}, {},
                     Matrix::Zero(n, n_errors), Matrix::Zero(n, n_errors)};
  for (Index m = 0; m < n; ++m) {
    const auto& [zone, window] = windows[static_cast<std::size_t>(m)];
    const Window& asked = answers[static_cast<std::size_t>(m)];
    rows.target[m] = asked.target;
    rows.curvature[m] = window->curvature_of(zeta);
    add_effects(zone, *window, asked, level, m, rows);
  }
  return rows;
}

}  // namespace manoscope::inversion
