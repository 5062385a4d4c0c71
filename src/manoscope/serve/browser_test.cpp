#include "manoscope/serve/browser.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "manoscope/serve/test_experiment.hpp"

namespace manoscope::serve {
namespace {

/// A script stands in for xdg-open.
class BrowserTest : public testing::Test {
 protected:
  void set_opener(const std::string& script) {
    write_text(folder / "xdg-open", "#!/bin/sh\n" + script);
    std::filesystem::permissions(folder / "xdg-open", std::filesystem::perms::owner_all);
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", ((folder / ".").string() + ":" + path).c_str(), 1);
    ::setenv("DISPLAY", ":0", 1);
  }
  /// What the script wrote, waited for.
  std::string written() {
    for (int i = 0; i < 200 && read_text(folder / "told").find('\n') == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return read_text(folder / "told");
  }

  test_support::TemporaryFolder folder;
};

TEST_F(BrowserTest, IsNeitherWaitedForNorEnded) {
  // Plain window managers' xdg-open becomes the browser.
  set_opener("echo $$ \"$1\" > " + (folder / "told").string() + "; exec sleep 60\n");
  const auto began = std::chrono::steady_clock::now();
  EXPECT_TRUE(open_browser("http://127.0.0.1:1/?token=a&b"));
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
  const std::string told = written();
  EXPECT_NE(told.find(" http://127.0.0.1:1/?token=a&b\n"), std::string::npos) << told;
  const int process = std::stoi(told);
  EXPECT_EQ(::kill(process, 0), 0) << "it runs on";
  EXPECT_NE(::getpgid(process), ::getpgrp()) << "a Ctrl-C at the terminal does not reach it";
  ::kill(process, SIGKILL);
}

TEST_F(BrowserTest, IsNotOpenedWithoutADisplay) {
  set_opener("exit 0\n");
  ::unsetenv("DISPLAY");
  ::unsetenv("WAYLAND_DISPLAY");
  EXPECT_FALSE(open_browser("http://127.0.0.1:1/"));
}

}  // namespace
}  // namespace manoscope::serve
