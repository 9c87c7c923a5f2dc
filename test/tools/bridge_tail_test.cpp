// The tool bridge_tail as a process, beside a bridge as a process.
#include <fcntl.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "lodestar/wms/site_messages.hpp"
#include "support/bridge_process.hpp"
#include "support/broker.hpp"
#include "support/real_time.hpp"
#include "support/temporary_folder.hpp"

namespace lodestar {
namespace {

using test::Broker;
using test::run_until;
using test::Worker;
using Numbers = std::vector<std::uint64_t>;

/// bridge_tail, its output in a file.
class Tail {
 public:
  Tail(const std::string& broker, const std::string& count, const std::string& form, const std::string& output)
      : output_(output) {
    process_ = fork();
    if (process_ != 0) return;
    dup2(open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), STDOUT_FILENO);
    execl(LODESTAR_BRIDGE_TAIL, LODESTAR_BRIDGE_TAIL, "--broker", broker.c_str(), "--count", count.c_str(),
          form.c_str(), nullptr);
    _exit(127);
  }
  ~Tail() { kill(); }
  Tail(const Tail&) = delete;
  Tail& operator=(const Tail&) = delete;

  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = -1;
  }
  /// Whether it ended by itself, and well.
  bool ends() {
    int status = -1;
    const auto ended = [&] {
      if (process_ > 0 && waitpid(process_, &status, WNOHANG) == process_) process_ = -1;
      return process_ < 0;
    };
    if (!run_until(ended, [] {})) return false;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
  std::vector<std::string> lines() const {
    std::ifstream file(output_);
    std::vector<std::string> out;
    for (std::string line; std::getline(file, line);) out.push_back(line);
    return out;
  }
  /// Of the documents that it printed.
  Numbers numbers() const {
    Numbers out;
    for (const std::string& line : lines())
      if (const auto key = document_key_from(line)) out.push_back(key->sequence);
    return out;
  }

 private:
  std::string output_;
  pid_t process_ = -1;
};

class BridgeTail : public testing::Test {
 protected:
  void SetUp() override {
    if (!Broker::installed()) GTEST_SKIP() << "mosquitto is not installed: nothing was delivered";
  }
  std::string file(const std::string& name) const { return folder_ / name; }

 private:
  test::TemporaryFolder folder_{test::TemporaryFolder::memory()};
};

TEST_F(BridgeTail, PrintsEachEventOnceAndEndsAfterItsCount) {
  Broker broker;
  Worker worker(file("wms.db"), "200", broker.uri());
  Tail first(broker.uri(), "3", "--documents", file("first"));
  ASSERT_TRUE(first.ends());
  Numbers expected(first.numbers().size());
  std::iota(expected.begin(), expected.end(), 1);
  EXPECT_EQ(first.numbers(), expected);
  EXPECT_GE(expected.size(), 3u);
  ASSERT_LT(expected.size(), 200u) << "a window or so";
  // What it printed it acknowledged: the next goes on after it.
  Tail second(broker.uri(), "1", "--documents", file("second"));
  ASSERT_TRUE(second.ends());
  EXPECT_EQ(second.numbers().at(0), expected.size() + 1);
}

TEST_F(BridgeTail, PrintsALineAnEvent) {
  Broker broker;
  Worker worker(file("wms.db"), "2", broker.uri());
  Tail tail(broker.uri(), "2", "--serial=+", file("lines"));
  ASSERT_TRUE(tail.ends());
  const auto lines = tail.lines();
  ASSERT_EQ(lines.size(), 3u) << "a pick; a drop, and where it stands";
  EXPECT_NE(lines[0].find(" 1 2026-"), std::string::npos) << lines[0];
  EXPECT_NE(lines[0].find("AssociationEvent ADD 106141412345678908"), std::string::npos) << lines[0];
  EXPECT_NE(lines[1].find("AssociationEvent DELETE"), std::string::npos) << lines[1];
  EXPECT_NE(lines[2].find("ObjectEvent OBSERVE"), std::string::npos) << lines[2];
  EXPECT_NE(lines[2].find(" x=0.5"), std::string::npos) << lines[2];
}

/// Killed after it printed and before its acknowledgement arrived, which this broker does not let through at first.
TEST_F(BridgeTail, WhatWasNotAcknowledgedIsPrintedAgain) {
  const test::TemporaryFolder folder;
  const std::string access = folder / "access";
  const auto allow = [&](const std::string& rules) { std::ofstream(access) << rules; };
  allow("topic readwrite wms/v1/+/+/event\ntopic readwrite wms/v1/+/+/stream\ntopic read wms/v1/+/+/ack\n");
  ASSERT_EQ(std::system(("chmod 755 " + folder / "." + " && chmod 644 " + access).c_str()), 0);
  Broker broker("allow_anonymous true\nacl_file " + access);
  Worker worker(file("wms.db"), "4", broker.uri());
  Tail killed(broker.uri(), "0", "--documents", file("killed"));
  ASSERT_TRUE(run_until([&] { return killed.numbers().size() == 4; }, [] {}));
  killed.kill();
  broker.kill();
  allow("topic readwrite #\n");
  broker.start();
  Tail again(broker.uri(), "4", "--documents", file("again"));
  ASSERT_TRUE(again.ends());
  EXPECT_EQ(again.numbers(), (Numbers{1, 2, 3, 4}));
  EXPECT_EQ(again.lines(), killed.lines()) << "byte for byte";
}

}  // namespace
}  // namespace lodestar
