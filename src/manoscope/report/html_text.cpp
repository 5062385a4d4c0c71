#include "manoscope/report/html_text.hpp"

namespace manoscope::report {

std::string escape_html(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char letter : text) {
    switch (letter) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default: {
        const auto byte = static_cast<unsigned char>(letter);
        const bool is_control = (byte < 0x20 && letter != '\t' && letter != '\n') || byte == 0x7f;
        if (is_control) {
          escaped += "\xEF\xBF\xBD";
        } else {
          escaped += letter;
        }
      }
    }
  }
  return escaped;
}

}  // namespace manoscope::report
