#pragma once

#include <map>
#include <string>

namespace manoscope::io {

/// Changes of single keys in the text of a TOML document; every other byte, comments too, stays.
///
/// `section` is a table at the top of the document, "" the top itself. What is returned was read
/// again: it differs from the old document in that key alone.
/// @throws InputError if the text is no TOML, or the section is written in a way that these
///         functions do not take apart (dotted keys, several keys in one line).

/// Sets a key to a value in TOML's own writing. One that is there is replaced in its place, and one
/// whose comment without_toml_key() has kept comes back there; a new one comes behind the last of
/// its section, a new section at the end.
std::string with_toml_value(const std::string& text, const std::string& section,
                            const std::string& key, const std::string& value);
/// Takes the line of a key out; the same text if it is not there. Comments in it stay as lines of
/// their own, the one behind the value as `# key =  # comment`.
std::string without_toml_key(const std::string& text, const std::string& section,
                             const std::string& key);
/// Takes out a section from its head to its last key; the same text if it is not there. Comments in
/// it stay as lines of their own.
std::string without_toml_section(const std::string& text, const std::string& section);

/// What stands behind a key's value as a comment in its line, by "section.key" (at the top: "key"):
/// without the '#' and the blanks around it.
std::map<std::string, std::string> toml_comments(const std::string& text);

/// A text as TOML writes it, in double quotes.
std::string toml_quoted(const std::string& text);

}  // namespace manoscope::io
