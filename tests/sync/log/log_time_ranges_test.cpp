// Tests of grouping the stamps of a log into time ranges.
#include "sync/log/log_time_ranges.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace tactus::sync;

namespace {

// Oracle of LogTimeRanges, by sorting all stamps: groups with gaps of more than kMaxGap_us between them.
struct Oracle {
  std::vector<std::vector<std::int64_t>> ages;
  std::size_t fullest = 0;
  explicit Oracle(std::vector<std::int64_t> stamps) {
    std::sort(stamps.begin(), stamps.end());
    for (const std::int64_t t : stamps) {
      if (ages.empty() || t - ages.back().back() > LogTimeRanges::kMaxGap_us) ages.emplace_back();
      ages.back().push_back(t);
      fullest = std::max(fullest, ages.back().size());
    }
  }
  bool good(const std::vector<std::int64_t>& age) const {
    return age.size() >= static_cast<std::size_t>(LogTimeRanges::kMinRunEvents) || age.size() == fullest;
  }
};

}  // namespace

TEST_CASE("Nearby time stamps form one range, for any order of arrival") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::int64_t> stamps;
    // From a few ranges to one range per stamp.
    const std::int64_t span_us = LogTimeRanges::kMaxGap_us * (1 + seed * 2);
    for (int i = 0; i < 300; ++i)
      stamps.push_back(static_cast<std::int64_t>(random()) * 4096 % span_us - (random() % 3 ? 0 : span_us * 2));
    LogTimeRanges ages;
    for (const std::int64_t t : stamps) ages.add(t);
    const Oracle oracle(stamps);
    std::int64_t misdated = 0;
    for (const auto& age : oracle.ages) {
      for (const std::int64_t t : age) CHECK(ages.in_run(t) == oracle.good(age));
      if (!oracle.good(age)) misdated += static_cast<std::int64_t>(age.size());
    }
    CHECK(ages.misdated() == misdated);
  }
}

TEST_CASE("A million random time stamps need bounded memory, and the range of the run is found") {
  std::mt19937_64 random(1);
  LogTimeRanges ages;
  constexpr int kNoise = 1'000'000;
  for (int i = 0; i < kNoise; ++i) {
    ages.add(static_cast<std::int64_t>(random() % 4'000'000'000'000'000));
    if (i % 100 == 0) ages.add(-1'000'000'000'000 + i);
  }
  CHECK(ages.in_run(-1'000'000'000'000 + kNoise / 2));
  CHECK_FALSE(ages.in_run(-2'000'000'000'000));
  CHECK(ages.misdated() > 0);
  CHECK(ages.misdated() <= kNoise);
}
