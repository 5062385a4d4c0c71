#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace manoscope {

/// A fault the user can mend: where it is, what was found there, what to do about it.
///
/// The command line prints it and exits with 2.
class InputError : public std::runtime_error {
 public:
  InputError(std::string where, std::string found, std::string mend);

  const std::string& where() const { return where_; }
  const std::string& found() const { return found_; }
  const std::string& mend() const { return mend_; }

 private:
  std::string where_, found_, mend_;
};

/// Every fault of one input, reported together.
class InputErrors : public std::runtime_error {
 public:
  explicit InputErrors(std::vector<InputError> faults);

  const std::vector<InputError>& faults() const { return faults_; }

 private:
  std::vector<InputError> faults_;
};

/// A fault of ours: a broken promise inside the program. Exit code 1.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// The user asked to stop (Ctrl-C). Exit code 130.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

namespace detail {
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);
}

}  // namespace manoscope

/// States what must hold at this point; throws InternalError where it does not.
#if defined(MANOSCOPE_ASSERTS) && MANOSCOPE_ASSERTS
#define MANO_ASSERT(condition) \
  ((condition) ? void(0) : ::manoscope::detail::assertion_failed(#condition, __FILE__, __LINE__))
#else
#define MANO_ASSERT(condition) (static_cast<void>(sizeof(!(condition))))
#endif
