#include "lodestar/sensing/irlink/ir_demodulator.hpp"

#include <gtest/gtest.h>

#include "support/frame_trials.hpp"

namespace lodestar {
namespace {

using namespace test;

const Stamp kStart{std::chrono::seconds(1000)};
const std::vector<float> kLevels{0.05f, 0.02f, 0.f, 0.01f, 0.04f, 0.f, 0.03f, 0.f};

/// Frames with begin times, through the ADC and the demodulator.
class Air {
 public:
  explicit Air(const sim::IrSamplerParams& params = {}) : sampler_(params, 1) {}

  Announcement send(double begin_s, const std::vector<float>& levels = kLevels, double rate = 1) {
    const Announcement said = random_announcement(random_);
    sampler_.send({begin_s, kBitRate_bps * rate, encode_ir_frame(said, {}), levels});
    return said;
  }
  void pass(int samples, Duration stamp_error = {}) {
    const Stamp stamp = kStart + from_seconds(sampler_.time_s()) + stamp_error;
    demodulator_.process(sampler_.next(samples, stamp), [&](const RawIrFrame& frame) { heard_.push_back(frame); });
  }
  void pass_seconds(double until_s) {
    while (sampler_.time_s() < until_s) pass(1000);
  }
  bool decodes(std::size_t i, const Announcement& said) const {
    const auto got = IrFrameDecoder(Link(), 8).decode(heard_.at(i));
    return got && got->beacon == said.beacon && got->superframe == said.superframe;
  }

  sim::Random random_{1, "air"};
  sim::IrSampler sampler_;
  IrDemodulator demodulator_{kBitRate_bps, kFullScale_counts};
  std::vector<RawIrFrame> heard_;
};

TEST(IrDemodulator, hears_a_frame_when_it_began_and_how_strong_each_diode_had_it) {
  Air air;
  const Announcement said = air.send(0.0103);
  air.pass_seconds(0.05);
  ASSERT_EQ(air.heard_.size(), 1u);
  EXPECT_TRUE(air.decodes(0, said));
  EXPECT_NEAR(seconds(air.heard_[0].stamp - kStart), 0.0103, 4e-6);
  ASSERT_EQ(air.heard_[0].levels.size(), 8u);
  // A sample that a bit's edge lies in is worth less, in all diodes alike: up to a tenth.
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(air.heard_[0].levels[i], 0.95 * kLevels[i], 0.05 * kLevels[i] + 0.001) << i;
}

TEST(IrDemodulator, the_size_of_blocks_does_not_matter) {
  for (const int size : {1, 7, 511, 1024, 6000}) {
    Air air;
    const Announcement first = air.send(0.003), second = air.send(0.028);
    while (air.sampler_.time_s() < 0.08) air.pass(size);
    ASSERT_EQ(air.heard_.size(), 2u) << size;
    EXPECT_TRUE(air.decodes(0, first) && air.decodes(1, second)) << size;
    EXPECT_NEAR(seconds(air.heard_[1].stamp - kStart), 0.028, 4e-6) << size;
  }
}

TEST(IrDemodulator, one_diode_is_enough) {
  sim::IrSamplerParams params;
  params.channels = 1;
  Air air(params);
  const Announcement said = air.send(0.01, {0.02f});
  air.pass_seconds(0.05);
  ASSERT_EQ(air.heard_.size(), 1u);
  EXPECT_TRUE(air.decodes(0, said));
  EXPECT_EQ(air.heard_[0].levels.size(), 1u);
}

TEST(IrDemodulator, clocks_may_differ_by_200_ppm_either_way) {
  for (const double sign : {-1.0, 1.0}) {
    sim::IrSamplerParams params;
    params.clock_error_ppm = -100 * sign;
    Air air(params);
    const Announcement said = air.send(0.005, kLevels, 1 + sign * 100e-6);
    air.pass_seconds(0.05);
    ASSERT_EQ(air.heard_.size(), 1u);
    EXPECT_TRUE(air.decodes(0, said));
  }
}

TEST(IrDemodulator, lamps_a_hundred_times_as_bright_do_not_disturb) {
  for (const double mains_hz : {50.0, 60.0}) {
    sim::IrSamplerParams params;
    params.noise = 0.0005;
    params.ambient = 0.5;
    params.flicker = 0.4;
    params.mains_hz = mains_hz;
    Air air(params);
    const Announcement said = air.send(0.005, std::vector<float>(8, 0.004f));
    air.pass_seconds(0.05);
    ASSERT_EQ(air.heard_.size(), 1u) << mains_hz;
    EXPECT_TRUE(air.decodes(0, said)) << mains_hz;
  }
}

TEST(IrDemodulator, the_stronger_of_two_at_once_is_heard) {
  Air air;
  const Announcement strong = air.send(0.010, std::vector<float>(8, 0.06f));
  air.send(0.0107, {0.02f, 0, 0, 0.02f, 0, 0, 0, 0});
  air.pass_seconds(0.06);
  ASSERT_GE(air.heard_.size(), 1u);
  EXPECT_TRUE(air.decodes(0, strong));
}

TEST(IrDemodulator, under_a_jammer_nothing_false_is_heard_and_after_him_the_next_frame_is) {
  Air air;
  std::array<std::uint8_t, RawIrFrame::kOctets> noise;
  for (double begin_s = 0.001; begin_s < 0.2; begin_s += 0.007) {
    for (auto& octet : noise) octet = static_cast<std::uint8_t>(air.random_.uniform(0, 255.9));
    air.sampler_.send({begin_s, kBitRate_bps, noise, std::vector<float>(8, 0.3f)});
  }
  for (const double begin_s : {0.02, 0.06, 0.1, 0.14}) air.send(begin_s);
  air.pass_seconds(0.25);
  const IrFrameDecoder decoder(Link(), 8);
  EXPECT_GE(air.heard_.size(), 5u) << "what is counted as spoilt";
  for (const RawIrFrame& frame : air.heard_) EXPECT_FALSE(decoder.decode(frame));

  const std::size_t before = air.heard_.size();
  const Announcement said = air.send(0.26);
  air.pass_seconds(0.3);
  ASSERT_EQ(air.heard_.size(), before + 1);
  EXPECT_TRUE(air.decodes(before, said));
}

TEST(IrDemodulator, a_frame_that_is_spoilt_hides_none_that_begins_within_it) {
  Air air;
  const std::vector<float> weak(8, 0.01f), strong(8, 0.08f);
  air.send(0.010, weak);
  const Announcement said = air.send(0.015, strong);
  air.pass_seconds(0.06);
  bool heard = false;
  for (std::size_t i = 0; i < air.heard_.size(); ++i) heard = heard || air.decodes(i, said);
  EXPECT_TRUE(heard);
}

TEST(IrDemodulator, a_lost_block_costs_the_frame_it_cuts_and_no_more) {
  Air air;
  air.send(0.01);
  const Announcement after = air.send(0.06);
  air.pass(3000);
  air.sampler_.next(1000, kStart);  // never handed on
  while (air.sampler_.time_s() < 0.1) air.pass(1000);
  EXPECT_EQ(air.demodulator_.gaps(), 1u);
  ASSERT_EQ(air.heard_.size(), 1u);
  EXPECT_TRUE(air.decodes(0, after));
}

TEST(IrDemodulator, stamps_that_tremble_are_no_gap) {
  Air air;
  const Announcement said = air.send(0.01);
  for (int i = 0; i < 20; ++i) air.pass(500, std::chrono::microseconds(i % 2 ? 400 : 0));
  EXPECT_EQ(air.demodulator_.gaps(), 0u);
  ASSERT_EQ(air.heard_.size(), 1u);
  EXPECT_TRUE(air.decodes(0, said));
}

TEST(IrDemodulator, a_rate_that_trembles_cuts_no_frame) {
  Air air;
  const Announcement said = air.send(0.01);
  for (int i = 0; i < 20; ++i) {
    IrSampleBlock block = air.sampler_.next(500, kStart + from_seconds(air.sampler_.time_s()));
    block.sample_rate_hz *= 1 + 20e-6 * (i % 3);
    air.demodulator_.process(block, [&](const RawIrFrame& frame) { air.heard_.push_back(frame); });
  }
  EXPECT_EQ(air.demodulator_.gaps(), 0u);
  ASSERT_EQ(air.heard_.size(), 1u);
  EXPECT_TRUE(air.decodes(0, said));
}

TEST(IrDemodulator, blocks_that_cannot_be_heard_are_dropped_by_their_reason) {
  IrDemodulator demodulator(kBitRate_bps, kFullScale_counts);
  const auto refused = [&](double rate_hz, int channels, std::size_t samples) {
    return demodulator.process({kStart, rate_hz, channels, std::vector<std::int16_t>(samples)},
                               [](const RawIrFrame&) { FAIL(); });
  };
  EXPECT_EQ(refused(kSampleRate_hz, 8, 800), std::nullopt);
  EXPECT_EQ(refused(19200, 8, 800), SampleDrop::kRate);
  EXPECT_EQ(refused(100000, 8, 800), SampleDrop::kRate);
  EXPECT_EQ(refused(std::nan(""), 8, 800), SampleDrop::kRate);
  EXPECT_EQ(refused(kSampleRate_hz, 0, 800), SampleDrop::kChannels);
  EXPECT_EQ(refused(kSampleRate_hz, 9, 900), SampleDrop::kChannels);
  EXPECT_EQ(refused(kSampleRate_hz, 8, 801), SampleDrop::kSize);
  EXPECT_EQ(refused(76800, 2, 0), std::nullopt);
  EXPECT_EQ(demodulator.drops().total(), 6u);
}

TEST(IrDemodulator, extreme_samples_are_safe) {
  IrDemodulator demodulator(kBitRate_bps, kFullScale_counts);
  IrSampleBlock block;
  block.stamp = Stamp::max();
  for (int i = 0; i < 40000; ++i) block.samples.push_back(i % 64 < 32 ? INT16_MIN : INT16_MAX);
  demodulator.process(block, [](const RawIrFrame&) {});
  block.samples.assign(80000, 0);
  demodulator.process(block, [](const RawIrFrame&) { FAIL(); });
}

}  // namespace
}  // namespace lodestar
