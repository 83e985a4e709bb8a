// Tests of the line protocol of the trial runner: non-blocking, without loss of order.
#include "scripts/trial_runner/lines.h"

#include <unistd.h>

#include <catch2/catch.hpp>

using tactus::trial_runner::Lines;

namespace {

struct Pipes {
  Pipes() { REQUIRE((pipe(in) == 0 && pipe(out) == 0)); }
  ~Pipes() {
    for (const int d : {in[0], in[1], out[0], out[1]}) close(d);
  }
  void write_in(const std::string& text) {
    REQUIRE(write(in[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  int in[2], out[2];
};

}  // namespace

TEST_CASE("Requests are read line by line without blocking") {
  Pipes p;
  Lines lines(p.in[0], p.out[1]);
  CHECK_FALSE(lines.next());
  p.write_in("one\ntw");
  CHECK(lines.next() == "one");
  CHECK_FALSE(lines.next());
  p.write_in("o\n");
  CHECK(lines.next() == "two");
  CHECK_FALSE(lines.ended());
  close(p.in[1]);
  CHECK_FALSE(lines.next());
  CHECK(lines.ended());
}

TEST_CASE("An endless request or an unread output ends with an error and does not block") {
  Pipes p;
  Lines lines(p.in[0], p.out[1]);
  const auto request_without_end = [&] {
    for (int i = 0; i < 100; ++i) {
      p.write_in(std::string(4096, 'x'));
      lines.next();
    }
  };
  CHECK_THROWS_WITH(request_without_end(), Catch::Contains("longer than 128 KiB"));
  const auto too_much = [&] {
    for (int i = 0; i < 20; ++i) lines.write_line(std::string(1 << 20, 'y'));
  };
  CHECK_THROWS_WITH(too_much(), Catch::Contains("unread"));
}
