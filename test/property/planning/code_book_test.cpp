#include "lodestar/planning/code_book.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/sensing/beacon/tone_bank.hpp"
#include "lodestar/sensing/beacon/tone_code.hpp"

namespace lodestar {
namespace {

/// Where |m - k fs| of the mains' flicker and its multiples lie, written down once more.
double nearest_alias_hz(double tone_hz, double rate_hz, double mains_hz) {
  double nearest_hz = 1e9;
  for (int n = 1; n <= 5; ++n)
    for (int k = 0; k <= 100; ++k)
      nearest_hz = std::min(nearest_hz, std::abs(std::abs(2 * mains_hz * n - k * rate_hz) - tone_hz));
  return nearest_hz;
}

/// What the camera's pixel shows of a code over a window; clipped at `white` of the peak.
Eigen::VectorXf window(const CodeBook& book, ToneSet code, const CodeBookParams& params, double white,
                       std::mt19937& random) {
  std::uniform_real_distribution<double> turn(0, 1);
  Eigen::VectorXd wave = Eigen::VectorXd::Zero(params.window_frames);
  for (const int tone : code.indices()) {
    const double start = turn(random);
    for (int i = 0; i < params.window_frames; ++i) {
      const double turns = start + book.tone_table_hz[static_cast<std::size_t>(tone)] * i / params.rate_hz;
      const double cosine = std::cos(2 * kPi * turns);
      wave[i] += (params.waveform == Waveform::kSquare ? std::copysign(1.0, cosine) : cosine) / code.size();
    }
  }
  return (0.5 + 0.5 * wave.array()).min(white).matrix().cast<float>();
}

ToneSet decoded(const CodeBook& book, const CodeBookParams& params, const Eigen::VectorXf& signal,
                const ToneCodeParams& detector) {
  std::vector<Stamp> stamps;
  for (int i = 0; i < params.window_frames; ++i) stamps.push_back(Stamp{} + from_seconds(i / params.rate_hz));
  const ToneBank bank(stamps, book.tone_table_hz);
  const Eigen::VectorXf q = bank.basis() * signal;
  TonePowers power(bank.tones());
  for (int k = 0; k < bank.tones(); ++k) power[k] = tone_power(q, k);
  return decide_code(power, detector);
}

TEST(CodeBook, keeps_off_mains_nyquist_and_zero_for_every_camera) {
  int books = 0;
  for (const double rate_hz : {20.0, 24.0, 25.0, 29.97, 30.0, 40.0, 50.0, 59.94, 60.0, 75.0, 90.0, 100.0, 120.0})
    for (const int frames : {5, 10, 15, 24, 30, 45, 60})
      for (const double mains_hz : {50.0, 60.0})
        for (const Waveform waveform : {Waveform::kSine, Waveform::kSquare}) {
          const CodeBookParams params{rate_hz, frames, mains_hz, waveform, {1}, 4};
          const CodeBook book = make_code_book(params, 1);
          SCOPED_TRACE(testing::Message() << rate_hz << " frames/s, window " << frames << ", mains " << mains_hz);
          if (book.codes.empty()) continue;
          ++books;
          const double bin_hz = rate_hz / frames;
          EXPECT_LE(book.tone_table_hz.size(), static_cast<std::size_t>(ToneSet::kMaxTones));
          for (const double tone_hz : book.tone_table_hz) {
            EXPECT_GT(nearest_alias_hz(tone_hz, rate_hz, mains_hz), bin_hz / 2) << tone_hz;
            EXPECT_GE(tone_hz, 4);
            EXPECT_LE(tone_hz, (rate_hz - bin_hz) / 2 + 1e-3);
          }
          Site site;
          site.tone_table_hz = book.tone_table_hz;
          EXPECT_TRUE(check_tones(site, {rate_hz, mains_hz, frames}, "plan").empty());
        }
  EXPECT_GT(books, 300);  // of 364: some cameras have no tone at all
}

TEST(CodeBook, is_at_least_the_one_of_the_link_page) {
  const std::vector<double> page_hz = {6, 8, 10, 12, 14, 16, 24, 26};
  const CodeBookParams params{60, 30, 50, Waveform::kSine, {2}, 4};
  const CodeBook pairs = make_code_book(params, 23);
  EXPECT_GE(pairs.codes.size(), 23u) << "28 pairs less 6 12, 6 24, 8 16, 8 24, 12 24";
  EXPECT_EQ(pairs.guard, 3);
  double nearest_hz = 1e9, page_nearest_hz = 1e9;
  for (const double tone_hz : pairs.tone_table_hz)
    nearest_hz = std::min({nearest_hz, nearest_alias_hz(tone_hz, 60, 50), 30 - tone_hz, tone_hz});
  for (const double tone_hz : page_hz)
    page_nearest_hz = std::min({page_nearest_hz, nearest_alias_hz(tone_hz, 60, 50), 30 - tone_hz, tone_hz});
  EXPECT_GE(nearest_hz, page_nearest_hz);
  EXPECT_GE(pairs.tone_table_hz.size(), page_hz.size());
}

/// The detector itself reads every code of a book, also where the camera clips the beacon.
TEST(CodeBook, is_read_by_the_detector) {
  std::mt19937 random(1);
  for (const Waveform waveform : {Waveform::kSine, Waveform::kSquare})
    for (const int wanted : {1, 1000})
      for (const int frames : {15, 30}) {
        CodeBookParams params{60, frames, 50, waveform, {2}, 4};
        if (waveform == Waveform::kSquare) params.tones_per_code = {1};
        const CodeBook book = make_code_book(params, wanted);
        ASSERT_FALSE(book.codes.empty());
        for (std::size_t i = 0; i < book.codes.size(); ++i)
          for (int trial = 0; trial < 20; ++trial) {
            ToneCodeParams detector;
            const bool robust = static_cast<int>(i) < book.robust;
            detector.margin_db += robust ? 0.9 * kReserve_db : -0.3;  // phases are drawn, not those of the book
            detector.balance_db -= robust ? 0.4 * kReserve_db : -0.3;
            const double white = trial % 2 ? 0.65 : 1.0;
            EXPECT_EQ(decoded(book, params, window(book, book.codes[i], params, white, random), detector).bits(),
                      book.codes[i].bits())
                << "code " << i << " of " << book.codes.size() << ", " << frames << " frames, white " << white;
          }
      }
}

/// 3 x 8 Hz is 24 Hz, and 3 x 24 Hz and 3 x 16 Hz fold to 12 Hz: a strict table of square tones holds no such two.
TEST(CodeBook, square_tones_keep_off_odd_harmonics) {
  const CodeBook book = make_code_book({60, 30, 50, Waveform::kSquare, {1}, 4}, 1);
  EXPECT_GE(book.tone_table_hz.size(), 5u);
  EXPECT_EQ(book.codes.size(), book.tone_table_hz.size());
  for (const double a : book.tone_table_hz)
    for (const double b : book.tone_table_hz) {
      if (a == b) continue;
      EXPECT_GT(std::abs(std::abs(std::remainder(3 * a, 60)) - b), 1) << a << " and " << b;
    }
}

/// 6 12, 12 24, 12 14 26: a light that glitters may have them.
TEST(CodeBook, has_no_code_that_one_rhythm_or_a_beat_makes) {
  int codes = 0;
  for (const int frames : {15, 30, 45, 60})
    for (const int wanted : {1, 20, 1000}) {
      const CodeBook book = make_code_book({60, frames, 50, Waveform::kSine, {2, 3}, 4}, wanted);
      for (const ToneSet code : book.codes) {
        ++codes;
        std::vector<long> mhz;
        for (const int tone : code.indices())
          mhz.push_back(std::lround(1e3 * book.tone_table_hz[static_cast<std::size_t>(tone)]));
        for (const long a : mhz)
          for (const long b : mhz) {
            EXPECT_FALSE(b > a && b % a == 0) << a << " and " << b;
            for (const long c : mhz) EXPECT_FALSE(a < b && a + b == c) << a << ", " << b << " and " << c;
          }
      }
    }
  EXPECT_GT(codes, 500);
}

/// 14 16: a light that glitters, now more and now less, may have them.
TEST(CodeBook, keeps_a_codes_tones_apart_where_it_can) {
  const auto closest_hz = [](const CodeBook& book) {
    double closest_hz = 1e9;
    for (const ToneSet code : book.codes) {
      const std::vector<int> own = code.indices();
      for (std::size_t i = 1; i < own.size(); ++i)
        closest_hz = std::min(closest_hz, book.tone_table_hz[static_cast<std::size_t>(own[i])] -
                                              book.tone_table_hz[static_cast<std::size_t>(own[i - 1])]);
    }
    return closest_hz;
  };
  EXPECT_GT(closest_hz(make_code_book({}, 16)), 3.9);
  EXPECT_NEAR(closest_hz(make_code_book({}, 22)), 2, 0.1) << "pairs of neighbours before triples";
}

TEST(CodeBook, holds_the_papers_plan) {
  const CodeBook book = make_code_book({25, 5, 50, Waveform::kSquare, {1}, 4}, 2);
  EXPECT_EQ(book.tone_table_hz, (std::vector<double>{5, 10}));
  EXPECT_EQ(book.codes.size(), 2u);
}

TEST(CodeBook, takes_triples_only_where_pairs_do_not_do) {
  CodeBookParams params;
  for (const ToneSet code : make_code_book(params, 12).codes) EXPECT_EQ(code.size(), 2);
  const CodeBook more = make_code_book(params, 45);
  EXPECT_GE(more.codes.size(), 45u);
  EXPECT_EQ(more.guard, 3);
}

}  // namespace
}  // namespace lodestar
