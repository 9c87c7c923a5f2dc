#include "lodestar/sensing/camera/answer_watch.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "lodestar/sensing/camera/capture.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;

/// However slow the machine is: the answer is another thread's.
template <class Done>
bool comes_true(Done done) {
  for (int i = 0; i < 30'000; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return false;
}

// Capture asks each time that no frame came for kPatience.
TEST(AnswerWatch, ASilentDeviceIsLostWithinASecondOfItsLastFrame) {
  std::promise<bool> never;
  AnswerWatch watch([&] { return never.get_future().get(); });
  const AnswerWatch::Instant last_frame;
  AnswerWatch::Instant now = last_frame + Capture::kPatience;
  while (watch.alive(now) && now < last_frame + std::chrono::minutes(1)) now += Capture::kPatience;
  EXPECT_LT(now - last_frame, std::chrono::seconds(1));
  EXPECT_GT(now - last_frame, milliseconds(500)) << "one lost packet is no fault";
  never.set_value(true);
}

TEST(AnswerWatch, ADeviceThatAnswersIsAskedAgain) {
  AnswerWatch watch([] { return true; });
  AnswerWatch::Instant now;
  for (int i = 0; i < 20; ++i, now += AnswerWatch::kAnswer) ASSERT_TRUE(comes_true([&] { return watch.alive(now); }));
}

TEST(AnswerWatch, ADeviceThatSaysNoIsLost) {
  AnswerWatch watch([] { return false; });
  const AnswerWatch::Instant now;
  EXPECT_TRUE(comes_true([&] { return !watch.alive(now); }));
}

}  // namespace
}  // namespace lodestar
