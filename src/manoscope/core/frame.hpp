#pragma once

#include <array>
#include <cmath>

#include "manoscope/core/units.hpp"

namespace manoscope {

/// Which way the flow runs in the map: along growing or falling columns, or rows.
enum class FlowDirection { plus_columns, minus_columns, plus_rows, minus_rows };

/// Whether a wall that bulges away from the fluid reads higher or lower in the map.
enum class Outward { plus_height, minus_height };

/// Where the channel lies in a map.
///
/// A point (x, z) of the channel, z counted from the centre line, has the camera position
///   origin + R(rotation) (x along the flow + (z + width/2) across),
/// where "across" runs along growing rows (columns, for a flow along rows) or, with
/// `across_reversed`, the other way. Camera positions are (along columns, along rows) from the
/// outer corner of the first pixel; R turns from columns towards growing rows.
struct ChannelFrame {
  Length length{}, width{};
  Length origin_x{}, origin_y{};  ///< camera position of the corner (x = 0, z = -width/2)
  FlowDirection flow = FlowDirection::plus_columns;
  bool across_reversed = false;
  Angle rotation{};
  Outward outward = Outward::plus_height;

  bool along_columns() const {
    return flow == FlowDirection::plus_columns || flow == FlowDirection::minus_columns;
  }
  double flow_sign() const {
    return flow == FlowDirection::plus_columns || flow == FlowDirection::plus_rows ? 1.0 : -1.0;
  }
  double across_sign() const { return across_reversed ? -1.0 : 1.0; }

  /// Camera position, m, of the channel point (x, z), m.
  std::array<double, 2> camera_from_channel(double x, double z) const {
    const double along = flow_sign() * x;
    const double across = across_sign() * (z + 0.5 * width.si());
    const double column = along_columns() ? along : across;
    const double row = along_columns() ? across : along;
    const double c = std::cos(rotation.si()), s = std::sin(rotation.si());
    return {origin_x.si() + c * column - s * row, origin_y.si() + s * column + c * row};
  }
};

}  // namespace manoscope
