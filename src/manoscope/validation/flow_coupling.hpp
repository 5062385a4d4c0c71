#pragma once

#include <optional>
#include <string>

#include "manoscope/validation/predict_flow.hpp"
#include "manoscope/validation/wall_answer.hpp"

namespace manoscope::validation {

/// Why wall and fluid have no steady state, or none that can be told, in words.
struct NoState {
  std::string why;      ///< "the flow chokes about x = 15.5 mm"
  std::string mend;     ///< what would help beside another flow rate; empty: nothing
  bool settled = true;  ///< false: Newton's method has found none, which says little of why
};

/// Wall and fluid at one flow rate. Arrays have shape (n), of FlowCoupling::wall().
struct CoupledState {
  FlowRate flow_rate{};
  Outlet outlet;
  Array1 pressure;    ///< Pa
  Array1 correction;  ///< Pa, of a march to `momentum`
  int steps = 0;
  std::optional<NoState> none;  ///< set: the numbers above answer nothing
};

/// The coupling of measured curves with a flow model that predict_flow() solves.
class FlowCoupling {
 public:
  /// @throws InputError if no station has a curve.
  FlowCoupling(const calibration::ConstitutiveCurves& curves, const FlowSetup& setup,
               flow::FlowModel model, const PredictFlowOptions& options);

  /// Newton's method from the flow past the undeflected wall, or from the pressure of another
  /// state.
  CoupledState solve(FlowRate flow_rate, const Outlet& outlet, const Array1* start = nullptr) const;
  /// Flow rate whose drop along the channel at rest is as large as the calibrated range.
  FlowRate scale() const;
  /// What a state is about to fail by, if anything: of the last one that holds.
  std::optional<NoState> on_the_edge(const CoupledState& state) const;

  const CurvedWall& wall() const { return wall_; }
  const FlowSetup& setup() const { return setup_; }
  const Matrix& spread() const { return spread_; }
  flow::FlowModel model() const { return model_; }
  /// What the wall answers to, P.
  Array1 felt(const Array1& p) const { return (spread_ * p.matrix()).array(); }
  /// dzeta/dP where P is that of p, m/Pa.
  Array1 slopes(const Array1& p) const;
  /// S^2, flow::speed_index(); 0 for models without inertia.
  Array1 speed_index(const CoupledState& state) const;

 private:
  bool settle(CoupledState& state) const;
  bool march_on(CoupledState& state) const;
  Array1 start(const CoupledState& state) const;
  flow::FlowCase flow(const CoupledState& state, const Array1& p) const;
  Array1 modelled(const CoupledState& state, const Array1& p) const;
  Matrix coupling(const CoupledState& state) const;
  flow::FlowModel local() const;
  Array1 spread_index(const CoupledState& state) const;
  std::optional<NoState> choking(const CoupledState& state, double from) const;
  std::optional<NoState> extrapolation(const CoupledState& state) const;
  NoState left_range(Index station, double pressure) const;

  CurvedWall wall_;
  FlowSetup setup_;
  flow::FlowModel model_;
  PredictFlowOptions options_;
  Matrix spread_;  ///< from p to what the wall answers to
};

}  // namespace manoscope::validation
