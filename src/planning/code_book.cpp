#include "lodestar/planning/code_book.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/sensing/beacon/tone_bank.hpp"
#include "lodestar/sensing/beacon/tone_code.hpp"

namespace lodestar {

namespace {

/// The white level of a camera that clips, as shares of the beacon's peak. At 0.65 a pair's products stand 11 dB below
/// its tones; much further down few codes of any table are left.
constexpr std::array<double, 2> kWhiteLevels = {0.8, 0.65};
constexpr int kPhases = 48;
constexpr float kNothing = 1e-9F;  ///< a power

/// Tones that may be sent: each passes check_tones as if the window were `guard` times shorter.
std::vector<double> candidate_tones(const CodeBookParams& params, int guard) {
  std::vector<double> tones_hz;
  const FrameRate frame_rate{params.rate_hz, params.mains_hz, params.window_frames / guard};
  for (int k = 1; k <= params.window_frames / 2; ++k) {
    const double tone_hz = std::round(1e4 * k * params.rate_hz / params.window_frames) * 1e-4;
    Site site;
    site.tone_table_hz = {tone_hz};
    if (tone_hz >= params.lowest_tone_hz && check_tones(site, frame_rate, "").empty()) tones_hz.push_back(tone_hz);
  }
  const std::size_t count = tones_hz.size(), most = ToneSet::kMaxTones;
  if (count <= most) return tones_hz;
  std::vector<double> spread_hz;
  for (std::size_t i = 0; i < most; ++i) spread_hz.push_back(tones_hz[i * count / most]);
  return spread_hz;
}

/// Whether one rhythm, or two tones and their beat, make the whole set: a tone is a multiple of another or the sum of
/// two others. What glitters in passing does that (docs/math/detector.md, limits).
bool intermodulates(ToneSet code, const std::vector<double>& tones_hz) {
  constexpr double kAlike_hz = 1e-3;
  std::vector<double> own_hz;
  for (const int tone : code.indices()) own_hz.push_back(tones_hz[static_cast<std::size_t>(tone)]);
  for (std::size_t high = 1; high < own_hz.size(); ++high) {
    for (std::size_t low = 0; low < high; ++low) {
      if (std::abs(std::remainder(own_hz[high], own_hz[low])) < kAlike_hz) return true;
      for (std::size_t lower = 0; lower < low; ++lower)
        if (std::abs(own_hz[lower] + own_hz[low] - own_hz[high]) < kAlike_hz) return true;
    }
  }
  return false;
}

/// Whether two of its tones lie next to one another in the bank: what glitters in passing, now more and now less, has
/// such a pair (docs/math/detector.md, limits).
bool has_neighbours(ToneSet code, const CodeBookParams& params, const std::vector<double>& tones_hz) {
  const double apart_hz = 1.5 * params.rate_hz / params.window_frames;
  const std::vector<int> own = code.indices();
  return std::adjacent_find(own.begin(), own.end(), [&](int low, int high) {
           return tones_hz[static_cast<std::size_t>(high)] - tones_hz[static_cast<std::size_t>(low)] < apart_hz;
         }) != own.end();
}

/// One code among the candidate tones.
struct Assessed {
  ToneSet code;
  bool usable = false, robust = false;      ///< whether its own tones are of like power
  std::uint32_t disturbs = 0, brushes = 0;  ///< tones that it must not share a table with, to be usable and robust
};

/// What the camera sees of codes, and what the detector's bank makes of it.
class Bench {
 public:
  Bench(const CodeBookParams& params, const std::vector<double>& tones_hz)
      : params_(params), tones_hz_(tones_hz), basis_(bank(params, tones_hz).basis()) {}

  std::vector<Assessed> assess_all(int tones_per_code) const {
    std::vector<Assessed> out;
    add_codes({}, 0, tones_per_code, out);
    return out;
  }

 private:
  static ToneBank bank(const CodeBookParams& params, const std::vector<double>& tones_hz) {
    std::vector<Stamp> stamps;
    for (int i = 0; i < params.window_frames; ++i) stamps.push_back(Stamp{} + from_seconds(i / params.rate_hz));
    return {stamps, tones_hz};
  }

  void add_codes(ToneSet code, int first, int missing, std::vector<Assessed>& out) const {
    if (missing == 0 && !intermodulates(code, tones_hz_)) out.push_back(assess(code));
    for (int tone = first; missing > 0 && tone < static_cast<int>(tones_hz_.size()); ++tone) {
      ToneSet longer = code;
      longer.insert(tone);
      add_codes(longer, tone + 1, missing - 1, out);
    }
  }

  /// One window a column: the code at each white level and at phases that fill the cube evenly.
  Eigen::MatrixXf windows(const std::vector<int>& code) const {
    // 1/g, 1/g^2, 1/g^3 of g^4 = g + 1: their multiples fill the cube evenly.
    constexpr double kSteps[] = {0.8191725134, 0.6710436067, 0.5497004779};
    Eigen::MatrixXf out(params_.window_frames, kPhases * static_cast<int>(kWhiteLevels.size()));
    for (int column = 0; column < out.cols(); ++column) {
      const double white = kWhiteLevels[static_cast<std::size_t>(column / kPhases)];
      for (int frame = 0; frame < out.rows(); ++frame) {
        double wave = 0;
        for (std::size_t i = 0; i < code.size(); ++i) {
          const double turns = tones_hz_[static_cast<std::size_t>(code[i])] * frame / params_.rate_hz;
          const double cosine = std::cos(2 * kPi * (turns + (column % kPhases + 0.5) * kSteps[i]));
          wave += params_.waveform == Waveform::kSquare ? std::copysign(1, cosine) : cosine;
        }
        out(frame, column) = static_cast<float>(std::min(0.5 + 0.5 * wave / static_cast<double>(code.size()), white));
      }
    }
    return out;
  }

  /// The worst case over all windows.
  Assessed assess(ToneSet code) const {
    const std::vector<int> own = code.indices();
    const Eigen::ArrayXXf squares = (basis_ * windows(own)).array().square();
    Eigen::ArrayXf highest = Eigen::ArrayXf::Zero(static_cast<Eigen::Index>(tones_hz_.size()));
    float imbalance = 1;
    for (Eigen::Index column = 0; column < squares.cols(); ++column) {
      const Eigen::ArrayXf power =
          Eigen::Map<const Eigen::Array2Xf>(squares.col(column).data(), 2, highest.size()).colwise().sum().transpose();
      float weakest = power.maxCoeff(), strongest = 0;
      for (const int tone : own) {
        weakest = std::min(weakest, std::max(power[tone], kNothing));
        strongest = std::max(strongest, power[tone]);
      }
      highest = highest.max(power / weakest);
      imbalance = std::max(imbalance, strongest / weakest);
    }
    return judge(code, highest, imbalance);
  }

  /// By the margins of decide_code.
  Assessed judge(ToneSet code, const Eigen::ArrayXf& highest, float imbalance) const {
    const ToneCodeParams detector;
    Assessed out;
    out.code = code;
    out.usable = decibel(imbalance) < detector.balance_db;
    out.robust = decibel(imbalance) < detector.balance_db - kReserve_db / 2;
    for (int tone = 0; tone < highest.size(); ++tone) {
      if (code.contains(tone)) continue;
      if (decibel(highest[tone]) > -detector.margin_db) out.disturbs |= ToneSet{tone}.bits();
      if (decibel(highest[tone]) > -detector.margin_db - kReserve_db) out.brushes |= ToneSet{tone}.bits();
    }
    return out;
  }

  static double decibel(double ratio) { return 10 * std::log10(ratio); }

  const CodeBookParams& params_;
  const std::vector<double>& tones_hz_;
  Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> basis_;
};

bool robust_in(const Assessed& a, std::uint32_t table) { return a.robust && !(a.brushes & table); }
bool usable_in(const Assessed& a, std::uint32_t table) { return a.usable && !(a.disturbs & table); }

/// Codes of `table` that pass.
template <class Passes>
int count(const std::vector<Assessed>& codes, std::uint32_t table, Passes&& passes) {
  return static_cast<int>(std::count_if(codes.begin(), codes.end(), [&](const Assessed& a) {
    return (a.code.bits() & ~table) == 0 && passes(a, table);
  }));
}

/// Takes tones out as long as that leaves more codes than before, then those that no code is left of.
template <class Passes>
std::uint32_t choose_table(const std::vector<Assessed>& codes, std::size_t tones, Passes&& passes) {
  std::uint32_t table = 0;
  for (std::size_t i = 0; i < tones; ++i) table |= std::uint32_t{1} << i;
  int most = count(codes, table, passes);
  for (std::uint32_t best = 0; best != table;) {
    best = table;
    for (std::size_t i = 0; i < tones; ++i) {
      const std::uint32_t without = table & ~(std::uint32_t{1} << i);
      const int left = count(codes, without, passes);
      if (left <= most) continue;
      most = left;
      best = without;
    }
    std::swap(best, table);
  }
  std::uint32_t used = 0;
  for (const Assessed& a : codes)
    if ((a.code.bits() & ~table) == 0 && passes(a, table)) used |= a.code.bits();
  return used;
}

/// The codes by their indices into the table that is left.
template <class Passes>
CodeBook book_of(const std::vector<Assessed>& codes, const std::vector<double>& tones_hz, Passes&& passes) {
  CodeBook book;
  const std::uint32_t table = choose_table(codes, tones_hz.size(), passes);
  std::vector<int> index(tones_hz.size(), 0);
  for (std::size_t i = 0; i < tones_hz.size(); ++i) {
    if (!(table >> i & 1u)) continue;
    index[i] = static_cast<int>(book.tone_table_hz.size());
    book.tone_table_hz.push_back(tones_hz[i]);
  }
  for (const bool robust : {true, false})
    for (const Assessed& a : codes) {
      if ((a.code.bits() & ~table) != 0 || !passes(a, table) || robust_in(a, table) != robust) continue;
      ToneSet code;
      for (const int tone : a.code.indices()) code.insert(index[static_cast<std::size_t>(tone)]);
      book.codes.push_back(code);
      book.robust += robust;
    }
  return book;
}

}  // namespace

CodeBook make_code_book(const CodeBookParams& params, int wanted) {
  CodeBook largest;
  const auto enough = [&](const CodeBook& book) { return static_cast<int>(book.codes.size()) >= wanted; };
  for (const int guard : {3, 2, 1}) {
    const std::vector<double> tones_hz = candidate_tones(params, guard);
    if (tones_hz.empty()) continue;
    const Bench bench(params, tones_hz);
    std::vector<Assessed> codes;
    for (const int tones_per_code : params.tones_per_code) {
      std::vector<Assessed> more = bench.assess_all(tones_per_code);
      const auto close = std::stable_partition(
          more.begin(), more.end(), [&](const Assessed& a) { return !has_neighbours(a.code, params, tones_hz); });
      for (const auto& [first, last] : {std::pair(more.begin(), close), std::pair(close, more.end())}) {
        codes.insert(codes.end(), first, last);
        for (CodeBook book : {book_of(codes, tones_hz, robust_in), book_of(codes, tones_hz, usable_in)}) {
          book.guard = guard;
          if (book.codes.size() > largest.codes.size()) largest = book;
          if (enough(book)) return book;
        }
      }
    }
  }
  return largest;
}

}  // namespace lodestar
