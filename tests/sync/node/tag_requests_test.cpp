// Tests of requests for tagged variables and of their expiry.
#include "sync/node/tag_requests.h"

#include <catch2/catch.hpp>
#include <random>
#include <regex>
#include <tactus/tag_request_t.hpp>

#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::at_ms;

namespace {

tag_request_t request(std::int64_t incarnation, std::vector<std::string> patterns, std::int64_t run_id = 7) {
  tag_request_t m{};
  m.header.run_id = run_id, m.header.incarnation = incarnation;
  m.patterns = std::move(patterns), m.pattern_count = static_cast<std::int32_t>(m.patterns.size());
  return m;
}

}  // namespace

TEST_CASE("A star in a pattern matches any characters") {
  std::mt19937 random(1);
  const auto text = [&](const char* letters, std::size_t kinds) {
    std::string t;
    for (auto n = random() % 7; n > 0; --n) t += letters[random() % kinds];
    return t;
  };
  int matched = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string pattern = text("ab.*", 4), name = text("ab.", 3);
    std::string expression;
    for (const char c : pattern) expression += c == '*' ? ".*" : c == '.' ? "\\." : std::string(1, c);
    const bool expected = std::regex_match(name, std::regex(expression));
    matched += expected;
    REQUIRE(matches(pattern, name) == expected);
  }
  CHECK(matched > 1000);
}

TEST_CASE("A pattern with many stars is matched quickly") {
  CHECK_FALSE(matches("*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*ab", std::string(100, 'a')));
}

TEST_CASE("A request holds for three seconds") {
  TagRequests requests(7);
  CHECK(requests.push(request(1, {"sim_node.*"}), at_ms(0)));
  CHECK_FALSE(requests.push(request(1, {"sim_node.*"}), at_ms(1000)));
  CHECK_FALSE(requests.expire(at_ms(4000)));
  CHECK(requests.is_requested("sim_node.work"));
  CHECK_FALSE(requests.is_requested("audio_node.work"));
  CHECK(requests.expire(at_ms(4001)));
  CHECK_FALSE(requests.any());
  CHECK_FALSE(requests.is_requested("sim_node.work"));
}

TEST_CASE("Requests of several requesters are combined, and each expires on its own") {
  TagRequests requests(7);
  requests.push(request(1, {"a.*"}), at_ms(0));
  CHECK(requests.push(request(2, {"*.b"}), at_ms(2000)));
  CHECK(requests.is_requested("a.c"));
  CHECK(requests.is_requested("c.b"));
  CHECK(requests.expire(at_ms(3500)));
  CHECK_FALSE(requests.is_requested("a.c"));
  CHECK(requests.is_requested("c.b"));
  CHECK(requests.push(request(2, {"d"}), at_ms(3600)));
  CHECK_FALSE(requests.is_requested("c.b"));
}

TEST_CASE("Requests of another run and of a 65th requester are ignored") {
  TagRequests requests(7);
  CHECK_FALSE(requests.push(request(1, {"*"}, 8), at_ms(0)));
  CHECK_FALSE(requests.any());
  for (int i = 0; i < 64; ++i) CHECK(requests.push(request(100 + i, {"x"}), at_ms(0)));
  CHECK_FALSE(requests.push(request(999, {"*"}), at_ms(1)));
  CHECK_FALSE(requests.is_requested("y"));
  requests.expire(at_ms(3500));
  CHECK(requests.push(request(999, {"*"}), at_ms(3500)));
  CHECK(requests.is_requested("y"));
}
