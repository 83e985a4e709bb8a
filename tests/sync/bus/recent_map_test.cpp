// Tests of the map that keeps the newest keys.
#include "sync/bus/recent_map.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace tactus::sync;

TEST_CASE("A recent map holds only the newest keys, each with its first value") {
  std::mt19937 random(3);
  for (const std::size_t max : {1u, 2u, 7u, 64u}) {
    RecentMap<int, int> recent(max);
    std::vector<std::pair<int, int>> expected;  // oldest first
    for (int i = 0; i < 2000; ++i) {
      const int key = static_cast<int>(random() % 100);
      const auto known = std::find_if(expected.begin(), expected.end(), [&](const auto& e) { return e.first == key; });
      const bool is_new = known == expected.end();
      const auto [value, fresh] = recent.try_emplace(key, i);
      REQUIRE(fresh == is_new);
      REQUIRE(value == (is_new ? i : known->second));
      if (is_new) expected.push_back({key, i});
      if (expected.size() > max) expected.erase(expected.begin());
      REQUIRE(recent.size() == expected.size());
    }
    for (int key = 0; key < 100; ++key) {
      const auto known = std::find_if(expected.begin(), expected.end(), [&](const auto& e) { return e.first == key; });
      const int* value = recent.find(key);
      REQUIRE((value != nullptr) == (known != expected.end()));
      if (value) CHECK(*value == known->second);
    }
    std::vector<std::pair<int, int>> newest;
    recent.each_newest_first([&](int key, int value) { return newest.push_back({key, value}), newest.size() < 3; });
    for (std::size_t i = 0; i < newest.size(); ++i) CHECK(newest[i] == expected[expected.size() - 1 - i]);
    CHECK(newest.size() == std::min<std::size_t>(3, max));
    recent.clear();
    CHECK(recent.size() == 0);
    CHECK(recent.try_emplace(1, 5).second);
  }
}
