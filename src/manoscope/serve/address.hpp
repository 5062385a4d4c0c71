#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace manoscope::serve {

/// What a request names: the parts of its path and its query, percent-decoded once.
struct Address {
  std::vector<std::string> parts;  ///< "/api/state" gives {"api", "state"}; "/" none
  std::vector<std::pair<std::string, std::string>> query;

  /// The value of a name that is there once.
  std::optional<std::string> value(std::string_view name) const;
};

/// Takes the target of a request apart.
///
/// Nullopt for what no honest client sends: a target that does not begin with '/', a percent that
/// encodes nothing, a part that is empty, "." or "..", holds '/' or '\' or a control character, or
/// is no UTF-8, in whatever encoding; a name in the query that stands there twice.
std::optional<Address> parse_address(std::string_view target);

/// Parts of a relative path in a query or a body, "a/b.gsf"; "" gives none. Nullopt as above, and
/// for a part that is hidden (begins with a dot) or longer than a file's name can be.
std::optional<std::vector<std::string>> relative_parts(std::string_view path);

/// Whether a part may name a file or folder that is served or written.
bool is_plain_name(std::string_view part);

/// "a/b.gsf"
std::string join(const std::vector<std::string>& parts);

/// The path of a name in a folder, "" being the one that is served.
std::string under(const std::string& folder, const std::string& name);

bool is_utf8(std::string_view text);

}  // namespace manoscope::serve
