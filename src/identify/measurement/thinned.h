// A sample of a sequence whose length nobody knows beforehand.
#pragma once

#include <cstddef>
#include <vector>

namespace heatsoak {

/// Every n-th of the numbers that come, n the least power of two with which they stay below a bound.
class Thinned {
 public:
  static constexpr std::size_t kMost = 1 << 16;

  /// `most` is even.
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
  /// In the order in which they came.
  [[nodiscard]] const std::vector<double>& values() const { return values_; }

 private:
  std::size_t most_;
  std::size_t seen_ = 0;
  std::size_t stride_ = 1;
  std::vector<double> values_;
};

}  // namespace heatsoak
