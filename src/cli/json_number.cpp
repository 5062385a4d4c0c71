#include "json_number.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace manoscope::cli {

using nlohmann::json;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json numbers(const Array1& values) {
  json all = json::array();
  for (const double value : values) all.push_back(number(value));
  return all;
}

}  // namespace manoscope::cli
