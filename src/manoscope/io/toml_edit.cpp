#include "manoscope/io/toml_edit.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/io/toml_comments.hpp"
#include "manoscope/io/toml_document.hpp"

namespace manoscope::io {
namespace {

constexpr const char* kWhere = "experiment.toml";

[[noreturn]] void refuse(const std::string& section, const std::string& key) {
  throw InputError(kWhere,
                   fmt::format("{} is written in a way that only a text editor can change",
                               section.empty() ? key : "section [" + section + "]"),
                   "Change the text itself");
}

/// A document with the places of its keys.
class Document {
 public:
  explicit Document(const std::string& text) : text_(text) {
    parse_toml(text, kWhere);  // refuses what the parser cannot bear, and says why in words
    root_ = toml::parse(text);
    lines_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') lines_.push_back(i + 1);
    }
  }

  const toml::table& root() const { return root_; }
  const toml::table* section(const std::string& name) const {
    if (name.empty()) return &root_;
    const toml::node* node = root_.get(name);
    return node == nullptr ? nullptr : node->as_table();
  }
  /// Byte of a place; the parser counts the characters of a line, not its bytes.
  std::size_t offset(toml::source_position at) const {
    if (at.line == 0 || at.line > lines_.size()) return text_.size();
    std::size_t byte = lines_[at.line - 1];
    for (std::uint32_t column = 1; column < at.column && byte < text_.size(); ++column) {
      ++byte;
      while (byte < text_.size() && (static_cast<unsigned char>(text_[byte]) & 0xC0) == 0x80)
        ++byte;
    }
    return byte;
  }
  std::size_t line_begin(std::size_t byte) const {
    return byte == 0 ? 0 : text_.rfind('\n', byte - 1) + 1;
  }
  /// Behind the end of the line.
  std::size_t line_end(std::size_t byte) const {
    const auto end = text_.find('\n', byte);
    return end == std::string::npos ? text_.size() : end + 1;
  }

 private:
  const std::string& text_;
  toml::table root_;
  std::vector<std::size_t> lines_;
};

bool is_head(const toml::node& node) {
  const toml::table* table = node.as_table();
  return (table != nullptr && !table->is_inline()) || node.is_array_of_tables();
}

std::optional<toml::source_position> key_begin(const toml::table& table, const std::string& key) {
  for (const auto& [known, value] : table) {
    if (known.str() == key) return known.source().begin;
  }
  return std::nullopt;
}

/// Where the last value that stands in the table itself ends; nullopt without any.
std::optional<std::size_t> last_value_end(const Document& document, const toml::table& table) {
  std::optional<std::size_t> last;
  for (const auto& [key, value] : table) {
    if (is_head(value)) continue;
    last = std::max(last.value_or(0), document.offset(value.source().end));
  }
  return last;
}

const char* line_end_of(const std::string& text) {
  return text.find("\r\n") == std::string::npos ? "\n" : "\r\n";
}

/// The first byte behind the head of a section.
std::size_t first_line_in(const Document& document, const toml::table& table,
                          const std::string& section) {
  return section.empty() ? 0 : document.line_end(document.offset(table.source().begin));
}

std::string insert_line(const std::string& text, std::size_t at, const std::string& line) {
  const std::string end = line_end_of(text);
  const bool open = at > 0 && text[at - 1] != '\n';
  return text.substr(0, at) + (open ? end : "") + line + end + text.substr(at);
}

toml::table with_value(const toml::table& table, const std::string& key, const std::string& value) {
  toml::table changed = table;
  const toml::table read = toml::parse("value = " + value);
  read.get("value")->visit([&](const auto& node) { changed.insert_or_assign(key, node); });
  return changed;
}

/// The document that is wanted: `changed` in place of a section.
toml::table with_section(const toml::table& root, const std::string& section, toml::table changed) {
  if (section.empty()) return changed;
  toml::table whole = root;
  whole.insert_or_assign(section, std::move(changed));
  return whole;
}

/// @throws InputError unless `text` says what is wanted and nothing else.
std::string checked(std::string text, const toml::table& wanted, const std::string& section,
                    const std::string& key) {
  try {
    if (toml::parse(text) == wanted) return text;
  } catch (const toml::parse_error&) {
    // told below
  }
  refuse(section, key);
}

bool only_blanks(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

/// Comments as lines of their own in a document.
std::string lines_of(const std::vector<std::string>& comments, const std::string& indent,
                     const std::string& document) {
  std::string lines;
  for (const std::string& comment : comments) {
    lines += indent;
    lines += comment;
    lines += line_end_of(document);
  }
  return lines;
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

}  // namespace

std::string with_toml_value(const std::string& text, const std::string& section,
                            const std::string& key, const std::string& value) {
  const Document document(text);
  const toml::table* table = document.section(section);
  if (table == nullptr && document.root().contains(section)) refuse(section, key);
  const toml::table wanted = with_section(document.root(), section,
                                          with_value(table ? *table : toml::table{}, key, value));
  const std::string end_of_line = line_end_of(text);
  const std::string written = end_of_line == "\n" ? value : replaced(value, "\n", end_of_line);
  const std::string line = key + " = " + written;
  std::string changed;
  if (table == nullptr) {
    const bool spaced = text.empty() || text.ends_with("\n\n") || text.ends_with("\n\r\n");
    const std::string head = "[" + section + "]" + end_of_line;
    changed = insert_line(text, text.size(), (spaced ? "" : end_of_line) + head + line);
  } else if (const toml::node* node = table->get(key)) {
    const std::size_t begin = document.offset(node->source().begin);
    const std::size_t end = document.offset(node->source().end);
    changed = text.substr(0, begin) + written + text.substr(end);
  } else if (const auto kept =
                 find_kept_comment(text, first_line_in(document, *table, section), key);
             kept && !table->is_inline()) {
    changed = text.substr(0, kept->begin) + line + text.substr(kept->end);
  } else if (const auto last = last_value_end(document, *table); table->is_inline()) {
    const std::size_t at = last ? *last : document.offset(table->source().begin) + 1;
    changed = text.substr(0, at) + (last ? ", " : "") + line + text.substr(at);
  } else if (last || !section.empty()) {
    const std::size_t at = last ? *last : document.offset(table->source().begin);
    changed = insert_line(text, document.line_end(at), line);
  } else {
    changed = insert_line(text, 0, line);
  }
  return checked(std::move(changed), wanted, section, key);
}

std::string without_toml_key(const std::string& text, const std::string& section,
                             const std::string& key) {
  const Document document(text);
  const toml::table* table = document.section(section);
  const toml::node* node = table == nullptr ? nullptr : table->get(key);
  if (node == nullptr) return text;
  toml::table changed = *table;
  changed.erase(key);
  const std::size_t name = document.offset(*key_begin(*table, key));
  const std::size_t begin = document.line_begin(name), value = document.offset(node->source().end);
  const std::size_t end = document.line_end(value);
  const std::string_view behind = std::string_view(text).substr(value, end - value);
  const auto comment = std::min(behind.find('#'), behind.size());
  if (!only_blanks(std::string_view(text).substr(begin, name - begin)) ||
      !only_blanks(behind.substr(0, comment))) {
    refuse(section, key);
  }
  std::vector<std::string> kept = comments_in(std::string_view(text).substr(begin, end - begin));
  if (comment < behind.size()) {
    kept.back() = mark_of(key) + text.substr(value, comment) + kept.back();
  }
  const std::string indent = text.substr(begin, name - begin);
  return checked(text.substr(0, begin) + lines_of(kept, indent, text) + text.substr(end),
                 with_section(document.root(), section, std::move(changed)), section, key);
}

std::string without_toml_section(const std::string& text, const std::string& section) {
  const Document document(text);
  const toml::table* table = document.section(section);
  if (table == nullptr) return text;
  toml::table wanted = document.root();
  wanted.erase(section);
  const std::size_t head = document.offset(table->source().begin);
  const std::size_t last = last_value_end(document, *table).value_or(head);
  const std::size_t begin = document.line_begin(head), end = document.line_end(last);
  const auto kept = comments_in(std::string_view(text).substr(begin, end - begin));
  return checked(text.substr(0, begin) + lines_of(kept, "", text) + text.substr(end), wanted,
                 section, "");
}

std::map<std::string, std::string> toml_comments(const std::string& text) {
  const Document document(text);
  std::map<std::string, std::string> comments;
  const auto look = [&](const toml::table& table, const std::string& prefix) {
    for (const auto& [key, value] : table) {
      if (is_head(value)) continue;
      const std::size_t end = document.offset(value.source().end);
      std::string_view rest = std::string_view(text).substr(end, document.line_end(end) - end);
      const auto begin = rest.find_first_not_of(" \t");
      if (begin == std::string_view::npos || rest[begin] != '#') continue;
      rest.remove_prefix(begin + 1);
      const auto first = rest.find_first_not_of(" \t\r\n");
      if (first == std::string_view::npos) continue;
      rest = rest.substr(first, rest.find_last_not_of(" \t\r\n") - first + 1);
      comments.emplace(prefix + std::string(key.str()), rest);
    }
  };
  look(document.root(), "");
  for (const auto& [key, value] : document.root()) {
    const toml::table* table = value.as_table();
    if (table != nullptr && !table->is_inline()) look(*table, std::string(key.str()) + ".");
  }
  return comments;
}

std::string toml_quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (code < 0x20 || code == 0x7F) {
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(code));
      continue;
    }
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  return quoted + '"';
}

}  // namespace manoscope::io
