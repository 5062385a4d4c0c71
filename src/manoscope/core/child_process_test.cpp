#include "manoscope/core/child_process.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/time.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace manoscope {
namespace {

using Clock = std::chrono::steady_clock;

std::optional<ChildProcess> shell(const std::string& script, ChildProcess::Options options = {}) {
  return ChildProcess::start({"/bin/sh", "-c", script}, options);
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

TEST(ChildProcess, HandsOverItsOutputAndItsExitCode) {
  auto child = shell("echo out; echo err >&2; exit 3");
  ASSERT_TRUE(child);
  EXPECT_EQ(child->read_all(1000), "out\n");
  const ChildEnd end = child->wait();
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_EQ(end.signal, 0);
  EXPECT_FALSE(end.succeeded());
  EXPECT_TRUE(shell("true")->wait().succeeded());
}

TEST(ChildProcess, MessagesComeWithTheOutputWhereAskedFor) {
  ChildProcess::Options options;
  options.messages_too = true;
  options.environment = {"MANOSCOPE_TEST_WORD=given"};
  auto child = shell("echo out; echo $MANOSCOPE_TEST_WORD >&2", options);
  EXPECT_EQ(child->read_all(1000), "out\ngiven\n");
}

TEST(ChildProcess, ASignalIsToldFromAnExit) {
  const ChildEnd end = shell("kill -SEGV $$")->wait();
  EXPECT_EQ(end.signal, SIGSEGV);
  EXPECT_EQ(end.exit_code, -1);
}

TEST(ChildProcess, IsStoppedWithAllItsChildrenWhenItsTimeIsUp) {
  ChildProcess::Options options;
  options.wall_seconds = 0.2;
  const auto start = Clock::now();
  // The inner shell holds the pipe open: only the death of the whole group ends the reading.
  auto child = shell("echo begun; sh -c 'sleep 30'; echo late", options);
  EXPECT_EQ(child->read_all(1000), "begun\n");
  EXPECT_TRUE(child->wait().timed_out);
  EXPECT_LT(seconds_since(start), 10.0);
}

TEST(ChildProcess, MayTidyUpBeforeItIsStopped) {
  ChildProcess::Options options;
  options.grace_seconds = 30.0;
  auto tidy = shell("trap 'exit 7' TERM; echo ready; while :; do sleep 0.01; done", options);
  char line[6];
  ASSERT_EQ(tidy->read(line, sizeof(line)), sizeof(line));
  const auto start = Clock::now();
  tidy->kill();
  EXPECT_EQ(tidy->wait().exit_code, 7);
  EXPECT_LT(seconds_since(start), 20.0);

  options.grace_seconds = 0.1;
  auto stubborn = shell("trap '' TERM; echo ready; while :; do sleep 0.01; done", options);
  ASSERT_EQ(stubborn->read(line, sizeof(line)), sizeof(line));
  stubborn->kill();
  EXPECT_EQ(stubborn->wait().signal, SIGKILL);
}

TEST(ChildProcess, ThatClosesItsOutputAndLingersIsStoppedToo) {
  ChildProcess::Options options;
  options.wall_seconds = 0.2;
  auto child = shell("exec >/dev/null; sleep 30", options);
  EXPECT_EQ(child->read_all(1000), "");
  EXPECT_TRUE(child->wait().timed_out);
}

TEST(ChildProcess, EndlessOutputIsCutAndEndsTheChild) {
  auto child = shell("yes");
  EXPECT_EQ(child->read_all(10).size(), 10U);
  EXPECT_EQ(child->wait().signal, SIGKILL);
}

TEST(ChildProcess, AProgramThatIsNotThereIsNoFault) {
  EXPECT_FALSE(ChildProcess::start({"/no/such/program"}, {}));
  EXPECT_FALSE(find_program("manoscope-no-such-program"));
  EXPECT_TRUE(find_program("sh"));
}

TEST(ChildProcess, EndsWhenASignalComesAndAStopIsRequested) {
  // One signal that nobody wants a stop for, then one that is meant.
  static volatile std::sig_atomic_t n_signals = 0;
  const auto before = std::signal(SIGALRM, [](int) { n_signals = n_signals + 1; });
  ChildProcess::Options options;
  options.stop_requested = [] { return n_signals >= 2; };
  const auto start = Clock::now();
  auto child = shell("sleep 15", options);
  const itimerval every{{0, 100000}, {0, 100000}};
  setitimer(ITIMER_REAL, &every, nullptr);
  EXPECT_EQ(child->read_all(10), "");
  const itimerval never{};
  setitimer(ITIMER_REAL, &never, nullptr);
  std::signal(SIGALRM, before);
  EXPECT_EQ(child->wait().signal, SIGKILL);
  EXPECT_LT(seconds_since(start), 14.0);
}

TEST(ChildProcess, SeveralAtOnceDoNotHoldEachOthersPipes) {
  // A pipe's end inherited by a sibling would keep `read_all` waiting for that sibling.
  ChildProcess::Options options;
  options.wall_seconds = 20.0;
  const auto start = Clock::now();
  auto slow = shell("sleep 15", options);
  std::vector<std::string> outputs(8);
  std::vector<std::thread> threads;
  for (std::string& output : outputs) {
    threads.emplace_back([&output, &options] { output = shell("echo x", options)->read_all(9); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::string& output : outputs) EXPECT_EQ(output, "x\n");
  EXPECT_LT(seconds_since(start), 14.0);
  slow->kill();
}

}  // namespace
}  // namespace manoscope
