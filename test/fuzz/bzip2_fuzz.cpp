// Two bytes of unpacked size and then compressed ones, to the unpacker of bags.

#include "lodestar/bzip2/bzip2.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  if (size < 2) return 0;
  static Bzip2Unpacker unpacker;
  unpacker.unpack({Bzip2Packed{data + 2, size - 2, data[0] + std::size_t{256} * data[1]}});
  return 0;
}
