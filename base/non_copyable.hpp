#pragma once
/// \file Base of classes that own something which cannot be had twice.

namespace bough {

/// Objects of a class derived from this one are neither copied nor moved.
class NonCopyable {
 public:
  NonCopyable(const NonCopyable&) = delete;
  NonCopyable& operator=(const NonCopyable&) = delete;

 protected:
  NonCopyable() = default;
  ~NonCopyable() = default;
};

}  // namespace bough
