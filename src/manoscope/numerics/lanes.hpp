#pragma once

#include <cstdint>
#include <cstring>

#if defined(__x86_64__) && !defined(__clang__)
#include <immintrin.h>  // declares the builtins used below
#endif

/// Eight doubles side by side, for the few loops that run over every pixel of a map.
///
/// A kernel written over `Lanes` does the same operations on the same eight lanes in the same order
/// on every processor, two, four or eight of them in one instruction: its result has the same bytes
/// everywhere (no fused multiply-add but of exact products: -ffp-contract=off). A kernel is a
/// struct with
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
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return Instructions::avx2;
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
  [[gnu::always_inline]] static Values plus_square(const Values& sum, const Values& x) {
    return sum + x * x;
  }
  /// One bit a lane, set where `lanes` is -1; elsewhere it is 0.
  [[gnu::always_inline]] static unsigned bits_of(const FloatBits& lanes) {
    std::uint64_t both;
    std::memcpy(&both, &lanes, sizeof both);
    return static_cast<unsigned>((both & 1) | (both >> 62 & 2));
  }
  [[gnu::always_inline]] static unsigned bits_of(const Bits& lanes) {
    return static_cast<unsigned>((lanes[0] & 1) | (lanes[1] & 2));
  }
  /// Widened; what is not finite becomes 0 and has its bit set in `missing`.
  [[gnu::always_inline]] static Values finite(const FloatBits& bits, unsigned& missing) {
    const FloatBits good = (bits & 0x7f800000) < 0x7f800000;
    missing = bits_of(good) ^ ((1U << size) - 1U);
    return widened(reinterpret_cast<Floats>(bits & good));
  }
  [[gnu::always_inline]] static bool all_finite(const Values& v) {
    constexpr std::int64_t kExponent = 0x7ff0000000000000;
    return bits_of((reinterpret_cast<const Bits&>(v) & kExponent) == kExponent) == 0;
  }
};
struct FourWide {
  static constexpr int size = 4;
  using Values = double __attribute__((vector_size(32)));
  using Bits = std::int64_t __attribute__((vector_size(32)));
  using Floats = float __attribute__((vector_size(16)));
  using FloatBits = std::int32_t __attribute__((vector_size(16)));
  [[gnu::always_inline]] static Values widened(const Floats& values) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    return __builtin_ia32_cvtps2pd256(values);  // g++ 12 makes two halves of the one below
#else
    return __builtin_convertvector(values, Values);
#endif
  }
  [[gnu::always_inline]] static Values plus_square(const Values& sum, const Values& x) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    return __builtin_ia32_vfmaddpd256(x, x, sum);
#else
    return sum + x * x;
#endif
  }
  [[gnu::always_inline]] static unsigned bits_of(const FloatBits& lanes) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<Floats>(lanes)));
#else
    return static_cast<unsigned>((lanes[0] & 1) | (lanes[1] & 2) | (lanes[2] & 4) | (lanes[3] & 8));
#endif
  }
  [[gnu::always_inline]] static unsigned bits_of(const Bits& lanes) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    return static_cast<unsigned>(__builtin_ia32_movmskpd256(reinterpret_cast<Values>(lanes)));
#else
    return static_cast<unsigned>((lanes[0] & 1) | (lanes[1] & 2) | (lanes[2] & 4) | (lanes[3] & 8));
#endif
  }
  [[gnu::always_inline]] static Values finite(const FloatBits& bits, unsigned& missing) {
    const FloatBits good = (bits & 0x7f800000) < 0x7f800000;
    missing = bits_of(good) ^ ((1U << size) - 1U);
    return widened(reinterpret_cast<Floats>(bits & good));
  }
  [[gnu::always_inline]] static bool all_finite(const Values& v) {
    constexpr std::int64_t kExponent = 0x7ff0000000000000;
    return bits_of((reinterpret_cast<const Bits&>(v) & kExponent) == kExponent) == 0;
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
  [[gnu::always_inline]] static Values plus_square(const Values& sum, const Values& x) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    constexpr int kCurrentRounding = 4;
    return __builtin_ia32_vfmaddpd512_mask(x, x, sum, -1, kCurrentRounding);
#else
    return sum + x * x;
#endif
  }
  template <class Any>
  [[gnu::always_inline]] static unsigned bits_of(const Any& lanes) {
    unsigned bits = 0;
    for (int i = 0; i < size; ++i) bits |= static_cast<unsigned>(lanes[i] & 1) << i;
    return bits;
  }
  [[gnu::always_inline]] static Values finite(const FloatBits& bits, unsigned& missing) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    constexpr int kNanOrInfinite = 0x99, kCurrentRounding = 4;
    const auto floats = reinterpret_cast<Floats>(bits);
    const auto bad = __builtin_ia32_fpclassps256_mask(floats, kNanOrInfinite, -1);
    missing = static_cast<std::uint8_t>(bad);
    return __builtin_ia32_cvtps2pd512_mask(floats, Values{}, static_cast<char>(~bad),
                                           kCurrentRounding);
#else
    const FloatBits good = (bits & 0x7f800000) < 0x7f800000;
    missing = bits_of(good) ^ ((1U << size) - 1U);
    return widened(reinterpret_cast<Floats>(bits & good));
#endif
  }
  [[gnu::always_inline]] static bool all_finite(const Values& v) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    constexpr int kNanOrInfinite = 0x99;
    return __builtin_ia32_fpclasspd512_mask(v, kNanOrInfinite, -1) == 0;
#else
    constexpr std::int64_t kExponent = 0x7ff0000000000000;
    return bits_of((reinterpret_cast<const Bits&>(v) & kExponent) == kExponent) == 0;
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
  /// The same; what is not finite becomes 0, and its bit in `missing` is set, else cleared.
  [[gnu::always_inline]] static Register finite_floats(const char* from, unsigned& missing) {
    FloatBits bits;
    std::memcpy(&bits, from, sizeof bits);
    return {Width::finite(bits, missing)};
  }
  [[gnu::always_inline]] bool all_finite() const { return Width::all_finite(v); }
  /// sum + x x, where x is a 32-bit float: its square is exact, so that it does not matter whether
  /// the processor rounds between product and sum.
  [[gnu::always_inline]] static Register plus_square(Register sum, Register x) {
    return {Width::plus_square(sum.v, x.v)};
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

  [[gnu::always_inline]] static Twice load(const double* from) {
    return {Half::load(from), Half::load(from + Half::size)};
  }
  [[gnu::always_inline]] static Twice all(double value) {
    return {Half::all(value), Half::all(value)};
  }
  [[gnu::always_inline]] static Twice floats(const char* from) {
    return {Half::floats(from), Half::floats(from + 4 * Half::size)};
  }
  [[gnu::always_inline]] static Twice finite_floats(const char* from, unsigned& missing) {
    unsigned above = 0;
    const Half first = Half::finite_floats(from, missing);
    const Half second = Half::finite_floats(from + 4 * Half::size, above);
    missing |= above << Half::size;
    return {first, second};
  }
  [[gnu::always_inline]] bool all_finite() const {
    return static_cast<int>(low.all_finite()) + static_cast<int>(high.all_finite()) == 2;
  }
  [[gnu::always_inline]] static Twice plus_square(Twice sum, Twice x) {
    return {Half::plus_square(sum.low, x.low), Half::plus_square(sum.high, x.high)};
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
[[gnu::target("avx2,fma")]] void run_avx2(Arguments... arguments) {
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
