#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace manoscope::io {

/// The comments in whole lines of a TOML document, each from its '#' to the end of its line.
std::vector<std::string> comments_in(std::string_view lines);

/// What a line that kept the comment of a removed key begins with: "# key =".
std::string mark_of(const std::string& key);

/// Where that stands in a document.
struct KeptComment {
  std::size_t begin = 0, end = 0;
};
/// The line of a section that kept the comment of a key: `# key =  # comment`, nothing between the
/// sign and the comment.
/// @param from  a byte behind the section's head.
std::optional<KeptComment> find_kept_comment(std::string_view text, std::size_t from,
                                             const std::string& key);

}  // namespace manoscope::io
