#include "manoscope/core/random.hpp"

#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope {
namespace {

/// Finaliser of splitmix64 (Steele, Lea & Flood 2014): spreads every bit over the word.
std::uint64_t mix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

std::uint64_t stream_key(std::uint64_t seed, std::string_view name, std::uint64_t index) {
  std::uint64_t key = mix(seed);
  for (const char letter : name) key = mix(key ^ static_cast<unsigned char>(letter));
  return mix(key ^ mix(index + 1));
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name, std::uint64_t index)
    : engine_(stream_key(seed, name, index)) {}

double RandomStream::uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log1p(-uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

Index RandomStream::below(Index n) {
  MANO_ASSERT(n > 0);
  return static_cast<Index>(uniform() * static_cast<double>(n));
}

}  // namespace manoscope
