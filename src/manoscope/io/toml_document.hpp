#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace manoscope::io {

/// One value of a TOML document and the line it stands on.
struct TomlValue {
  enum class Kind { text, integer, real, boolean, date, list, table };

  Kind kind = Kind::table;
  int line = 0;                   ///< 1-based; of a [section], its head
  std::string text;               ///< of a text: the text; of another scalar: as in a message
  double number = 0.0;            ///< of an integer or real
  std::vector<std::string> keys;  ///< of a table: names of `items`, in the order of the file
  std::vector<TomlValue> items;   ///< of a list or table

  /// The value of a key of this table, nullptr if absent.
  const TomlValue* find(const std::string& key) const;
};

/// Reads a TOML 1.0 document.
///
/// @throws InputError for a syntax error (naming line, column and the line's text; a parser cannot
///         go on behind the first), and for texts nobody needs: over 4 MB, or keys nested
///         dozens deep.
TomlValue parse_toml(const std::string& text, const std::filesystem::path& file);

}  // namespace manoscope::io
