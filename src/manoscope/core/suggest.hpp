#pragma once

#include <span>
#include <string>
#include <string_view>

namespace manoscope {

/// The candidate nearest to `word` (letters inserted, dropped, changed or swapped; case ignored),
/// or "" if none is near.
///
/// Near means at most a third of the longer word's letters differ.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

/// " (did you mean \"height\"?)" or "" for use inside a message.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace manoscope
