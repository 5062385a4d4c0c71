// The app without a socket, on a small experiment: for the tests of this folder.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "manoscope/serve/app.hpp"
#include "manoscope/serve/test_experiment.hpp"

namespace manoscope::serve {

using nlohmann::json;

class ApiTest : public testing::Test {
 protected:
  ApiTest() : app(made(), "/bin/true", [](const json&) {}) {}

  std::filesystem::path made() {
    std::filesystem::create_directories(outer / "served");
    write_experiment_folder(outer / "served");
    return outer / "served";
  }
  std::filesystem::path top() const { return outer / "served"; }

  Reply ask(Method method, const std::string& target, const json& body = nullptr,
            const std::string& if_match = "", const std::string& if_none_match = "") {
    Request request{method, *parse_address(target), if_match, if_none_match,
                    body.is_null() ? "" : body.dump()};
    const Found found = find_route(method, request.address.parts);
    EXPECT_TRUE(found.route) << target;
    return app.answer(*found.route, request, {});
  }
  json get(const std::string& target, unsigned status = 200) {
    const Reply reply = ask(Method::get, target);
    EXPECT_EQ(reply.status, status) << target << reply.body;
    return json::parse(reply.body);
  }
  json post(const std::string& target, const json& body, unsigned status = 200) {
    const Reply reply = ask(Method::post, target, body);
    EXPECT_EQ(reply.status, status) << target << reply.body;
    return json::parse(reply.body);
  }
  json put(const json& body, const std::string& revision, unsigned status = 200) {
    const Reply reply =
        ask(Method::put, "/api/experiment?file=s1/experiment.toml", body, '"' + revision + '"');
    EXPECT_EQ(reply.status, status) << reply.body;
    return json::parse(reply.body);
  }
  json experiment() { return get("/api/experiment?file=s1/experiment.toml"); }
  json check(const json& form) {
    return post("/api/check", {{"file", "s1/experiment.toml"}, {"form", form}});
  }

  test_support::TemporaryFolder outer;
  App app;
};

}  // namespace manoscope::serve
