#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "manoscope/core/frame.hpp"
#include "manoscope/core/grid.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/maps/level.hpp"
#include "manoscope/maps/width_average.hpp"
#include "manoscope/numerics/lanes.hpp"

namespace manoscope::maps {

struct LinearReductionOptions {
  std::optional<Length> rim_margin;  ///< auto: auto_rim_margin()
  WidthAverageOptions width;
};

/// Width average of a map leveled by the plane of its rim.
struct LinearReduction {
  Profile profile;
  /// Least squares over the good pixels of the rim; `sigma` is the standard deviation about it.
  RimPlane plane;
  double missing = 0.0;  ///< share of the pixels that were looked at and hold no height
};

/// What the maps of one camera share: the weight of every pixel.
class LinearReducer {
 public:
  /// @throws InputError(name, ...) for a frame that is rotated or whose flow runs along the rows of
  ///         pixels (see reduces()), options out of range, and a channel whose edges the map does
  ///         not show.
  LinearReducer(const CameraGrid& grid, const ChannelFrame& frame, const std::string& name,
                const LinearReductionOptions& options = {});
  ~LinearReducer();
  LinearReducer(LinearReducer&&) noexcept;
  LinearReducer& operator=(LinearReducer&&) noexcept;

  /// Whether the flow runs along the rows of the map's pixels as they lie in the file.
  static bool reduces(const ChannelFrame& frame);
  const CameraGrid& grid() const;

  struct Geometry;
  const Geometry& geometry() const { return *geometry_; }

 private:
  std::unique_ptr<const Geometry> geometry_;
};

/// zeta(x) of one map in one pass over its 32-bit floats, while they are still in the processor's
/// cache: for frames by the thousand, and for a quick look.
///
///   zeta(x) = sum_z w(z) h(x, z) - plane,   w of width_average(), plane by least squares on the
///   rim
///
/// Both are linear in the pixels, so that one pass gives them; the sums are taken in double
/// precision. Missing pixels (NaN, infinities) are bridged, and left out of the plane, exactly as
/// width_average() does. Stations, flags, the noise, leveling and quadrature errors are those of
/// width_average().
///
/// What the full reduction does and this does not: outliers on the rim pull the plane (one of
/// height d among n pixels by d/n), no spike is removed (one of height d shifts its station by d
/// times the pitch over the width), neighbouring pixels are taken to have independent noise, and
/// there is no registration. On maps without outliers both agree within their uncertainty.
class LinearPass {
 public:
  /// @param reducer  outlives the pass.
  explicit LinearPass(const LinearReducer& reducer,
                      numerics::Instructions instructions = numerics::best_instructions());
  ~LinearPass();
  LinearPass(const LinearPass&) = delete;
  LinearPass& operator=(const LinearPass&) = delete;

  /// Takes in the next rows, from the top: whole rows of 32-bit floats in this machine's byte
  /// order, any number of them. The result does not depend on how the rows are handed over.
  /// @throws InternalError if it is no whole number of rows, or more than the map has.
  void add_rows(std::span<const char> rows);

  /// The result, once every row has come; the pass is then ready for the next map.
  /// @param metres_per_unit  of the floats.
  /// @param name  of the map, for error modes and messages.
  /// @throws InputError(name, ...) if fewer than 100 good pixels lie on the rim, or all of them on
  ///         one line.
  LinearReduction finish(double metres_per_unit, const std::string& name);

 private:
  class Sums;
  std::unique_ptr<Sums> sums_;
};

}  // namespace manoscope::maps
