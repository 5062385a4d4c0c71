#include "passage_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

constexpr const char* kWhere = "rigid passage";

void check_length(const char* name, Length length, bool may_be_zero) {
  if ((length > Length{} || (may_be_zero && length == Length{})) && std::isfinite(length.si()))
    return;
  throw InputError(kWhere, fmt::format("its {} is {:g} mm", name, length.in(mm)),
                   "Give a positive length such as \"1 mm\"");
}

/// Of the piece of channel: what a step does to the flow across fades there as exp(-2 pi x/width).
double channel_piece(const SimulatedPassage& given, int dim) {
  constexpr double kGaps = 3.0;
  return kGaps + (dim == 3 ? given.channel.width / given.channel.height : 0.0);
}

/// Length of a wider section in which a jet into it comes to fill it, in its heights. Cut at 20,
/// the drop of a step 1:2 between plates at Re = 690 is off by 0.34 rho U^2/2.
double jet_length(const SimulatedPassage& given) {
  constexpr double kLeast = 4.0, kSpread = 0.1;
  const double speed = given.flow_rate.si() / (given.passage.width * given.passage.height).si();
  const double reynolds =
      speed * given.passage.height.si() / given.fluid.kinematic_viscosity().si();
  return given.end == PassageEnd::inlet ? kLeast : kLeast + kSpread * reynolds;
}

}  // namespace

void SimulatedPassage::validate() const {
  flow::Channel end_of_channel = channel;
  end_of_channel.length = channel.width;
  end_of_channel.validate(kWhere);
  fluid.validate(kWhere);
  check_length("length", passage.length, false);
  check_length("width", passage.width, false);
  check_length("height", passage.height, false);
  check_length("port", port, true);
  check_length("section beyond, its width,", beyond_width, true);
  check_length("section beyond, its height,", beyond_height, true);
  if (!(flow_rate > FlowRate{}) || !std::isfinite(flow_rate.si())) {
    throw InputError(kWhere, fmt::format("the flow rate is {:g} m3/s", flow_rate.si()),
                     "Give a positive flow rate");
  }
  if (port > passage.length) {
    throw InputError(kWhere,
                     fmt::format("its port, {:g} mm, is longer than the passage, {:g} mm",
                                 port.in(mm), passage.length.in(mm)),
                     "The port opens into the passage: count its length to that of the passage");
  }
  const bool beyond = beyond_width > Length{} || beyond_height > Length{};
  if (beyond && port > Length{}) {
    throw InputError(kWhere, "it has both a port and a wider section at its far end",
                     "Keep what the flow meets first");
  }
  if (beyond && (beyond_width < passage.width || beyond_height < passage.height)) {
    throw InputError(kWhere,
                     fmt::format("the section beyond it, {:g} by {:g} mm, does not hold its own, "
                                 "{:g} by {:g} mm",
                                 beyond_width.in(mm), beyond_height.in(mm), passage.width.in(mm),
                                 passage.height.in(mm)),
                     "Give a section at least as wide and as high");
  }
}

PassageGeometry::PassageGeometry(const SimulatedPassage& given, int dim) {
  given.validate();
  const Length unit = given.channel.height;
  const double length = given.passage.length / unit, height = given.passage.height / unit;
  const double half = 0.5 * (given.passage.width / unit);
  const double channel_half = 0.5 * (given.channel.width / unit);
  boxes.push_back({-channel_piece(given, dim), 0.0, 0.0, 1.0, -channel_half, channel_half});
  boxes.push_back({0.0, length, 0.0, height, -half, half});
  if (given.port > Length{}) {
    constexpr double kLong = 3.0;  // of the port
    const double port = given.port / unit, start = length - port;
    if (given.port_side == PortSide::top) {
      const double top = std::max(height, 1.0) + given.stretch * kLong * port;
      boxes.push_back({start, length, height, top, -half, half});
      far = {(top - height) * unit, given.port, given.passage.width};
      far_axis = 1;
    } else {
      if (dim == 2) {
        throw InputError(kWhere, "between plates there is no side for a port",
                         "Solve in three dimensions, or put the port on top");
      }
      const double outer =
          std::max(half, channel_half) + given.stretch * kLong * std::max(port, height);
      boxes.push_back({start, length, 0.0, height, half, outer});
      far = {(outer - half) * unit, given.port, given.passage.height};
      far_axis = 2;
      whole_width = true;
    }
  } else if (given.beyond_height > Length{}) {
    const double up = given.beyond_height / unit, across = 0.5 * (given.beyond_width / unit);
    // What the cells of three dimensions afford.
    const double most = dim == 2 ? 100.0 : 20.0, needed = jet_length(given);
    missing = std::max(0.0, 1.0 - most / needed);
    const double end = length + given.stretch * std::min(needed, most) * up;
    boxes.push_back({length, end, 0.0, up, -across, across});
    far = {(end - length) * unit, given.beyond_width, given.beyond_height};
  } else {
    far = {Length{}, given.passage.width, given.passage.height};
  }
}

bool PassageGeometry::contains(double s, double y, double z) const {
  return std::any_of(boxes.begin(), boxes.end(), [&](const FluidBox& box) {
    return s > box.s_low && s < box.s_high && y > box.y_low && y < box.y_high && z > box.z_low &&
           z < box.z_high;
  });
}

}  // namespace manoscope::navier_stokes
