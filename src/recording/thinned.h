// Evenly spaced sample of a sequence of unknown length.
#pragma once

#include <cstddef>
#include <vector>

namespace heatsoak::recording {

/// Keeps every n-th number; n is the smallest power of two for which the count stays within a bound.
class Thinned {
 public:
  static constexpr std::size_t kMost = 1 << 16;

  /// `most` must be even.
  explicit Thinned(std::size_t most = kMost) : most_(most) {}

  void add(double value) {
    if ((seen_++ & (stride_ - 1)) != 0) {
      return;
    }
    if (values_.size() == most_) {
      for (std::size_t i = 0; 2 * i < most_; ++i) {
        values_[i] = values_[2 * i];
      }
      values_.resize(most_ / 2);
      stride_ *= 2;
    }
    values_.push_back(value);
  }
  /// Kept numbers in the order of add().
  [[nodiscard]] const std::vector<double>& values() const { return values_; }

 private:
  std::size_t most_;
  std::size_t seen_ = 0;
  std::size_t stride_ = 1;
  std::vector<double> values_;
};

}  // namespace heatsoak::recording
