#include "manoscope/inversion/read_nonlocal.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/inversion/model_scale.hpp"
#include "manoscope/inversion/shared_errors.hpp"
#include "manoscope/numerics/natural_spline.hpp"
#include "manoscope/numerics/penalised_fit.hpp"

namespace manoscope::inversion {
namespace {

using Vector = Eigen::VectorXd;

constexpr double kEndGap = 0.08;      // widths: nearer stations do not take part
constexpr double kCorrelation = 0.3;  // widths, of errors of curves and model along x
constexpr double kEndZone = 0.5;      // widths, where p may bend more sharply
constexpr double kEndShare = 0.35;    // half-response wavelengths: the same, of walls of long reach
constexpr int kMostIterations = 14, kFreeIterations = 4;
constexpr double kStepShare = 0.05;  // of the local reading's mean standard uncertainty
constexpr double kNearly = 10.0;     // times that: what the last step may leave, in the bars
constexpr double kFiner = 4.0;       // a ripple finer by the square root of 2, as weight
constexpr double kHuber = 2.5;       // pulls beyond count as if they grew no more (Huber 1964)
constexpr Index kFewestStations = 20;

/// Modes of a covariance, leaving out what is below 1e-8 of its trace.
void add_modes(const Matrix& covariance, const Matrix& sampling, const std::string& name,
               const std::string& source, std::vector<ErrorMode>& modes) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance);
  const double least = 1e-8 * covariance.trace();
  for (Index j = covariance.rows() - 1; j >= 0; --j) {
    const double variance = solver.eigenvalues()[j];
    if (!(variance > least)) continue;
    modes.push_back({fmt::format("{} {}", name, covariance.rows() - j), source,
                     (sampling * solver.eigenvectors().col(j) * std::sqrt(variance)).array()});
  }
}

/// Variance, Pa2, that gives independent stations the weight of the doubt of interpolation: each of
/// its variables is one error over all the stations between two levels.
Array1 interpolation_variance(const PressureReading& reading) {
  Array1 variance = Array1::Zero(reading.x.size());
  for (const ErrorMode& mode : reading.uncertainty.modes) {
    if (mode.source != "interpolation") continue;
    variance += static_cast<double>((mode.effect != 0.0).count()) * mode.effect.square();
  }
  return variance;
}

/// Number of neighbouring stations whose errors are one: 1 + 2 sum of the autocorrelation up to its
/// first lag that is not clear of 0.
double count_together(const Array1& residual) {
  constexpr Index kLongest = 60;
  const Index n = residual.size();
  const Array1 off = residual.max(-kHuber).min(kHuber);
  const double variance = off.square().mean(), clear = 2.0 / std::sqrt(static_cast<double>(n));
  double together = 1.0;
  for (Index lag = 1; lag < std::min(kLongest, n / 4) && variance > 0.0; ++lag) {
    const double rho = (off.head(n - lag) * off.tail(n - lag)).mean() / variance;
    if (rho < clear) break;
    together += 2.0 * rho;
  }
  return together;
}

/// The same reading, counted in the pressures of the model.
PressureReading in_model(PressureReading local, const ModelScale& scale) {
  for (Index i = 0; i < local.x.size(); ++i) {
    if (local.answered(i)) local.pressure[i] = scale.to_model(local.pressure[i]);
  }
  return local;
}

/// Knots of p(x): near the ends, where the wall is stiff and pixels tell little, nearly as far
/// apart as inside. The p(x) of a nitride wall 1.7 mm wide that rises by a fifth of its gap within
/// 0.3 mm is off by a few pascals of 10 kPa there.
Array1 pressure_knots(Length length, Length width) {
  constexpr double kAtEnds = 0.09;  // widths
  return graded_nodes(length, width, kAtEnds);
}

class Reader {
 public:
  Reader(const PressureReading& local, const NonlocalWall& wall, const ReadNonlocalOptions& options)
      : scale_(wall),
        local_(in_model(local, scale_)),
        wall_(wall),
        options_(options),
        width_(wall.calibrated.wall.width.si()),
        length_(wall.calibrated.wall.length.si()),
        nodes_(wall.response->nodes()),
        knots_(pressure_knots(wall.calibrated.wall.length, wall.calibrated.wall.width)),
        spline_(knots_),
        at_nodes_(spline_.sampling(nodes_)),
        inner_(nodes_.segment(1, nodes_.size() - 2)),
        sampling_(spline_.sampling(local.x)),
        inner_sampling_(inner_.sampling(local.x)),
        interpolation_(interpolation_variance(local)),
        offset_(Array1::Zero(local.x.size())) {
    for (Index i = 0; i < local.x.size(); ++i) {
      if (local.answered(i)) offset_[i] = scale_.doubt(local.pressure[i]);
      const double distance = std::min(local.x[i], length_ - local.x[i]);
      if (local.answered(i) && distance > kEndGap * width_) used_.push_back(i);
    }
    shared_ = effects_of(local_, "registration", used_);
    trust_ = Array1::Ones(static_cast<Index>(used_.size()));
    const Array1 standard = local.uncertainty.standard();
    for (const Index i : used_) enough_ += kStepShare * standard[i];
    enough_ /= std::max(1.0, static_cast<double>(used_.size()));
    for (const double sharper : {0.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6})
      penalties_.push_back(bend(sharper));
  }

  bool enough() const { return static_cast<Index>(used_.size()) >= kFewestStations; }

  std::optional<NonlocalReading> run(double coverage) {
    const Index n = nodes_.size();
    Vector pressure = start();
    WallResponse::Answer answer{at_nodes_ * pressure, Matrix::Identity(n, n)};
    double ripple = wall_.half_wavelength > 0.0 ? wall_.half_wavelength : width_;
    NonlocalReading result;
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
      if (iteration > 0) {
        answer = wall_.response->answer(at_nodes_ * pressure);
        result.half_wavelength = wall_.response->half_wavelength(answer.kernel, n / 2);
        if (result.half_wavelength > 0.0) ripple = result.half_wavelength;
        ++result.iterations;
      }
      const Vector before = pressure;
      // The choice of the weight may go back and forth: after a few steps it stays.
      if (iteration >= kFreeIterations && !settled_) settled_ = chosen_;
      const Step step = solve(pressure, answer, options_.finest_ripple * ripple);
      if (!settled_) trust_ = step.trust;
      chosen_ = Choice{step.fit.penalty, step.fit.weight};
      pressure = spline_.from_coefficients() * step.fit.coefficients;
      if (!pressure.allFinite()) return std::nullopt;
      const double moved =
          std::sqrt((pressure - before).squaredNorm() / static_cast<double>(pressure.size()));
      const bool last = iteration + 1 == kMostIterations && moved < kNearly * enough_;
      if (iteration > 1 && (moved < enough_ || last)) {
        result.misfit = step.fit.misfit / static_cast<double>(used_.size());
        result.pressure = finish(pressure, answer, step, pressure - before, coverage);
        return result;
      }
      // A step that leads back and forth is halved.
      if (settled_) pressure = 0.5 * (pressure + before);
    }
    return std::nullopt;
  }

 private:
  struct Step {
    numerics::PenalisedFit fit;
    Matrix gain;   ///< (n, n_used) of the node values by the stations' readings
    Array1 noise;  ///< (n_used) Pa2, the stations' own variance
    Array1 trust;  ///< (n_used) share of its weight that a station keeps
    Vector finer;  ///< (n) Pa, what half the finest ripple would change, where that is in force
    double together = 1.0;  ///< stations that err together, by the residuals
  };

  numerics::Penalty bend(double sharper) const {
    const Array1 x = knots_.segment(1, knots_.size() - 2);
    const double zone = std::max(kEndZone * width_, kEndShare * wall_.half_wavelength);
    const Array1 stiffness =
        1.0 /
        (1.0 + sharper * ((-(x / zone).square()).exp() + (-((length_ - x) / zone).square()).exp()));
    return {spline_.roughness(stiffness), stiffness.log().sum(), x.size()};
  }

  /// The local reading at the nodes; near the ends, where it is biased, a line through the rest.
  Vector start() const {
    const double margin = width_;
    double count = 0.0, sx = 0.0, sxx = 0.0, sy = 0.0, sxy = 0.0;
    for (const Index i : used_) {
      const double x = local_.x[i], y = local_.pressure[i];
      if (x < margin || x > length_ - margin) continue;
      count += 1.0;
      sx += x;
      sxx += x * x;
      sy += y;
      sxy += x * y;
    }
    const double determinant = count * sxx - sx * sx;
    const double slope = determinant > 0.0 ? (count * sxy - sx * sy) / determinant : 0.0;
    const double level = count > 0.0 ? (sy - slope * sx) / count : local_.pressure[used_.front()];
    return (level + slope * knots_).matrix();
  }

  /// R at the stations: p there plus the correction, which is smooth and unknown at the very ends.
  Array1 correction(const WallResponse::Answer& answer, const Vector& pressure) const {
    const Vector difference = answer.reading - at_nodes_ * pressure;
    return (inner_sampling_ * difference.segment(1, nodes_.size() - 2)).array();
  }

  Step solve(const Vector& pressure, const WallResponse::Answer& answer, double ripple) const {
    const Index n = nodes_.size(), m = static_cast<Index>(used_.size());
    const Array1 off = correction(answer, pressure);
    const Matrix change = (answer.kernel - Matrix::Identity(n, n)).middleRows(1, n - 2);
    const Vector uniform = inner_sampling_ * change.rowwise().sum();
    const Matrix change_by_knots = change * at_nodes_;
    const double spacing =
        (local_.x[local_.x.size() - 1] - local_.x[0]) / static_cast<double>(local_.x.size() - 1);
    const double together = std::max(1.0, kCorrelation * width_ / spacing);
    Step step;
    step.noise.resize(m);
    Array1 variance(m);
    Vector target(m);
    Matrix model(m, knots_.size());
    for (Index a = 0; a < m; ++a) {
      const Index i = used_[static_cast<std::size_t>(a)];
      const double own = local_.uncertainty.independent[i];
      step.noise[a] = own * own;
      const double doubt =
          std::pow(wall_.calibrated.model_error * off[i], 2) + std::pow(offset_[i] * uniform[i], 2);
      variance[a] = std::max(step.noise[a], 1e-12) + interpolation_[i] + together * doubt;
      model.row(a) = sampling_.row(i) + inner_sampling_.row(i) * change_by_knots;
      target[a] =
          local_.pressure[i] - off[i] - sampling_.row(i).dot(pressure) + model.row(a).dot(pressure);
    }
    model = model * spline_.from_coefficients();
    const Array1 weight = trust_ / variance;
    const SharedErrors shared(shared_, weight);
    const Matrix weighted = shared.weighted(model);  // V^-1 J
    const Vector weighted_target = shared.weighted(target);
    const numerics::NormalEquations data{
        model.transpose() * weighted, weighted.transpose() * target, target.dot(weighted_target)};
    // A smoothing spline passes half of a ripple if weight (2 pi/ripple)^4 is the density of the
    // stations over their variance (Green & Silverman 1994, sec. 3.7).
    const double floor = weight.mean() / spacing * std::pow(ripple / (2.0 * std::numbers::pi), 4);
    step.fit = settled_ ? numerics::fit_penalised(data, {penalties_[settled_->penalty]},
                                                  {settled_->weight, 0})
                        : numerics::fit_penalised(data, penalties_, {floor, 24});
    if (settled_) step.fit.penalty = settled_->penalty;
    const Vector own = shared.own_part(target - model * step.fit.coefficients);
    step.together = count_together(own.array() / variance.sqrt());
    const Array1 pull = (own.array().square() / variance).sqrt();
    step.trust = (kHuber / pull.max(kHuber));
    if (step.fit.weight <= floor) {
      step.finer = spline_.from_coefficients() *
                   (numerics::fit_penalised(data, {penalties_[step.fit.penalty]},
                                            {step.fit.weight / kFiner, 0})
                        .coefficients -
                    step.fit.coefficients);
    }
    step.gain = spline_.from_coefficients() * step.fit.covariance * weighted.transpose();
    return step;
  }

  PressureReading finish(const Vector& pressure, const WallResponse::Answer& answer,
                         const Step& step, const Vector& last_step, double coverage) const {
    PressureReading reading;
    reading.x = local_.x;
    reading.pressure = (sampling_ * pressure).array();
    for (double& p : reading.pressure) p = scale_.from_model(p);
    reading.slope = local_.slope;
    reading.flags = local_.flags;
    const Matrix& nodes = spline_.from_coefficients();
    const Matrix all = nodes * step.fit.covariance * nodes.transpose();
    const Matrix pixels = step.gain * step.noise.matrix().asDiagonal() * step.gain.transpose();
    auto& modes = reading.uncertainty.modes;
    add_modes(step.together * pixels, sampling_, "reading", "pixel noise", modes);
    const Matrix by_shared = step.gain * shared_;
    add_modes(all - pixels - by_shared * by_shared.transpose(), sampling_, "smoothness",
              "smoothness", modes);
    modes.push_back({"last step", "smoothness", (sampling_ * last_step).array()});
    if (step.finer.size() > 0) {
      modes.push_back({"finest ripple", "smoothness", (sampling_ * step.finer).array()});
    }
    const auto m = static_cast<Index>(used_.size());
    for (const ErrorMode& mode : local_.uncertainty.modes) {
      Vector effect(m);
      for (Index a = 0; a < m; ++a) effect[a] = mode.effect[used_[static_cast<std::size_t>(a)]];
      modes.push_back({mode.variable, mode.source, (sampling_ * (step.gain * effect)).array()});
    }
    const Array1 off = wall_.calibrated.model_error * correction(answer, pressure);
    const Array1 before = (reading.x < 0.5 * length_).cast<double>();
    modes.push_back({"wall model, inlet half", "wall model", off * before});
    modes.push_back({"wall model, outlet half", "wall model", off * (1.0 - before)});
    reading.uncertainty.independent = Array1::Zero(reading.x.size());
    for (Index i = 0; i < reading.x.size(); ++i) {
      // Where the wall hardly rises p(x) would be a guess of the spline's.
      const double distance = std::min(reading.x[i], length_ - reading.x[i]);
      if (reading.answered(i) && distance <= kEndGap * width_) {
        reading.flags[i] |= ReadingFlag::insensitive;
      }
      if (reading.answered(i)) continue;
      reading.pressure[i] = 0.0;
      for (ErrorMode& mode : modes) mode.effect[i] = 0.0;
    }
    form_interval(reading, coverage);
    return reading;
  }

  ModelScale scale_;
  PressureReading local_;
  const NonlocalWall& wall_;
  const ReadNonlocalOptions& options_;
  double width_, length_;
  Array1 nodes_;  ///< of the response
  Array1 knots_;  ///< of p(x)
  numerics::NaturalSpline spline_;
  Matrix at_nodes_;
  numerics::NaturalSpline inner_;
  Matrix sampling_, inner_sampling_;
  Array1 interpolation_, offset_;
  std::vector<Index> used_;
  Matrix shared_;  ///< (n_used, k) Pa, of the maps' places, which the fit finds as well
  std::vector<numerics::Penalty> penalties_;
  Array1 trust_;         ///< (n_used) of the last step
  double enough_ = 0.0;  ///< Pa: a step that moves p by less on average is the last
  struct Choice {
    std::size_t penalty;
    double weight;
  };
  std::optional<Choice> chosen_, settled_;
};

}  // namespace

std::optional<NonlocalReading> read_nonlocal(const PressureReading& local, const NonlocalWall& wall,
                                             double coverage, const ReadNonlocalOptions& options) {
  options.validate();
  Reader reader(local, wall, options);
  if (!reader.enough()) return std::nullopt;
  try {
    return reader.run(coverage);
  } catch (const InputError&) {
    return std::nullopt;  // the wall model has no equilibrium there
  }
}

}  // namespace manoscope::inversion
