#pragma once

#include <cstdint>

namespace manoscope::fuzz {

/// Counts the bytes that this process holds from its allocator: `new`, `malloc` and what libraries
/// such as zlib, libzip, libtiff and pugixml take through them. Linking allocation_counter.cpp is
/// all it needs; under the address sanitizer it uses the sanitizer's hooks.
///
/// Not counted: what the kernel maps (stacks, mapped files).
struct AllocationCounter {
  /// Bytes held now, as asked for.
  static std::int64_t held();
  /// The most held since the last call of restart(), less what was held then.
  static std::int64_t peak();
  static void restart();
  /// True if an allocation of the program is seen; false where another allocator is linked in.
  static bool works();
};

}  // namespace manoscope::fuzz
