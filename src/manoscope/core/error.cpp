#include "manoscope/core/error.hpp"

#include <fmt/format.h>

namespace manoscope {
namespace {

std::string join(const std::vector<InputError>& faults) {
  std::string text;
  for (const InputError& fault : faults) {
    if (!text.empty()) text += '\n';
    text += fault.what();
  }
  return text;
}

}  // namespace

InputError::InputError(std::string where, std::string found, std::string mend)
    : std::runtime_error(fmt::format("{}: {}. {}.", where, found, mend)),
      where_(std::move(where)),
      found_(std::move(found)),
      mend_(std::move(mend)) {}

InputErrors::InputErrors(std::vector<InputError> faults)
    : std::runtime_error(join(faults)), faults_(std::move(faults)) {}

namespace detail {

void assertion_failed(const char* condition, const char* file, int line) {
  throw InternalError(fmt::format("{}:{}: broken promise: {}", file, line, condition));
}

}  // namespace detail
}  // namespace manoscope
