#include "manoscope/io/toml_comments.hpp"

#include <algorithm>

namespace manoscope::io {
namespace {

/// Behind the text in quotes that begins at `at`.
std::size_t behind_quotes(std::string_view text, std::size_t at) {
  const char quote = text[at];
  std::string end(3, quote);
  if (!text.substr(at).starts_with(end)) end.resize(1);
  for (std::size_t i = at + end.size(); i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text.substr(i).starts_with(end)) {
      i += end.size();
      while (end.size() == 3 && i < text.size() && text[i] == quote) ++i;  // """a quote""""
      return i;
    }
  }
  return text.size();
}

}  // namespace

std::vector<std::string> comments_in(std::string_view lines) {
  std::vector<std::string> comments;
  for (std::size_t i = 0; i < lines.size();) {
    if (lines[i] == '"' || lines[i] == '\'') {
      i = behind_quotes(lines, i);
    } else if (lines[i] == '#') {
      const std::size_t end = std::min(lines.find_first_of("\r\n", i), lines.size());
      comments.emplace_back(lines.substr(i, end - i));
      i = end;
    } else {
      ++i;
    }
  }
  return comments;
}

std::string mark_of(const std::string& key) { return "# " + key + " ="; }

std::optional<KeptComment> find_kept_comment(std::string_view text, std::size_t from,
                                             const std::string& key) {
  const std::string mark = mark_of(key);
  for (std::size_t at = from; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    const std::size_t first = std::min(line.find_first_not_of(" \t"), line.size());
    const std::string_view rest = line.substr(first);
    if (rest.starts_with('[')) return std::nullopt;  // the next section
    const std::string_view behind = rest.substr(std::min(mark.size(), rest.size()));
    const std::size_t comment = behind.find_first_not_of(" \t");
    if (rest.starts_with(mark) && comment != std::string_view::npos && behind[comment] == '#') {
      return KeptComment{at + first, at + first + mark.size()};
    }
    at = end + 1;
  }
  return std::nullopt;
}

}  // namespace manoscope::io
