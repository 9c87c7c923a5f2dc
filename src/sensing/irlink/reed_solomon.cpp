#include "reed_solomon.hpp"

#include <new>

extern "C" {
#include <fec.h>
}

namespace lodestar {

ReedSolomon::ReedSolomon()
    : code_(init_rs_char(8, 0x11D, 0, 1, kParityOctets, 255 - static_cast<int>(RawIrFrame::kOctets)), free_rs_char) {
  if (!code_) throw std::bad_alloc();
}

void ReedSolomon::add_parity(Octets& octets) const {
  encode_rs_char(code_.get(), octets.data(), octets.data() + octets.size() - kParityOctets);
}

std::optional<int> ReedSolomon::correct(Octets& octets) const {
  const Octets received = octets;
  if (decode_rs_char(code_.get(), octets.data(), nullptr, 0) < 0) return std::nullopt;

  // An error that the decoder places in the padding, which was never sent, cannot be mended. Debian's libfec refuses
  // it; its documentation does not promise so. What is no code word was not mended.
  Octets word = octets;
  add_parity(word);
  if (word != octets) return std::nullopt;

  int corrected = 0;
  for (std::size_t i = 0; i < octets.size(); ++i) corrected += octets[i] != received[i] ? 1 : 0;
  return corrected;
}

}  // namespace lodestar
