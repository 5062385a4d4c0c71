#include "manoscope/core/unit_text.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <charconv>
#include <cmath>
#include <memory>
#include <mutex>

#include "manoscope/core/error.hpp"

namespace manoscope {
namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;
using Converter = std::unique_ptr<cv_converter, FreeConverter>;

/// udunits keeps its database and its parser's state in globals: one owner, one lock.
class UnitDatabase {
 public:
  static UnitDatabase& instance() {
    static UnitDatabase database;
    return database;
  }

  Unit parse(std::string_view text) {
    const std::string terminated(text);
    return Unit(ut_parse(system_, terminated.c_str(), UT_UTF8));
  }

  std::mutex& lock() { return mutex_; }

 private:
  UnitDatabase() {
    ut_set_error_message_handler(ut_ignore);
    system_ = ut_read_xml(nullptr);
    if (system_ == nullptr) {
      throw InputError("units", "the unit database of udunits-2 cannot be read",
                       "Install the package libudunits2-0 or set UDUNITS2_XML_PATH");
    }
    // Symbols of our field that the database lacks.
    for (const auto& [symbol, meaning] :
         {std::pair{"cP", "1e-3 Pa s"}, std::pair{"cSt", "1e-6 m2 s-1"},
          std::pair{"mmH2O", "9.80665 Pa"}, std::pair{"deg", "arc_degree"}}) {
      const Unit unit = parse(meaning);
      ut_map_symbol_to_unit(symbol, UT_ASCII, unit.get());
    }
  }
  ~UnitDatabase() { ut_free_system(system_); }
  UnitDatabase(const UnitDatabase&) = delete;
  UnitDatabase& operator=(const UnitDatabase&) = delete;

  ut_system* system_ = nullptr;
  std::mutex mutex_;
};

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

}  // namespace

std::optional<UnitScale> unit_scale(std::string_view unit, std::string_view si_unit) {
  unit = trim(unit);
  // udunits reads "" and bare numbers as units of 1: neither names a unit.
  if (unit.empty() || unit.size() > 64 || parse_number(unit)) return std::nullopt;
  UnitDatabase& database = UnitDatabase::instance();
  const std::scoped_lock guard(database.lock());
  const Unit from = database.parse(unit);
  const Unit to = database.parse(si_unit);
  if (!from || !to || ut_are_convertible(from.get(), to.get()) == 0) return std::nullopt;
  const Converter converter(ut_get_converter(from.get(), to.get()));
  if (!converter) return std::nullopt;
  // Probed away from 0, where a reciprocal unit divides by zero.
  const double at_one = cv_convert_double(converter.get(), 1.0);
  const double at_two = cv_convert_double(converter.get(), 2.0);
  const double factor = at_two - at_one;
  const UnitScale scale{factor, at_one - factor};
  // "s/m" towards "m/s" counts as convertible in udunits, but is not linear: refuse it.
  const double probe = cv_convert_double(converter.get(), 4.0);
  if (!std::isfinite(scale.factor) || !std::isfinite(probe) ||
      std::abs(probe - scale.to_si(4.0)) > 1e-9 * std::abs(probe)) {
    return std::nullopt;
  }
  return scale;
}

bool is_known_unit(std::string_view unit) {
  unit = trim(unit);
  if (unit.empty() || unit.size() > 64) return false;
  UnitDatabase& database = UnitDatabase::instance();
  const std::scoped_lock guard(database.lock());
  return database.parse(unit) != nullptr;
}

std::optional<double> parse_number(std::string_view text) {
  text = trim(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

double parse_si(std::string_view text, const char* si_unit, const char* kind, const char* example,
                const std::string& where) {
  const std::string wanted = fmt::format("Write the {} with its unit, e.g. \"{}\"", kind, example);
  std::string_view rest = trim(text);
  if (rest.starts_with('+')) rest.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc()) {
    throw InputError(where, fmt::format("\"{}\" does not start with a number", text), wanted);
  }
  const std::string_view unit = trim(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (unit.empty()) {
    throw InputError(where, fmt::format("\"{}\" has no unit", text), wanted);
  }
  const auto scale = unit_scale(unit, si_unit);
  if (!scale) {
    throw InputError(where,
                     is_known_unit(unit)
                         ? fmt::format("\"{}\" is not a {}: wrong unit \"{}\"", text, kind, unit)
                         : fmt::format("\"{}\" has an unknown unit \"{}\"", text, unit),
                     wanted);
  }
  const double value = scale->to_si(number);
  if (!std::isfinite(value)) {
    throw InputError(where, fmt::format("\"{}\" is not finite", text), wanted);
  }
  return value;
}

}  // namespace manoscope
