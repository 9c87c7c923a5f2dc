#pragma once

#include <algorithm>
#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace lodestar::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes bytes(const std::string& text) { return Bytes(text.begin(), text.end()); }

/// By libbz2.
/// @param level size of the blocks, 1 to 9 times 100 kB
inline Bytes compress(const Bytes& text, int level = 9) {
  namespace io = boost::iostreams;
  std::vector<char> packed;
  io::filtering_ostream out;
  out.push(io::bzip2_compressor(io::bzip2_params(level)));
  out.push(io::back_inserter(packed));
  out.write(reinterpret_cast<const char*>(text.data()), static_cast<std::streamsize>(text.size()));
  out.reset();
  return Bytes(packed.begin(), packed.end());
}

/// By libbz2.
inline Bytes uncompress(const Bytes& packed) {
  namespace io = boost::iostreams;
  std::vector<char> text;
  io::filtering_istream in;
  in.push(io::bzip2_decompressor(false, 1 << 16));
  in.push(io::array_source(reinterpret_cast<const char*>(packed.data()), packed.size()));
  io::copy(in, io::back_inserter(text), 1 << 16);
  return Bytes(text.begin(), text.end());
}

/// The kinds of data that try different parts of a decoder.
enum class Kind { kNoise, kRuns, kPeriods, kText, kImage, kStairs, kCount };

inline Bytes data(Kind kind, std::size_t size, std::mt19937& random) {
  Bytes out;
  out.reserve(size + 300);
  while (out.size() < size) {
    const auto i = static_cast<unsigned>(out.size());
    switch (kind) {
      case Kind::kNoise:
        out.push_back(static_cast<std::uint8_t>(random()));
        break;
      case Kind::kRuns:  // of 1 to 299, those of 4, 5, 255 and 259 among them
        out.insert(out.end(), random() % 3 ? 1 + random() % 6 : random() % 300,
                   static_cast<std::uint8_t>(random() % 3));
        break;
      case Kind::kPeriods:
        out.push_back(static_cast<std::uint8_t>("abcab"[i % 5]));
        break;
      case Kind::kText:
        for (const char c : std::to_string(random() % 1000) + " pallets in aisle ")
          out.push_back(static_cast<std::uint8_t>(c));
        break;
      case Kind::kImage:  // dark, a little noise, a few lights
        out.push_back(static_cast<std::uint8_t>(random() % 5000 ? 10 + random() % 3 + random() % 3 : random()));
        break;
      case Kind::kStairs:
        out.push_back(static_cast<std::uint8_t>(i / 7));
        break;
      case Kind::kCount:
        return out;
    }
  }
  out.resize(size);
  return out;
}

}  // namespace lodestar::test
