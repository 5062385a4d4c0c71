#include "manoscope/serve/guard.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "manoscope/serve/secret.hpp"

namespace manoscope::serve {
namespace {

constexpr std::uint16_t kPort = 4711;

class GuardTest : public testing::Test {
 protected:
  GuardTest() : guard(kPort, Limits{}) {}

  Head head(Method method, const std::string& target) const {
    Head head;
    head.method = method;
    head.target = target;
    head.host = {"127.0.0.1:4711"};
    head.peer_user = [] { return ::geteuid(); };
    const std::string cookie = guard.cookie();
    head.cookie = {"other=1; " + cookie.substr(0, cookie.find(';'))};
    if (method != Method::get) head.origin = {"http://127.0.0.1:4711"};
    if (method == Method::post) {
      head.content_type = {"application/json"};
      head.content_length = {"2"};
    }
    return head;
  }
  unsigned status(const Head& head) {
    const Admission admission = guard.admit(head);
    return admission.refusal ? admission.refusal->status : 200;
  }

  Guard guard;
};

TEST_F(GuardTest, LetsThePageOfThisServerThrough) {
  EXPECT_EQ(status(head(Method::get, "/")), 200u);
  EXPECT_EQ(status(head(Method::get, "/api/state")), 200u);
  EXPECT_EQ(status(head(Method::post, "/api/check")), 200u);
  EXPECT_EQ(status(head(Method::del, "/api/jobs/current")), 200u);
  Head other = head(Method::post, "/api/check");
  other.host = {"localhost:4711"};
  other.origin = {"http://localhost:4711"};
  EXPECT_EQ(status(other), 200u);
}

TEST_F(GuardTest, TokenLetsInOnce) {
  Head first = head(Method::get, "/?token=" + guard.token());
  first.cookie.clear();
  first.fetch_site = "cross-site";  // a link in a terminal or a mail
  Admission admission = guard.admit(first);
  EXPECT_FALSE(admission.refusal);
  EXPECT_TRUE(admission.enters);
  admission = guard.admit(first);
  ASSERT_TRUE(admission.refusal);
  EXPECT_EQ(admission.refusal->status, 403u);
  Head again = head(Method::get, "/?token=" + guard.token());
  EXPECT_TRUE(guard.admit(again).enters) << "a browser that is in goes on";
}

TEST_F(GuardTest, WrongTokenLetsNobodyInAndSpendsNothing) {
  Head wrong = head(Method::get, "/?token=" + std::string(64, '0'));
  wrong.cookie.clear();
  EXPECT_EQ(status(wrong), 403u);
  wrong.target = "/?token=";
  EXPECT_EQ(status(wrong), 403u);
  wrong.target = "/?token=" + guard.token();
  EXPECT_TRUE(guard.admit(wrong).enters);
}

TEST_F(GuardTest, TokenIsForTheUserOfTheServerAndRootAlone) {
  Head other = head(Method::get, "/?token=" + guard.token());
  other.cookie.clear();
  for (const std::optional<unsigned> user :
       {std::optional(::geteuid() + 1), std::optional<unsigned>()}) {
    other.peer_user = [user] { return user; };
    EXPECT_EQ(status(other), 403u) << "another user's program, or nobody knows whose";
  }
  other.peer_user = nullptr;
  EXPECT_EQ(status(other), 403u);
  for (const unsigned user : {::geteuid(), 0U}) {
    Guard fresh(kPort, Limits{});
    other.target = "/?token=" + fresh.token();
    other.peer_user = [user] { return user; };
    EXPECT_TRUE(fresh.admit(other).enters);
  }
}

TEST_F(GuardTest, TokenIsTheSameInEveryEncoding) {
  // What the address is decoded to decides, not how it is spelled.
  for (const char* name : {"token", "%74oken", "tok%65n", "%74%6f%6B%65%6E"}) {
    Head other = head(Method::get, std::string("/?") + name + "=" + guard.token());
    other.cookie.clear();
    other.peer_user = [] { return ::geteuid() + 1; };
    EXPECT_EQ(status(other), 403u) << name;
    other.peer_user = nullptr;
    EXPECT_EQ(status(other), 403u) << name;
  }
}

TEST_F(GuardTest, CookieIsForTheUserOfTheServerAlone) {
  // A browser sends it to every port of 127.0.0.1, and another user may listen at one.
  Head stolen = head(Method::get, "/api/state");
  stolen.peer_user = [] { return ::geteuid() + 1; };
  EXPECT_EQ(status(stolen), 403u);
  stolen.target = "/?token=" + guard.token();
  EXPECT_EQ(status(stolen), 403u);
}

TEST_F(GuardTest, AsksForTheUserOfNobodyWithoutASecret) {
  int n_asked = 0;
  Head stranger = head(Method::get, "/?token=" + std::string(64, '0'));
  stranger.cookie.clear();
  stranger.peer_user = [&] { return ++n_asked, ::geteuid(); };
  EXPECT_EQ(status(stranger), 403u);
  stranger.target = "/api/state?token=" + guard.token();
  EXPECT_EQ(status(stranger), 401u);
  EXPECT_EQ(n_asked, 0);
}

TEST_F(GuardTest, TokenOpensNothingButThePage) {
  Head head_ = head(Method::get, "/api/state?token=" + guard.token());
  head_.cookie.clear();
  EXPECT_EQ(status(head_), 401u);
}

TEST_F(GuardTest, HostIsOneOfTwoToTheLetter) {
  for (const char* host : {"evil.example", "evil.example:4711", "127.0.0.1", "127.0.0.1:80",
                           "127.0.0.1:4711.evil.example", "localhost", "LOCALHOST:4711",
                           "0.0.0.0:4711", "[::1]:4711", "127.0.0.1:4711 ", ""}) {
    Head foreign = head(Method::get, "/api/state");
    foreign.host = {host};
    EXPECT_EQ(status(foreign), 421u) << host;
    foreign.target = "/?token=" + guard.token();
    EXPECT_EQ(status(foreign), 421u) << host;
  }
  Head none = head(Method::get, "/api/state");
  none.host.clear();
  EXPECT_EQ(status(none), 400u);
  none.host = {"127.0.0.1:4711", "evil.example"};
  EXPECT_EQ(status(none), 400u);
}

TEST_F(GuardTest, WithoutTheCookieNothingIsToldNotEvenWhatIsThere) {
  for (const char* target : {"/", "/app.js", "/api/state", "/results/a.csv", "/nothing"}) {
    Head stranger = head(Method::get, target);
    stranger.cookie.clear();
    EXPECT_EQ(status(stranger), 401u) << target;
    stranger.cookie = {"manoscope-4711=" + std::string(64, 'a')};
    EXPECT_EQ(status(stranger), 401u) << target;
    stranger.cookie = {"manoscope-4711"};
    EXPECT_EQ(status(stranger), 401u) << target;
  }
}

TEST_F(GuardTest, ForeignPagesDoNotWriteNorListen) {
  for (const char* origin : {"http://evil.example", "http://127.0.0.1:4712", "null", "",
                             "https://127.0.0.1:4711", "http://localhost:4711"}) {
    for (const auto& [method, target] :
         {std::pair(Method::post, "/api/jobs"), std::pair(Method::put, "/api/files/a.gsf"),
          std::pair(Method::del, "/api/jobs/current"), std::pair(Method::get, "/api/events")}) {
      Head foreign = head(method, target);
      foreign.origin = {origin};
      EXPECT_EQ(status(foreign), 403u) << origin << " " << target;
      foreign.origin.clear();
      EXPECT_EQ(status(foreign), 403u) << "no origin " << target;
    }
  }
  Head site = head(Method::get, "/api/state");
  site.fetch_site = "same-site";  // another port of this machine
  EXPECT_EQ(status(site), 403u);
  site.fetch_site = "same-origin";
  EXPECT_EQ(status(site), 200u);
}

TEST_F(GuardTest, AddressesAndMethodsThatAreNotThere) {
  EXPECT_EQ(status(head(Method::get, "/api/nothing")), 404u);
  EXPECT_EQ(status(head(Method::get, "/api/check")), 405u);
  EXPECT_EQ(status(head(Method::del, "/results/a.csv")), 405u);
  EXPECT_EQ(status(head(Method::get, "/results")), 404u);
  EXPECT_EQ(status(head(Method::get, "/results/../a")), 400u);
  EXPECT_EQ(status(head(Method::get, "/api/events")), 403u);
}

TEST_F(GuardTest, BodiesHaveOneEndAndALimit) {
  const auto with = [&](std::vector<std::string> length, std::vector<std::string> encoding) {
    Head head_ = head(Method::post, "/api/check");
    head_.content_length = std::move(length);
    head_.transfer_encoding = std::move(encoding);
    return status(head_);
  };
  EXPECT_EQ(with({"4194304"}, {}), 200u);
  EXPECT_EQ(with({"4194305"}, {}), 413u);
  EXPECT_EQ(with({"18446744073709551616"}, {}), 400u);
  EXPECT_EQ(with({"-1"}, {}), 400u);
  EXPECT_EQ(with({"+2"}, {}), 400u);
  EXPECT_EQ(with({"2, 2"}, {}), 400u);
  EXPECT_EQ(with({"2", "2"}, {}), 400u);
  EXPECT_EQ(with({}, {"chunked"}), 200u);
  EXPECT_EQ(with({}, {"gzip, chunked"}), 400u);
  EXPECT_EQ(with({}, {"identity"}), 400u);
  EXPECT_EQ(with({}, {"chunked", "chunked"}), 400u);
  EXPECT_EQ(with({"2"}, {"chunked"}), 400u);
  Head get = head(Method::get, "/api/state");
  get.content_length = {"5"};
  EXPECT_EQ(status(get), 400u);
  get.content_length = {"0"};
  EXPECT_EQ(status(get), 200u);
  Head upload = head(Method::put, "/api/files/a.gsf");
  upload.content_length = {"4194305"};
  EXPECT_EQ(status(upload), 200u);
  upload.content_length = {"2147483649"};
  EXPECT_EQ(status(upload), 413u);
}

TEST_F(GuardTest, OnlyBodiesCalledJsonAreReadAsJson) {
  Head form = head(Method::post, "/api/check");
  for (const char* type : {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data",
                           "application/jsonp", ""}) {
    form.content_type = {type};
    EXPECT_EQ(status(form), 415u) << type;
  }
  form.content_type = {"Application/JSON; charset=utf-8"};
  EXPECT_EQ(status(form), 200u);
}

TEST_F(GuardTest, WebSocketsAreWhereTheyAreAlone) {
  Head events = head(Method::get, "/api/events");
  events.origin = {"http://127.0.0.1:4711"};
  EXPECT_EQ(status(events), 426u);
  events.upgrades = true;
  EXPECT_EQ(status(events), 200u);
  events.target = "/api/state";
  EXPECT_EQ(status(events), 400u);
}

TEST(Secret, IsLongAndNeverTheSame) {
  EXPECT_EQ(new_secret().size(), 64u);
  EXPECT_NE(new_secret(), new_secret());
  EXPECT_TRUE(same_secret("ab", "ab"));
  EXPECT_FALSE(same_secret("ab", "aB"));
  EXPECT_FALSE(same_secret("ab", "abc"));
}

}  // namespace
}  // namespace manoscope::serve
