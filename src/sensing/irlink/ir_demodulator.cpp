#include "lodestar/sensing/irlink/ir_demodulator.hpp"

#include <algorithm>
#include <cmath>

#include "frame_slicer.hpp"
#include "manchester_filter.hpp"
#include "reed_solomon.hpp"
#include "sync_search.hpp"

namespace lodestar {

namespace {

constexpr int kChunk = 1024;  // samples that are worked on at once
constexpr double kGap_s = 1e-3;
constexpr double kRateTolerance = 1e-3;
constexpr unsigned kMendingTrials = 1u << kDoubtfulBits;

/// 0 when there is no even number of samples from 4 to 32 to a bit.
int samples_per_bit(double sample_rate_hz, double bit_rate_bps) {
  const double ratio = sample_rate_hz / bit_rate_bps;
  if (!(ratio > 3 && ratio < 33)) return 0;
  const int whole = 2 * static_cast<int>(std::lround(ratio / 2));
  return std::abs(ratio - whole) <= kRateTolerance * whole ? whole : 0;
}

}  // namespace

const char* name(SampleDrop reason) {
  switch (reason) {
    case SampleDrop::kRate:
      return "sample rate";
    case SampleDrop::kChannels:
      return "sample channels";
    case SampleDrop::kSize:
      return "sample count";
    case SampleDrop::kCount:
      break;
  }
  return "unknown";
}

/// One uninterrupted run of samples, as many of them to a bit.
class IrDemodulator::Stream {
 public:
  Stream(const IrSampleBlock& block, int samples_per_bit, double full_scale_counts)
      : samples_per_bit_(samples_per_bit),
        sync_span_(kIrSyncBits * samples_per_bit),
        frame_span_((kIrFrameBits - 1) * samples_per_bit + 1 + FrameSlicer::kMargin),
        channels_(block.channels),
        full_scale_counts_(full_scale_counts),
        filter_(block.channels, samples_per_bit, full_scale_counts, kChunk),
        slicer_(samples_per_bit) {
    matched_.reserve(static_cast<std::size_t>(2 * (frame_span_ + sync_span_) + kChunk));
    frame_.levels.reserve(kIrLanes);
  }

  /// A rate that trembles from block to block is the same: the clock is recovered from each frame.
  bool suits(const IrSampleBlock& block, int samples_per_bit) const {
    return block.channels == channels_ && samples_per_bit == samples_per_bit_;
  }

  /// Whether the block begins where the last one ended.
  bool continued_by(const IrSampleBlock& block) const {
    return taken_ == 0 || std::abs(seconds(block.stamp - stamp_of(static_cast<double>(taken_)))) <= kGap_s;
  }

  void restart() {
    filter_ = ManchesterFilter(channels_, samples_per_bit_, full_scale_counts_, kChunk);
    matched_.clear();
    searched_ = spoilt_until_ = 0;
    taken_ = block_first_ = 0;
    candidate_.reset();
  }

  void process(const IrSampleBlock& block, const Visit& visit) {
    block_stamp_ = block.stamp;
    rate_hz_ = block.sample_rate_hz;
    block_first_ = taken_;
    const int count = static_cast<int>(block.samples.size()) / channels_;
    for (int begin = 0; begin < count; begin += kChunk) {
      const int chunk = std::min(kChunk, count - begin);
      filter_.push(block.samples.data() + begin * channels_, chunk, matched_);
      taken_ += chunk;
      search(visit);
      forget();
    }
  }

 private:
  struct Candidate {
    int at = 0;  ///< in matched_
    SyncMatch match;
  };

  int size() const { return static_cast<int>(matched_.size()); }

  /// Of the sample with this number since the start.
  Stamp stamp_of(double sample) const {
    return block_stamp_ + from_seconds((sample - static_cast<double>(block_first_)) / rate_hz_);
  }

  /// Among the places where a frame may begin the best one counts that no better one follows within the pattern's span.
  void search(const Visit& visit) {
    searched_ = std::max(searched_, FrameSlicer::kMargin);
    while (true) {
      const bool settled = candidate_ && searched_ >= candidate_->at + sync_span_;
      if (settled && size() < candidate_->at + frame_span_) return;
      if (settled) {
        hear(visit);
        continue;
      }
      if (searched_ + sync_span_ > size()) return;
      const auto match = match_sync(&matched_[static_cast<std::size_t>(searched_)], samples_per_bit_);
      if (match && (!candidate_ || match->score > candidate_->match.score)) candidate_ = Candidate{searched_, *match};
      ++searched_;
    }
  }

  void hear(const Visit& visit) {
    const int at = candidate_->at;
    const SlicedFrame sliced = slicer_.slice(&matched_[static_cast<std::size_t>(at)], candidate_->match);
    candidate_.reset();
    frame_.octets = sliced.octets;
    // A frame that is none may hide one that begins within it. A transmitter that jams with the pattern alone would
    // have each of its own mended: within a spoilt one only what is sound as it stands counts.
    const bool in_spoilt = at < spoilt_until_;
    const bool is_sound = mend(sliced, in_spoilt ? 1 : kMendingTrials);
    if (!is_sound && !in_spoilt) spoilt_until_ = at + frame_span_;
    searched_ = at + (is_sound ? frame_span_ : sync_span_);
    const auto newest = static_cast<double>(taken_ - filter_.delay());
    frame_.stamp = stamp_of(newest - (size() - at) + sliced.begin);
    frame_.levels.clear();
    for (int c = 0; c < channels_;
         ++c)  // an amplitude is half a bit's samples times the swing, which is twice the mean
      frame_.levels.push_back(std::max(0.f, sliced.amplitude[static_cast<std::size_t>(c)] / samples_per_bit_));
    visit(frame_);
  }

  bool sound(IrOctets octets) const {
    return code_.correct(octets) && read_field<std::uint16_t>(octets, ir_field::kCrc) == frame_crc(octets);
  }

  /// Whether the frame is sound, if need be with some of its least certain bits turned: with kMendingTrials all ways
  /// are tried, one bit turned from each to the next (D. Chase, "A class of algorithms for decoding block codes with
  /// channel measurement information", IEEE Trans. Information Theory 18, 1972, algorithm 2).
  bool mend(const SlicedFrame& sliced, unsigned trials) {
    IrOctets octets = sliced.octets;
    for (unsigned trial = 1; trial <= trials; ++trial) {
      if (sound(octets)) {
        frame_.octets = octets;
        return true;
      }
      std::size_t turned = 0;  // of a Gray code: the lowest bit that is set
      while (turned + 1 < kDoubtfulBits && !(trial >> turned & 1)) ++turned;
      flip_bit(octets, sliced.doubtful[turned]);
    }
    return false;
  }

  void forget() {
    const int kept_from = (candidate_ ? candidate_->at : searched_) - FrameSlicer::kMargin;
    if (kept_from < frame_span_) return;
    matched_.erase(matched_.begin(), matched_.begin() + kept_from);
    searched_ -= kept_from;
    spoilt_until_ = std::max(0, spoilt_until_ - kept_from);
    if (candidate_) candidate_->at -= kept_from;
  }

  int samples_per_bit_, sync_span_, frame_span_, channels_;
  double full_scale_counts_, rate_hz_ = 0;  ///< the newest block's
  ManchesterFilter filter_;
  FrameSlicer slicer_;
  ReedSolomon code_;
  std::vector<IrLanes> matched_;  ///< the filter's outputs that a frame may still begin in
  int searched_ = 0;              ///< up to here in matched_
  int spoilt_until_ = 0;          ///< where in matched_ the last frame that was none ends
  std::optional<Candidate> candidate_;
  std::int64_t taken_ = 0, block_first_ = 0;  ///< samples since the start
  Stamp block_stamp_;
  RawIrFrame frame_;
};

IrDemodulator::IrDemodulator(double bit_rate_bps, double full_scale_counts)
    : bit_rate_bps_(bit_rate_bps), full_scale_counts_(full_scale_counts) {}

IrDemodulator::IrDemodulator(IrDemodulator&&) noexcept = default;
IrDemodulator& IrDemodulator::operator=(IrDemodulator&&) noexcept = default;
IrDemodulator::~IrDemodulator() = default;

std::optional<SampleDrop> IrDemodulator::fault_of(const IrSampleBlock& block) const {
  if (samples_per_bit(block.sample_rate_hz, bit_rate_bps_) == 0) return SampleDrop::kRate;
  if (block.channels < 1 || block.channels > kIrLanes) return SampleDrop::kChannels;
  if (block.samples.size() % static_cast<std::size_t>(block.channels) != 0) return SampleDrop::kSize;
  return std::nullopt;
}

std::optional<SampleDrop> IrDemodulator::process(const IrSampleBlock& block, const Visit& visit) {
  if (const auto fault = fault_of(block)) {
    drops_.add(*fault);
    return fault;
  }
  const int per_bit = samples_per_bit(block.sample_rate_hz, bit_rate_bps_);
  if (!stream_ || !stream_->suits(block, per_bit))
    stream_ = std::make_unique<Stream>(block, per_bit, full_scale_counts_);
  if (!stream_->continued_by(block)) {
    ++gaps_;
    stream_->restart();
  }
  stream_->process(block, visit);
  return std::nullopt;
}

void IrDemodulator::reset() { stream_.reset(); }

}  // namespace lodestar
