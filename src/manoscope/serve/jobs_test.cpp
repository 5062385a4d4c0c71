#include "manoscope/serve/jobs.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "manoscope/serve/api_error.hpp"

namespace manoscope::serve {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

/// Shell scripts stand in for the measurement.
class JobsTest : public testing::Test {
 protected:
  JobsTest()
      : jobs([this](const json& event) {
          const std::scoped_lock lock(mutex);
          events.push_back(event);
          changed.notify_all();
        }) {}

  json start(const std::string& script) {
    return jobs.start({"a/experiment.toml", "a-result", {"/bin/sh", "-c", script}});
  }
  /// The first event of a type, waited for.
  json event(const std::string& type) {
    std::unique_lock lock(mutex);
    json found;
    changed.wait_for(lock, std::chrono::seconds(20), [&] {
      for (const json& event : events) {
        if (event["type"] == type) found = event;
      }
      return !found.is_null();
    });
    return found;
  }

  std::mutex mutex;
  std::condition_variable changed;
  std::vector<json> events;
  Jobs jobs;
};

TEST_F(JobsTest, TellsProgressLinesAndTheEnd) {
  EXPECT_TRUE(jobs.current().is_null());
  const json job = start(
      "echo '{\"progress\": {\"stage\": \"reading maps\", \"fraction\": 0.5}}' >&2; echo a line");
  EXPECT_EQ(job["id"], 1);
  EXPECT_EQ(job["state"], "running");
  EXPECT_EQ(job["command"][0], "manoscope");
  const json end = event("end")["job"];
  EXPECT_EQ(end["state"], "done");
  EXPECT_EQ(end["exit_code"], 0);
  EXPECT_EQ(end["log"], json({"a line"}));
  EXPECT_EQ(event("progress")["stage"], "reading maps");
  EXPECT_EQ(event("progress")["fraction"], 0.5);
  EXPECT_EQ(event("log")["line"], "a line");
  EXPECT_EQ(jobs.current(), end);
}

TEST_F(JobsTest, FailuresAndCrashesAreEnds) {
  start("echo no >&2; exit 2");
  json end = event("end")["job"];
  EXPECT_EQ(end["state"], "failed");
  EXPECT_EQ(end["exit_code"], 2);
  EXPECT_EQ(end["log"], json({"no"}));
  events.clear();
  start("kill -SEGV $$");
  end = event("end")["job"];
  EXPECT_EQ(end["id"], 2);
  EXPECT_EQ(end["state"], "failed");
  EXPECT_EQ(end["signal"], SIGSEGV);
  EXPECT_TRUE(end["exit_code"].is_null());
}

TEST_F(JobsTest, AProgramThatIsNotThereIsAFailure) {
  jobs.start({"a", "b", {"/no/such/program"}});
  const json end = event("end")["job"];
  EXPECT_EQ(end["state"], "failed");
  EXPECT_NE(end["log"][0].get<std::string>().find("/no/such/program"), std::string::npos);
}

TEST_F(JobsTest, OneAtATime) {
  start("exec sleep 60");
  try {
    start("true");
    FAIL() << "two at a time";
  } catch (const ApiError& error) {
    EXPECT_EQ(error.status(), 409u);
  }
  jobs.cancel();
  EXPECT_EQ(event("end")["job"]["state"], "cancelled");
  EXPECT_THROW(jobs.cancel(), ApiError);
}

TEST_F(JobsTest, WhoDoesNotStopWhenAskedIsEnded) {
  start("trap '' INT; echo deaf; while :; do sleep 1; done");
  event("log");
  const auto before = steady_clock::now();
  EXPECT_EQ(jobs.cancel()["state"], "running");
  const json end = event("end")["job"];
  EXPECT_EQ(end["state"], "cancelled");
  EXPECT_EQ(end["signal"], SIGKILL);
  const auto patience = steady_clock::now() - before;
  EXPECT_GT(patience, std::chrono::seconds(4));
  EXPECT_LT(patience, std::chrono::seconds(8));
}

TEST_F(JobsTest, ProgressOfAnotherKindIsALineLikeAnother) {
  start(
      "echo '{\"progress\": {\"stage\": 5}}'; echo '{\"progress\": {\"stage\": \"a\", "
      "\"fraction\": \"b\"}}'; echo '{\"progress\": 1}'; echo '{\"progress\"'");
  const json end = event("end")["job"];
  EXPECT_EQ(end["state"], "done");
  EXPECT_EQ(end["log"].size(), 4u);
  EXPECT_EQ(end["stage"], "");
}

TEST_F(JobsTest, WhoHasClosedItsOutputIsCancelledToo) {
  const auto before = steady_clock::now();
  start("echo begun; exec >/dev/null 2>&1; exec sleep 60");
  event("log");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the end of the output is read
  jobs.cancel();
  EXPECT_EQ(event("end")["job"]["state"], "cancelled");
  EXPECT_LT(steady_clock::now() - before, std::chrono::seconds(4)) << "by SIGINT, at once";
}

TEST_F(JobsTest, NothingIsPublishedWhileSomebodyLooks) {
  // A page that is told the state is told every event behind it.
  start("echo begun; sleep 0.2");
  event("log");
  bool ended = true;
  jobs.look([&](const json& job) {
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    const std::scoped_lock lock(mutex);
    ended = events.back()["type"] == "end";
    EXPECT_EQ(job["state"], "running");
  });
  EXPECT_FALSE(ended);
  EXPECT_EQ(event("end")["job"]["state"], "done");
}

TEST_F(JobsTest, KeepsTheLastLinesAlone) {
  start("i=0; while [ $i -lt 500 ]; do echo $i; i=$((i+1)); done; head -c 100000 /dev/zero");
  const json end = event("end")["job"];
  ASSERT_EQ(end["log"].size(), 400u);
  EXPECT_EQ(end["log"][398], "499");
  EXPECT_LE(end["log"][399].get<std::string>().size(), 2000u);
}

TEST(Jobs, GoWithTheServer) {
  const auto before = steady_clock::now();
  {
    Jobs jobs([](const json&) {});
    jobs.start({"a", "b", {"/bin/sh", "-c", "exec sleep 60"}});
  }
  EXPECT_LT(steady_clock::now() - before, std::chrono::seconds(5));
}

}  // namespace
}  // namespace manoscope::serve
