#include "manoscope/io/xml_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/file_text.hpp"

namespace manoscope::io {

void parse_xml(std::string& text, pugi::xml_document& document, const std::string& where) {
  // A node takes about 64 bytes, an attribute 40.
  std::size_t n_nodes = 0;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    n_nodes += (text[i] == '<' && text[i + 1] != '/') || text[i] == '=' ? 1 : 0;
  }
  if (64 * n_nodes > 8 * text.size() + (std::size_t{1} << 20)) {
    throw InputError(where, fmt::format("has {} elements in {} bytes", n_nodes, text.size()),
                     "The file is damaged or not what it says; export the map again");
  }
  const pugi::xml_parse_result result = document.load_buffer_inplace(
      text.data(), text.size(), pugi::parse_default | pugi::parse_embed_pcdata);
  if (!result) {
    throw InputError(
        where,
        fmt::format("is not well-formed XML: {} (at byte {})", result.description(), result.offset),
        "The file is damaged; copy or export it again");
  }
}

std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const auto colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_node& child : node.children()) {
    if (local_name(child) == name) return child;
  }
  return {};
}

std::string_view text_of(const pugi::xml_node& node, std::string_view name) {
  return trimmed(child_of(node, name).text().get());
}

std::optional<double> number_of(const pugi::xml_node& node, std::string_view name,
                                const std::string& where) {
  const std::string_view text = text_of(node, name);
  if (text.empty()) return std::nullopt;
  const auto value = parse_number(text);
  if (!value || !std::isfinite(*value)) {
    throw InputError(where, fmt::format("{} is \"{}\", not a number", name, excerpt(text)),
                     "Export the map again");
  }
  return value;
}

}  // namespace manoscope::io
