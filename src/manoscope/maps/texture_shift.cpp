#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/maps/frame_texture.hpp"
#include "manoscope/maps/texture_patch.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::maps {
namespace {

using namespace texture;

constexpr int kTurn = 3;  // pixels by which rotation moves the ends across
constexpr Index kFewestBlocks = 24, kSearchBlocks = 96;

/// Student's t of the mean of n values from their sums.
double student_t(double sum, double squares, double n) {
  const double rest = n * squares - sum * sum;
  return rest > 0.0 ? sum * std::sqrt((n - 1.0) / rest) : 0.0;
}

/// Displacement of a block, in pixels, for parameters in pixels: dx, dz, and by how much rotation
/// moves a point `radius` from the middle, along x.
struct Motion {
  double radius, pitch_x, pitch_z;

  Eigen::Matrix<double, 2, 3> at(const Block& block) const {
    Eigen::Matrix<double, 2, 3> matrix = Eigen::Matrix<double, 2, 3>::Identity();
    matrix(0, 2) = -block.z / radius;
    matrix(1, 2) = block.x / radius * pitch_x / pitch_z;
    return matrix;
  }
};

/// Integer shifts and the rotation at which the patterns of map and reference agree best.
std::optional<Eigen::Vector3d> search(const FrameTexture& texture, const DeflectionMap& map,
                                      const Motion& motion, bool turns) {
  constexpr int kReachZ = kReach + kTurn, kNx = 2 * kReach + 1, kNz = 2 * kReachZ + 1;
  constexpr int kSegments = 8;
  using Sums = Eigen::Array<double, kNz, kNx>;
  std::array<Sums, kSegments> sum, squares;
  sum.fill(Sums::Zero());
  squares.fill(Sums::Zero());
  std::array<double, kSegments> place{}, members{};
  const std::vector<Block>& blocks = texture.blocks();
  const auto n = static_cast<Index>(blocks.size()), used = std::min(n, kSearchBlocks);
  double least = blocks.front().x, most = least;
  for (const Block& block : blocks) {
    least = std::min(least, block.x);
    most = std::max(most, block.x);
  }
  for (Index i = 0; i < used; ++i) {
    const Block& block = blocks[static_cast<std::size_t>(i * n / used)];
    Patch<kSide + 2 * kReachZ, kSide + 2 * kReach> patch(map, block.iz - kReachZ, block.ix - kReach,
                                                         1.0 / texture.spread());
    patch.height -= patch.height.mean();
    patch.height = patch.height.max(-kClip).min(kClip);
    const auto segment = static_cast<std::size_t>(std::min(
        kSegments - 1.0, std::floor(kSegments * (block.x - least) / (most - least + 1e-12))));
    place[segment] += block.x;
    members[segment] += 1.0;
    for (int dz = 0; dz < kNz; ++dz) {
      for (int dx = 0; dx < kNx; ++dx) {
        Row products = Row::Zero();
        for (int r = 0; r < kSide; ++r) {
          products += block.pattern[static_cast<std::size_t>(r)] * patch.row(r + dz, dx);
        }
        const double c = products.sum();
        sum[segment](dz, dx) += c;
        squares[segment](dz, dx) += c * c;
      }
    }
  }
  double best = 0.0, best_squares = 0.0;
  Eigen::Vector3d found = Eigen::Vector3d::Zero();
  const int turn = turns ? kTurn : 0;
  for (int k = -turn; k <= turn; ++k) {
    for (int dz = -kReach; dz <= kReach; ++dz) {
      for (int dx = -kReach; dx <= kReach; ++dx) {
        double total = 0.0, total_squares = 0.0;
        for (std::size_t s = 0; s < kSegments; ++s) {
          if (members[s] == 0.0) continue;
          const double lift = k * place[s] / members[s] / motion.radius;
          const int row = dz + static_cast<int>(std::lround(lift)) + kReachZ;
          if (row < 0 || row >= kNz) continue;
          total += sum[s](row, dx + kReach);
          total_squares += squares[s](row, dx + kReach);
        }
        if (total > best) {
          best = total;
          best_squares = total_squares;
          found = Eigen::Vector3d(dx, dz, k * motion.pitch_z / motion.pitch_x);
        }
      }
    }
  }
  constexpr double kLeastT = 5.0;
  if (!(student_t(best, best_squares, static_cast<double>(used)) > kLeastT)) return std::nullopt;
  return found;
}

/// Weights of the cubic through four values about a place t in [0, 1) between the middle two, and
/// their derivatives.
std::array<float, 4> cubic(float t) {
  return {-t * (t - 1.0F) * (t - 2.0F) / 6.0F, (t + 1.0F) * (t - 1.0F) * (t - 2.0F) / 2.0F,
          -(t + 1.0F) * t * (t - 2.0F) / 2.0F, (t + 1.0F) * t * (t - 1.0F) / 6.0F};
}
std::array<float, 4> cubic_slope(float t) {
  return {((6.0F - 3.0F * t) * t - 2.0F) / 6.0F, ((3.0F * t - 4.0F) * t - 1.0F) / 2.0F,
          ((2.0F - 3.0F * t) * t + 2.0F) / 2.0F, (3.0F * t * t - 1.0F) / 6.0F};
}

/// What one block says at one displacement.
struct Verdict {
  bool counts = false;
  Eigen::Vector2d score = Eigen::Vector2d::Zero();   ///< sum w g_ref r
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();  ///< sum psi' g_ref g_map^T
  double common = 0.0;                               ///< sum w pattern h_map
  double scatter = 0.0;                              ///< mean absolute residual
};

Verdict judge_block(const Block& block, const DeflectionMap& map, const Eigen::Vector2d& shift,
                    double scale, float deviation) {
  const Eigen::Vector2d whole(std::floor(shift[0]), std::floor(shift[1]));
  const Patch<kSide + 3, kSide + 3> patch(map, block.iz + static_cast<Index>(whole[1]) - 1,
                                          block.ix + static_cast<Index>(whole[0]) - 1, scale);
  const auto u = static_cast<float>(shift[0] - whole[0]),
             v = static_cast<float>(shift[1] - whole[1]);
  const auto wx = cubic(u), wz = cubic(v), sx = cubic_slope(u), sz = cubic_slope(v);
  std::array<Row, kSide + 3> value, slope;
  for (int r = 0; r < kSide + 3; ++r) {
    const auto a = patch.row(r, 0), b = patch.row(r, 1), c = patch.row(r, 2), d = patch.row(r, 3);
    value[static_cast<std::size_t>(r)] = wx[0] * a + wx[1] * b + wx[2] * c + wx[3] * d;
    slope[static_cast<std::size_t>(r)] = sx[0] * a + sx[1] * b + sx[2] * c + sx[3] * d;
  }
  Pixels rest, good;
  for (std::size_t r = 0; r < kSide; ++r) {
    rest[r] = wz[0] * value[r] + wz[1] * value[r + 1] + wz[2] * value[r + 2] +
              wz[3] * value[r + 3] - block.height[r];
    good[r] = block.counts[r];
    if (patch.share_bad == 0.0F) continue;
    const int k = static_cast<int>(r);
    // Continuous in u and v, lest the iteration hop to and fro across a whole pixel: full where the
    // bad ones among the four pixels around weigh nothing, none from a half on.
    const Row around =
        (1.0F - v) * ((1.0F - u) * patch.good_row(k + 1, 1) + u * patch.good_row(k + 1, 2)) +
        v * ((1.0F - u) * patch.good_row(k + 2, 1) + u * patch.good_row(k + 2, 2));
    good[r] *= (2.0F * around - 1.0F).max(0.0F);
  }
  Verdict verdict;
  Pixels weight = good, stiffness = good;  // psi(r) / r and psi'(r) of the biweight
  constexpr double kBiweight = 4.685;
  const float cut = 1.0F / static_cast<float>(kBiweight * deviation);
  constexpr int kRounds = 2;  // a spot in one block moves its mean; the second round is free of it
  for (int round = 0; round <= kRounds; ++round) {
    Row sum = Row::Zero(), count = Row::Zero();
    for (std::size_t r = 0; r < kSide; ++r) {
      sum += weight[r] * rest[r];
      count += weight[r];
    }
    const float n = count.sum();
    if (n < 0.5F * kFewestPixels) return verdict;
    const float mean = sum.sum() / n;
    Row scatter = Row::Zero();
    for (std::size_t r = 0; r < kSide; ++r) {
      rest[r] -= mean;
      if (round == kRounds) {
        scatter += weight[r] * rest[r].abs();
        continue;
      }
      const Row square = (rest[r] * cut).square();
      const Row left = (1.0F - square).max(0.0F);
      weight[r] = good[r] * left * left;
      stiffness[r] = good[r] * left * (1.0F - 5.0F * square);
    }
    verdict.scatter = scatter.sum() / n;
  }
  Row score_x = Row::Zero(), score_z = Row::Zero(), common = Row::Zero();
  Row xx = Row::Zero(), xz = Row::Zero(), zx = Row::Zero(), zz = Row::Zero();
  for (std::size_t r = 0; r < kSide; ++r) {
    const Row gx = weight[r] * block.along_x[r], gz = weight[r] * block.along_z[r];
    const Row hx =
        wz[0] * slope[r] + wz[1] * slope[r + 1] + wz[2] * slope[r + 2] + wz[3] * slope[r + 3];
    const Row hz =
        sz[0] * value[r] + sz[1] * value[r + 1] + sz[2] * value[r + 2] + sz[3] * value[r + 3];
    score_x += gx * rest[r];
    score_z += gz * rest[r];
    const Row kx = stiffness[r] * block.along_x[r], kz = stiffness[r] * block.along_z[r];
    xx += kx * hx;
    xz += kx * hz;
    zx += kz * hx;
    zz += kz * hz;
    common += weight[r] * block.pattern[r] * (rest[r] + block.height[r]);
  }
  verdict.counts = true;
  verdict.score << score_x.sum(), score_z.sum();
  verdict.matrix << xx.sum(), xz.sum(), zx.sum(), zz.sum();
  verdict.common = common.sum();
  return verdict;
}

/// Sums over one half of the blocks.
struct Half {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero(), spread = Eigen::Matrix3d::Zero();
  Eigen::Vector3d score = Eigen::Vector3d::Zero();
  double n = 0.0;
};

/// Covariance of the parameters; the third only where it is free.
Eigen::MatrixXd covariance(const Half& half, Index free) {
  const Eigen::MatrixXd inverse = half.matrix.topLeftCorner(free, free).inverse();
  const double small = half.n / std::max(1.0, half.n - static_cast<double>(free));
  return small * inverse * half.spread.topLeftCorner(free, free) * inverse.transpose();
}

}  // namespace

std::optional<TextureShift> find_texture_shift(const FrameTexture& reference,
                                               const DeflectionMap& map) {
  const ChannelGrid& grid = reference.grid();
  MANO_ASSERT(grid == map.grid());
  const std::vector<Block>& blocks = reference.blocks();
  if (static_cast<Index>(blocks.size()) < kFewestBlocks) return std::nullopt;
  double farthest = 0.0, spread_x = 0.0;
  for (const Block& block : blocks) {
    farthest = std::max(farthest, std::abs(block.x));
    spread_x += block.x * block.x / static_cast<double>(blocks.size());
  }
  constexpr double kLeastLever = 3.0 * kSide;  // pixels
  const bool turns = std::sqrt(spread_x) > kLeastLever * grid.pitch_x.si();
  const Motion motion{std::max(farthest, grid.pitch_x.si()), grid.pitch_x.si(), grid.pitch_z.si()};
  const auto start = search(reference, map, motion, turns);
  if (!start) return std::nullopt;

  const Index free = turns ? 3 : 2;
  constexpr int kMostSteps = 10;
  constexpr double kSmallStep = 5e-3, kFarthest = 1.5;  // pixels
  constexpr float kFirst = 1.4F;                        // root 2 spreads: as if nothing agreed yet
  float deviation = kFirst;
  Eigen::Vector3d p = *start;
  std::array<Half, 2> halves;
  double common = 0.0, common_squares = 0.0, n = 0.0;
  bool settled = false;
  for (int step = 0; step < kMostSteps && !settled; ++step) {
    halves = {};
    common = common_squares = n = 0.0;
    std::vector<double> scatter;
    for (const Block& block : blocks) {
      const Eigen::Matrix<double, 2, 3> moves = motion.at(block);
      const Verdict verdict =
          judge_block(block, map, moves * p, 1.0 / reference.spread(), deviation);
      if (!verdict.counts) continue;
      Half& half = halves[block.even ? 0 : 1];
      const Eigen::Vector3d score = moves.transpose() * verdict.score;
      half.matrix += moves.transpose() * verdict.matrix * moves;
      half.spread += score * score.transpose();
      half.score += score;
      half.n += 1.0;
      common += verdict.common;
      common_squares += verdict.common * verdict.common;
      n += 1.0;
      scatter.push_back(verdict.scatter);
    }
    if (n < static_cast<double>(kFewestBlocks)) return std::nullopt;
    const Eigen::MatrixXd matrix = (halves[0].matrix + halves[1].matrix).topLeftCorner(free, free);
    const Eigen::VectorXd move = matrix.inverse() * (halves[0].score + halves[1].score).head(free);
    p.head(free) -= move;
    // Also where a matrix without texture behind it is singular.
    if (!((p - *start).cwiseAbs().maxCoeff() < kFarthest)) return std::nullopt;
    deviation = static_cast<float>(kSpreadOfMean * numerics::median(scatter));
    settled = step > 0 && move.cwiseAbs().maxCoeff() < kSmallStep;
  }
  if (!settled) return std::nullopt;

  constexpr double kLeastT = 6.0, kSigmas = 4.0, kMostDoubt = 0.1;
  const double t = student_t(common, common_squares, n);
  if (!(t > kLeastT)) return std::nullopt;
  const Eigen::VectorXd difference =
      halves[0].matrix.topLeftCorner(free, free).inverse() * halves[0].score.head(free) -
      halves[1].matrix.topLeftCorner(free, free).inverse() * halves[1].score.head(free);
  const Eigen::VectorXd doubt =
      (covariance(halves[0], free) + covariance(halves[1], free)).diagonal().cwiseSqrt();
  Half all;
  for (const Half& half : halves) {
    all.matrix += half.matrix;
    all.spread += half.spread;
    all.n += half.n;
  }
  constexpr double kFloor = 5e-3;  // pixels: what resampling leaves
  const Eigen::VectorXd sigma =
      (covariance(all, free).diagonal().array() + kFloor * kFloor).sqrt().matrix();
  for (Index k = 0; k < free; ++k) {
    if (!(std::abs(difference[k]) < kSigmas * doubt[k] + kFloor)) return std::nullopt;
  }
  if (!(sigma.head(2).maxCoeff() < kMostDoubt)) return std::nullopt;
  TextureShift found;
  found.x = p[0] * grid.pitch_x;
  found.z = p[1] * grid.pitch_z;
  found.x_uncertainty = sigma[0] * grid.pitch_x;
  found.z_uncertainty = sigma[1] * grid.pitch_z;
  if (turns) {
    found.angle = p[2] * grid.pitch_x.si() / motion.radius;
    found.angle_uncertainty = sigma[2] * grid.pitch_x.si() / motion.radius;
  }
  found.significance = t;
  return found;
}

}  // namespace manoscope::maps
