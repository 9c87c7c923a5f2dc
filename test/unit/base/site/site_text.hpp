#pragma once

#include <gtest/gtest.h>

#include <string>

#include "lodestar/base/common/fault.hpp"
#include "lodestar/base/common/result.hpp"

namespace lodestar {

/// `text` with the only occurrence of `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " is not in the text";
  if (at == std::string::npos) return text;
  EXPECT_EQ(text.find(from, at + 1), std::string::npos) << from << " is in the text twice";
  return text.replace(at, from.size(), to);
}

/// The faults as printed; empty when there are none.
template <class T>
std::string faults_of(const Result<T, Faults>& result) {
  return result.ok() ? "" : describe(result.error());
}

}  // namespace lodestar
