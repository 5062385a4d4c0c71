#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "sparse_direct.hpp"

namespace manoscope::navier_stokes {

/// Unknowns of a finite-element problem: the degrees of freedom that are not fixed, numbered from
/// 0, and the pattern of their matrix.
class DofPattern {
 public:
  using DofIndex = dealii::types::global_dof_index;

  /// @param fixed    (degrees of freedom) not 0 where the value is given.
  /// @param couples  whether local degrees of freedom i and j of a cell share an entry.
  template <int dim, class Couples>
  DofPattern(const dealii::DoFHandler<dim>& dofs, const std::vector<char>& fixed,
             const Couples& couples)
      : free_index_(fixed.size(), -1) {
    for (std::size_t i = 0; i < fixed.size(); ++i) {
      if (fixed[i] == 0) free_index_[i] = n_free_++;
    }
    std::vector<std::vector<int>> rows(static_cast<std::size_t>(n_free_));
    std::vector<DofIndex> local(dofs.get_fe().n_dofs_per_cell());
    for (const auto& cell : dofs.active_cell_iterators()) {
      cell->get_dof_indices(local);
      for (unsigned int i = 0; i < local.size(); ++i) {
        const int row = free_index(local[i]);
        if (row < 0) continue;
        for (unsigned int j = 0; j < local.size(); ++j) {
          const int column = free_index(local[j]);
          if (column >= 0 && couples(i, j)) rows[row].push_back(column);
        }
        // Neighbours repeat what is there: kept short, the lists do not outgrow the matrix.
        if (rows[row].size() > kLongList) settle(rows[row]);
      }
    }
    matrix_.row_start.push_back(0);
    for (std::vector<int>& row : rows) {
      settle(row);
      matrix_.column.insert(matrix_.column.end(), row.begin(), row.end());
      matrix_.row_start.push_back(static_cast<int>(matrix_.column.size()));
      std::vector<int>().swap(row);
    }
  }

  int n_free() const { return n_free_; }
  /// Number of the unknown, -1 of what is fixed.
  int free_index(DofIndex dof) const { return free_index_[dof]; }
  /// A matrix of zeros.
  SparseMatrix matrix() const {
    SparseMatrix result = matrix_;
    result.value.assign(result.column.size(), 0.0);
    return result;
  }
  /// Adds a cell's block, (local, local); entries outside the pattern and of fixed values are left
  /// out.
  void add(const std::vector<DofIndex>& local, const Eigen::MatrixXd& block,
           SparseMatrix& matrix) const {
    for (std::size_t i = 0; i < local.size(); ++i) {
      const int row = free_index(local[i]);
      if (row < 0) continue;
      const auto first = matrix.column.begin() + matrix.row_start[row];
      const auto last = matrix.column.begin() + matrix.row_start[row + 1];
      for (std::size_t j = 0; j < local.size(); ++j) {
        const int column = free_index(local[j]);
        if (column < 0) continue;
        const auto place = std::lower_bound(first, last, column);
        if (place == last || *place != column) continue;
        matrix.value[static_cast<std::size_t>(place - matrix.column.begin())] +=
            block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
  }

 private:
  static constexpr std::size_t kLongList = 2000;

  static void settle(std::vector<int>& row) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }

  int n_free_ = 0;
  std::vector<int> free_index_;
  SparseMatrix matrix_;
};

}  // namespace manoscope::navier_stokes
