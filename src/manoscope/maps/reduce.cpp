#include "manoscope/maps/reduce.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/combine_shifts.hpp"
#include "manoscope/maps/cut_sections.hpp"
#include "manoscope/maps/deflection_picture.hpp"
#include "manoscope/maps/despike.hpp"
#include "manoscope/maps/level.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::maps {
namespace {

double share(const Flags2& flags, FlagBits bit) {
  return static_cast<double>(count_set(flags, bit)) / static_cast<double>(flags.size());
}

/// dzeta/dx by a line through the good stations within `reach` to either side; 0 where too few.
Array1 slope_along(const Profile& profile, Index reach) {
  const Index n = profile.x.size();
  Array1 slope = Array1::Zero(n);
  for (Index i = 0; i < n; ++i) {
    double count = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (Index j = std::max<Index>(0, i - reach); j <= std::min(n - 1, i + reach); ++j) {
      if (profile.flags[j] != 0) continue;
      const double dx = profile.x[j] - profile.x[i], y = profile.zeta[j];
      count += 1.0;
      sx += dx;
      sy += y;
      sxx += dx * dx;
      sxy += dx * y;
    }
    const double determinant = count * sxx - sx * sx;
    if (count >= 2.0 && determinant > 0.0) slope[i] = (count * sxy - sx * sy) / determinant;
  }
  return slope;
}

/// Height at mid-channel on the centre line: c0 of c0 + c1 x + c2 z + c3 z^2 fitted to a patch
/// about it, a fifth of the width across and 5 % of it along the flow, five by two pixels at least.
void measure_crest(const LeveledMap& map, const ChannelFrame& frame, ReducedMap& result) {
  const ChannelGrid& grid = map.deflection.grid();
  const double reach_x = std::max(0.025 * frame.width.si(), 1.01 * grid.pitch_x.si());
  const double reach_z = std::max(0.1 * frame.width.si(), 2.51 * grid.pitch_z.si());
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (Index iz = 0; iz < grid.nz; ++iz) {
    const double b = grid.z(iz) / reach_z;
    if (std::abs(b) > 1.0) continue;
    for (Index ix = 0; ix < grid.nx; ++ix) {
      const double a = (grid.x(ix) - 0.5 * frame.length.si()) / reach_x;
      if (std::abs(a) > 1.0 || map.deflection.flags()(iz, ix) != 0) continue;
      const Eigen::Vector4d row(1.0, a, b, b * b);
      normal += row * row.transpose();
      right += map.deflection.zeta()(iz, ix) * row;
    }
  }
  result.crest = result.crest_uncertainty = std::numeric_limits<double>::quiet_NaN();
  const auto factors = normal.ldlt();
  constexpr double kLeastPivot = 1e-3;  // below it the patch holds too few pixels for the fit
  if (!(factors.vectorD().minCoeff() > kLeastPivot * normal(0, 0))) return;
  result.crest = factors.solve(right)[0];
  const double gain = factors.solve(Eigen::Vector4d::Unit(0))[0];  // variance for unit noise
  const double shared = map.deflection.noise_length_x() * map.deflection.noise_length_z();
  const double pixel = map.deflection.noise().si();
  result.crest_uncertainty =
      std::sqrt(pixel * pixel * std::min(1.0, shared * gain) + map.plane.covariance(0, 0));
}

using Shifts = std::vector<std::optional<OneShift>>;

/// Offset across and slope of every map's centre line against the common one, by the sides of its
/// wall and by the frame's texture.
std::pair<Shifts, Shifts> lines_with_texture(const std::vector<ReducedMap>& reduced,
                                             const CentreLine& common) {
  Shifts offset, slope, texture_offset, texture_slope;
  for (const ReducedMap& map : reduced) {
    const auto& line = map.condition.centre;
    const auto& texture = map.condition.texture;
    const auto where = [](bool known, double value, double uncertainty) {
      return known ? std::optional(OneShift{value, uncertainty}) : std::nullopt;
    };
    const CentreLine own = line.value_or(CentreLine{});
    offset.push_back(
        where(line.has_value(), (own.offset - common.offset).si(), own.offset_uncertainty.si()));
    slope.push_back(where(line.has_value(), own.slope - common.slope, own.slope_uncertainty));
    const TextureShift moved = texture.value_or(TextureShift{});
    texture_offset.push_back(where(texture.has_value(), moved.z.si(), moved.z_uncertainty.si()));
    const bool turns = texture && moved.angle_uncertainty > 0.0;
    texture_slope.push_back(where(turns, moved.angle, moved.angle_uncertainty));
  }
  return {combine_shifts(offset, texture_offset).shifts,
          combine_shifts(slope, texture_slope).shifts};
}

/// Takes the frame's texture into the shifts along the flow.
/// @return whether it agrees with the wall's ends.
bool heed_texture(Registration& found, const std::vector<ReducedMap>& hydrostatic,
                  const std::vector<ReducedMap>& flow) {
  Shifts ends, texture;
  const auto add = [&](const std::vector<ReducedMap>& maps,
                       const std::vector<std::optional<MapShift>>& shifts) {
    for (std::size_t i = 0; i < maps.size(); ++i) {
      ends.emplace_back();
      if (shifts[i]) ends.back() = OneShift{shifts[i]->shift.si(), shifts[i]->uncertainty.si()};
      texture.emplace_back();
      const auto& moved = maps[i].condition.texture;
      if (moved) texture.back() = OneShift{moved->x.si(), moved->x_uncertainty.si()};
    }
  };
  add(hydrostatic, found.hydrostatic);
  add(flow, found.flow);
  const CombinedShifts combined = combine_shifts(ends, texture);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (!texture[i] || !combined.shifts[i]) continue;  // as the ends say, to the last bit
    auto& shift =
        i < hydrostatic.size() ? found.hydrostatic[i] : found.flow[i - hydrostatic.size()];
    shift = MapShift{Length::from_si(combined.shifts[i]->value),
                     Length::from_si(combined.shifts[i]->uncertainty)};
  }
  return combined.agree;
}

}  // namespace

Length auto_rim_margin(const ChannelGrid& grid, const ChannelFrame& frame) {
  const double half = 0.5 * frame.width.si();
  const double widest = std::max({-grid.x(0), grid.x(grid.nx - 1) - frame.length.si(),
                                  -grid.z(0) - half, grid.z(grid.nz - 1) - half});
  const Length wanted = std::max(3.0 * std::max(grid.pitch_x, grid.pitch_z), 0.02 * frame.width);
  return std::min(wanted, Length::from_si(0.5 * std::max(0.0, widest)));
}

void ReduceOptions::validate() const {
  if (!(spike_threshold >= 3.0)) {
    throw InputError("--spike-threshold", fmt::format("is {}", spike_threshold),
                     "Give at least 3, or ordinary noise would be flagged");
  }
  if (rim_margin && *rim_margin < Length{}) {
    throw InputError("--rim-margin", "is negative", "Give a length of 0 or more");
  }
  if (shift_uncertainty && *shift_uncertainty < Length{}) {
    throw InputError("--shift-uncertainty", "is negative", "Give a length of 0 or more");
  }
  if (level_order != 1 && level_order != 2) {
    throw InputError("--level-order", fmt::format("is {}", level_order), "Give 1 or 2");
  }
  width.validate();
}

LeveledMap level_map(const HeightMap& map, const ChannelFrame& frame, const MapKnowledge& known,
                     const std::string& name, const ReduceOptions& options) {
  options.validate();
  ChannelMap work = to_channel_frame(map, frame);
  const Length margin = options.rim_margin.value_or(auto_rim_margin(work.grid, frame));
  const Flags2 rim = rim_mask(work.grid, frame.length, frame.width, margin, known.placement);

  RimPlane plane = fit_rim_plane(work, rim, name);
  subtract_plane(work, plane);
  MapCondition condition;
  condition.name = name;
  condition.tilt_x = plane.tilt_x;
  condition.tilt_z = plane.tilt_z;
  condition.missing = share(map.flags(), PixelFlag::no_data);
  condition.noise = measure_noise(work, rim);
  condition.bend = fit_rim_bend(work, rim, condition.noise.sigma, frame.length);
  PixelNoise beyond_bend = condition.noise;
  const double bend_height = condition.bend.coefficient.tail(3).cwiseAbs().maxCoeff();
  const double bend_doubt = std::sqrt(condition.bend.covariance.diagonal().tail(3).maxCoeff());
  constexpr double kSigmas = 4.0;
  if (options.level_order == 2) {
    subtract_bend(work, condition.bend);
    beyond_bend = condition.noise = measure_noise(work, rim);
  } else if (bend_height > kSigmas * bend_doubt) {
    // Seen from the plane a bend looks like noise of long reach.
    ChannelMap flat = work;
    subtract_bend(flat, condition.bend);
    beyond_bend = measure_noise(flat, rim);
  }
  condition.placement = known.placement;
  const Length noise = known.height_noise.value_or(condition.noise.sigma);
  // A noise-free map still has round-off; a picometre keeps the threshold above it.
  const Length spike_noise = std::max({noise, condition.noise.sigma, 1e-3 * nm});
  const Index spikes = flag_spikes(work, spike_noise, options.spike_threshold);
  condition.spikes = static_cast<double>(spikes) / static_cast<double>(work.flags.size());
  if (options.fringe_order) {
    condition.fringe = mend_fringe_patches(work, spike_noise, known.wavelength);
  }

  const double shared = condition.noise.length_x * condition.noise.length_z;
  const double scale = plane.sigma > Length{} ? noise / plane.sigma : 0.0;
  plane.covariance *= shared * scale * scale;
  const double shared_beyond = beyond_bend.length_x * beyond_bend.length_z;
  const double bend_scale =
      condition.bend.sigma > Length{} ? beyond_bend.sigma / condition.bend.sigma : 0.0;
  condition.bend.covariance *= shared_beyond * bend_scale * bend_scale;
  condition.bend.at_middle_uncertainty =
      std::sqrt(shared_beyond) * bend_scale * condition.bend.at_middle_uncertainty;
  DeflectionMap deflection(work.grid, std::move(work.height), std::move(work.flags), noise,
                           condition.noise.length_x, condition.noise.length_z);
  return {std::move(deflection), plane, std::move(condition)};
}

ReducedMap reduce_map(const HeightMap& map, const ChannelFrame& frame, const MapKnowledge& known,
                      const std::string& name, const ReduceOptions& options) {
  const LeveledMap leveled = level_map(map, frame, known, name, options);
  ReducedMap result;
  const RimBend* bend = options.level_order == 2 ? &leveled.condition.bend : nullptr;
  result.profile = width_average(leveled.deflection, leveled.plane, frame.length, frame.width, name,
                                 options.width, known.placement, bend);
  result.condition = leveled.condition;
  result.condition.centre = find_centre_line(leveled.deflection, frame.length, frame.width);
  result.sections =
      cut_sections(leveled.deflection, frame.length, frame.width, leveled.condition.noise.sigma,
                   result.condition.centre.value_or(known.placement));
  if (known.texture != nullptr) {
    result.condition.texture = find_texture_shift(*known.texture, leveled.deflection);
  }
  const Length shift = options.shift_uncertainty.value_or(leveled.deflection.grid().pitch_x *
                                                          (1.0 / std::sqrt(12.0)));
  result.condition.shift.uncertainty = shift;
  constexpr Index kReach = 4;  // columns to either side: noise of the slope well below its size
  result.profile.uncertainty.modes.push_back({fmt::format("shift of {}", name), "registration",
                                              slope_along(result.profile, kReach) * shift.si()});
  measure_crest(leveled, frame, result);
  if (known.picture_cells > 0) {
    result.picture = picture_deflection(leveled.deflection, known.picture_cells);
  }
  return result;
}

FrameTexture texture_of_reference(const HeightMap& map, const ChannelFrame& frame,
                                  const MapKnowledge& known, const std::string& name,
                                  const ReduceOptions& options) {
  const LeveledMap leveled = level_map(map, frame, known, name, options);
  const ChannelGrid& grid = leveled.deflection.grid();
  return {leveled.deflection, frame.length, frame.width,
          options.rim_margin.value_or(auto_rim_margin(grid, frame))};
}

void place_reference(std::vector<ReducedMap>& reduced) {
  std::vector<double> x, z, angle;
  for (const ReducedMap& map : reduced) {
    const auto& texture = map.condition.texture;
    if (!texture) continue;
    x.push_back(texture->x_uncertainty.si());
    z.push_back(texture->z_uncertainty.si());
    angle.push_back(texture->angle_uncertainty);
  }
  if (x.empty()) return;
  TextureShift own;
  own.x_uncertainty = Length::from_si(numerics::median(x) / std::sqrt(2.0));
  own.z_uncertainty = Length::from_si(numerics::median(z) / std::sqrt(2.0));
  own.angle_uncertainty = numerics::median(angle) / std::sqrt(2.0);
  reduced.front().condition.texture = own;
}

Placements find_placements(const std::vector<ReducedMap>& reduced, std::size_t n_hydrostatic,
                           Length length, Length pitch_z) {
  constexpr double kPixels = 0.3, kSigmas = 4.0;
  Placements placements;
  placements.own.resize(reduced.size());
  std::vector<double> offsets, slopes, offset_doubts, slope_doubts;
  for (std::size_t i = 0; i < n_hydrostatic; ++i) {
    const auto& line = reduced[i].condition.centre;
    if (!line) continue;
    offsets.push_back(line->offset.si());
    slopes.push_back(line->slope);
    offset_doubts.push_back(line->offset_uncertainty.si());
    slope_doubts.push_back(line->slope_uncertainty);
  }
  if (offsets.empty()) return placements;
  const CentreLine common{Length::from_si(numerics::median(offsets)), numerics::median(slopes),
                          Length::from_si(numerics::median(offset_doubts)),
                          numerics::median(slope_doubts)};
  placements.common = common;
  const auto [across, turned] = lines_with_texture(reduced, common);
  for (std::size_t i = 0; i < reduced.size(); ++i) {
    if (!across[i]) continue;
    const OneShift slope = turned[i].value_or(OneShift{});
    const CentreLine line{Length::from_si(across[i]->value), slope.value,
                          Length::from_si(across[i]->uncertainty), slope.uncertainty};
    const double doubt = line.offset_uncertainty.si() + 0.5 * length.si() * line.slope_uncertainty;
    if (line.farthest(length.si()) > std::max(kPixels * pitch_z.si(), kSigmas * doubt)) {
      placements.own[i] = line;
    }
  }
  return placements;
}

namespace {

/// The error of place that all maps share, like the map's own but for its size.
void add_common_place(ReducedMap& map, Length uncertainty) {
  const Length own = map.condition.shift.uncertainty;
  if (uncertainty == Length{} || !(own > Length{})) return;
  for (const ErrorMode& mode : map.profile.uncertainty.modes) {
    if (mode.variable != fmt::format("shift of {}", map.condition.name)) continue;
    map.profile.uncertainty.modes.push_back(
        {"place of the frame", "registration", (uncertainty / own) * mode.effect});
    return;
  }
}

}  // namespace

std::optional<MapShift> register_maps(std::vector<ReducedMap>& hydrostatic,
                                      std::vector<ReducedMap>& flow, Length length, Length width,
                                      const ReduceOptions& options, Length largest_offset) {
  if (!options.registration || options.shift_uncertainty) return std::nullopt;
  const auto profiles = [](const std::vector<ReducedMap>& maps) {
    std::vector<const Profile*> found;
    for (const ReducedMap& map : maps) found.push_back(&map.profile);
    return found;
  };
  Registration found = register_profiles(profiles(hydrostatic), profiles(flow), length, width);
  const bool agree = heed_texture(found, hydrostatic, flow);
  for (auto* maps : {&hydrostatic, &flow}) {
    for (ReducedMap& map : *maps) map.condition.texture_contradicts = !agree;
  }
  MapShift common{};
  if (found.offset && !hydrostatic.empty() &&
      std::abs(found.offset->shift.si()) <= largest_offset.si() &&
      found.offset->uncertainty < hydrostatic.front().condition.shift.uncertainty) {
    constexpr double kAsymmetry = 2e-4;  // of the width
    common.uncertainty = std::max(found.offset->uncertainty, kAsymmetry * width);
    std::swap(common.shift, found.offset->shift);
  }
  const auto move = [common](ReducedMap& map, const std::optional<MapShift>& shift) {
    const Length assumed = map.condition.shift.uncertainty;
    const bool is_found = shift && shift->uncertainty < assumed;
    add_common_place(map, common.uncertainty);
    if (!is_found && common.shift == Length{}) return;
    // A map whose own shift is not known lies where the others do, as well as was supposed.
    MapShift whole = is_found ? *shift : MapShift{Length{}, assumed};
    whole.shift += common.shift;
    move_profile(map.profile, whole, map.condition.name, assumed);
    map.condition.shift = whole;
  };
  for (std::size_t i = 0; i < hydrostatic.size(); ++i) move(hydrostatic[i], found.hydrostatic[i]);
  for (std::size_t i = 0; i < flow.size(); ++i) move(flow[i], found.flow[i]);
  return found.offset;
}

HeightMap subtract_reference(const HeightMap& map, const HeightMap& reference,
                             const std::string& name) {
  if (!(map.grid() == reference.grid())) {
    throw InputError(
        name,
        fmt::format("has {} x {} pixels of {:.4g} x {:.4g} um, the reference map "
                    "{} x {} of {:.4g} x {:.4g} um",
                    map.grid().nx, map.grid().ny, map.grid().pitch_x.in(um),
                    map.grid().pitch_y.in(um), reference.grid().nx, reference.grid().ny,
                    reference.grid().pitch_x.in(um), reference.grid().pitch_y.in(um)),
        "Give a reference map taken with the same camera settings");
  }
  Flags2 flags = map.flags();
  for (Index i = 0; i < flags.size(); ++i) flags.data()[i] |= reference.flags().data()[i];
  return {map.grid(), map.height() - reference.height(), std::move(flags)};
}

}  // namespace manoscope::maps
