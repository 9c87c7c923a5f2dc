#pragma once

namespace lodestar {

/// Pixels that are read soon begin to come nearer now: the processor guesses no way through frames and windows.
template <class Pixel>
void prefetch(const Pixel* pixels, int count) {
  constexpr int kLine = 64 / sizeof(Pixel);
  for (int i = 0; i < count; i += kLine) __builtin_prefetch(pixels + i);
}

/// The same for pixels that are read once: they do not drive out of the caches what is read again in each frame.
template <class Pixel>
void prefetch_once(const Pixel* pixels, int count) {
  constexpr int kLine = 64 / sizeof(Pixel);
  for (int i = 0; i < count; i += kLine) __builtin_prefetch(pixels + i, 0, 0);
}

}  // namespace lodestar
