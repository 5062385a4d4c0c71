#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

/// An answer in JSON; what is no UTF-8 in it is replaced.
Reply json_reply(const nlohmann::json& content, unsigned status = 200);

/// {"error": {"where", "found", "mend"}}
Reply error_reply(unsigned status, const InputError& error);

/// Answers for the exception that is being handled: an ApiError with its status, an InputError with
/// 422, what is no JSON or holds other things than it ought to with 400, all else with 500.
Reply reply_to_exception();

/// The object in a body.
/// @throws ApiError 400 if it is no JSON, no object, or nested dozens deep.
nlohmann::json parse_object(const std::string& body);

/// A text in an object; `fallback` if it is not there.
/// @throws ApiError 400 if something else is there.
std::string text_in(const nlohmann::json& object, const char* key, const std::string& fallback);
bool flag_in(const nlohmann::json& object, const char* key);

/// What stands in a request, of which `name` tells the user where.
/// @throws ApiError 400, in words, if it is of another kind.
std::string text_of(const nlohmann::json& value, const std::string& name);
std::vector<std::string> texts_of(const nlohmann::json& value, const std::string& name);
/// @param kind  "an object"
ApiError wrong_kind(const std::string& name, const char* kind);

/// A number, null if it is not finite.
nlohmann::json number(double value);

}  // namespace manoscope::serve
