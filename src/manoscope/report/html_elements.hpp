#pragma once

#include <string>
#include <string_view>

#include "manoscope/report/flow_verdict.hpp"

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
/// Class of a verdict in the page's style: "good", "half", "bad", "none".
const char* verdict_style(FlowVerdict verdict);
/// A model or simulation against a reading: verdict, difference as a share, E_n and chance.
/// @param doubtful  drawn hollow.
std::string agreement_cell(FlowVerdict verdict, bool doubtful, double share, double en_number,
                           double p_value);
/// A table that scrolls by itself where the page is narrow, and where it is `tall`.
std::string table(const std::string& caption, const std::string& head, const std::string& body,
                  bool tall = false);

}  // namespace manoscope::report
