#pragma once

#include "manoscope/core/error.hpp"

namespace manoscope::serve {

/// An InputError with a status of its own; without one an input at fault is told with 422.
class ApiError : public InputError {
 public:
  ApiError(unsigned status, std::string where, std::string found, std::string mend)
      : InputError(std::move(where), std::move(found), std::move(mend)), status_(status) {}

  unsigned status() const { return status_; }

 private:
  unsigned status_;
};

}  // namespace manoscope::serve
