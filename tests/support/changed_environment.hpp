#pragma once

#include <cstdlib>
#include <string>

namespace manoscope::test_support {

/// An environment variable with another value while the object lives.
class ChangedEnvironment {
 public:
  ChangedEnvironment(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) {
      before_ = before;
      was_set_ = true;
    }
    ::setenv(name, value, 1);
  }
  ~ChangedEnvironment() {
    if (was_set_) {
      ::setenv(name_.c_str(), before_.c_str(), 1);
    } else {
      ::unsetenv(name_.c_str());
    }
  }
  ChangedEnvironment(const ChangedEnvironment&) = delete;
  ChangedEnvironment& operator=(const ChangedEnvironment&) = delete;

 private:
  std::string name_, before_;
  bool was_set_ = false;
};

}  // namespace manoscope::test_support
