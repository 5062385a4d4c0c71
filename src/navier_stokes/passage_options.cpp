#include "passage_options.hpp"

#include <fmt/format.h>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

void check_word(const char* name, const std::string& word, const char* first, const char* second) {
  if (word == first || word == second) return;
  throw InputError(fmt::format("--{}", name), fmt::format("\"{}\" is neither", word),
                   fmt::format("Choose {} or {}", first, second));
}

}  // namespace

SimulatedPassage passage_of(const PassageOptions& options) {
  check_word("passage", options.passage, "inlet", "outlet");
  check_word("port-side", options.port_side, "top", "side");
  options.mesh.validate();
  SimulatedPassage given = options.given;
  given.end = options.passage == "inlet" ? PassageEnd::inlet : PassageEnd::outlet;
  given.port_side = options.port_side == "top" ? PortSide::top : PortSide::side;
  given.validate();
  return given;
}

}  // namespace manoscope::navier_stokes
