#pragma once

#include <cstdint>
#include <cstring>

#if defined(__x86_64__) && !defined(__clang__)
#include <immintrin.h>  // declares the builtin used below
#endif

/// Eight doubles side by side, for the few loops that run over every pixel of a map.
///
/// A kernel written over `Lanes` does the same operations on the same eight lanes in the same order
/// on every processor, two, four or eight of them in one instruction: its result has the same bytes
/// everywhere (no fused multiply-add: -ffp-contract=off). A kernel is a struct with
///
///   template <class Lanes>
///   [[gnu::always_inline]] static void run(arguments...);
///
/// and is called by run_in_lanes<Kernel>(instructions, arguments...).
namespace manoscope::numerics {

inline constexpr int kLanes = 8;

/// What a kernel may use of the processor; the result does not depend on it.
enum class Instructions { baseline, avx2, avx512 };

/// The widest instructions that this processor has.
inline Instructions best_instructions() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) {
    return Instructions::avx512;
  }
  if (__builtin_cpu_supports("avx2")) return Instructions::avx2;
#endif
  return Instructions::baseline;
}

struct TwoWide {
  static constexpr int size = 2;
  using Values = double __attribute__((vector_size(16)));
  using Bits = std::int64_t __attribute__((vector_size(16)));
  using Floats = float __attribute__((vector_size(8)));
  using FloatBits = std::int32_t __attribute__((vector_size(8)));
  [[gnu::always_inline]] static Values widened(const Floats& values) {
    return __builtin_convertvector(values, Values);
  }
};
struct FourWide {
  static constexpr int size = 4;
  using Values = double __attribute__((vector_size(32)));
  using Bits = std::int64_t __attribute__((vector_size(32)));
  using Floats = float __attribute__((vector_size(16)));
  using FloatBits = std::int32_t __attribute__((vector_size(16)));
  [[gnu::always_inline]] static Values widened(const Floats& values) {
    return __builtin_convertvector(values, Values);
  }
};
struct EightWide {
  static constexpr int size = 8;
  using Values = double __attribute__((vector_size(64)));
  using Bits = std::int64_t __attribute__((vector_size(64)));
  using Floats = float __attribute__((vector_size(32)));
  using FloatBits = std::int32_t __attribute__((vector_size(32)));
  [[gnu::always_inline]] static Values widened(const Floats& values) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    // g++ 12 makes two halves of __builtin_convertvector here.
    constexpr int kCurrentRounding = 4;
    return __builtin_ia32_cvtps2pd512_mask(values, Values{}, -1, kCurrentRounding);
#else
    return __builtin_convertvector(values, Values);
#endif
  }
};

/// As many doubles as fit one register.
template <class Width>
struct Register {
  using Values = typename Width::Values;
  using Bits = typename Width::Bits;
  using Floats = typename Width::Floats;
  using FloatBits = typename Width::FloatBits;
  static constexpr int size = Width::size;

  Values v;

  [[gnu::always_inline]] static Register load(const double* from) {
    Register r;
    std::memcpy(&r.v, from, sizeof r.v);
    return r;
  }
  [[gnu::always_inline]] static Register all(double value) { return {value - Values{}}; }
  /// 32-bit floats in this machine's byte order.
  [[gnu::always_inline]] static Register floats(const char* from) {
    Floats values;
    std::memcpy(&values, from, sizeof values);
    return {Width::widened(values)};
  }
  /// The same; what is not finite becomes 0.
  [[gnu::always_inline]] static Register finite_floats(const char* from) {
    FloatBits bits;
    std::memcpy(&bits, from, sizeof bits);
    const FloatBits exponent = bits & 0x7f800000;
    const FloatBits finite = bits & ~(exponent == 0x7f800000);
    return {Width::widened(reinterpret_cast<Floats>(finite))};
  }
  /// Raises `largest` to the sizes of the floats, as bit patterns, which rise with the size.
  [[gnu::always_inline]] static void raise(FloatBits& largest, const char* from) {
    FloatBits bits;
    std::memcpy(&bits, from, sizeof bits);
    bits &= 0x7fffffff;
    largest = bits > largest ? bits : largest;
  }
  /// Whether a float of such a size is infinite or NaN.
  [[gnu::always_inline]] static bool any_not_finite(const FloatBits& largest) {
    const FloatBits bad = largest >= 0x7f800000;
    std::uint64_t words[sizeof bad / 8], any = 0;
    std::memcpy(words, &bad, sizeof bad);
    for (const std::uint64_t word : words) any |= word;
    return any != 0;
  }
  [[gnu::always_inline]] void store(double* to) const { std::memcpy(to, &v, sizeof v); }

  [[gnu::always_inline]] friend Register operator+(Register a, Register b) { return {a.v + b.v}; }
  [[gnu::always_inline]] friend Register operator-(Register a, Register b) { return {a.v - b.v}; }
  [[gnu::always_inline]] friend Register operator*(Register a, Register b) { return {a.v * b.v}; }
  [[gnu::always_inline]] friend Register operator/(Register a, Register b) { return {a.v / b.v}; }
  [[gnu::always_inline]] friend Register lesser(Register a, Register b) {
    return {a.v < b.v ? a.v : b.v};
  }
  [[gnu::always_inline]] friend Register greater(Register a, Register b) {
    return {a.v > b.v ? a.v : b.v};
  }
  [[gnu::always_inline]] friend Register size_of(Register a) {
    return {reinterpret_cast<Values>(reinterpret_cast<Bits>(a.v) & INT64_MAX)};
  }
  /// 1 where a < b, else 0.
  [[gnu::always_inline]] friend Register is_below(Register a, Register b) {
    const Values one = 1.0 - Values{};
    const Bits below = a.v < b.v;
    return {reinterpret_cast<Values>(below & reinterpret_cast<Bits>(one))};
  }
};

/// Two halves side by side.
template <class Half>
struct Twice {
  static constexpr int size = 2 * Half::size;

  Half low, high;

  struct FloatBits {
    typename Half::FloatBits low{}, high{};
  };
  [[gnu::always_inline]] static Twice load(const double* from) {
    return {Half::load(from), Half::load(from + Half::size)};
  }
  [[gnu::always_inline]] static Twice all(double value) {
    return {Half::all(value), Half::all(value)};
  }
  [[gnu::always_inline]] static Twice floats(const char* from) {
    return {Half::floats(from), Half::floats(from + 4 * Half::size)};
  }
  [[gnu::always_inline]] static Twice finite_floats(const char* from) {
    return {Half::finite_floats(from), Half::finite_floats(from + 4 * Half::size)};
  }
  [[gnu::always_inline]] static void raise(FloatBits& largest, const char* from) {
    Half::raise(largest.low, from);
    Half::raise(largest.high, from + 4 * Half::size);
  }
  [[gnu::always_inline]] static bool any_not_finite(const FloatBits& largest) {
    return static_cast<int>(Half::any_not_finite(largest.low)) +
               static_cast<int>(Half::any_not_finite(largest.high)) !=
           0;
  }
  [[gnu::always_inline]] void store(double* to) const {
    low.store(to);
    high.store(to + Half::size);
  }
  [[gnu::always_inline]] friend Twice operator+(Twice a, Twice b) {
    return {a.low + b.low, a.high + b.high};
  }
  [[gnu::always_inline]] friend Twice operator-(Twice a, Twice b) {
    return {a.low - b.low, a.high - b.high};
  }
  [[gnu::always_inline]] friend Twice operator*(Twice a, Twice b) {
    return {a.low * b.low, a.high * b.high};
  }
  [[gnu::always_inline]] friend Twice operator/(Twice a, Twice b) {
    return {a.low / b.low, a.high / b.high};
  }
  [[gnu::always_inline]] friend Twice lesser(Twice a, Twice b) {
    return {lesser(a.low, b.low), lesser(a.high, b.high)};
  }
  [[gnu::always_inline]] friend Twice greater(Twice a, Twice b) {
    return {greater(a.low, b.low), greater(a.high, b.high)};
  }
  [[gnu::always_inline]] friend Twice size_of(Twice a) { return {size_of(a.low), size_of(a.high)}; }
  [[gnu::always_inline]] friend Twice is_below(Twice a, Twice b) {
    return {is_below(a.low, b.low), is_below(a.high, b.high)};
  }
};

using BaselineLanes = Twice<Twice<Register<TwoWide>>>;

#if defined(__x86_64__)
template <class Kernel, class... Arguments>
[[gnu::target("avx2")]] void run_avx2(Arguments... arguments) {
  Kernel::template run<Twice<Register<FourWide>>>(arguments...);
}
template <class Kernel, class... Arguments>
[[gnu::target("avx512f,avx512dq,avx512bw,avx512vl")]] void run_avx512(Arguments... arguments) {
  Kernel::template run<Register<EightWide>>(arguments...);
}
#endif

/// Runs a kernel. The arguments are plain values and pointers.
template <class Kernel, class... Arguments>
void run_in_lanes(Instructions instructions, Arguments... arguments) {
#if defined(__x86_64__)
  if (instructions == Instructions::avx512) return run_avx512<Kernel>(arguments...);
  if (instructions == Instructions::avx2) return run_avx2<Kernel>(arguments...);
#endif
  static_cast<void>(instructions);
  Kernel::template run<BaselineLanes>(arguments...);
}

/// The sum of eight lanes, always in the same order.
inline double sum_of_lanes(const double* lane) {
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

}  // namespace manoscope::numerics
