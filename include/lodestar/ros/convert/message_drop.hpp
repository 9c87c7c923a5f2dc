#pragma once

namespace lodestar {

/// Why a message did not become a measurement.
enum class MessageDrop {
  kEncoding,   ///< an image that is neither mono8 nor mono16
  kByteOrder,  ///< 16 bits a pixel in the other byte order
  kSize,       ///< a width or height of zero or beyond 65535, or more data than rows times step
  kStep,       ///< a row shorter than its pixels, or 16-bit rows that begin at odd addresses
  kTruncated,  ///< less data than rows times step
  kStamp,      ///< no stamp
  kFrame,      ///< not in the frame that it has to be in, or in one whose mount is not known
  kAbsent,     ///< the sender says that it does not measure this
  kNotFinite,  ///< NaN or infinite
  kRotation,   ///< a quaternion that is not of unit length
  kRange,      ///< a number outside what the field may hold
  kCount
};
const char* name(MessageDrop reason);

}  // namespace lodestar
