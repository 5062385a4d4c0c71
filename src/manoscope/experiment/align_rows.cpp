#include "manoscope/experiment/align_rows.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace manoscope::experiment {
namespace {

using Keys = std::vector<std::string>;

std::optional<std::size_t> map_column(const FormList& list) {
  const auto found = std::find(list.columns.begin(), list.columns.end(), "map");
  if (found == list.columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - list.columns.begin());
}

/// What tells a row from another.
Keys keys_of(const FormList& list, bool by_map) {
  const std::size_t column = map_column(list).value_or(0);
  Keys keys;
  for (const auto& row : list.rows) {
    std::string key = by_map ? row[column] : "";
    for (std::size_t i = 0; !by_map && i < row.size(); ++i) key += row[i] + '\n';
    keys.push_back(std::move(key));
  }
  return keys;
}

/// Rows of equal keys, as many as keep their order: pairs of old and wanted, ascending.
class CommonRows {
 public:
  /// The ranges [first, behind) of both that are compared.
  CommonRows(const Keys& old, const Keys& wanted, std::size_t first, std::size_t old_behind,
             std::size_t wanted_behind)
      : old_(old),
        wanted_(wanted),
        first_(first),
        n_old_(old_behind - first),
        n_wanted_(wanted_behind - first),
        longest_((n_old_ + 1) * (n_wanted_ + 1), 0) {
    for (std::size_t i = n_old_; i-- > 0;) {
      for (std::size_t j = n_wanted_; j-- > 0;) {
        at(i, j) = same(i, j) ? static_cast<std::uint16_t>(at(i + 1, j + 1) + 1)
                              : std::max(at(i + 1, j), at(i, j + 1));
      }
    }
  }

  template <class Take>
  void each(const Take& take) {
    for (std::size_t i = 0, j = 0; i < n_old_ && j < n_wanted_;) {
      if (same(i, j)) {
        take(first_ + i++, first_ + j++);
      } else if (at(i + 1, j) >= at(i, j + 1)) {
        ++i;
      } else {
        ++j;
      }
    }
  }

 private:
  bool same(std::size_t i, std::size_t j) const { return old_[first_ + i] == wanted_[first_ + j]; }
  std::uint16_t& at(std::size_t i, std::size_t j) { return longest_[i * (n_wanted_ + 1) + j]; }

  const Keys &old_, &wanted_;
  std::size_t first_, n_old_, n_wanted_;
  std::vector<std::uint16_t> longest_;  ///< of what is left from (i, j) on
};

}  // namespace

std::vector<std::optional<std::size_t>> align_rows(const FormList& old, const FormList& wanted) {
  constexpr std::size_t kMostPairs = 4000000;  // 8 MB, some 10 ms
  const bool by_map = map_column(old) && map_column(wanted);
  const Keys before = keys_of(old, by_map), after = keys_of(wanted, by_map);
  std::vector<std::optional<std::size_t>> rows(after.size());
  std::size_t first = 0, n_old = before.size(), n_wanted = after.size();
  for (; first < std::min(n_old, n_wanted) && before[first] == after[first]; ++first) {
    rows[first] = first;
  }
  while (n_old > first && n_wanted > first && before[n_old - 1] == after[n_wanted - 1]) {
    rows[--n_wanted] = --n_old;
  }
  // Between two rows that are known the rest is paired in turn.
  std::size_t next_old = first, next_wanted = first;
  const auto pair = [&](std::size_t until_old, std::size_t until_wanted) {
    while (next_old < until_old && next_wanted < until_wanted) rows[next_wanted++] = next_old++;
    next_old = until_old;
    next_wanted = until_wanted;
  };
  if ((n_old - first) * (n_wanted - first) <= kMostPairs) {
    CommonRows(before, after, first, n_old, n_wanted).each([&](std::size_t i, std::size_t j) {
      pair(i, j);
      rows[j] = i;
      next_old = i + 1;
      next_wanted = j + 1;
    });
  }
  pair(n_old, n_wanted);
  return rows;
}

}  // namespace manoscope::experiment
