#pragma once

#include <nlohmann/json_fwd.hpp>

#include "manoscope/io/map_summary.hpp"

namespace manoscope::io {

/// {"file", "format", "orientation", "channels": [{"name", "nx", ...}]}, SI units; null for what
/// the file does not tell.
nlohmann::json summary_json(const MapSummary& summary);

}  // namespace manoscope::io
