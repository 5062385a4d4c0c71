#include "manoscope/serve/json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace manoscope::serve {

using nlohmann::json;

namespace {

json error_json(const InputError& error) {
  return {{"where", error.where()}, {"found", error.found()}, {"mend", error.mend()}};
}

}  // namespace

Reply json_reply(const json& content, unsigned status) {
  Reply reply;
  reply.status = status;
  reply.type = "application/json";
  reply.body = content.dump(-1, ' ', false, json::error_handler_t::replace);
  return reply;
}

Reply error_reply(unsigned status, const InputError& error) {
  return json_reply({{"error", error_json(error)}}, status);
}

Reply reply_to_exception() {
  try {
    throw;
  } catch (const ApiError& error) {
    return error_reply(error.status(), error);
  } catch (const InputError& error) {
    return error_reply(422, error);
  } catch (const InputErrors& errors) {
    json faults = json::array();
    for (const InputError& fault : errors.faults()) faults.push_back(error_json(fault));
    return json_reply({{"error", faults.at(0)}, {"faults", faults}}, 422);
  } catch (const json::exception&) {
    return error_reply(400, {"request", "something in it is of another kind than it ought to be",
                             "Send what the manual describes"});
  } catch (const std::bad_alloc&) {
    return error_reply(500, {"", "out of memory", "Free some"});
  } catch (const std::exception& error) {
    return error_reply(500, {"fault of the program", error.what(), "Please report it"});
  }
}

json parse_object(const std::string& body) {
  constexpr int kDeepest = 32;
  bool too_deep = false;
  const auto watch = [&](int depth, json::parse_event_t, json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  json object = json::parse(body, watch, false);
  if (!object.is_object() || too_deep) {
    throw ApiError(400, "request", "the body is no JSON object", "Send what the manual describes");
  }
  return object;
}

std::string text_in(const json& object, const char* key, const std::string& fallback) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return fallback;
  return text_of(*found, key);
}

bool flag_in(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return false;
  if (!found->is_boolean()) throw wrong_kind(key, "true or false");
  return found->get<bool>();
}

ApiError wrong_kind(const std::string& name, const char* kind) {
  return {400, name, fmt::format("{} is not {}", name, kind), "Send what the manual describes"};
}

std::string text_of(const json& value, const std::string& name) {
  if (!value.is_string()) throw wrong_kind(name, "a text");
  return value.get<std::string>();
}

std::vector<std::string> texts_of(const json& value, const std::string& name) {
  if (!value.is_array()) throw wrong_kind(name, "a list of texts");
  std::vector<std::string> texts;
  for (const json& text : value) texts.push_back(text_of(text, name));
  return texts;
}

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

}  // namespace manoscope::serve
