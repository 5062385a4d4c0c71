#include "roof_misfit.hpp"

#include <algorithm>
#include <cmath>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

/// Gauss and Lobatto's points on [0, 1].
std::vector<double> nodes_of(int order) {
  MANO_ASSERT(order >= 2 && order <= 4);
  if (order == 2) return {0.0, 0.5, 1.0};
  if (order == 3) {
    const double inner = 0.5 / std::sqrt(5.0);
    return {0.0, 0.5 - inner, 0.5 + inner, 1.0};
  }
  const double inner = 0.5 * std::sqrt(3.0 / 7.0);
  return {0.0, 0.5 - inner, 0.5, 0.5 + inner, 1.0};
}

std::vector<double> between(const std::vector<double>& nodes) {
  std::vector<double> places;
  for (std::size_t i = 1; i < nodes.size(); ++i) places.push_back(0.5 * (nodes[i - 1] + nodes[i]));
  return places;
}

/// (places, nodes) weights of the polynomial through the nodes.
Matrix interpolation(const std::vector<double>& nodes, const std::vector<double>& places) {
  Matrix weights =
      Matrix::Ones(static_cast<Index>(places.size()), static_cast<Index>(nodes.size()));
  for (std::size_t p = 0; p < places.size(); ++p) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (k == i) continue;
        weights(static_cast<Index>(p), static_cast<Index>(i)) *=
            (places[p] - nodes[k]) / (nodes[i] - nodes[k]);
      }
    }
  }
  return weights;
}

/// One axis of a cell.
struct Axis {
  std::vector<double> nodes{0.0}, places{0.0};
  Matrix weights = Matrix::Ones(1, 1);

  Axis() = default;
  explicit Axis(int order)
      : nodes(nodes_of(order)), places(between(nodes)), weights(interpolation(nodes, places)) {}
};

}  // namespace

RoofMisfit roof_misfit(const std::function<double(double x, double z)>& gap,
                       const std::vector<double>& edges_x, const std::vector<double>& edges_z,
                       int order) {
  const bool plane = edges_z.empty();
  const Axis along(order);
  const Axis across = plane ? Axis() : Axis(order);
  const std::size_t n_z = plane ? 1 : edges_z.size() - 1;
  const auto sample = [&](std::size_t i, std::size_t k, const std::vector<double>& s,
                          const std::vector<double>& t) {
    const double x = edges_x[i], dx = edges_x[i + 1] - x;
    const double z = plane ? 0.0 : edges_z[k], dz = plane ? 0.0 : edges_z[k + 1] - z;
    Matrix values(static_cast<Index>(s.size()), static_cast<Index>(t.size()));
    for (std::size_t a = 0; a < s.size(); ++a) {
      for (std::size_t b = 0; b < t.size(); ++b) {
        values(static_cast<Index>(a), static_cast<Index>(b)) = gap(x + s[a] * dx, z + t[b] * dz);
      }
    }
    return values;
  };
  RoofMisfit worst;
  for (std::size_t i = 0; i + 1 < edges_x.size(); ++i) {
    for (std::size_t k = 0; k < n_z; ++k) {
      const Matrix nodes = sample(i, k, along.nodes, across.nodes);
      const Matrix exact = sample(i, k, along.places, across.places);
      const Matrix mesh = along.weights * nodes * across.weights.transpose();
      Index a = 0, b = 0;
      const double share = ((mesh - exact).array().abs() / exact.array()).maxCoeff(&a, &b);
      if (!(share > worst.share)) continue;
      worst.share = share;
      worst.x =
          edges_x[i] + along.places[static_cast<std::size_t>(a)] * (edges_x[i + 1] - edges_x[i]);
      if (!plane) {
        worst.z =
            edges_z[k] + across.places[static_cast<std::size_t>(b)] * (edges_z[k + 1] - edges_z[k]);
      }
    }
  }
  return worst;
}

}  // namespace manoscope::navier_stokes
