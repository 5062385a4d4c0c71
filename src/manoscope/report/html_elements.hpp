#pragma once

#include <string>
#include <string_view>

namespace manoscope::report {

/// A table cell; `content` is HTML.
std::string cell(const std::string& content);
/// The head of a row; `label` is text.
std::string row_head(std::string_view label);
/// The head of a column; `content` is HTML.
std::string column_head(const std::string& content);
/// How often chance does something, or a power of ten where that is rare; as HTML, in colour below
/// `least`, where it is no chance.
std::string chance_text(double chance, double least);
/// A table that scrolls by itself where the page is narrow, and where it is `tall`.
std::string table(const std::string& caption, const std::string& head, const std::string& body,
                  bool tall = false);

}  // namespace manoscope::report
