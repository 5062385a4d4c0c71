// The server over real sockets: what an honest browser does.
#include "manoscope/serve/server.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "manoscope/core/error.hpp"
#include "manoscope/serve/test_client.hpp"
#include "manoscope/serve/test_experiment.hpp"

namespace manoscope::serve {
namespace {

using nlohmann::json;

class ServerTest : public testing::Test {
 protected:
  ServerTest() : server(options()) {}

  /// A script stands in for the program that measures.
  ServerOptions options() {
    write_text(folder / "worker", "#!/bin/sh\necho working; echo \"$2\"\n");
    std::filesystem::permissions(folder / "worker", std::filesystem::perms::owner_all);
    std::filesystem::create_directories(folder / "served");
    write_experiment_folder(folder / "served");
    ServerOptions options;
    options.folder = folder / "served";
    options.program = folder / "worker";
    return options;
  }

  test_support::TemporaryFolder folder;
  TestServer server;
};

/// The text of the next frame that a server sends.
std::string next_frame(Connection& connection, std::string& read) {
  const auto need = [&](std::size_t size) {
    while (read.size() < size) {
      const std::string more = connection.receive(1 << 16, 10000);
      if (more.empty()) return false;
      read += more;
    }
    return true;
  };
  if (!need(2)) return "";
  std::size_t size = static_cast<unsigned char>(read[1]) & 0x7F, begin = 2;
  const std::size_t n_more = size == 126 ? 2 : size == 127 ? 8 : 0;
  if (!need(2 + n_more)) return "";
  if (n_more > 0) size = 0;
  for (std::size_t i = 0; i < n_more; ++i)
    size = 256 * size + static_cast<unsigned char>(read[2 + i]);
  begin += n_more;
  if (!need(begin + size)) return "";
  const std::string text = read.substr(begin, size);
  read.erase(0, begin + size);
  return text;
}

TEST_F(ServerTest, TheAddressLetsInWithACookieThatScriptsDoNotSee) {
  EXPECT_EQ(server.cookie.substr(0, 10), "manoscope-");
  const std::string target = server.url().substr(server.url().find("/?"));
  const Answer again = server.ask("GET", target);
  EXPECT_EQ(again.status, 200);
  const std::string cookie = again.field("Set-Cookie");
  EXPECT_NE(cookie.find("; HttpOnly; SameSite=Strict"), std::string::npos) << cookie;
  EXPECT_NE(again.body.find("url=/"), std::string::npos);
  EXPECT_TRUE(server.url().starts_with("http://127.0.0.1:"));
}

TEST_F(ServerTest, EveryAnswerForbidsWhatItDoesNotNeed) {
  const Answer page = server.ask("GET", "/");
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.body.find("/app.js"), std::string::npos);
  const std::string policy = page.field("Content-Security-Policy");
  EXPECT_NE(policy.find("script-src 'self';"), std::string::npos);
  EXPECT_EQ(policy.find("unsafe"), std::string::npos);
  for (const char* target : {"/", "/app.js", "/app.css", "/api/state", "/api/none"}) {
    const Answer answer = server.ask("GET", target);
    EXPECT_EQ(answer.field("X-Content-Type-Options"), "nosniff") << target;
    EXPECT_EQ(answer.field("Cache-Control"), "no-store") << target;
    EXPECT_EQ(answer.field("Cross-Origin-Resource-Policy"), "same-origin") << target;
    EXPECT_EQ(answer.field("Referrer-Policy"), "no-referrer") << target;
    EXPECT_NE(answer.field("Content-Security-Policy").find("default-src 'none'"),
              std::string::npos);
  }
}

TEST_F(ServerTest, AStrangerGetsAPageInWords) {
  const Answer page = server.send("GET / HTTP/1.1\r\nHost: " + server.host() + "\r\n\r\n");
  EXPECT_EQ(page.status, 401);
  EXPECT_TRUE(page.field("Content-Type").starts_with("text/html"));
  EXPECT_NE(page.body.find("manoscope serve"), std::string::npos);
}

TEST_F(ServerTest, OneConnectionServesManyRequests) {
  Connection connection(server.port());
  for (int i = 0; i < 20; ++i) {
    connection.send(server.request("GET", "/api/experiment?file=s1/experiment.toml"));
    const Answer answer = connection.answer();
    ASSERT_EQ(answer.status, 200);
    EXPECT_EQ(json::parse(answer.body)["form"]["name"], "small");
  }
}

TEST_F(ServerTest, TakesUploadsWholeOrChunked) {
  const std::string bytes(300000, 'x');
  const auto put = [&](const std::string& target, const std::string& fields,
                       const std::string& body) {
    return server.send(server.head("PUT", target) + fields + "\r\n" + body).status;
  };
  const std::string length = "Content-Length: 300000\r\n";
  EXPECT_EQ(put("/api/files/new/a%20b.gsf", length, bytes), 201);
  EXPECT_EQ(read_text(folder / "served/new/a b.gsf"), bytes);
  EXPECT_EQ(put("/api/files/new/a%20b.gsf", length, bytes), 409);
  const std::string chunks = "10\r\n0123456789abcdef\r\n3\r\nghi\r\n0\r\n\r\n";
  EXPECT_EQ(put("/api/files/c.gsf", "Transfer-Encoding: chunked\r\n", chunks), 201);
  EXPECT_EQ(read_text(folder / "served/c.gsf"), "0123456789abcdefghi");
  EXPECT_EQ(put("/api/files/empty.gsf", "Content-Length: 0\r\n", ""), 201);
}

TEST_F(ServerTest, AnUploadThatBreaksOffLeavesNothing) {
  {
    Connection connection(server.port());
    connection.send(server.head("PUT", "/api/files/half.gsf") + "Content-Length: 300000\r\n\r\n" +
                    std::string(100000, 'x'));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  for (const auto& entry : std::filesystem::directory_iterator(folder / "served")) {
    EXPECT_EQ(entry.path().filename(), "s1");
  }
}

TEST_F(ServerTest, MeasuresInAnotherProcessAndTellsIt) {
  Connection events(server.port());
  events.send(server.head("GET", "/api/events") +
              "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  std::string read;
  while (read.find("\r\n\r\n") == std::string::npos) {
    const std::string more = events.receive(1 << 16);
    ASSERT_FALSE(more.empty());
    read += more;
  }
  EXPECT_TRUE(read.starts_with("HTTP/1.1 101"));
  // RFC 6455, section 1.3
  EXPECT_NE(read.find("s3pPLMBiTxaQ9kYGzzhZRbK+xOo="), std::string::npos);
  read.erase(0, read.find("\r\n\r\n") + 4);
  EXPECT_EQ(json::parse(next_frame(events, read))["type"], "hello");

  const Answer started = server.ask("POST", "/api/jobs", R"({"experiment": "s1/experiment.toml"})");
  EXPECT_EQ(started.status, 202) << started.body;
  std::vector<std::string> types;
  json event;
  do {
    const std::string text = next_frame(events, read);
    ASSERT_FALSE(text.empty());
    event = json::parse(text);
    types.push_back(event["type"]);
  } while (event["type"] != "end");
  EXPECT_EQ(types.front(), "start");
  EXPECT_EQ(event["job"]["state"], "done");
  EXPECT_EQ(event["job"]["log"][0], "working");
  EXPECT_EQ(json::parse(server.ask("GET", "/api/jobs/current").body)["job"], event["job"]);
  EXPECT_EQ(server.ask("DELETE", "/api/jobs/current").status, 409);
}

TEST_F(ServerTest, TellsListenersOfFilesThatChange) {
  Connection events(server.port());
  events.send(server.head("GET", "/api/events") +
              "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));  // the first scan is past
  write_text(folder / "served/s1/new.csv", "x");
  std::string read;
  while (read.find("new.csv") == std::string::npos) {
    const std::string more = events.receive(1 << 16, 5000);
    ASSERT_FALSE(more.empty()) << read;
    read += more;
  }
  EXPECT_NE(read.find("{\"changed\":[\"s1/new.csv\"],\"type\":\"files\"}"), std::string::npos);
}

TEST_F(ServerTest, SendsLargeFilesWhole) {
  std::string bytes(3000000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i % 251);
  write_text(folder / "served/r/result.nc", bytes);
  write_text(folder / "served/r/empty.csv", "");
  Connection connection(server.port());
  for (int i = 0; i < 3; ++i) {
    connection.send(server.request("GET", "/results/r/result.nc"));
    const Answer answer = connection.answer();
    EXPECT_EQ(answer.status, 200);
    EXPECT_TRUE(answer.body == bytes);
    connection.send(server.request("GET", "/results/r/empty.csv"));
    EXPECT_EQ(connection.answer().status, 200);
  }
}

TEST_F(ServerTest, ASandboxedPageHasNoOpenerPolicy) {
  // The HTML standard makes both together in a tab a network error.
  write_text(folder / "served/r/report.html", "<p>");
  const Answer report = server.ask("GET", "/results/r/report.html");
  EXPECT_TRUE(report.field("Content-Security-Policy").starts_with("sandbox"));
  EXPECT_EQ(report.field("Cross-Origin-Opener-Policy"), "");
  EXPECT_EQ(server.ask("GET", "/").field("Cross-Origin-Opener-Policy"), "same-origin");
}

TEST_F(ServerTest, AFolderHasAPortOfItsOwn) {
  EXPECT_EQ(port_of_folder(folder / "served/../served/s1/."), port_of_folder(folder / "served/s1"));
  int n_own = 0;
  for (const char* name : {"a", "b", "c", "d", "e"}) {
    ServerOptions options;
    options.folder = folder / name;
    std::filesystem::create_directories(options.folder);
    const int own = port_of_folder(options.folder);
    EXPECT_GE(own, 61000);
    EXPECT_LE(own, 65535);
    for (int i = 0; i < 2; ++i) {
      const Server first(options), second(options);  // the port is taken: any other does
      EXPECT_NE(second.port(), first.port());
      n_own += first.port() == own;
    }
  }
  EXPECT_GE(n_own, 6) << "of 10: some other program may have one of the ports";
}

TEST_F(ServerTest, TheEndDoesNotWaitForWhatIsStillInLine) {
  using Clock = std::chrono::steady_clock;
  const CameraGrid camera{2500, 2000, 1.0 * um, 1.0 * um};
  std::filesystem::create_directories(folder / "large");
  io::write_gsf(folder / "large/map.gsf", HeightMap(camera, Array2::Zero(2000, 2500)), "height");
  ServerOptions options;
  options.folder = folder / "large";
  auto large = std::make_unique<TestServer>(options);
  auto began = Clock::now();
  EXPECT_EQ(large->ask("GET", "/api/map?file=map.gsf").status, 200);
  const auto one = Clock::now() - began;
  std::vector<std::unique_ptr<Connection>> waiting;
  for (int i = 0; i < 20; ++i) {
    waiting.push_back(std::make_unique<Connection>(large->port()));
    waiting.back()->send(large->request("GET", "/api/map?file=map.gsf"));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  began = Clock::now();
  large.reset();
  // The one that runs, and a tick of 0.1 s: far from the 20 in line.
  EXPECT_LT(Clock::now() - began, 7 * one + std::chrono::milliseconds(300));
}

TEST_F(ServerTest, APortThatIsTakenIsTheUsersToMend) {
  ServerOptions options;
  options.folder = folder / "served";
  options.port = server.port();
  EXPECT_THROW(Server{options}, InputError);
  options.folder = folder / "none";
  EXPECT_THROW(Server{options}, InputError);
}

TEST_F(ServerTest, ListensAtTheLoopbackInterfaceAlone) {
  // Any other address of this machine is refused; 127.0.0.2 is one that every machine has.
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(server.port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);
  EXPECT_NE(::connect(socket.number(), reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
}

}  // namespace
}  // namespace manoscope::serve
