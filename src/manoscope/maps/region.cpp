#include "manoscope/maps/region.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/maps/response.hpp"

namespace manoscope::maps {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Heights seen along the channel's axis: row = across, column = along, for either flow axis.
struct AxisView {
  Array2 height;  ///< outward positive
  double pitch_along, pitch_across;

  AxisView(const Response& response, bool along_columns, double sign)
      : pitch_along((along_columns ? response.grid.pitch_x : response.grid.pitch_y).si()),
        pitch_across((along_columns ? response.grid.pitch_y : response.grid.pitch_x).si()) {
    if (along_columns) {
      height = sign * response.height;
    } else {
      height = sign * response.height.transpose();
    }
  }
  /// Camera coordinate, m, of a position in pixel indices (a pixel's centre is at i + 1/2).
  double along(double index) const { return (index + 0.5) * pitch_along; }
  double across(double index) const { return (index + 0.5) * pitch_across; }
};

Outward find_outward(const Response& response) {
  const double bound = std::max(5.0 * response.sigma, 0.2 * response.top);
  double sum = 0.0;
  for (Index i = 0; i < response.height.size(); ++i) {
    const double h = response.height.data()[i];
    if (std::abs(h) > bound) sum += h;
  }
  return sum >= 0.0 ? Outward::plus_height : Outward::minus_height;
}

/// The axis along which the responding pixels spread farther.
bool longer_along_columns(const Response& response) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, syy = 0.0;
  for (Index iy = 0; iy < response.grid.ny; ++iy) {
    for (Index ix = 0; ix < response.grid.nx; ++ix) {
      if (std::abs(response.height(iy, ix)) < 0.3 * response.top) continue;
      const double x = static_cast<double>(ix) * response.grid.pitch_x.si();
      const double y = static_cast<double>(iy) * response.grid.pitch_y.si();
      n += 1.0;
      sx += x;
      sy += y;
      sxx += x * x;
      syy += y * y;
    }
  }
  return sxx - sx * sx / n >= syy - sy * sy / n;
}

struct Rectangle {
  Extent along, across;  ///< pixel indices
  double slope = 0.0;    ///< drift of the middle line, metres across per metre along
};

/// Mean profile across, over the columns [first, last].
Array1 across_profile(const AxisView& view, double first, double last) {
  const auto begin = static_cast<Index>(std::max(0.0, std::floor(first)));
  const auto end = std::min(view.height.cols(), static_cast<Index>(std::ceil(last)) + 1);
  return view.height.middleCols(begin, end - begin).rowwise().mean();
}

Rectangle find_rectangle(const AxisView& view, const std::string& name) {
  Rectangle found;
  found.across = extent_of(view.height.rowwise().mean());
  const auto fail = [&] {
    throw InputError(name, "the pixels that answer to pressure form no rectangle",
                     "Give channel.origin, flow and outward in the experiment file");
  };
  if (!found.across.found) fail();
  const double quarter = 0.25 * (found.across.last - found.across.first);
  const auto top = static_cast<Index>(std::max(0.0, found.across.first + quarter));
  const auto bottom =
      std::min(view.height.rows() - 1, static_cast<Index>(found.across.last - quarter));
  if (bottom < top) fail();
  const Array1 along = view.height.middleRows(top, bottom - top + 1).colwise().mean();
  found.along = extent_of(along);
  if (!found.along.found) fail();
  const double length = found.along.last - found.along.first;
  found.across = extent_of(
      across_profile(view, found.along.first + 0.2 * length, found.along.last - 0.2 * length));

  // The middle line, block by block, and the line through it.
  constexpr int kBlocks = 12;
  double n = 0.0, sx = 0.0, sz = 0.0, sxx = 0.0, sxz = 0.0;
  for (int block = 0; block < kBlocks; ++block) {
    const double first = found.along.first + length * (0.1 + 0.8 * block / kBlocks);
    const Extent sides = extent_of(across_profile(view, first, first + 0.8 * length / kBlocks));
    if (!sides.found) continue;
    const double x = (first + 0.4 * length / kBlocks) * view.pitch_along;
    const double z = 0.5 * (sides.first + sides.last) * view.pitch_across;
    n += 1.0;
    sx += x;
    sz += z;
    sxx += x * x;
    sxz += x * z;
  }
  const double determinant = n * sxx - sx * sx;
  if (n >= 3.0 && determinant > 0.0) found.slope = (n * sxz - sx * sz) / determinant;
  return found;
}

/// Share of the static response that a flow shows in the first third of the channel, minus that in
/// the last, along growing camera coordinates: positive where the inlet is at the low end.
double inlet_preference(const AxisView& still, const AxisView& flowing, const Extent& along) {
  const double third = (along.last - along.first) / 3.0;
  const auto share = [&](double first) {
    const auto begin = static_cast<Index>(std::max(0.0, first));
    const Index count = std::min(static_cast<Index>(third), still.height.cols() - begin);
    return flowing.height.middleCols(begin, count).sum() /
           still.height.middleCols(begin, count).sum();
  };
  return share(along.first) - share(along.last - third);
}

bool inside(const CameraGrid& grid, const ChannelFrame& frame) {
  const double slack_x = 2.0 * grid.pitch_x.si(), slack_y = 2.0 * grid.pitch_y.si();
  const double half = 0.5 * frame.width.si();
  for (const double x : {0.0, frame.length.si()}) {
    for (const double z : {-half, half}) {
      const auto [column, row] = frame.camera_from_channel(x, z);
      if (column < -slack_x || row < -slack_y || column > grid.size_x().si() + slack_x ||
          row > grid.size_y().si() + slack_y) {
        return false;
      }
    }
  }
  return true;
}

/// Sum of the response at points spread over the channel's rectangle.
double summed_response(const Response& response, const ChannelFrame& frame) {
  constexpr int kAlong = 60, kAcross = 20;
  double sum = 0.0;
  for (int i = 0; i < kAlong; ++i) {
    for (int k = 0; k < kAcross; ++k) {
      const auto [column, row] = frame.camera_from_channel(
          frame.length.si() * (i + 0.5) / kAlong, frame.width.si() * ((k + 0.5) / kAcross - 0.5));
      const auto ix = static_cast<Index>(column / response.grid.pitch_x.si());
      const auto iy = static_cast<Index>(row / response.grid.pitch_y.si());
      if (ix < 0 || iy < 0 || ix >= response.grid.nx || iy >= response.grid.ny) continue;
      sum += std::abs(response.height(iy, ix));
    }
  }
  return sum;
}

FlowDirection reversed(FlowDirection flow) {
  switch (flow) {
    case FlowDirection::plus_columns:
      return FlowDirection::minus_columns;
    case FlowDirection::minus_columns:
      return FlowDirection::plus_columns;
    case FlowDirection::plus_rows:
      return FlowDirection::minus_rows;
    default:
      return FlowDirection::plus_rows;
  }
}

[[noreturn]] void refuse(const ChannelFrame& frame, const CameraGrid& grid, bool origin_given,
                         const std::string& name) {
  const std::string size =
      fmt::format("a channel of {:.4g} x {:.4g} mm", frame.length.in(mm), frame.width.in(mm));
  const std::string map =
      fmt::format("the map of {:.4g} x {:.4g} mm", grid.size_x().in(mm), grid.size_y().in(mm));
  const std::string origin =
      fmt::format("({:.4g} mm, {:.4g} mm)", frame.origin_x.in(mm), frame.origin_y.in(mm));
  if (origin_given) {
    throw InputError(
        name, fmt::format("{} from channel.origin = {} reaches beyond {}", size, origin, map),
        "Check channel.origin, flow, length and width, or leave origin out to have it found");
  }
  throw InputError(
      name,
      fmt::format("{} in the middle of the pixels that answer to pressure, from {}, reaches beyond "
                  "{}",
                  size, origin, map),
      "Check channel.length and width; the map must show the whole channel and some of its rim");
}

/// Which way the channel extends from its origin: across, and, with `flow_open`, along.
void settle_sides(ChannelFrame& frame, bool flow_open, bool origin_given, const Response& response,
                  const std::string& name) {
  std::optional<ChannelFrame> best;
  double most = 0.0;
  for (const bool turned : {false, true}) {
    if (turned && !flow_open) continue;
    for (const bool across_reversed : {false, true}) {
      ChannelFrame candidate = frame;
      if (turned) candidate.flow = reversed(frame.flow);
      candidate.across_reversed = across_reversed;
      if (!inside(response.grid, candidate)) continue;
      const double answer = summed_response(response, candidate);
      if (best && answer <= most) continue;
      best = candidate;
      most = answer;
    }
  }
  if (!best) refuse(frame, response.grid, origin_given, name);
  frame = *best;
}

void place_on(const Rectangle& rectangle, const AxisView& view, ChannelFrame& frame) {
  const double along = 0.5 * (view.along(rectangle.along.first) + view.along(rectangle.along.last));
  const double across =
      0.5 * (view.across(rectangle.across.first) + view.across(rectangle.across.last));
  const double centre_x = frame.along_columns() ? along : across;
  const double centre_y = frame.along_columns() ? across : along;
  frame.origin_x = frame.origin_y = Length{};
  const auto [dx, dy] = frame.camera_from_channel(0.5 * frame.length.si(), 0.0);
  frame.origin_x = Length::from_si(centre_x - dx);
  frame.origin_y = Length::from_si(centre_y - dy);
}

/// Compares a given place with the wall that answers to pressure, to about a pixel.
void compare_place(const Response& response, FoundPlace& found, const std::string& name) {
  const ChannelFrame& frame = found.frame;
  constexpr double kClear = 5.0;
  if (!(response.top > kClear * response.sigma)) return;
  const double sign = find_outward(response) == Outward::plus_height ? 1.0 : -1.0;
  const AxisView view(response, frame.along_columns(), sign);
  Rectangle rectangle;
  try {
    rectangle = find_rectangle(view, name);
  } catch (const InputError&) {
    return;  // what moves is no rectangle: nothing to compare with
  }
  const double along = 0.5 * (view.along(rectangle.along.first) + view.along(rectangle.along.last));
  const double across =
      0.5 * (view.across(rectangle.across.first) + view.across(rectangle.across.last));
  const double column = frame.along_columns() ? along : across;
  const double row = frame.along_columns() ? across : along;
  const auto [middle_column, middle_row] = frame.camera_from_channel(0.5 * frame.length.si(), 0.0);
  // Turned back into the frame's axes.
  const double c = std::cos(frame.rotation.si()), s = std::sin(frame.rotation.si());
  const double dx = column - middle_column, dy = row - middle_row;
  const double u = c * dx + s * dy, v = -s * dx + c * dy;
  found.along_misfit = frame.flow_sign() * (frame.along_columns() ? u : v);
  found.across_misfit = frame.across_sign() * (frame.along_columns() ? v : u);
}

/// The frame of a place that is given whole, if the channel fits in the map on one side only.
std::optional<ChannelFrame> only_fit(const KnownPlace& known, const CameraGrid& grid) {
  ChannelFrame frame;
  frame.length = known.length;
  frame.width = known.width;
  frame.origin_x = (*known.origin)[0];
  frame.origin_y = (*known.origin)[1];
  frame.flow = *known.flow;
  frame.rotation = known.rotation.value_or(Angle{});
  frame.outward = *known.outward;
  ChannelFrame reversed_side = frame;
  reversed_side.across_reversed = true;
  const bool forward_fits = inside(grid, frame), reversed_fits = inside(grid, reversed_side);
  if (forward_fits == reversed_fits) return std::nullopt;
  return forward_fits ? frame : reversed_side;
}

}  // namespace

FoundPlace find_place(const RegionMaps& maps, const KnownPlace& known, const std::string& name) {
  MANO_ASSERT(maps.low != nullptr && maps.high != nullptr);
  FoundPlace found;
  found.length_misfit = found.width_misfit = found.along_misfit = found.across_misfit = kNan;
  ChannelFrame& frame = found.frame;
  frame.length = known.length;
  frame.width = known.width;
  if (known.complete()) {
    if (const auto given = only_fit(known, maps.low->grid())) {
      frame = *given;
      compare_place(wall_response(*maps.low, *maps.high, name), found, name);
      return found;
    }
  }
  const Response response = wall_response(*maps.low, *maps.high, name);

  if (!known.complete() && !(response.top > 5.0 * response.sigma)) {
    throw InputError(name,
                     "no pixel answers to pressure: the maps of lowest and highest pressure "
                     "differ by noise only",
                     "Check the list of pressures, or give channel.origin, flow and outward");
  }
  frame.outward = known.outward.value_or(find_outward(response));
  const bool along_columns = known.flow ? *known.flow == FlowDirection::plus_columns ||
                                              *known.flow == FlowDirection::minus_columns
                                        : longer_along_columns(response);
  const double sign = frame.outward == Outward::plus_height ? 1.0 : -1.0;
  frame.flow =
      known.flow.value_or(along_columns ? FlowDirection::plus_columns : FlowDirection::plus_rows);
  frame.rotation = known.rotation.value_or(Angle{});
  if (known.origin) {
    frame.origin_x = (*known.origin)[0];
    frame.origin_y = (*known.origin)[1];
  }
  const AxisView view(response, along_columns, sign);
  if (!known.flow || !known.origin) {
    const Rectangle rectangle = find_rectangle(view, name);
    if (!known.flow && maps.flowing != nullptr) {
      const Response moved = wall_response(*maps.low, *maps.flowing, name);
      const AxisView flowing(moved, along_columns, sign);
      if (inlet_preference(view, flowing, rectangle.along) < 0.0) {
        frame.flow = reversed(frame.flow);
      }
    }
    if (!known.origin) {
      constexpr double kLeastRotation = 1e-3;  // below it 15 mm of channel drift by under a pixel
      if (!known.rotation && std::abs(rectangle.slope) > kLeastRotation) {
        // R turns from columns towards rows: a flow along rows drifts the other way.
        frame.rotation =
            Angle::from_si(std::atan(along_columns ? rectangle.slope : -rectangle.slope));
      }
      place_on(rectangle, view, frame);
      found.length_misfit =
          view.along(rectangle.along.last) - view.along(rectangle.along.first) - known.length.si();
      found.width_misfit = view.across(rectangle.across.last) -
                           view.across(rectangle.across.first) - known.width.si();
    }
  }
  const bool flow_open = known.origin && !known.flow && maps.flowing == nullptr;
  settle_sides(frame, flow_open, known.origin.has_value(), response, name);
  if (known.origin) compare_place(response, found, name);
  return found;
}

}  // namespace manoscope::maps
