#include "scripts/simulated_player/observer/sobol.h"

#include <array>
#include <stdexcept>
#include <string>

#include "sync/random/keyed_random.h"

namespace tactus::observer {
namespace {

constexpr int kBits = 32;

// One coordinate after the first: the primitive polynomial with all its coefficients as bits, and the odd initial
// numbers m_i. Joe and Kuo 2008, new-joe-kuo-6, coordinates 2 to 48.
struct Direction {
  std::uint32_t polynomial;
  std::array<std::uint32_t, 8> initial;
};
constexpr std::array<Direction, kMaxSobolDimensions - 1> kDirections{{{3, {1}},
                                                                      {7, {1, 3}},
                                                                      {11, {1, 3, 1}},
                                                                      {13, {1, 1, 1}},
                                                                      {19, {1, 1, 3, 3}},
                                                                      {25, {1, 3, 5, 13}},
                                                                      {37, {1, 1, 5, 5, 17}},
                                                                      {41, {1, 1, 5, 5, 5}},
                                                                      {47, {1, 1, 7, 11, 19}},
                                                                      {55, {1, 1, 5, 1, 1}},
                                                                      {59, {1, 1, 1, 3, 11}},
                                                                      {61, {1, 3, 5, 5, 31}},
                                                                      {67, {1, 3, 3, 9, 7, 49}},
                                                                      {91, {1, 1, 1, 15, 21, 21}},
                                                                      {97, {1, 3, 1, 13, 27, 49}},
                                                                      {103, {1, 1, 1, 15, 7, 5}},
                                                                      {109, {1, 3, 1, 15, 13, 25}},
                                                                      {115, {1, 1, 5, 5, 19, 61}},
                                                                      {131, {1, 3, 7, 11, 23, 15, 103}},
                                                                      {137, {1, 3, 7, 13, 13, 15, 69}},
                                                                      {143, {1, 1, 3, 13, 7, 35, 63}},
                                                                      {145, {1, 3, 5, 9, 1, 25, 53}},
                                                                      {157, {1, 3, 1, 13, 9, 35, 107}},
                                                                      {167, {1, 3, 1, 5, 27, 61, 31}},
                                                                      {171, {1, 1, 5, 11, 19, 41, 61}},
                                                                      {185, {1, 3, 5, 3, 3, 13, 69}},
                                                                      {191, {1, 1, 7, 13, 1, 19, 1}},
                                                                      {193, {1, 3, 7, 5, 13, 19, 59}},
                                                                      {203, {1, 1, 3, 9, 25, 29, 41}},
                                                                      {211, {1, 3, 5, 13, 23, 1, 55}},
                                                                      {213, {1, 3, 7, 3, 13, 59, 17}},
                                                                      {229, {1, 3, 1, 3, 5, 53, 69}},
                                                                      {239, {1, 1, 5, 5, 23, 33, 13}},
                                                                      {241, {1, 1, 7, 7, 1, 61, 123}},
                                                                      {247, {1, 1, 7, 9, 13, 61, 49}},
                                                                      {253, {1, 3, 3, 5, 3, 55, 33}},
                                                                      {285, {1, 3, 1, 15, 31, 13, 49, 245}},
                                                                      {299, {1, 3, 5, 15, 31, 59, 63, 97}},
                                                                      {301, {1, 3, 1, 11, 11, 11, 77, 249}},
                                                                      {333, {1, 3, 1, 11, 27, 43, 71, 9}},
                                                                      {351, {1, 1, 7, 15, 21, 11, 81, 45}},
                                                                      {355, {1, 3, 7, 3, 25, 31, 65, 79}},
                                                                      {357, {1, 3, 1, 1, 19, 11, 3, 205}},
                                                                      {361, {1, 1, 5, 9, 19, 21, 29, 157}},
                                                                      {369, {1, 3, 7, 11, 1, 33, 89, 185}},
                                                                      {391, {1, 3, 3, 3, 15, 9, 79, 71}},
                                                                      {397, {1, 3, 7, 11, 15, 39, 119, 27}}}};

int degree_of(std::uint32_t polynomial) {
  int degree = 0;
  while (polynomial >> (degree + 1)) ++degree;
  return degree;
}

// Direction numbers v_1 to v_32 of a coordinate (Bratley and Fox 1988, "Algorithm 659", equations 2 and 3).
std::array<std::uint32_t, kBits> direction_numbers(int dimension) {
  std::array<std::uint32_t, kBits> v{};
  if (dimension == 0) {
    for (int i = 0; i < kBits; ++i) v[static_cast<std::size_t>(i)] = 1u << (kBits - 1 - i);
    return v;
  }
  const Direction& d = kDirections[static_cast<std::size_t>(dimension - 1)];
  const int degree = degree_of(d.polynomial);
  for (int i = 0; i < kBits; ++i) {
    auto& now = v[static_cast<std::size_t>(i)];
    if (i < degree) {
      now = d.initial[static_cast<std::size_t>(i)] << (kBits - 1 - i);
      continue;
    }
    const std::uint32_t before = v[static_cast<std::size_t>(i - degree)];
    now = before ^ (before >> degree);
    for (int k = 1; k < degree; ++k)
      if ((d.polynomial >> (degree - k)) & 1u) now ^= v[static_cast<std::size_t>(i - k)];
  }
  return v;
}

std::uint32_t sobol_bits(std::uint32_t index, int dimension) {
  const auto v = direction_numbers(dimension);
  const std::uint32_t gray = index ^ (index >> 1);
  std::uint32_t bits = 0;
  for (int i = 0; i < kBits; ++i)
    if ((gray >> i) & 1u) bits ^= v[static_cast<std::size_t>(i)];
  return bits;
}

void require_dimensions(int dimensions) {
  if (dimensions < 1 || dimensions > kMaxSobolDimensions)
    throw std::invalid_argument("sobol: " + std::to_string(dimensions) + " dimensions; use 1 to " +
                                std::to_string(kMaxSobolDimensions));
}

}  // namespace

std::vector<double> sobol_point(std::uint32_t index, int dimensions) {
  require_dimensions(dimensions);
  std::vector<double> point;
  for (int i = 0; i < dimensions; ++i) point.push_back(sobol_bits(index, i) * 0x1p-32);
  return point;
}

std::vector<double> scrambled_sobol_point(std::uint32_t index, int dimensions, std::uint64_t seed) {
  require_dimensions(dimensions);
  std::vector<double> point;
  for (int i = 0; i < dimensions; ++i) {
    const std::uint64_t own = sync::mixed(seed, static_cast<std::uint64_t>(i));
    const std::uint32_t bits = sobol_bits(index, i);
    std::uint32_t out = 0;
    for (int bit = 0; bit < kBits; ++bit) {
      // The key of a prefix: its bits behind a leading one, so that prefixes of different lengths differ.
      const std::uint64_t prefix = bit == 0 ? 1 : (1ull << bit) | (bits >> (kBits - bit));
      const std::uint32_t flip = static_cast<std::uint32_t>(sync::mixed(own, prefix) >> 63);
      out |= (((bits >> (kBits - 1 - bit)) & 1u) ^ flip) << (kBits - 1 - bit);
    }
    point.push_back((out + 0.5) * 0x1p-32);
  }
  return point;
}

}  // namespace tactus::observer
