#pragma once

#include <functional>
#include <optional>

#include "channel_shape.hpp"
#include "flow_json.hpp"
#include "roof_map.hpp"
#include "simulation_options.hpp"

namespace manoscope::navier_stokes {

/// The wall of a table, as a simulation takes it: along the channel, and across by the table's own
/// map or by the shape that the options tell.
class GivenWall {
 public:
  /// @throws InputError if the map cannot be used, closes the gap, or the options ask for a map
  ///         that there is none of, or for a shape beside a map.
  GivenWall(const ShapeTable& table, const SimulationOptions& options);

  double start() const { return along().x()[0]; }  ///< first x of the table, m
  double length() const { return along().length(); }
  /// SimulatedChannel::zeta, x from 0; lives no longer than this wall.
  std::function<double(double x, double z)> zeta(const SimulationOptions& options) const;
  RoofNote note(const SimulationOptions& options) const;

 private:
  const ChannelShape& along() const { return map_ ? map_->mean() : *profile_; }

  std::optional<ChannelShape> profile_;
  std::optional<RoofMap> map_;
};

}  // namespace manoscope::navier_stokes
