#include "manoscope/numerics/grid_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "manoscope/core/random.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::numerics {
namespace {

/// A frame around a channel: tilted, noisy, with holes, dust on one side and spikes.
struct Frame {
  Array1 a, b;
  Array2 v;
  Flags2 selected, flags;

  Frame(Index nx, Index nz, double sigma, double bad_share, const std::string& name)
      : a(Array1::LinSpaced(nx, -1.0, 1.0)),
        b(Array1::LinSpaced(nz, -1.0, 1.0)),
        v(nz, nx),
        selected(Flags2::Ones(nz, nx)),
        flags(Flags2::Zero(nz, nx)) {
    RandomStream stream(5, name);
    for (Index iz = 0; iz < nz; ++iz) {
      for (Index ix = 0; ix < nx; ++ix) {
        v(iz, ix) = 1.0 - 2.0 * a[ix] + 0.5 * b[iz] + sigma * stream.normal();
        if (stream.uniform() < bad_share) v(iz, ix) += 50.0 * sigma * stream.uniform();
        if (stream.uniform() < bad_share) {
          flags(iz, ix) = 1;
          v(iz, ix) = 0.0;
        }
      }
    }
    selected.block(nz / 5, nx / 10, 3 * nz / 5, 4 * nx / 5).setZero();
  }
  GridPoints points() const { return {a, b, v, selected, flags}; }
  std::vector<PlanePoint> list() const {
    std::vector<PlanePoint> points;
    for (Index iz = 0; iz < v.rows(); ++iz) {
      for (Index ix = 0; ix < v.cols(); ++ix) {
        if (selected(iz, ix) != 0 && flags(iz, ix) == 0) {
          points.push_back({a[ix], b[iz], v(iz, ix)});
        }
      }
    }
    return points;
  }
};

TEST(FitPlaneOnGrid, FindsWhatTheFitOfScatteredPointsFinds) {
  for (const double bad_share : {0.0, 0.01, 0.2}) {
    for (const Index nx : {61, 257, 1024}) {  // the first has too few points for a start of its own
      const Frame frame(nx, nx / 2, 0.02, bad_share, "same");
      const auto fit = fit_plane(frame.points());
      const auto list = frame.list();
      const auto same = fit_plane(list);
      ASSERT_TRUE(fit && same);
      EXPECT_EQ(frame.points().size(), static_cast<Index>(list.size()));
      // Both end when a step falls below 1e-6 of the plane's own uncertainty; each step is at most
      // half of the one before, with a fifth of outliers at most 0.9.
      const double own = same->sigma / std::sqrt(static_cast<double>(list.size()));
      EXPECT_LT((fit->coefficient - same->coefficient).norm(), 2e-5 * own) << nx << bad_share;
      EXPECT_NEAR(fit->sigma / same->sigma, 1.0, 1e-8);
      EXPECT_EQ(fit->inlier_fraction, same->inlier_fraction);
      EXPECT_LT((fit->covariance - same->covariance).norm(), 1e-7 * same->covariance.norm());
    }
  }
}

TEST(FitPlaneOnGrid, RecoversAnExactPlane) {
  const Frame frame(400, 100, 0.0, 0.0, "exact");
  const auto fit = fit_plane(frame.points());
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->coefficient - Eigen::Vector3d(1.0, -2.0, 0.5)).norm(), 1e-12);  // round-off
}

TEST(FitPlaneOnGrid, HasTheSameBytesWithAllInstructions) {
  const Frame frame(515, 200, 0.02, 0.05, "bytes");
  const auto baseline = fit_plane(frame.points(), Instructions::baseline);
  ASSERT_TRUE(baseline);
  for (const Instructions wider : {Instructions::avx2, Instructions::avx512}) {
    if (wider > best_instructions()) continue;
    const auto fit = fit_plane(frame.points(), wider);
    ASSERT_TRUE(fit);
    EXPECT_EQ(std::memcmp(fit->coefficient.data(), baseline->coefficient.data(), 24), 0);
    EXPECT_EQ(std::memcmp(fit->covariance.data(), baseline->covariance.data(), 72), 0);
    EXPECT_EQ(fit->sigma, baseline->sigma);
    EXPECT_EQ(fit->inlier_fraction, baseline->inlier_fraction);
  }
}

TEST(FitPlaneOnGrid, SaysWhenPointsLieOnALine) {
  Frame frame(6000, 5, 0.02, 0.0, "line");
  frame.selected.setZero();
  frame.selected.row(2).setOnes();
  EXPECT_FALSE(fit_plane(frame.points()));
}

TEST(FitPlaneOnGrid, MeetsAMedianThatTheFewPointsMiss) {
  // Every 18th sample lies far off in step with the sample of the start, so that its bracket is
  // wrong; the median of all is that of the rest.
  Frame frame(720, 100, 0.02, 0.0, "aliased");
  frame.selected.setOnes();
  const Index stride = 72000 / 4000 + 1;
  for (Index i = stride / 2; i < 72000; i += stride) frame.v.data()[i] += 3.0;
  const auto fit = fit_plane(frame.points());
  ASSERT_TRUE(fit);
  const auto same = fit_plane(frame.list());
  ASSERT_TRUE(same);
  EXPECT_NEAR(fit->sigma / same->sigma, 1.0, 1e-8);
  EXPECT_LT((fit->coefficient - same->coefficient).norm(), 1e-6 * same->sigma);
}

TEST(MadSigmaOnGrid, IsThatOfTheListedValues) {
  for (const Index nx : {3, 61, 1024}) {
    const Frame frame(nx, std::max<Index>(nx / 2, 3), 0.02, 0.05, "sigma");
    std::vector<double> values;
    for (const PlanePoint& point : frame.list()) values.push_back(point.v);
    EXPECT_EQ(mad_sigma(frame.points()), mad_sigma(values, 0.0));
  }
}

}  // namespace
}  // namespace manoscope::numerics
