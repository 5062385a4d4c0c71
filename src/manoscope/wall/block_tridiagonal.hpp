#pragma once

#include <Eigen/Cholesky>
#include <optional>
#include <vector>

#include "manoscope/core/arrays.hpp"

namespace manoscope::wall {

/// A symmetric block-tridiagonal matrix: block k couples to blocks k - 1 and k + 1 alone.
struct BlockTridiagonal {
  std::vector<Matrix> diagonal;  ///< (n_k, n_k); the lower triangle counts
  std::vector<Matrix> below;     ///< block (k + 1, k): (n_{k+1}, n_k), one fewer than `diagonal`

  /// All zero, with these block sizes.
  explicit BlockTridiagonal(const std::vector<Index>& sizes);
  void set_zero();
  /// Adds factor times a matrix of the same block sizes.
  void add(double factor, const BlockTridiagonal& other);
  Eigen::VectorXd multiply(const Eigen::VectorXd& x) const;
};

/// L D L^T of a symmetric block-tridiagonal matrix, definite or not; many right-hand sides share
/// it.
///
/// A block whose Schur complement is positive definite is factored by Cholesky, any other by
/// Eigen's LDLT with symmetric pivoting inside the block. Pivoting does not cross blocks.
class BlockFactorisation {
 public:
  explicit BlockFactorisation(const BlockTridiagonal& matrix);

  /// Number of negative pivots: that of negative eigenvalues (Sylvester's law of inertia).
  Index n_negative() const { return n_negative_; }
  Index size() const { return offsets_.back(); }
  /// Solves in place; rhs is (size, n).
  void solve_in_place(Eigen::Ref<Matrix> rhs) const;
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const;

 private:
  struct Block {
    bool definite = true;
    std::optional<Eigen::LLT<Matrix>> cholesky;  ///< of a definite block
    std::optional<Eigen::LDLT<Matrix>> pivoted;  ///< of an indefinite block
    Matrix coupling;                             ///< L^-1 P (below)^T
    Array1 inverse_pivots;                       ///< of an indefinite block
  };
  void apply_forward(const Block& block, Eigen::Ref<Matrix> part) const;
  void apply_backward(const Block& block, Eigen::Ref<Matrix> part) const;

  std::vector<Block> blocks_;
  std::vector<Index> offsets_;
  Index n_negative_ = 0;
};

}  // namespace manoscope::wall
