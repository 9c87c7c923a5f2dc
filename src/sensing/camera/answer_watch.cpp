#include "lodestar/sensing/camera/answer_watch.hpp"

namespace lodestar {

bool AnswerWatch::alive(Instant now) {
  const bool told = answer_.valid() && answer_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (told && !answer_.get()) return false;
  if (!answer_.valid()) {
    asked_ = now;
    answer_ = std::async(std::launch::async, ask_);
  }
  return now - asked_ < kAnswer;
}

}  // namespace lodestar
