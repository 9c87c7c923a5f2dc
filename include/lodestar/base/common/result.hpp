#pragma once

#include <utility>
#include <variant>

namespace lodestar {

/// A value, or the reason why there is none. T and E are different types.
template <class T, class E>
class Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(E error) : content_(std::move(error)) {}

  bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  /// Calling value() on an error, or error() on a value, throws std::bad_variant_access.
  const T& value() const& { return std::get<T>(content_); }
  T&& value() && { return std::get<T>(std::move(content_)); }
  const E& error() const { return std::get<E>(content_); }

  const T& operator*() const& { return value(); }
  const T* operator->() const { return &value(); }

 private:
  std::variant<T, E> content_;
};

}  // namespace lodestar
