#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "manoscope/experiment/form_list.hpp"

namespace manoscope::experiment {

/// Which row of a list every row of its next state was; nullopt for a new one.
///
/// A row is known by its map, without a column of maps by all its cells; between two rows that are
/// known, what is left is paired in turn. The order of the old rows is kept: of two that changed
/// places one is new. Tables of thousands of rows of which many differ are paired in turn alone.
std::vector<std::optional<std::size_t>> align_rows(const FormList& old, const FormList& wanted);

}  // namespace manoscope::experiment
