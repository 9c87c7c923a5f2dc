#include "runs.hpp"

#include <algorithm>
#include <cstring>

namespace lodestar::bzip2 {
namespace {

constexpr std::size_t kRun = 4;

std::uint64_t word(const std::uint8_t* bytes) {
  std::uint64_t out;
  std::memcpy(&out, bytes, sizeof(out));
  return out;
}

bool has_zero_byte(std::uint64_t word) {
  constexpr std::uint64_t kOnes = 0x0101010101010101u;
  return ((word - kOnes) & ~word & kOnes << 7) != 0;
}

bool run_begins(const std::uint8_t* text) { return text[0] == text[1] && text[0] == text[2] && text[0] == text[3]; }

/// The first run of four, or `end`.
const std::uint8_t* find_run(const std::uint8_t* text, const std::uint8_t* end) {
  constexpr std::ptrdiff_t kStep = 8;
  for (; end - text >= kStep + 3; text += kStep) {
    const std::uint64_t here = word(text);
    if (has_zero_byte((here ^ word(text + 1)) | (here ^ word(text + 2)) | (here ^ word(text + 3)))) break;
  }
  for (; end - text >= static_cast<std::ptrdiff_t>(kRun); ++text)
    if (run_begins(text)) return text;
  return end;
}

}  // namespace

std::optional<std::size_t> expand_runs(const std::uint8_t* text, std::size_t size, std::uint8_t* out,
                                       std::size_t room) {
  const std::uint8_t* const end = text + size;
  std::uint8_t* const begin = out;
  while (text != end) {
    const std::uint8_t* const run = find_run(text, end);
    const std::size_t plain = static_cast<std::size_t>(run - text);
    const bool found = run != end;
    if (found && static_cast<std::size_t>(end - run) == kRun) return std::nullopt;
    const std::size_t length = found ? kRun + run[kRun] : 0;
    if (plain + length > room) return std::nullopt;
    std::copy(text, run, out);
    if (found) std::memset(out + plain, *run, length);
    out += plain + length;
    room -= plain + length;
    text = found ? run + kRun + 1 : end;
  }
  return static_cast<std::size_t>(out - begin);
}

}  // namespace lodestar::bzip2
