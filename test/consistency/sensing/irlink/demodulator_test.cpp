#include <gtest/gtest.h>

#include "support/frame_trials.hpp"
#include "support/heap_watch.hpp"

namespace lodestar {
namespace {

using namespace test;

// The report (bench/irlink_report.cpp) has the whole curve. Three standard deviations of the count are allowed.
TEST(DemodulatorConsistency, loses_no_more_frames_than_theory_does_with_one_decibel_less) {
  constexpr int kTrials = 150;
  const double ideal_db = ideal_eb_n0_db(0.10);
  const FrameTrials trials = frame_trials(ideal_db + 1.0, kTrials);
  EXPECT_LE(trials.lost, 0.10 * kTrials + 3 * std::sqrt(0.09 * kTrials));
  EXPECT_EQ(trials.false_frames, 0);
  EXPECT_LT(std::sqrt(trials.stamp_error2_s2 / (kTrials - trials.lost)), 3e-6);
  EXPECT_EQ(frame_trials(12, 50).lost, 0);
}

TEST(DemodulatorConsistency, loses_no_more_than_one_in_a_hundred_with_one_and_a_half_decibels_more_than_theory) {
  constexpr int kTrials = 300;
  const FrameTrials trials = frame_trials(ideal_eb_n0_db(0.01) + 1.5, kTrials);
  EXPECT_LE(trials.lost, 0.01 * kTrials + 3 * std::sqrt(0.0099 * kTrials));
  EXPECT_EQ(trials.false_frames, 0);
}

TEST(DemodulatorConsistency, hears_nothing_where_nothing_is) {
  sim::IrSamplerParams params;
  params.channels = 8;
  sim::IrSampler sampler(params, 1);
  IrDemodulator demodulator(kBitRate_bps, kFullScale_counts);
  int heard = 0;
  while (sampler.time_s() < 3) {
    const Stamp stamp(from_seconds(1000 + sampler.time_s()));
    demodulator.process(sampler.next(4096, stamp), [&](const RawIrFrame&) { ++heard; });
  }
  EXPECT_EQ(heard, 0);
}

TEST(DemodulatorConsistency, keeps_off_the_heap_once_it_runs) {
  if (!HeapWatch::kWorks) GTEST_SKIP() << "sanitizers have a heap of their own";
  sim::Random random(1, "heap");
  sim::IrSampler sampler({}, 1);
  IrDemodulator demodulator(kBitRate_bps, kFullScale_counts);
  long allocated = 0;
  int heard = 0;
  const IrDemodulator::Visit visit = [&](const RawIrFrame&) { ++heard; };
  for (int block = 0; block < 100; ++block) {
    if (block % 25 == 0)
      sampler.send({sampler.time_s(), kBitRate_bps, encode_ir_frame(random_announcement(random), {}),
                    std::vector<float>(8, 0.05f)});
    const IrSampleBlock samples = sampler.next(512, Stamp(from_seconds(1000 + sampler.time_s())));
    const long before = HeapWatch::allocations;
    demodulator.process(samples, visit);
    if (block > 0) allocated += HeapWatch::allocations - before;
  }
  EXPECT_EQ(heard, 4);
  EXPECT_EQ(allocated, 0);
}

}  // namespace
}  // namespace lodestar
