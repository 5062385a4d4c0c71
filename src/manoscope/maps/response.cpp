#include "manoscope/maps/response.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/numerics/plane.hpp"

namespace manoscope::maps {
namespace {

Array1 smoothed(const Array1& profile) {
  constexpr Index kReach = 2;
  Array1 result(profile.size());
  for (Index i = 0; i < profile.size(); ++i) {
    const Index first = std::max<Index>(0, i - kReach);
    const Index last = std::min(profile.size() - 1, i + kReach);
    result[i] = profile.segment(first, last - first + 1).mean();
  }
  return result;
}

/// Position at which the profile first reaches `level`, walking from `from` by `step`.
double crossing(const Array1& profile, double level, Index from, Index step) {
  for (Index i = from; i + step >= 0 && i + step < profile.size(); i += step) {
    const double here = profile[i], next = profile[i + step];
    if (here < level && next >= level) {
      return static_cast<double>(i) + static_cast<double>(step) * (level - here) / (next - here);
    }
  }
  return static_cast<double>(from);  // it starts above the level: cut by the map's border
}

/// Takes out lone spikes: each good pixel becomes the median of itself and its good neighbours in
/// the row, of two the one nearer zero. Slopes and edges stay where they are.
void remove_lone_spikes(Response& response) {
  const Array2 height = response.height;
  for (Index iy = 0; iy < height.rows(); ++iy) {
    for (Index ix = 0; ix < height.cols(); ++ix) {
      if (response.good(iy, ix) == 0) continue;
      const double here = height(iy, ix);
      const bool left = ix > 0 && response.good(iy, ix - 1) != 0;
      const bool right = ix + 1 < height.cols() && response.good(iy, ix + 1) != 0;
      double& value = response.height(iy, ix);
      if (left && right) {
        const double a = height(iy, ix - 1), b = height(iy, ix + 1);
        value = std::clamp(here, std::min(a, b), std::max(a, b));
      } else if (left || right) {
        const double other = height(iy, left ? ix - 1 : ix + 1);
        value = std::abs(other) < std::abs(here) ? other : here;
      }
    }
  }
}

}  // namespace

Response wall_response(const HeightMap& before, const HeightMap& after, const std::string& name) {
  if (!(before.grid() == after.grid())) {
    throw InputError(name, "differs in size or pixel pitch from the other maps",
                     "Take all maps of one experiment with the same camera settings");
  }
  Response response;
  response.grid = after.grid();
  const CameraGrid& grid = response.grid;
  response.height = after.height() - before.height();
  response.good = Flags2::Zero(grid.ny, grid.nx);
  const Index border_x = std::max<Index>(3, grid.nx / 25),
              border_y = std::max<Index>(3, grid.ny / 25);
  std::vector<numerics::PlanePoint> points;
  const auto a_of = [&](Index ix) {
    return 2.0 * static_cast<double>(ix) / static_cast<double>(grid.nx) - 1.0;
  };
  const auto b_of = [&](Index iy) {
    return 2.0 * static_cast<double>(iy) / static_cast<double>(grid.ny) - 1.0;
  };
  for (Index iy = 0; iy < grid.ny; ++iy) {
    for (Index ix = 0; ix < grid.nx; ++ix) {
      if ((before.flags()(iy, ix) | after.flags()(iy, ix)) != 0) {
        response.height(iy, ix) = 0.0;
        continue;
      }
      response.good(iy, ix) = 1;
      if (ix < border_x || iy < border_y || ix >= grid.nx - border_x || iy >= grid.ny - border_y) {
        points.push_back({a_of(ix), b_of(iy), response.height(iy, ix)});
      }
    }
  }
  const auto plane = points.size() >= 10 ? numerics::fit_plane(points) : std::nullopt;
  if (!plane) {
    throw InputError(name, "the border of the map has too few good pixels for a plane",
                     "Give channel.origin, flow and outward in the experiment file");
  }
  response.sigma = plane->sigma;
  for (Index iy = 0; iy < grid.ny; ++iy) {
    for (Index ix = 0; ix < grid.nx; ++ix) {
      if (response.good(iy, ix) == 0) continue;
      response.height(iy, ix) -= plane->coefficient[0] + plane->coefficient[1] * a_of(ix) +
                                 plane->coefficient[2] * b_of(iy);
    }
  }
  remove_lone_spikes(response);
  std::vector<double> sizes;
  for (Index i = 0; i < response.height.size(); ++i) {
    if (response.good.data()[i] != 0) sizes.push_back(std::abs(response.height.data()[i]));
  }
  const auto rank =
      sizes.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), rank, sizes.end());
  response.top = *rank;
  return response;
}

Extent extent_of(const Array1& profile) {
  Extent extent;
  if (profile.size() < 5) return extent;
  const Array1 smooth = smoothed(profile);
  Index peak = 0;
  const double top = smooth.maxCoeff(&peak);
  if (top <= 0.0) return extent;
  const double low_first = crossing(smooth, 0.1 * top, 0, 1);
  const double high_first = crossing(smooth, 0.3 * top, 0, 1);
  const double low_last = crossing(smooth, 0.1 * top, smooth.size() - 1, -1);
  const double high_last = crossing(smooth, 0.3 * top, smooth.size() - 1, -1);
  extent.first = low_first - 0.5 * (high_first - low_first);
  extent.last = low_last + 0.5 * (low_last - high_last);
  extent.found = extent.last > extent.first;
  return extent;
}

}  // namespace manoscope::maps
