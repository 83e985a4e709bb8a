// Tests of reassembly from a wire that loses, repeats, reorders and forges pages: only whole messages come out, each once, and memory
// stays bounded.
#include "sync/bus/page_assembler.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>

using namespace tactus::sync;

namespace {

struct Sent {
  std::int64_t key;
  int number, count;
};

// The text of a page: its message and its page number.
std::string text(const Sent& s) { return std::to_string(s.key) + "/" + std::to_string(s.number) + " "; }

std::string text(std::int64_t key, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text(Sent{key, i, count});
  return all;
}

template <class Group>
std::string text_of(const Group& group) {
  std::string all;
  for (const auto& [number, page] : group.pages) all += page;
  return all;
}

using Assembler = PageAssembler<std::string, std::int64_t>;

}  // namespace

TEST_CASE("A message comes out with its last page, in the order of its pages, for any order of arrival") {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    const int count = 1 + static_cast<int>(random() % 12);
    std::vector<int> order(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) order[static_cast<std::size_t>(i)] = i;
    std::shuffle(order.begin(), order.end(), random);
    Assembler pages({});
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto* whole = pages.add(round, order[i], count, text(Sent{round, order[i], count}));
      REQUIRE((whole != nullptr) == (i + 1 == order.size()));
      if (whole) CHECK(text_of(*whole) == text(round, count));
    }
    CHECK(pages.size() == 0);
  }
}

TEST_CASE("Of pages that are lost, repeated and reordered, each message that is whole comes out once and no other does") {
  const auto order = GENERATE(PageOrder::kFirstPage, PageOrder::kNewestPage, PageOrder::kKey);
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const auto chance = [&](double p) { return std::uniform_real_distribution<>(0, 1)(random) < p; };
    const double loss = 0.1 * (seed % 4), twice = 0.1 * (seed % 3);
    std::vector<Sent> wire;
    std::map<std::int64_t, int> counts;
    std::set<std::int64_t> lost;
    for (std::int64_t key = 0; key < 60; ++key) {
      const int count = counts[key] = 1 + static_cast<int>(random() % 8);
      for (int number = 0; number < count; ++number) {
        if (chance(loss)) {
          lost.insert(key);
          continue;
        }
        wire.push_back({key, number, count});
        if (chance(twice)) wire.push_back(wire.back());
      }
    }
    for (int round = 0; round < 5; ++round)
      for (std::size_t i = 0; i + 1 < wire.size(); ++i)
        if (chance(0.3)) std::swap(wire[i], wire[i + 1]);
    Assembler pages({.groups = 60, .pages = 8, .remembered = 60}, order);
    std::map<std::int64_t, int> came;
    for (const Sent& s : wire)
      if (const auto* whole = pages.add(s.key, s.number, s.count, text(s))) {
        REQUIRE(text_of(*whole) == text(whole->key, counts[whole->key]));
        ++came[whole->key];
      }
    CAPTURE(seed);
    for (std::int64_t key = 0; key < 60; ++key) CHECK(came[key] == (lost.contains(key) ? 0 : 1));
  }
}

TEST_CASE("Forged pages never take more than the limits, and no page that cannot be is kept") {
  std::mt19937 random(7);
  const PageLimits limits{.groups = 5, .pages = 16, .total = 40, .remembered = 3};
  Assembler pages(limits, GENERATE(PageOrder::kFirstPage, PageOrder::kNewestPage, PageOrder::kKey));
  std::size_t given_up = 0;
  for (int i = 0; i < 20'000; ++i) {
    const int count = static_cast<int>(random() % 40) - 10, number = static_cast<int>(random() % 40) - 10;
    const auto* whole = pages.add(static_cast<std::int64_t>(random() % 50), number, count, "x", [&](Assembler::Group& g) {
      CHECK(g.pages.size() > 0);
      ++given_up;
    });
    REQUIRE(pages.size() <= limits.groups);
    if (!whole) continue;
    REQUIRE(number >= 0);
    REQUIRE(number < count);
    REQUIRE(count <= limits.pages);
    REQUIRE(whole->pages.size() == static_cast<std::size_t>(count));
  }
  CHECK(given_up > 0);
  for (const auto& [number, count] : {std::pair{0, 0}, {-1, 3}, {3, 3}, {0, 17}, {INT_MAX, INT_MAX}, {INT_MIN, 2}, {0, INT_MIN}}) {
    Assembler none(limits);
    CHECK_FALSE(none.add(1, number, count, "x"));
    CHECK(none.size() == 0);
  }
}

TEST_CASE("The incomplete message that is given up is the one that the order names") {
  const auto [order, gone] = GENERATE(std::pair{PageOrder::kFirstPage, 8}, std::pair{PageOrder::kNewestPage, 3}, std::pair{PageOrder::kKey, 1});
  Assembler pages({.groups = 3}, order);
  std::vector<std::int64_t> dropped;
  const auto drop = [&](Assembler::Group& g) { dropped.push_back(g.key); };
  for (const std::int64_t key : {8, 3, 1}) pages.add(key, 0, 3, "x", drop);
  for (const std::int64_t key : {8, 1}) pages.add(key, 1, 3, "x", drop);
  CHECK(dropped.empty());
  pages.add(5, 0, 3, "x", drop);
  CHECK(dropped == std::vector<std::int64_t>{gone});
}

TEST_CASE("All incomplete messages together keep the limit of pages, and a single one may be larger") {
  Assembler pages({.groups = 10, .pages = 100, .total = 6});
  for (int i = 0; i < 20; ++i) pages.add(1, i, 100, "x");
  CHECK(pages.size() == 1);
  pages.add(2, 0, 4, "x");
  CHECK(pages.size() == 1);
  for (int i = 1; i < 3; ++i) CHECK_FALSE(pages.add(2, i, 4, "x"));
  CHECK(pages.add(2, 3, 4, "x"));
}

TEST_CASE("A page that gives another count starts its message again, and a repeated page replaces the one before") {
  Assembler pages({});
  CHECK_FALSE(pages.add(1, 0, 3, "old "));
  CHECK_FALSE(pages.add(1, 0, 2, "a "));
  CHECK_FALSE(pages.add(1, 0, 2, "b "));
  const auto* whole = pages.add(1, 1, 2, "c");
  REQUIRE(whole);
  CHECK(text_of(*whole) == "b c");
}

TEST_CASE("Repeated pages of a message that is remembered as complete begin no new one") {
  Assembler pages({.remembered = 1});
  CHECK(pages.add(1, 0, 1, "x"));
  CHECK_FALSE(pages.add(1, 0, 1, "x"));
  CHECK(pages.repeated());
  CHECK(pages.add(2, 0, 1, "x"));
  CHECK_FALSE(pages.repeated());
  CHECK(pages.add(1, 0, 1, "x"));
}

TEST_CASE("Dropping by key leaves the other incomplete messages as they are") {
  Assembler pages({}, PageOrder::kKey);
  for (const std::int64_t key : {1, 2, 3}) pages.add(key, 0, 2, "x");
  pages.drop_if([](std::int64_t key) { return key < 3; });
  CHECK(pages.size() == 1);
  CHECK(pages.add(3, 1, 2, "y"));
  pages.add(4, 0, 2, "x");
  pages.clear();
  CHECK_FALSE(pages.add(4, 1, 2, "y"));
}
