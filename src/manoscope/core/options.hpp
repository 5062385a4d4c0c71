#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/suggest.hpp"
#include "manoscope/core/unit_text.hpp"

namespace manoscope {

/// One option as a person meets it: in help, manual, or the settings of a result.
struct OptionInfo {
  std::string name;   ///< "smoothing"
  std::string value;  ///< text of the present value, with its unit: "5e-05 m"
  std::string help;
  std::string kind;  ///< "length", "number", "integer", "yes or no", "text"
};

namespace option_text {

std::string write(double value);
std::string write(int value);
std::string write(std::uint64_t value);
std::string write(bool value);
std::string write(const std::string& value);
template <int M, int L, int T, int A>
std::string write(Quantity<M, L, T, A> value) {
  return write(value.si()) + " " + UnitOf<Quantity<M, L, T, A>>::name;
}
template <class T>
std::string write(const std::optional<T>& value) {
  return value ? write(*value) : std::string("auto");
}

void read(std::string_view text, const std::string& where, double& value);
void read(std::string_view text, const std::string& where, int& value);
void read(std::string_view text, const std::string& where, std::uint64_t& value);
void read(std::string_view text, const std::string& where, bool& value);
void read(std::string_view text, const std::string& where, std::string& value);
template <int M, int L, int T, int A>
void read(std::string_view text, const std::string& where, Quantity<M, L, T, A>& value) {
  value = parse_quantity<Quantity<M, L, T, A>>(text, where);
}
template <class T>
void read(std::string_view text, const std::string& where, std::optional<T>& value) {
  if (text == "auto") {
    value.reset();
    return;
  }
  T parsed{};
  read(text, where, parsed);
  value = parsed;
}

inline std::string kind(const double&) { return "number"; }
inline std::string kind(const int&) { return "integer"; }
inline std::string kind(const std::uint64_t&) { return "integer"; }
inline std::string kind(const bool&) { return "yes or no"; }
inline std::string kind(const std::string&) { return "text"; }
template <int M, int L, int T, int A>
std::string kind(const Quantity<M, L, T, A>&) {
  return UnitOf<Quantity<M, L, T, A>>::kind;
}
template <class T>
std::string kind(const std::optional<T>&) {
  return kind(T{}) + " or auto";
}

}  // namespace option_text

/// All options of a struct with a `describe(visitor)` member, in its order.
template <class Options>
std::vector<OptionInfo> list_options(const Options& options) {
  std::vector<OptionInfo> list;
  Options copy = options;
  copy.describe([&](const char* name, auto& value, const char* help) {
    list.push_back({name, option_text::write(value), help, option_text::kind(value)});
  });
  return list;
}

/// Sets one option by name from text; dimensional options need their unit.
///
/// @throws InputError for an unknown name (with the nearest known one) or a bad value.
template <class Options>
void set_option(Options& options, std::string_view name, std::string_view text,
                const std::string& where) {
  bool found = false;
  std::vector<std::string> names;
  options.describe([&](const char* known, auto& value, const char*) {
    names.emplace_back(known);
    if (name != known) return;
    option_text::read(text, where, value);
    found = true;
  });
  if (!found) {
    throw InputError(where,
                     "unknown option \"" + std::string(name) + "\"" + did_you_mean(name, names),
                     "See the list of options in the help");
  }
}

}  // namespace manoscope
