// Pseudo-random numbers that are identical on every machine and for every number of threads.
#pragma once

#include <cstdint>
#include <random>

namespace heatsoak::base {

/// A random stream that is determined by (seed, stream). Each sample uses its own stream.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(mixed(seed + mixed(stream))) {}

  /// Returns a uniform number in the open interval (0, 1).
  double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }

 private:
  /// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): neighbouring seeds give unrelated streams.
  static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
  }

  std::mt19937_64 engine_;
};

}  // namespace heatsoak::base
