#include "manoscope/serve/result_api.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "manoscope/report/summary_json.hpp"
#include "manoscope/results/write.hpp"
#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/json.hpp"

namespace manoscope::serve {
namespace {

using nlohmann::json;

/// A report may run its own script, and a file that only calls itself a report too: both in an
/// origin of their own, out of reach of this server's pages, without a way to anywhere.
constexpr const char* kReportPolicy =
    "sandbox allow-scripts allow-downloads allow-popups allow-modals; default-src 'none'; "
    "script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'self'";
constexpr const char* kNoPage = "sandbox; default-src 'none'; style-src 'unsafe-inline'";

/// "" for what is not handed out.
std::string type_of(const std::string& extension) {
  constexpr std::pair<const char*, const char*> kTypes[] = {{".html", "text/html; charset=utf-8"},
                                                            {".csv", "text/csv; charset=utf-8"},
                                                            {".nc", "application/x-netcdf"},
                                                            {".svg", "image/svg+xml"},
                                                            {".png", "image/png"},
                                                            {".txt", "text/plain; charset=utf-8"},
                                                            {".json", "application/json"},
                                                            {".toml", "text/plain; charset=utf-8"},
                                                            {".pdf", "application/pdf"}};
  for (const auto& [known, type] : kTypes) {
    if (extension == known) return type;
  }
  return "";
}

json row_json(const Array2& values, Index row) {
  json list = json::array();
  for (const double value : values.row(row)) list.push_back(number(value));
  return list;
}

}  // namespace

Reply result_file_reply(const Folder& folder, const Address& address) {
  const std::vector<std::string> parts(address.parts.begin() + 1, address.parts.end());
  const std::string name = join(parts);
  Reply reply;
  reply.type = type_of(std::filesystem::path(name).extension().string());
  if (relative_parts(name) && !reply.type.empty())
    reply.file = folder.open(name, Folder::Kind::file);
  if (!reply.file) {
    throw ApiError(404, name, "there is no such file", "Measure again, or look at its spelling");
  }
  reply.file_size = status_of(reply.file).size;
  const bool page = reply.type.starts_with("text/html");
  reply.headers.emplace_back("Content-Security-Policy", page ? kReportPolicy : kNoPage);
  if (address.value("download")) {
    reply.headers.emplace_back("Content-Disposition", "attachment");
  }
  return reply;
}

Reply result_reply(const Folder& folder, const Address& address) {
  const std::string name = address.value("folder").value_or("");
  const std::string file = under(name, "result.nc");
  if (!relative_parts(name) || !folder.has(file, Folder::Kind::file)) {
    throw ApiError(404, name, "the folder holds no result", "Name a folder with a result.nc");
  }
  const results::Measurement measurement = results::read_result(folder.absolute(file));
  json summary = report::summary_json(measurement, name);
  summary["title"] = measurement.title;
  summary["x_m"] = json::array();
  for (const double x : measurement.x) summary["x_m"].push_back(x);
  for (Index run = 0; run < measurement.flow_rate.size(); ++run) {
    json& told = summary["runs"][static_cast<std::size_t>(run)];
    told["pressure_Pa"] = row_json(measurement.pressure, run);
    told["pressure_uncertainty_Pa"] = row_json(measurement.pressure_uncertainty, run);
    told["deflection_m"] = row_json(measurement.deflection, run);
  }
  return json_reply(summary);
}

}  // namespace manoscope::serve
