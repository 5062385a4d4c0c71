#pragma once

#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/parasitic.hpp"

namespace manoscope::navier_stokes {

enum class PassageEnd { inlet, outlet };
enum class PortSide { top, side };

/// A rigid passage joined to one end of the channel, and what lies beyond its far end.
///
/// All sections are rectangles on one floor, centred across. Where passage and channel differ in
/// height or width there is a step. Beyond the far end: nothing, a wider section `beyond` behind
/// another step, or a port: a hole of that length along x at the far end, as wide as the passage
/// in its roof, or as high as the passage in one side wall.
struct SimulatedPassage {
  PassageEnd end = PassageEnd::inlet;
  flow::Channel channel;                   ///< its length plays no part
  flow::RigidPassage passage;              ///< the uncertainty of its height plays no part
  Length beyond_width{}, beyond_height{};  ///< 0: no wider section
  Length port{};                           ///< 0: no port
  PortSide port_side = PortSide::top;
  flow::Fluid fluid{1.0 * mPa_s, 998.0 * kg_per_m3};
  FlowRate flow_rate{};
  double stretch = 1.0;  ///< of the lengths of port and wider section that are solved

  /// @throws InputError for sizes out of range or that do not fit.
  void validate() const;
};

/// A box of fluid, in heights of the channel: s runs from the end of the channel, 0, into the
/// passage, y up from the floor, z across.
struct FluidBox {
  double s_low, s_high, y_low, y_high, z_low, z_high;
};

/// The fluid of a passage and of the piece of channel that it is solved with.
struct PassageGeometry {
  explicit PassageGeometry(const SimulatedPassage& given, int dim);

  bool contains(double s, double y, double z) const;

  std::vector<FluidBox> boxes;  ///< channel, passage, then what lies beyond
  bool whole_width = false;     ///< else z >= 0 alone is solved
  int far_axis = 0;             ///< the far end faces along s, y or z: 0, 1, 2
  flow::RigidPassage far;       ///< section there, and its length, whose friction is not counted
  /// Share of the length that a jet into a wider section needs which is not solved.
  double missing = 0.0;
};

}  // namespace manoscope::navier_stokes
