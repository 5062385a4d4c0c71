#include "manoscope/report/html_interactive.hpp"

#include <fmt/format.h>

#include "manoscope/core/base64.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/report/packed.hpp"
#include "manoscope/report/page_bundle.hpp"
#include "manoscope/report/page_data.hpp"

namespace manoscope::report {
namespace {

std::string bytes_of_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return bytes;
}

}  // namespace

std::string interactive_head() {
  // Styles stand in the figures' elements, too; nothing that they could load is allowed.
  return fmt::format(
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
      "'sha256-{}'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action "
      "'none'\">\n<style>{}</style>\n",
      base64(bytes_of_hex(sha256(page_script()))), page_style());
}

std::string interactive_place(const results::Measurement& m) {
  std::string place =
      "<div id=\"explore\"><noscript><p>With scripts allowed this page shows maps, curves and "
      "p(x) to explore; figures and tables below hold the same numbers.</p></noscript></div>\n";
  if (m.map_picture.empty()) {
    place +=
        "<p id=\"no-maps\">The deflection maps are not at hand (no <code>maps.nc</code> beside the "
        "result): the page shows curves and pressures without them. Measuring again writes "
        "it.</p>\n";
  }
  place +=
      "<script type=\"text/plain\" id=\"report-data\">" + pack_text(page_data(m)) + "</script>\n";
  return place + "<script>" + std::string(page_script()) + "</script>\n";
}

std::string interactive_tail(const results::Measurement& m) {
  std::string tail;
  for (std::size_t i = 0; i < m.map_picture.size(); ++i) {
    tail += fmt::format("<script type=\"text/plain\" id=\"map-{}\">", i) +
            pack_counts(m.map_picture[i].counts) + "</script>\n";
  }
  return tail;
}

}  // namespace manoscope::report
