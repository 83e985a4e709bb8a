// A reproducible sequence of random numbers from a seed. Two streams of one seed are independent. Pure.
#pragma once

#include <cmath>
#include <cstdint>

#include "sync/random/keyed_random.h"

namespace tactus::observer {

class NoiseStream {
 public:
  NoiseStream(std::uint64_t seed, std::uint64_t stream) : seed_(sync::mixed(seed, stream)) {}

  // Uniform in (0, 1).
  double uniform() { return sync::uniform(seed_, draws_++); }
  // Normal with this standard deviation, mean 0.
  double normal(double sd = 1) { return sd * sync::normal_quantile(uniform()); }
  // Exponential with this mean.
  double exponential(double mean) { return -mean * std::log(uniform()); }

 private:
  std::uint64_t seed_, draws_ = 0;
};

}  // namespace tactus::observer
