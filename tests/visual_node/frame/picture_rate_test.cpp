#include "visual_node/frame/picture_rate.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {
constexpr std::int64_t kBegin_ns = 7'000'000'000;
// Ticks of 60 Hz for `seconds`, each up to 4 ms late. Returns the times of the pictures, ns since the beginning.
std::vector<std::int64_t> pictures(PictureRate& rate, double rate_Hz, double seconds) {
  std::mt19937 random(2);
  std::vector<std::int64_t> out;
  for (int i = 0; i < static_cast<int>(seconds * 60); ++i) {
    const std::int64_t t = i * 1'000'000'000LL / 60 + static_cast<std::int64_t>(random() % 4'000'000);
    if (rate.due(sync::host_time(kBegin_ns + t), rate_Hz, 60)) out.push_back(t);
  }
  return out;
}
}  // namespace

TEST_CASE("A picture rate below the tick rate holds on average, each picture in its nearest tick") {
  const double rate_Hz = GENERATE(0.7, 1.0, 5.0, 7.3, 15.0, 24.0, 30.0, 59.0);
  PictureRate rate;
  const auto shown = pictures(rate, rate_Hz, 20);
  REQUIRE(static_cast<double>(shown.size()) == Approx(20 * rate_Hz).margin(1));
  CHECK(rate.held() == sync::from_seconds(1 / rate_Hz));
  for (std::size_t i = 0; i < shown.size(); ++i)
    CHECK(std::abs(static_cast<double>(shown[i] - shown[0]) * 1e-9 - static_cast<double>(i) / rate_Hz) <
          0.5 / 60 + 0.005);
}

TEST_CASE("Without a rate, or with a higher one than the ticks, each tick has a picture") {
  const double rate_Hz = GENERATE(0.0, 60.0, 200.0);
  PictureRate rate;
  CHECK(pictures(rate, rate_Hz, 1).size() == 60);
  CHECK(rate.held() == milliseconds(0));
}

TEST_CASE("One picture follows a stall, and a higher rate or a new scene takes effect at once") {
  PictureRate rate;
  const auto at = [](int ms) { return sync::host_time(kBegin_ns + std::int64_t{ms} * 1'000'000); };
  CHECK(rate.due(at(0), 1, 60));
  CHECK_FALSE(rate.due(at(500), 1, 60));
  CHECK(rate.due(at(7300), 1, 60));
  CHECK_FALSE(rate.due(at(7317), 1, 60));
  CHECK(rate.due(at(7334), 10, 60));
  CHECK_FALSE(rate.due(at(7350), 10, 60));
  rate.restart();
  CHECK(rate.due(at(7367), 10, 60));
}
