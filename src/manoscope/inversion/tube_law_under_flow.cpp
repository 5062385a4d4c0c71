// The tube law from a flow run: station by station curves hold f and its own curvature, the
// momentum balance of the measured gap tells p(x) but for a few sizes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/duct_resistance.hpp"
#include "manoscope/inversion/curvature_fit.hpp"
#include "manoscope/inversion/free_curve.hpp"
#include "manoscope/inversion/tube_law.hpp"
#include "manoscope/inversion/weak_window.hpp"

namespace manoscope::inversion {
namespace {

using calibration::ConstitutiveCurves;

constexpr double kEndStep = 0.1, kEndReach = 1.3;     // widths: windows near the ends
constexpr double kInnerStep = 0.4, kInnerFrom = 1.5;  // widths: windows inside
constexpr std::size_t kFewestWindows = 12;
constexpr double kLeastClear = 4.0;   // curvature over its noise: attenuates b by 6 %
constexpr double kLeastNoise = 1e-9;  // m, of a deflection: what is smoother counts as smooth
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Excess drop of a flow that develops from x = 0 between parallel plates, over rho U^2/2.
///
///   K = 4 x+ (f_app - f) Re,  f_app Re = 3.44/sqrt(x+) +
///       (24 + 0.674/(4 x+) - 3.44/sqrt(x+)) / (1 + 2.9e-5/x+^2),  x+ = x/(Dh Re)
///
/// Source: Shah & London, Laminar Flow Forced Convection in Ducts (1978).
double developing_excess(double x_plus) {
  if (!(x_plus > 0.0)) return 0.0;
  const double start = 3.44 / std::sqrt(x_plus);
  const double apparent =
      start + (24.0 + 0.674 / (4.0 * x_plus) - start) / (1.0 + 2.9e-5 / (x_plus * x_plus));
  return 4.0 * x_plus * (apparent - 24.0);
}

/// What p(x) may be made of, one column a shape, and what is known of their sizes.
struct FlowShapes {
  Matrix shape;  ///< (n_x, 5) Pa
  Eigen::VectorXd prior, prior_sigma;
};

/// @throws InputError where the gap is no duct.
FlowShapes flow_shapes(const Profile& state, const flow::Channel& channel, const flow::Fluid& fluid,
                       FlowRate flow_rate) {
  const Array1& x = state.x;
  const Index n = x.size();
  // Across missing stations the gap is that of the last one before.
  Array1 gap(n);
  double zeta = 0.0;
  for (Index i = 0; i < n; ++i) {
    if (state.flags[i] == 0) zeta = state.zeta[i];
    gap[i] = channel.height.si() + zeta;
  }
  const double w = channel.width.si(), q = flow_rate.si();
  const Array1 gradient =
      q * flow::duct_resistance(fluid.viscosity, channel.width, gap, flow::DuctFormula::series);
  const Array1 lever = x / channel.length.si() - 0.5;
  const Array1 dynamic = 0.5 * fluid.density.si() * (q / (w * gap)).square();
  FlowShapes flow{Matrix::Zero(n, 5), Eigen::VectorXd(5), Eigen::VectorXd(5)};
  for (Index i = 0; i < n; ++i) {
    const double diameter = 2.0 * w * gap[i] / (w + gap[i]);
    const double reynolds = fluid.density.si() * q * diameter / (w * gap[i] * fluid.viscosity.si());
    flow.shape(i, 0) = 1.0;
    if (i > 0) {
      const double step = 0.5 * (x[i] - x[i - 1]);
      flow.shape(i, 1) = flow.shape(i - 1, 1) - step * (gradient[i] + gradient[i - 1]);
      flow.shape(i, 3) =
          flow.shape(i - 1, 3) - step * (gradient[i] * lever[i] + gradient[i - 1] * lever[i - 1]);
    }
    flow.shape(i, 2) = -dynamic[i];
    flow.shape(i, 4) = -dynamic[i] * developing_excess(x[i] / (diameter * reynolds));
  }
  flow.prior << 0.0, 1.0, 1.2, 0.0, 0.0;
  flow.prior_sigma << kInfinite, kInfinite, 0.1, 0.1, 0.5;
  return flow;
}

/// A window under flow, and the uniform state it is held against.
struct FlowWindow {
  WeakWindow window;
  double pressure;  ///< Pa, mean of the station-by-station reading
  Array1 uniform;   ///< (n of the window) m, deflection under that pressure everywhere
  /// 1/m: what the reading's own slope over the window adds to the curvature of the uniform states.
  double slope_part = 0.0;
  std::vector<calibration::ConstitutiveCurve::LevelWeight> weights;
};

std::vector<double> window_centres(double length, double width, double start) {
  std::vector<double> centres;
  for (double d = start; d < kEndReach * width; d += kEndStep * width) {
    centres.push_back(d);
    centres.push_back(length - d);
  }
  for (double x = kInnerFrom * width; x < length - (kInnerFrom - 0.1) * width;
       x += kInnerStep * width) {
    centres.push_back(x);
  }
  return centres;
}

std::optional<FlowWindow> ask(const ConstitutiveCurves& curves, const PressureReading& local,
                              WeakWindow window) {
  const double pressure = window.mean_of(local.pressure);
  FlowWindow asked{std::move(window), pressure, {}, 0.0, {}};
  const Index n = asked.window.size();
  asked.uniform = Array1::Zero(n);
  Array1 compliance = Array1::Zero(n);
  for (Index i = 0; i < n; ++i) {
    if (asked.window.mean[i] == 0.0) continue;
    const auto& curve = curves.curves[static_cast<std::size_t>(asked.window.first + i)];
    if (!curve || pressure < curve->lowest() || pressure > curve->highest()) return std::nullopt;
    asked.uniform[i] = curve->zeta(pressure);
    compliance[i] = curve->slope(pressure);
  }
  const auto reading = local.pressure.segment(asked.window.first, n);
  const Array1 lever = local.x.segment(asked.window.first, n) - asked.window.centre;
  // Slope of r by the line through the window, per half width: phi's mean of t^2 is 1/9.
  const double spread = (asked.window.mean * lever.square()).sum();
  const double slope = (asked.window.mean * lever * (reading - pressure)).sum() / spread;
  asked.slope_part = slope * 3.0 * std::sqrt(spread) * (asked.window.skew * compliance).sum();
  const auto middle = static_cast<std::size_t>(asked.window.first + asked.window.size() / 2);
  if (!curves.curves[middle]) return std::nullopt;
  asked.weights = curves.curves[middle]->level_weights(pressure);
  return asked;
}

std::vector<FlowWindow> ask_all(const ConstitutiveCurves& curves, const PressureReading& local,
                                const Profile& state, double length, double width, double start) {
  Flags1 usable(local.x.size());
  for (Index i = 0; i < usable.size(); ++i) {
    usable[i] = local.answered(i) && state.flags[i] == 0 ? 1 : 0;
  }
  const double half = window_half_width(local.x, width);
  std::vector<FlowWindow> windows;
  std::vector<double> roughness;
  for (const double centre : window_centres(length, width, std::max(start, half))) {
    auto window = make_weak_window(local.x, usable, centre, half);
    if (!window) continue;
    auto asked = ask(curves, local, std::move(*window));
    if (!asked) continue;
    const Index first = asked->window.first, n = asked->window.size();
    const Array1 noise =
        local.uncertainty.independent.segment(first, n) * local.slope.segment(first, n);
    roughness.push_back(asked->window.roughness(state.zeta.segment(first, n) - asked->uniform,
                                                noise.max(kLeastNoise)));
    windows.push_back(std::move(*asked));
  }
  const std::vector<bool> passed = not_rough(roughness);
  std::vector<FlowWindow> kept;
  for (std::size_t m = 0; m < windows.size(); ++m) {
    if (passed[m]) kept.push_back(std::move(windows[m]));
  }
  return kept;
}

/// Effects of every error on the readings and the curvatures of the windows.
class FlowEffects {
 public:
  FlowEffects(const ConstitutiveCurves& curves, const Profile& state, const PressureReading& local)
      : curves_(curves), state_(state), local_(local) {
    for (const ErrorMode& mode : local.uncertainty.modes) column(mode);
    for (const ErrorMode& mode : state.uncertainty.modes) column(mode);
    for (const auto& level : curves.levels) {
      for (const ErrorMode& mode : level.profile.uncertainty.modes) column(mode);
    }
  }
  Index n_errors() const { return static_cast<Index>(column_.size()) + local_.x.size(); }

  /// Signs are those of -(zeta'' - zeta_c'').
  void add(const FlowWindow& asked, Index row, CurvatureRows& rows) {
    const WeakWindow& window = asked.window;
    auto target = rows.target_effect.row(row);
    auto curvature = rows.curvature_effect.row(row);
    for (const ErrorMode& mode : local_.uncertainty.modes) {
      target[column(mode)] += window.mean_of(mode.effect);
    }
    for (const ErrorMode& mode : state_.uncertainty.modes) {
      curvature[column(mode)] -= window.curvature_of(mode.effect);
    }
    for (const auto& weight : asked.weights) {
      const auto& level = curves_.levels[static_cast<std::size_t>(weight.level)];
      for (const ErrorMode& mode : level.profile.uncertainty.modes) {
        curvature[column(mode)] += weight.deflection * window.curvature_of(mode.effect);
      }
    }
    // Pixels of the run and of the levels move a station's reading and its deflection together.
    const Index first = static_cast<Index>(column_.size()) + window.first;
    for (Index i = 0; i < window.size(); ++i) {
      const double noise = local_.uncertainty.independent[window.first + i];
      target[first + i] = window.mean[i] * noise;
      curvature[first + i] = -window.curvature[i] * noise * local_.slope[window.first + i];
    }
  }

 private:
  Index column(const ErrorMode& mode) {
    return column_.try_emplace(mode.variable, static_cast<Index>(column_.size())).first->second;
  }

  const ConstitutiveCurves& curves_;
  const Profile& state_;
  const PressureReading& local_;
  std::map<std::string, Index> column_;
};

CurvatureRows write_rows(const ConstitutiveCurves& curves, const Profile& state,
                         const PressureReading& local, const FlowShapes& shapes,
                         const std::vector<FlowWindow>& windows) {
  const auto n = static_cast<Index>(windows.size());
  FlowEffects effects(curves, state, local);
  CurvatureRows rows{Eigen::VectorXd(n),
                     Eigen::VectorXd(n),
                     Matrix(n, shapes.shape.cols()),
                     shapes.prior,
                     shapes.prior_sigma,
                     Matrix::Zero(n, effects.n_errors()),
                     Matrix::Zero(n, effects.n_errors())};
  for (Index m = 0; m < n; ++m) {
    const FlowWindow& asked = windows[static_cast<std::size_t>(m)];
    const WeakWindow& window = asked.window;
    rows.target[m] = asked.pressure;
    rows.curvature[m] = (window.curvature * asked.uniform).sum() + asked.slope_part -
                        window.curvature_of(state.zeta);
    for (Index j = 0; j < shapes.shape.cols(); ++j) {
      rows.nuisance(m, j) = window.mean_of(shapes.shape.col(j).array());
    }
    effects.add(asked, m, rows);
  }
  return rows;
}

/// Deflection and stiffness where b was found: far from the ends at the pressures of the windows,
/// by what each had to say.
bool place_law(const ConstitutiveCurves& curves, const flow::Channel& channel,
               const std::vector<FlowWindow>& windows, const CurvatureRows& rows, TubeLaw& law) {
  double weights = 0.0;
  for (const auto end : {FreeCurve::End::inlet, FreeCurve::End::outlet}) {
    const auto curve = FreeCurve::about(curves, channel.length, channel.width, end);
    if (!curve) continue;
    for (std::size_t m = 0; m < windows.size(); ++m) {
      const bool near_inlet = windows[m].window.centre < 0.5 * channel.length.si();
      if (near_inlet != (end == FreeCurve::End::inlet)) continue;
      const double weight = std::pow(rows.curvature[static_cast<Index>(m)], 2);
      const double zeta = curve->deflection(windows[m].pressure);
      law.deflection += weight * zeta;
      law.stiffness += weight * curve->at_deflection(zeta).stiffness;
      weights += weight;
    }
  }
  if (!(weights > 0.0)) return false;
  law.deflection /= weights;
  law.stiffness /= weights;
  return true;
}

}  // namespace

TubeLawUnderFlow tube_law_under_flow(const ConstitutiveCurves& curves, const Profile& state,
                                     const PressureReading& local, const flow::Channel& channel,
                                     const flow::Fluid& fluid, FlowRate flow_rate, double start) {
  TubeLawUnderFlow found;
  const auto windows =
      ask_all(curves, local, state, channel.length.si(), channel.width.si(), start);
  if (windows.size() < kFewestWindows) {
    found.reason = "too few stations near the ends have a reading";
    return found;
  }
  try {
    const FlowShapes shapes = flow_shapes(state, channel, fluid, flow_rate);
    const CurvatureRows rows = write_rows(curves, state, local, shapes, windows);
    const auto fit = fit_curvature(rows);
    if (!fit) {
      found.reason = "the run curves the wall by no more than noise";
      return found;
    }
    found.resistance_factor = fit->size[1];
    TubeLaw law;
    if (fit->clearness < kLeastClear) {
      found.reason = "the run curves the wall by no more than noise";
    } else if (!place_law(curves, channel, windows, rows, law)) {
      found.reason = "the wall is too short, or does not rise with pressure throughout";
    } else {
      law.b = fit->b;
      law.misfit = fit->misfit;
      law.uncertainty = fit->uncertainty();
      found.law = law;
    }
  } catch (const InputError& error) {
    found.reason = error.found();  // a gap that closes, or a flow rate of 0
  }
  return found;
}

}  // namespace manoscope::inversion
