#pragma once

// For the readers of XML-based formats; includes pugixml, so not for other headers.

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace manoscope::io {

/// Parses untrusted XML in place: `text` is overwritten and must outlive the document.
///
/// No entity but the five of XML is expanded. Text stands in the element itself.
/// @throws InputError(where, ...) if it is not well-formed, or if its elements are so many and
///         short that they would take far more memory than the text.
void parse_xml(std::string& text, pugi::xml_document& document, const std::string& where);

/// Name of an element without its namespace prefix.
std::string_view local_name(const pugi::xml_node& node);

/// The first child of that local name; empty if there is none.
pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name);

/// The text of a child, without blanks around it; "" if there is none.
std::string_view text_of(const pugi::xml_node& node, std::string_view name);

/// The text of a child as a finite number; nullopt if there is none or it is empty.
/// @throws InputError(where, ...) if it is no finite number.
std::optional<double> number_of(const pugi::xml_node& node, std::string_view name,
                                const std::string& where);

}  // namespace manoscope::io
