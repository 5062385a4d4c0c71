// Requests that no honest client sends, over real sockets.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <vector>

#include "manoscope/serve/test_client.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::serve {
namespace {

namespace fs = std::filesystem;

class HostileTest : public testing::Test {
 protected:
  HostileTest() : server(options()) {}

  ServerOptions options() {
    fs::create_directories(outer / "served");
    std::ofstream(outer / "secret.csv") << "not for you";
    std::ofstream(outer / "served/fine.csv") << "fine";
    fs::create_symlink("../secret.csv", outer / "served/link.csv");
    fs::create_symlink("/etc", outer / "served/etc");
    ServerOptions options;
    options.folder = outer / "served";
    options.limits.header_seconds = 0.5;
    options.limits.idle_seconds = 1.0;
    options.limits.linger_seconds = 0.3;
    options.limits.upload_bytes = 1 << 20;
    return options;
  }
  /// The server is there and answers an honest request.
  void expect_alive() {
    const Answer answer = server.ask("GET", "/results/fine.csv");
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, "fine");
  }
  std::string chunked_head(const std::string& target) const {
    return server.head("POST", target) +
           "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n";
  }

  test_support::TemporaryFolder outer;
  TestServer server;
};

TEST_F(HostileTest, NoWayOutInAnyEncoding) {
  for (const char* target :
       {"/results/../secret.csv", "/results/%2e%2e/secret.csv", "/results/.%2e/secret.csv",
        "/results/%2E%2E/secret.csv", "/results/..%2fsecret.csv", "/results/%2e%2e%2fsecret.csv",
        "/results/..%5csecret.csv", "/results/..\\secret.csv", "/results/%c0%ae%c0%ae/secret.csv",
        "/results/%e0%80%ae%e0%80%ae/secret.csv", "/results/fine.csv%00", "/results/%00.csv",
        "/results//fine.csv", "//results/fine.csv", "/results/./fine.csv", "/results/%u002e./x.csv",
        "http://127.0.0.1/results/fine.csv", "results/fine.csv", "/api/map?file=%00"}) {
    EXPECT_EQ(server.ask("GET", target).status, 400) << target;
  }
  // Decoded once, these are names of files that are not there, or not for all.
  for (const char* target :
       {"/results/%252e%252e/secret.csv", "/results/....//secret.csv", "/results/link.csv",
        "/results/etc/passwd", "/results/etc/os-release.txt", "/results/.hidden.csv",
        "/api/map?file=../secret.csv", "/api/map?file=/etc/passwd", "/api/map?file=link.csv",
        "/api/files?folder=..", "/api/files?folder=etc", "/api/result?folder=../x"}) {
    const Answer answer = server.ask("GET", target);
    EXPECT_TRUE(answer.status == 404 || answer.status == 400) << target << answer.status;
    EXPECT_EQ(answer.body.find("not for you"), std::string::npos);
  }
  EXPECT_EQ(server.ask("GET", "/results/link.csv").status, 404);
  EXPECT_EQ(server.ask("GET", "/api/experiment?file=../x.toml").status, 400);
  EXPECT_EQ(server.ask("PUT", "/api/files/..%2fx.gsf", "{}").status, 400);
  EXPECT_EQ(server.ask("PUT", "/api/files/.ssh/key", "{}").status, 400);
  EXPECT_EQ(server.ask("PUT", "/api/files/etc/x.gsf", "{}").status, 422);
  expect_alive();
}

TEST_F(HostileTest, ForeignHostsOriginsAndStrangers) {
  const auto get = [&](const std::string& host, const std::string& fields) {
    return server.send("GET /api/state HTTP/1.1\r\nHost: " + host + "\r\n" + fields + "\r\n")
        .status;
  };
  const std::string cookie = "Cookie: " + server.cookie + "\r\n";
  EXPECT_EQ(get("evil.example", cookie), 421);
  EXPECT_EQ(get("evil.example:" + std::to_string(server.port()), cookie), 421);
  EXPECT_EQ(get(server.host() + ".evil.example", cookie), 421);
  EXPECT_EQ(get("localhost:" + std::to_string(server.port()), cookie), 200);
  EXPECT_EQ(get(server.host(), ""), 401);
  EXPECT_EQ(get(server.host(), "Cookie: x=y\r\n"), 401);
  EXPECT_EQ(get(server.host(), cookie + "Sec-Fetch-Site: cross-site\r\n"), 403);
  EXPECT_EQ(server.send("GET /api/state HTTP/1.1\r\n" + cookie + "\r\n").status, 400);
  EXPECT_EQ(server.send("GET /api/state HTTP/1.0\r\nHost: " + server.host() + "\r\n\r\n").status,
            505);
  EXPECT_EQ(server
                .send("POST /api/jobs HTTP/1.1\r\nHost: " + server.host() + "\r\n" + cookie +
                      "Origin: http://evil.example\r\nContent-Type: application/json\r\n"
                      "Content-Length: 2\r\n\r\n{}")
                .status,
            403);
  EXPECT_EQ(server
                .send("GET /api/events HTTP/1.1\r\nHost: " + server.host() + "\r\n" + cookie +
                      "Origin: http://evil.example\r\nUpgrade: websocket\r\n"
                      "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n")
                .status,
            403);
  const std::string used = server.url().substr(server.url().find("/?"));
  EXPECT_EQ(server.send("GET " + used + " HTTP/1.1\r\nHost: " + server.host() + "\r\n\r\n").status,
            403)
      << "the token lets in once";
  expect_alive();
}

TEST_F(HostileTest, ChunkedBodyOfTwiceTheLimit) {
  const double before = resident_megabytes();
  for (int i = 0; i < 5; ++i) {
    Connection connection(server.port());
    connection.send(chunked_head("/api/check"));
    const std::string chunk = "10000\r\n" + std::string(0x10000, ' ') + "\r\n";
    bool taken = true;
    for (int n = 0; n < 128 && taken; ++n) taken = connection.send(chunk);  // 8 MB
    if (taken) connection.send("0\r\n\r\n");
    EXPECT_EQ(connection.answer().status, 413);
  }
  EXPECT_EQ(server
                .send(server.head("POST", "/api/check") +
                      "Content-Type: application/json\r\nContent-Length: 8388608\r\n\r\n")
                .status,
            413);
  expect_alive();
  EXPECT_LT(resident_megabytes() - before, 20.0) << "one body of 4 MB at a time, and the allocator";
}

TEST_F(HostileTest, ChunkedUploadOfTwiceTheLimit) {
  Connection connection(server.port());
  connection.send(server.head("PUT", "/api/files/big.gsf") + "Transfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "10000\r\n" + std::string(0x10000, 'x') + "\r\n";
  bool taken = true;
  for (int n = 0; n < 32 && taken; ++n) taken = connection.send(chunk);  // 2 MB
  if (taken) connection.send("0\r\n\r\n");
  EXPECT_EQ(connection.answer().status, 413);
  EXPECT_TRUE(connection.is_closed());
  for (const auto& entry : fs::directory_iterator(outer / "served")) {
    EXPECT_EQ(entry.path().filename().string().find(".manoscope"), std::string::npos) << entry;
  }
  EXPECT_EQ(server.ask("GET", "/results/big.csv").status, 404);
  expect_alive();
}

TEST_F(HostileTest, AUsedTokenIsUsedInEveryEncoding) {
  const std::string token = server.url().substr(server.url().find('=') + 1);
  for (const char* name : {"%74oken", "t%6Fken"}) {
    EXPECT_EQ(server
                  .send(std::string("GET /?") + name + "=" + token +
                        " HTTP/1.1\r\nHost: " + server.host() + "\r\n\r\n")
                  .status,
              403);
  }
  expect_alive();
}

TEST_F(HostileTest, OneChunkOfAbsurdSize) {
  Connection connection(server.port());
  connection.send(chunked_head("/api/check") + "7fffffffffffffff\r\n");
  EXPECT_EQ(connection.answer().status, 413);
  Connection more(server.port());
  more.send(chunked_head("/api/check") + "ffffffffffffffffff\r\n");
  EXPECT_EQ(more.answer().status, 400);
  expect_alive();
}

TEST_F(HostileTest, HeadersWithoutEndOrNumber) {
  const double before = resident_megabytes();
  std::string many = "GET / HTTP/1.1\r\nHost: " + server.host() + "\r\n";
  for (int i = 0; i < 200000; ++i) many += "a: b\r\n";
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(server.send(many + "\r\n").status, 431);
    EXPECT_EQ(server.send("GET /" + std::string(1 << 20, 'a') + " HTTP/1.1\r\n\r\n").status, 431);
  }
  expect_alive();
  EXPECT_LT(resident_megabytes() - before, 10.0);
}

TEST_F(HostileTest, LengthsThatAreNone) {
  const auto post = [&](const std::string& fields) {
    return server
        .send(server.head("POST", "/api/check") + "Content-Type: application/json\r\n" + fields +
              "\r\n{}")
        .status;
  };
  EXPECT_EQ(post("Content-Length: -1\r\n"), 400);
  EXPECT_EQ(post("Content-Length: 2\r\nContent-Length: 2\r\n"), 400);
  EXPECT_EQ(post("Content-Length: 2\r\nContent-Length: 3\r\n"), 400);
  EXPECT_EQ(post("Content-Length: 2, 2\r\n"), 400);
  EXPECT_EQ(post("Content-Length: 0x2\r\n"), 400);
  EXPECT_EQ(post("Content-Length: 99999999999999999999\r\n"), 400);
  EXPECT_EQ(post("Content-Length: 2\r\nTransfer-Encoding: chunked\r\n"), 400);
  EXPECT_EQ(post("Transfer-Encoding: chunked\r\nContent-Length: 2\r\n"), 400);
  EXPECT_EQ(post("Transfer-Encoding: chunked, identity\r\n"), 400);
  EXPECT_EQ(post("Transfer-Encoding: xchunked\r\n"), 400);
  EXPECT_EQ(post("Content-Length : 2\r\n"), 400);
  expect_alive();
}

TEST_F(HostileTest, WhatIsNoHttp) {
  for (const std::string& bytes :
       {std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11), std::string("GET\r\n\r\n"),
        std::string("GET / HTTP/9.9\r\n\r\n"), std::string(100, '\0') + "\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: " + server.host() + "\r\n folded: x\r\na\x01: b\r\n\r\n"}) {
    const int status = server.send(bytes).status;
    EXPECT_TRUE(status == 400 || status == 505) << status;
  }
  EXPECT_EQ(server.ask("TRACE", "/").status, 405);
  EXPECT_EQ(server.ask("CONNECT", "/").status, 405);
  EXPECT_EQ(server.ask("GET", "/api/state", "{}").status, 400) << "a body where none belongs";
  expect_alive();
}

TEST_F(HostileTest, BodiesThatAreNoJson) {
  for (const std::string& body :
       {std::string("{"), std::string("[]"), std::string("\"x\""), std::string(100000, '['),
        std::string("{\"file\": 5}"), std::string("{\"file\": \"a.toml\"}"),
        std::string("{\"file\": \"a.toml\", \"form\": 5}"),
        std::string("{\"file\": \"a.toml\", \"form\": {\"chanel\": {}}}"),
        std::string("{\"file\": \"a.toml\", \"form\": {\"channel\": {\"length\": 5}}}"),
        std::string("{\"file\": \"a.txt\", \"text\": \"\"}"),
        std::string("{\"file\": \"../a.toml\", \"text\": \"\"}")}) {
    EXPECT_EQ(server.ask("POST", "/api/check", body).status, 400) << body.substr(0, 80);
  }
  expect_alive();
}

TEST_F(HostileTest, SlowHeadersAndBodiesEnd) {
  const auto began = std::chrono::steady_clock::now();
  Connection header(server.port()), silent(server.port()), body(server.port());
  body.send(server.head("POST", "/api/check") +
            "Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{");
  const std::string text = "GET / HTTP/1.1\r\nHost: " + server.host() + "\r\nX-Slow: ";
  header.send(text);
  for (int i = 0; i < 12; ++i) {  // a byte now and then does not help
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    header.send("a");
  }
  EXPECT_EQ(header.answer().status, 408);
  EXPECT_TRUE(silent.is_closed());
  EXPECT_EQ(body.answer().status, 408);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(10));
  expect_alive();
}

TEST_F(HostileTest, FiveHundredConnections) {
  const double before = resident_megabytes();
  std::vector<std::unique_ptr<Connection>> connections;
  for (int i = 0; i < 500; ++i) {
    connections.push_back(std::make_unique<Connection>(server.port()));
    connections.back()->send("GET / HTTP/1.1\r\n");
  }
  int n_busy = 0, n_late = 0, n_closed = 0;
  for (const auto& connection : connections) {
    const int status = connection->answer().status;
    n_busy += status == 503;
    n_late += status == 408;
    n_closed += status == 0;
  }
  const Limits limits;
  EXPECT_EQ(n_late, limits.connections) << "as many as are served at a time";
  EXPECT_GT(n_busy, 0);
  EXPECT_EQ(n_busy + n_late + n_closed, 500);
  connections.clear();
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  expect_alive();
  EXPECT_LT(resident_megabytes() - before, 20.0);
}

TEST_F(HostileTest, RequestsInOneGoAreAnsweredInTurn) {
  Connection connection(server.port());
  connection.send(server.request("GET", "/results/fine.csv") +
                  server.request("GET", "/api/nothing") + server.request("GET", "/app.css"));
  EXPECT_EQ(connection.answer().status, 200);
  EXPECT_EQ(connection.answer().status, 404);
  EXPECT_TRUE(connection.is_closed()) << "behind a refusal nothing is trusted";
}

TEST_F(HostileTest, MemoryStaysFlatUnderMany) {
  const auto many = [&](int n) {
    for (int i = 0; i < n; ++i) {
      server.ask("GET", "/results/..%2fx");
      server.send("GET / HTTP/1.1\r\nHost: evil\r\n\r\n");
      server.ask("POST", "/api/check", "{\"file\": 5}");
    }
  };
  many(100);
  const double before = resident_megabytes();
  many(1000);
  EXPECT_LT(resident_megabytes() - before, 2.0) << "3000 refusals leave less than 1 kB each";
}

}  // namespace
}  // namespace manoscope::serve
