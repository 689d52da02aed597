#include "random.h"

#include <cmath>
#include <numbers>

namespace heatsoak::suite {

std::uint64_t seed_of(std::uint64_t seed, std::string_view label) {
  // FNV-1a of the label, then the mixer of SplitMix64 (Steele et al. 2014).
  std::uint64_t hash = 0xcbf29ce484222325ULL ^ (seed * 0x9e3779b97f4a7c15ULL);
  for (const char c : label) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ULL;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebULL;
  return hash ^ (hash >> 31);
}

double Random::uniform(double low, double high) {
  const double unit = static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  return low + (high - low) * unit;
}

double Random::log_uniform(double low, double high) { return low * std::exp(uniform() * std::log(high / low)); }

double Random::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

double Random::exponential(double mean) { return -mean * std::log(1.0 - uniform()); }

std::size_t Random::index(std::size_t count) { return static_cast<std::size_t>(uniform() * static_cast<double>(count)); }

}  // namespace heatsoak::suite
