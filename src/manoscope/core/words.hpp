#pragma once

#include <cstddef>

namespace manoscope {

/// A word of our files and the value it stands for.
template <class E>
struct Word {
  const char* word;
  E value;
};

/// The word of a value that the table has; "" of one that it has not.
template <class E, std::size_t N>
constexpr const char* word_of(const Word<E> (&words)[N], E value) {
  for (const Word<E>& one : words) {
    if (one.value == value) return one.word;
  }
  return "";
}

}  // namespace manoscope
