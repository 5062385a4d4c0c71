// Times the answers of `manoscope serve` as a page waits for them: bench_serve PROGRAM FOLDER
// EXPERIMENT
//
// 8 connections at once, each asking one question after another; once alone, once while another
// connection has one map after another drawn. Writing, which waits for the disk, one after another.
// One line of JSON.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "manoscope/core/child_process.hpp"

namespace {

using manoscope::ChildProcess;
using nlohmann::json;

constexpr int kConnections = 8, kRequests = 500;

class Connection {
 public:
  explicit Connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    if (::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error("cannot connect");
    }
  }
  ~Connection() { ::close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Head and body of the answer.
  std::pair<std::string, std::string> ask(const std::string& request) {
    if (::send(socket_, request.data(), request.size(), MSG_NOSIGNAL) < 0) {
      throw std::runtime_error("the server has closed");
    }
    std::string read;
    std::size_t end = std::string::npos;
    while ((end = read.find("\r\n\r\n")) == std::string::npos) receive(read);
    const auto at = read.find("Content-Length: ");
    const std::size_t size = std::stoul(read.substr(at + 16));
    while (read.size() < end + 4 + size) receive(read);
    return {read.substr(0, end), read.substr(end + 4)};
  }

 private:
  void receive(std::string& read) {
    char buffer[1 << 16];
    const ssize_t n = ::recv(socket_, buffer, sizeof(buffer), 0);
    if (n <= 0) throw std::runtime_error("the answer breaks off");
    read.append(buffer, static_cast<std::size_t>(n));
  }
  int socket_;
};

/// A server, and how to ask it.
struct Service {
  int port = 0;
  std::string host, cookie;

  std::string request(const std::string& method, const std::string& target,
                      const std::string& body = "", const std::string& fields = "") const {
    std::string text = method + " " + target + " HTTP/1.1\r\nHost: " + host +
                       "\r\nCookie: " + cookie + "\r\nOrigin: http://" + host + "\r\n" + fields;
    if (!body.empty()) {
      text += "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
              "\r\n";
    }
    return text + "\r\n" + body;
  }
};

Service enter(const std::string& line) {
  const json told = json::parse(line);
  Service service;
  service.port = told.at("port");
  service.host = "127.0.0.1:" + std::to_string(service.port);
  const std::string url = told.at("url");
  const auto [head, body] =
      Connection(service.port).ask(service.request("GET", url.substr(url.find("/?"))));
  const auto at = head.find("Set-Cookie: ") + 12;
  service.cookie = head.substr(at, head.find(';', at) - at);
  return service;
}

/// Milliseconds of every answer, in ascending order.
std::vector<double> time_answers(const Service& service, const std::string& request) {
  std::vector<std::vector<double>> times(kConnections);
  std::vector<std::thread> threads;
  for (auto& own : times) {
    threads.emplace_back([&] {
      Connection connection(service.port);
      for (int i = 0; i < kRequests; ++i) {
        const auto start = std::chrono::steady_clock::now();
        const auto [head, body] = connection.ask(request);
        const std::chrono::duration<double, std::milli> taken =
            std::chrono::steady_clock::now() - start;
        if (head.find(" 200 ") == std::string::npos) std::_Exit(1);
        own.push_back(taken.count());
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::vector<double> all;
  for (const auto& own : times) all.insert(all.end(), own.begin(), own.end());
  std::sort(all.begin(), all.end());
  return all;
}

json told(const std::vector<double>& times) {
  const auto at = [&](double part) {
    return times[static_cast<std::size_t>(part * static_cast<double>(times.size() - 1))];
  };
  return {{"p50_ms", at(0.5)}, {"p99_ms", at(0.99)}, {"most_ms", times.back()}};
}

/// Milliseconds of one writing after another, each of them a change that reaches the disk; the
/// last one puts the text back.
std::vector<double> time_writing(const Service& service, const std::string& target, json read) {
  constexpr int kWritings = 100;  // an even number
  Connection connection(service.port);
  const std::string text = read.at("text");
  std::vector<double> times;
  for (int i = 0; i < kWritings; ++i) {
    const json body = {{"text", i % 2 == 0 ? text + "# changed\n" : text}};
    const std::string match = "If-Match: \"" + read.at("revision").get<std::string>() + "\"\r\n";
    const auto start = std::chrono::steady_clock::now();
    const auto [head, answer] = connection.ask(service.request("PUT", target, body.dump(), match));
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - start;
    if (head.find(" 200 ") == std::string::npos) std::_Exit(1);
    read = json::parse(answer);
    times.push_back(taken.count());
  }
  std::sort(times.begin(), times.end());
  return times;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: bench_serve PROGRAM FOLDER EXPERIMENT\n";
    return 2;
  }
  ChildProcess::Options limits;
  limits.wall_seconds = 600.0;
  auto server =
      ChildProcess::start({argv[1], "serve", argv[2], "--json", "--no-browser", "--quiet"}, limits);
  if (!server) return 1;
  std::string line;
  for (char letter = 0; server->read(&letter, 1) == 1 && letter != '\n';) line += letter;
  const Service service = enter(line);
  const std::string experiment = "/api/experiment?file=" + std::string(argv[3]);
  Connection first(service.port);
  const json read = json::parse(first.ask(service.request("GET", experiment)).second);
  const json check = {{"file", argv[3]}, {"form", read.at("form")}};
  const std::string folder = read.at("file").get<std::string>();
  const std::string listing = "/api/files?folder=" + folder.substr(0, folder.rfind('/'));
  const std::string map =
      folder.substr(0, folder.rfind('/') + 1) +
      read.at("form").at("hydrostatic").at("rows").at(1).at(0).get<std::string>();
  const std::pair<const char*, std::string> questions[] = {
      {"current job", service.request("GET", "/api/jobs/current")},
      {"state", service.request("GET", "/api/state")},
      {"files of a folder", service.request("GET", listing)},
      {"experiment", service.request("GET", experiment)},
      {"check of a draft", service.request("POST", "/api/check", check.dump())}};
  json answers = json::array();
  for (const bool drawing : {false, true}) {
    std::atomic<bool> stop{false};
    std::thread painter;
    if (drawing) {
      painter = std::thread([&] {
        Connection connection(service.port);
        while (!stop) connection.ask(service.request("GET", "/api/map?file=" + map));
      });
    }
    const auto add = [&](const char* name, const std::vector<double>& times) {
      json answer = told(times);
      answer["question"] = name;
      answer["while_maps_are_drawn"] = drawing;
      answers.push_back(answer);
    };
    for (const auto& [name, request] : questions) add(name, time_answers(service, request));
    add("writing of a draft", time_writing(service, experiment, read));
    stop = true;
    if (painter.joinable()) painter.join();
  }
  std::cout << json{{"connections", kConnections}, {"requests", kRequests}, {"answers", answers}}
            << '\n';
  return 0;
}
