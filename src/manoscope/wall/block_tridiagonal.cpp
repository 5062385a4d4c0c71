#include "manoscope/wall/block_tridiagonal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {

BlockTridiagonal::BlockTridiagonal(const std::vector<Index>& sizes) {
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    diagonal.emplace_back(Matrix::Zero(sizes[k], sizes[k]));
    if (k + 1 < sizes.size()) below.emplace_back(Matrix::Zero(sizes[k + 1], sizes[k]));
  }
}

void BlockTridiagonal::set_zero() {
  for (Matrix& block : diagonal) block.setZero();
  for (Matrix& block : below) block.setZero();
}

void BlockTridiagonal::add(double factor, const BlockTridiagonal& other) {
  for (std::size_t k = 0; k < diagonal.size(); ++k) diagonal[k] += factor * other.diagonal[k];
  for (std::size_t k = 0; k < below.size(); ++k) below[k] += factor * other.below[k];
}

Eigen::VectorXd BlockTridiagonal::multiply(const Eigen::VectorXd& x) const {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(x.size());
  Index at = 0;
  for (std::size_t k = 0; k < diagonal.size(); ++k) {
    const Index n = diagonal[k].rows();
    product.segment(at, n) += diagonal[k].selfadjointView<Eigen::Lower>() * x.segment(at, n);
    if (k < below.size()) {
      const Index next = below[k].rows();
      product.segment(at + n, next) += below[k] * x.segment(at, n);
      product.segment(at, n) += below[k].transpose() * x.segment(at + n, next);
    }
    at += n;
  }
  return product;
}

BlockFactorisation::BlockFactorisation(const BlockTridiagonal& matrix)
    : blocks_(matrix.diagonal.size()), offsets_{0} {
  Matrix schur;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    Block& block = blocks_[k];
    schur = matrix.diagonal[k];
    offsets_.push_back(offsets_.back() + schur.rows());
    if (k > 0) {
      const Block& last = blocks_[k - 1];
      if (last.definite) {
        schur.selfadjointView<Eigen::Lower>().rankUpdate(last.coupling.transpose(), -1.0);
      } else {
        const Matrix scaled = last.inverse_pivots.matrix().asDiagonal() * last.coupling;
        schur.noalias() -= last.coupling.transpose() * scaled;
      }
    }
    block.cholesky.emplace(schur);
    block.definite = block.cholesky->info() == Eigen::Success;
    if (!block.definite) {
      schur.triangularView<Eigen::StrictlyUpper>() = schur.transpose();
      block.cholesky.reset();
      block.pivoted.emplace(schur);
      Array1 pivots = block.pivoted->vectorD().array();
      // A pivot lost to round-off stands for a tiny one: its sign decides nothing by then.
      const double floor =
          std::max(std::numeric_limits<double>::epsilon() * 1e-3 * pivots.abs().maxCoeff(),
                   std::numeric_limits<double>::min() * 1e16);
      for (double& pivot : pivots) {
        if (std::abs(pivot) < floor) pivot = floor;
        if (pivot < 0.0) ++n_negative_;
      }
      block.inverse_pivots = pivots.inverse();
    }
    if (k + 1 < blocks_.size()) {
      block.coupling = matrix.below[k].transpose();
      apply_forward(block, block.coupling);
    }
  }
}

void BlockFactorisation::apply_forward(const Block& block, Eigen::Ref<Matrix> part) const {
  if (block.definite) {
    block.cholesky->matrixL().solveInPlace(part);
  } else {
    part = block.pivoted->transpositionsP() * part;
    block.pivoted->matrixL().solveInPlace(part);
  }
}

void BlockFactorisation::apply_backward(const Block& block, Eigen::Ref<Matrix> part) const {
  if (block.definite) {
    block.cholesky->matrixU().solveInPlace(part);
  } else {
    block.pivoted->matrixU().solveInPlace(part);
    part = block.pivoted->transpositionsP().transpose() * part;
  }
}

void BlockFactorisation::solve_in_place(Eigen::Ref<Matrix> rhs) const {
  MANO_ASSERT(rhs.rows() == size());
  const std::size_t n = blocks_.size();
  const auto part = [&](std::size_t k) {
    return rhs.middleRows(offsets_[k], offsets_[k + 1] - offsets_[k]);
  };
  // With y = L^-1 P b: the part of block k is reduced by coupling^T D^-1 y of the block before.
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) part(k).noalias() -= blocks_[k - 1].coupling.transpose() * part(k - 1);
    apply_forward(blocks_[k], part(k));
    // D^-1 at once: both the next block and the way back need it.
    if (!blocks_[k].definite) {
      part(k) = blocks_[k].inverse_pivots.matrix().asDiagonal() * Matrix(part(k));
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    if (k + 1 < n) {
      if (blocks_[k].definite) {
        part(k).noalias() -= blocks_[k].coupling * part(k + 1);
      } else {
        part(k) -= blocks_[k].inverse_pivots.matrix().asDiagonal() *
                   Matrix(blocks_[k].coupling * part(k + 1));
      }
    }
    apply_backward(blocks_[k], part(k));
  }
}

Eigen::VectorXd BlockFactorisation::solve(const Eigen::VectorXd& rhs) const {
  Eigen::VectorXd x = rhs;
  solve_in_place(x);
  return x;
}

}  // namespace manoscope::wall
