// A worker of compare.py: obeys one order a line and answers each with one line of JSON.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "manoscope/core/frame.hpp"

namespace manoscope::bench {

/// What one can do at best: the bytes of every file into one buffer, and dropped.
inline void read_all(const std::vector<std::string>& files, std::size_t buffer_bytes) {
  std::vector<char> buffer(buffer_bytes);
  for (const std::string& file : files) {
    const int descriptor = ::open(file.c_str(), O_RDONLY);
    if (descriptor < 0) throw std::runtime_error("cannot open " + file);
    while (::read(descriptor, buffer.data(), buffer.size()) > 0) {
    }
    ::close(descriptor);
  }
}

/// High-water mark of this program alone; getrusage() would count whoever started it.
inline double peak_MB() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0.0;
}

inline nlohmann::json read_json(const std::string& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream);
}

inline ChannelFrame frame_of(const nlohmann::json& inputs) {
  ChannelFrame frame;
  frame.length = Length::from_si(inputs.at("length_m"));
  frame.width = Length::from_si(inputs.at("width_m"));
  frame.origin_x = Length::from_si(inputs.at("origin_x_m"));
  frame.origin_y = Length::from_si(inputs.at("origin_z_m"));
  return frame;
}

/// Has every line of standard input obeyed and answers with wall and processor seconds and the peak
/// of resident memory.
inline void obey_lines(const std::function<void(const std::string&)>& obey) {
  for (std::string line; std::getline(std::cin, line);) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor = std::clock();
    obey(line);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    const nlohmann::json answer = {
        {"wall_s", wall.count()},
        {"cpu_s", static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC},
        {"peak_MB", peak_MB()}};
    std::cout << answer << std::endl;
  }
}

}  // namespace manoscope::bench
