#pragma once
// Random numbers that are the same with every standard library: only the engine is from it, the distributions are written here.
#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>

namespace heatsoak::suite {

/// Seed of one part of the suite. Parts with different labels have independent random numbers, so a part can be made alone.
std::uint64_t seed_of(std::uint64_t seed, std::string_view label);

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  Random(std::uint64_t seed, std::string_view label) : engine_(seed_of(seed, label)) {}

  /// Uniform in [low, high).
  double uniform(double low = 0.0, double high = 1.0);
  /// Uniform on a logarithmic scale; both bounds are positive.
  double log_uniform(double low, double high);
  /// Standard normal (Box and Muller 1958).
  double normal();
  /// Exponential with this mean.
  double exponential(double mean);
  /// Uniform in 0 … count-1.
  std::size_t index(std::size_t count);
  bool chance(double probability) { return uniform() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace heatsoak::suite
